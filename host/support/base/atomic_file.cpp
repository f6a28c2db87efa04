#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <dolp/errors.hpp>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/interrupt.hpp"
#include "base/temporary_folder.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;
constexpr int kMostNames = 1000;
constexpr std::size_t kBytesAtOnce = 1U << 20U;
constexpr const char* kOpenFiles = "/proc/self/fd";
constexpr mode_t kNewFileMode = 0666;
constexpr mode_t kPermissionBits = 0777;
constexpr mode_t kWriteBits = 0222;

[[noreturn]] void fail(const fs::path& path, const std::string& what) { throw IoError(path.string() + ": " + what); }

[[noreturn]] void fail_errno(const fs::path& path, const std::string& what) {
  const int error = errno;
  fail(path, what + ": " + std::generic_category().message(error));
}

fs::path parent_folder(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

bool is_device_or_pipe(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_other(status);
}

/// Writes all bytes by calls of write(bytes, size), which returns the number of bytes that it wrote, or -1.
template <class Write>
void write_all(const fs::path& path, std::string_view content, const Write& write) {
  while (!content.empty()) {
    if (interrupted()) throw Cancelled();
    const ssize_t written = write(content.data(), std::min(content.size(), kBytesAtOnce));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_errno(path, "cannot write");
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_all(int descriptor, const fs::path& path, std::string_view content) {
  write_all(path, content, [&](const char* bytes, std::size_t size) { return ::write(descriptor, bytes, size); });
}

void read_all(int descriptor, const fs::path& path, std::uint64_t offset, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::pread(descriptor, bytes, size, static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_errno(path, "cannot read");
    if (count == 0) fail(path, "is cut short");
    bytes += count;
    offset += static_cast<std::uint64_t>(count);
    size -= static_cast<std::size_t>(count);
  }
}

fs::path temporary_name(const fs::path& target, int number) {
  return parent_folder(target) / (".dolp-" + std::to_string(::getpid()) + "-" + std::to_string(number) + ".tmp");
}

/// Calls make(name) with temporary names in the folder of `target`, until a name is free. Returns name and result.
template <class Make>
std::pair<fs::path, int> with_new_name(const fs::path& target, const Make& make) {
  for (int i = 0; i < kMostNames; ++i) {
    fs::path name = temporary_name(target, i);
    const int result = make(name);
    if (result < 0 && errno == EEXIST) continue;
    if (result < 0) fail_errno(target, "cannot create a file in its folder");
    return {std::move(name), result};
  }
  fail(target, "too many temporary files in its folder; remove .dolp-*.tmp");
}

/// Creates a file without a name or, if the system cannot, with a temporary name. Returns the file and its name.
std::pair<FileDescriptor, fs::path> create_temporary(const fs::path& target) {
  const bool can_be_linked = ::access(kOpenFiles, X_OK) == 0;
  const int unnamed =
      can_be_linked ? ::open(parent_folder(target).c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, kNewFileMode) : -1;
  if (unnamed >= 0) return {FileDescriptor(unnamed), fs::path()};
  auto [name, named] = with_new_name(target, [](const fs::path& path) {
    return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
  });
  return {FileDescriptor(named), std::move(name)};
}

std::string open_file(const FileDescriptor& file) { return std::string(kOpenFiles) + '/' + std::to_string(file.get()); }

/// Gives a temporary name in the folder of `target` to a file without a name. Returns the name.
fs::path link_with_new_name(const FileDescriptor& file, const fs::path& target) {
  const std::string own = open_file(file);
  const auto link = [&](const fs::path& name) {
    return ::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
  };
  return with_new_name(target, link).first;
}

void keep_permissions(const FileDescriptor& file, const fs::path& target) {
  struct stat existing {};
  const bool exists = ::stat(target.c_str(), &existing) == 0;
  // A failure of fchmod is ignored, because the file's content is more important than its permissions.
  if (exists) static_cast<void>(!::fchmod(file.get(), existing.st_mode & kPermissionBits));
}

bool has_name(const struct stat& file, const fs::path& name) {
  struct stat named {};
  return ::lstat(name.c_str(), &named) == 0 && named.st_dev == file.st_dev && named.st_ino == file.st_ino;
}

void sync_folder(const fs::path& folder, const fs::path& path) {
  const FileDescriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // Some file systems cannot sync a folder at all (EINVAL).
  if (file.get() < 0 || (::fsync(file.get()) != 0 && errno != EINVAL)) fail_errno(path, "cannot sync its folder");
}

}  // namespace

// Does not use std::filesystem::canonical(), which fails for an output that does not exist yet.
fs::path follow_links(fs::path path) {
  std::error_code error;
  for (int links = 0; fs::is_symlink(path, error); ++links) {
    if (links == kMostLinks) fail(path, "too many symbolic links");
    const fs::path target = fs::read_symlink(path, error);
    if (error) fail(path, "cannot read the symbolic link: " + error.message());
    path = parent_folder(path) / target;
  }
  return path;
}

void check_writable(const fs::path& path) {
  if (path == "-") return;
  std::error_code error;
  if (fs::is_directory(path, error)) fail(path, "is a folder; a file name is expected");
  const fs::path target = follow_links(path);
  if (is_device_or_pipe(target)) {
    if (::access(target.c_str(), W_OK) != 0) fail_errno(path, "cannot write");
    return;
  }
  if (target.filename().empty()) fail(path, "is not a file name");
  const fs::path folder = parent_folder(target);
  const fs::file_status found = fs::status(folder, error);
  if (found.type() == fs::file_type::none)
    fail(path, "cannot look at the folder " + folder.string() + ": " + error.message());
  if (!fs::is_directory(found)) fail(path, "there is no folder " + folder.string());
  struct stat existing {};
  const bool exists = ::stat(target.c_str(), &existing) == 0;
  if (!exists && errno != ENOENT) fail_errno(path, "cannot create the file");
  // Looks at the mode, because access() lets root write even to files that the user has made read-only.
  if (exists && (existing.st_mode & kWriteBits) == 0) {
    fail(path, "is read-only; remove it first, or write to another file");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail_errno(path, "cannot write to the folder " + folder.string());
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

bool FileDescriptor::close() { return ::close(std::exchange(number_, -1)) == 0; }

AtomicFile::AtomicFile(const fs::path& path) : path_(path) {
  check_writable(path);
  target_ = follow_links(path);
  const bool is_device = is_device_or_pipe(target_);
  std::tie(file_, name_) = create_temporary(is_device ? temporary_files() / "-" : target_);
  if (!is_device) keep_permissions(file_, target_);
}

AtomicFile::AtomicFile(const fs::path& path, const fs::path& under_way)
    : path_(path), name_(under_way), is_kept_(true) {
  check_writable(path);
  target_ = follow_links(path);
  file_ = FileDescriptor(::open(under_way.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, kNewFileMode));
  if (file_.get() < 0 && errno == ELOOP) fail(under_way, "is a symbolic link; remove it");
  if (file_.get() < 0) fail_errno(under_way, "cannot create the file");
  const bool is_locked = ::flock(file_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  struct stat found {};
  if (::fstat(file_.get(), &found) != 0 || !S_ISREG(found.st_mode)) fail(under_way, "is not a regular file");
  // If the opened file no longer has the name `under_way`, another run has just renamed it.
  if (!is_locked || !has_name(found, under_way)) throw InputError(under_way.string() + ": another run writes it");
  if (found.st_nlink > 1) fail(under_way, "is a file that has other names too; remove it");
  keep_permissions(file_, target_);
}

AtomicFile::~AtomicFile() {
  if (file_.get() >= 0 && !name_.empty() && !is_kept_) ::unlink(name_.c_str());
}

fs::path AtomicFile::open_path() const {
  // Prefers the open file, because the name may be gone, or belong to another file by now.
  return ::access(kOpenFiles, X_OK) == 0 ? fs::path(open_file(file_)) : fs::absolute(name_);
}

void AtomicFile::write_at(std::uint64_t offset, const void* bytes, std::size_t size) {
  write_all(path_, {static_cast<const char*>(bytes), size}, [&](const char* next, std::size_t most) {
    const ssize_t written = ::pwrite(file_.get(), next, most, static_cast<off_t>(offset));
    if (written > 0) offset += static_cast<std::uint64_t>(written);
    return written;
  });
}

void AtomicFile::append(std::string_view bytes) { write_at(size(), bytes.data(), bytes.size()); }

std::uint64_t AtomicFile::size() const {
  struct stat now {};
  if (::fstat(file_.get(), &now) != 0) fail_errno(path_, "cannot read its size");
  return static_cast<std::uint64_t>(now.st_size);
}

void AtomicFile::read_at(std::uint64_t offset, void* bytes, std::size_t size) const {
  read_all(file_.get(), path_, offset, static_cast<char*>(bytes), size);
}

void AtomicFile::resize(std::uint64_t size) {
  if (::ftruncate(file_.get(), static_cast<off_t>(size)) != 0) fail_errno(path_, "cannot write");
}

void AtomicFile::copy_to_target() const {
  FileDescriptor device(::open(target_.c_str(), O_WRONLY | O_CLOEXEC));
  if (device.get() < 0 && interrupted()) throw Cancelled();
  if (device.get() < 0) fail_errno(path_, "cannot open for writing");
  std::string bytes;
  const std::uint64_t whole = size();
  for (std::uint64_t done = 0; done < whole; done += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBytesAtOnce, whole - done)));
    read_at(done, bytes.data(), bytes.size());
    write_all(device.get(), path_, bytes);
  }
  if (!device.close()) fail_errno(path_, "cannot write");
}

void AtomicFile::commit() {
  if (is_device_or_pipe(target_)) return copy_to_target();
  const fs::path folder = parent_folder(target_);  // allocated before the rename, because an allocation can fail
  if (interrupted()) throw Cancelled();
  if (::fsync(file_.get()) != 0) fail_errno(path_, "cannot write");
  if (name_.empty()) name_ = link_with_new_name(file_, target_);
  // The file stays locked until it has its final name. So no other run can continue it as an unfinished file.
  if (::rename(name_.c_str(), target_.c_str()) != 0) fail_errno(path_, "cannot rename the finished file");
  name_.clear();
  sync_folder(folder, path_);
}

void write_text_atomically(const fs::path& path, std::string_view content) {
  if (path == "-") return write_all(STDOUT_FILENO, "standard output", content);
  AtomicFile file(path);
  file.append(content);
  file.commit();
}

}  // namespace dolp
