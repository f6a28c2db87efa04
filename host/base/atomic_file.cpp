#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/error.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;
constexpr int kMostNames = 1000;
constexpr mode_t kNewFileMode = 0666;
constexpr mode_t kPermissionBits = 0777;
constexpr mode_t kWriteBits = 0222;

[[noreturn]] void fail(const fs::path& path, const std::string& what) { throw IoError(path.string() + ": " + what); }

[[noreturn]] void fail_errno(const fs::path& path, const std::string& what) {
  const int error = errno;
  fail(path, what + ": " + std::generic_category().message(error));
}

/// An open file descriptor.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&&) = delete;
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const { return descriptor_; }
  // Some file systems report a failed write only here.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// A file name that is unlinked unless it was released.
class Temporary {
 public:
  explicit Temporary(fs::path path) : path_(std::move(path)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  void release() { path_.clear(); }

 private:
  fs::path path_;
};

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// std::filesystem::canonical wants the target to exist; an output need not.
fs::path follow_links(fs::path path) {
  std::error_code error;
  for (int links = 0; fs::is_symlink(path, error); ++links) {
    if (links == kMostLinks) fail(path, "too many symbolic links");
    const fs::path target = fs::read_symlink(path, error);
    if (error) fail(path, "cannot read the symbolic link: " + error.message());
    path = folder_of(path) / target;
  }
  return path;
}

bool is_device_or_pipe(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_block_file(status) || fs::is_socket(status);
}

void write_all(int descriptor, const fs::path& path, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_errno(path, "cannot write");
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_directly(const fs::path& path, std::string_view content) {
  File file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) fail_errno(path, "cannot open for writing");
  write_all(file.get(), path, content);
  if (!file.close()) fail_errno(path, "cannot write");
}

struct NamedFile {
  fs::path path;
  File file;
};

/// Creates an empty file of a new name beside `target`, with the permissions that the target has or would get.
NamedFile create_temporary(const fs::path& target) {
  for (int i = 0; i < kMostNames; ++i) {
    const fs::path path =
        folder_of(target) / (".dolp-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".tmp");
    File file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode));
    if (file.get() < 0 && errno == EEXIST) continue;
    if (file.get() < 0) fail_errno(target, "cannot create a file in its folder");
    struct stat existing {};
    const bool exists = ::stat(target.c_str(), &existing) == 0;
    // Permissions that cannot be kept are no reason to lose the result.
    if (exists) static_cast<void>(!::fchmod(file.get(), existing.st_mode & kPermissionBits));
    return {path, std::move(file)};
  }
  fail(target, "too many temporary files in its folder; remove .dolp-*.tmp");
}

void sync_folder(const fs::path& folder, const fs::path& path) {
  const File file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // Some file systems cannot sync a folder at all.
  if (file.get() < 0 || (::fsync(file.get()) != 0 && errno != EINVAL)) fail_errno(path, "cannot sync its folder");
}

void write_and_rename(const fs::path& path, const fs::path& target, std::string_view content) {
  auto [name, file] = create_temporary(target);
  Temporary temporary(name);
  write_all(file.get(), path, content);
  if (::fsync(file.get()) != 0 || !file.close()) fail_errno(path, "cannot write");
  if (::rename(name.c_str(), target.c_str()) != 0) fail_errno(path, "cannot rename the finished file");
  temporary.release();
  sync_folder(folder_of(target), path);
}

}  // namespace

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
  struct stat existing {};
  // Root may write to what is read-only, but did not say so.
  if (::stat(target.c_str(), &existing) == 0 && (existing.st_mode & kWriteBits) == 0) {
    fail(path, "is read-only; remove it first, or write to another file");
  }
  const fs::path folder = folder_of(target);
  if (!fs::is_directory(folder, error)) fail(path, "there is no folder " + folder.string());
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail_errno(path, "cannot write to the folder " + folder.string());
}

void write_text_atomically(const fs::path& path, std::string_view content) {
  if (path == "-") return write_all(STDOUT_FILENO, "standard output", content);
  check_writable(path);
  const fs::path target = follow_links(path);
  if (is_device_or_pipe(target)) return write_directly(path, content);
  write_and_rename(path, target, content);
}

}  // namespace dolp
