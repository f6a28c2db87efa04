// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dolp {

/// The target of a path with symbolic links resolved; it need not exist. Errors: IoError for too many links.
std::filesystem::path follow_links(std::filesystem::path path);

/// Refuses an output path of any suffix, before anything is computed for it; "-" is standard output.
///
/// Errors: IoError if the path is a folder, a read-only file or too long a name, or if its folder is missing or not
/// writable.
void check_writable(const std::filesystem::path& path);

/// A file that becomes `path`: written in any order, then synced and renamed. Until then it has no name, or the name
/// .dolp-*.tmp if the file system needs one; a killed process leaves it. A symbolic link stays and its target is
/// replaced; an existing file keeps its permissions. A device or pipe gets the bytes when the file is complete.
class AtomicFile {
 public:
  /// Errors: the errors of check_writable(); IoError if no file can be made.
  explicit AtomicFile(const std::filesystem::path& path);
  /// A locked file that has the name `under_way` until it is complete, and keeps the name and its bytes if it never is.
  /// Opens an existing file with its content.
  /// Errors: the errors of check_writable(); IoError if no file can be made, and for a link, which could lead to any
  /// file; InputError if another process writes it.
  AtomicFile(const std::filesystem::path& path, const std::filesystem::path& under_way);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;
  ~AtomicFile();

  const std::filesystem::path& path() const;
  /// Puts bytes at an offset. Errors: IoError; Cancelled when interrupted().
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  void append(std::string_view bytes);
  std::uint64_t size() const;
  /// Errors: IoError, also if the file has fewer bytes.
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  /// Sets the length; new bytes are zero. Errors: IoError.
  void resize(std::uint64_t size);
  /// Makes the file `path`. Errors: IoError, Cancelled; they leave `path` unchanged.
  void commit();
  /// Removes a file with a name.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes text or bytes to standard output for "-", else as an AtomicFile.
/// Errors: IoError, Cancelled if interrupted(); they leave `path` unchanged.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
