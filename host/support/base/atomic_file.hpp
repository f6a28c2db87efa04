#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dolp {

/// The path to which `path` leads if it is a symbolic link, otherwise `path`. Errors: IoError for too many links.
std::filesystem::path follow_links(std::filesystem::path path);

/// Checks before a computation that its output can be written; "-" is standard output. Errors: IoError if `path` is a
/// folder, a read-only file or too long, or if the folder of `path` is missing or not writable.
void check_writable(const std::filesystem::path& path);

/// A file that gets the name `path` only when it is complete. Write its bytes in any order, and then call commit().
/// Before commit() the file has no name. If the file system requires a name, it is .dolp-*.tmp, and the file remains if
/// the process is killed. If `path` is a symbolic link, the file at the end of the link is replaced, not the link. The
/// new file has the permissions of the file that it replaces. A device or pipe gets all bytes in commit().
class AtomicFile {
 public:
  /// Errors: the errors of check_writable(); IoError if no file can be made.
  explicit AtomicFile(const std::filesystem::path& path);
  /// Creates and locks a file that has the name `under_way` until it is complete. If commit() is never called, the file
  /// remains with this name. If a file `under_way` exists, opens this file and keeps its content.
  /// Errors: the errors of check_writable(); IoError if no file can be made, or if `under_way` is a symbolic link,
  /// which could lead to any file; InputError if another process has locked it.
  AtomicFile(const std::filesystem::path& path, const std::filesystem::path& under_way);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;
  ~AtomicFile();

  const std::filesystem::path& path() const;
  /// Writes bytes at an offset. Errors: IoError; Cancelled if interrupted().
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  void append(std::string_view bytes);
  std::uint64_t size() const;
  /// Reads bytes at an offset. Errors: IoError, also if the file ends before the last byte.
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  void resize(std::uint64_t size);  ///< additional bytes are zero. Errors: IoError
  /// Syncs the file and renames it to `path`. Errors: IoError, Cancelled; until the rename, `path` stays unchanged.
  void commit();
  /// Gives up the file: the destructor removes it, even if it is named `under_way`.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes text or bytes to standard output for "-", otherwise to an AtomicFile.
/// Errors: IoError; Cancelled if interrupted(). Until the AtomicFile is renamed, errors leave `path` unchanged.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
