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

/// Checks early that an output path can be written. "-" is standard output.
///
/// Errors: IoError if the path is a folder, a read-only file or too long, or if its folder is missing or not writable.
void check_writable(const std::filesystem::path& path);

/// A file that becomes `path`: written in any order, then synced and renamed. Until then it has no name or, if the file
/// system needs one, a name .dolp-*.tmp, which remains after a kill. A symbolic link stays and its target is replaced.
/// An existing file keeps its permissions. A device or pipe gets the bytes when the file is complete.
class AtomicFile {
 public:
  /// Errors: the errors of check_writable(); IoError if no file can be made.
  explicit AtomicFile(const std::filesystem::path& path);
  /// A locked file named `under_way` until it is complete. If it is never completed, it keeps this name and its bytes.
  /// Opens an existing file with its content.
  /// Errors: the errors of check_writable(); IoError if no file can be made, and for a symbolic link, which could lead
  /// to any file; InputError if another process writes it.
  AtomicFile(const std::filesystem::path& path, const std::filesystem::path& under_way);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;
  ~AtomicFile();

  const std::filesystem::path& path() const;
  /// Writes bytes at an offset. Errors: IoError; Cancelled if interrupted().
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  void append(std::string_view bytes);
  std::uint64_t size() const;
  /// Errors: IoError, also if the file has fewer bytes.
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  /// Sets the length; new bytes are zero. Errors: IoError.
  void resize(std::uint64_t size);
  /// Gives the complete file the name `path`. Errors: IoError, Cancelled; they leave `path` unchanged.
  void commit();
  /// Removes the file if it has a name.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes text or bytes to standard output for "-", otherwise to an AtomicFile.
/// Errors: IoError, Cancelled if interrupted(); they leave `path` unchanged.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
