// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dolp {

/// The target of a path with symbolic links resolved; it need not exist. Errors: IoError for too many of them.
std::filesystem::path follow_links(std::filesystem::path path);

/// Refuses an output path of any suffix, before anything is computed for it; "-" is standard output.
///
/// Errors: IoError when it is a folder, a file that is read-only or a name that is too long, or its folder is missing
/// or cannot be written to.
void check_writable(const std::filesystem::path& path);

/// A file under way to `path`: written in any order, then synced and renamed. Until then it has no name where the file
/// system allows that; else it is .dolp-*.tmp, which a process that is killed leaves. A symbolic link stays, its target
/// is replaced; an existing file keeps its permissions. Into a device or pipe the bytes go when all are there.
class AtomicFile {
 public:
  /// Errors: those of check_writable; IoError when no file can be made.
  explicit AtomicFile(const std::filesystem::path& path);
  /// A file that has the name `under_way` until it is whole, and keeps it, with what was written, if it never is; one
  /// that is there already is opened with its content. It is locked.
  /// Errors: as above; IoError for a link, which could lead to any file; InputError when another process writes it.
  AtomicFile(const std::filesystem::path& path, const std::filesystem::path& under_way);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;
  ~AtomicFile();

  const std::filesystem::path& path() const;
  /// Puts bytes at an offset. Errors: IoError; Cancelled when interrupted().
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  void append(std::string_view bytes);
  std::uint64_t size() const;
  /// Errors: IoError, also for fewer bytes than asked for.
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  /// Sets the length; new bytes are zero. Errors: IoError.
  void resize(std::uint64_t size);
  /// Makes the file `path`. Errors: IoError, Cancelled; `path` is as it was then.
  void commit();
  /// Removes a file with a name.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes text or bytes to standard output for "-", else as an AtomicFile.
/// Errors: IoError, Cancelled when interrupted(); `path` is as it was.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
