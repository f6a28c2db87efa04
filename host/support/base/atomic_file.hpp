#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace dolp {

/// The path to which `path` leads if it is a symbolic link, otherwise `path`. Errors: IoError for too many links.
std::filesystem::path follow_links(std::filesystem::path path);

/// Checks before a computation that the output `path` can be written; "-" is standard output. Errors: IoError if `path`
/// is a folder, a read-only file or too long, or if the folder of `path` is missing or not writable.
void check_writable(const std::filesystem::path& path);

/// Closes the file descriptor. -1 stands for no file.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();
  int get() const { return number_; }
  bool close();  ///< false on failure: some file systems report a failed write only when the file is closed

 private:
  int number_;
};

/// A file that gets the name `path` only in commit(), when all bytes are written. Before, the file has no name, or the
/// name .dolp-*.tmp if the file system requires one. The new file has the permissions of the file that it replaces. If
/// `path` is a symbolic link, replaces the file at the end of the link. A device or pipe gets all bytes in commit().
class AtomicFile {
 public:
  /// Errors: the errors of check_writable(); IoError if no file can be made.
  explicit AtomicFile(const std::filesystem::path& path);
  /// Opens the file `under_way` with its content, or creates it, and locks it. Only commit() renames the file to
  /// `path`; without commit() the name stays `under_way`. Errors: the errors of check_writable(); IoError if no file
  /// can be made or `under_way` is a symbolic link; InputError if another process has locked the file.
  AtomicFile(const std::filesystem::path& path, const std::filesystem::path& under_way);
  AtomicFile(AtomicFile&&) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  const std::filesystem::path& path() const { return path_; }
  /// A path by which a library can open the incomplete file. It stays valid until commit().
  std::filesystem::path open_path() const;
  /// Writes bytes at an offset. Errors: IoError; Cancelled if interrupted().
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  void append(std::string_view bytes);
  std::uint64_t size() const;
  /// Reads bytes at an offset. Errors: IoError, also if the file ends before the last byte.
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  void resize(std::uint64_t size);  ///< additional bytes are zero. Errors: IoError
  /// Syncs the file and renames it to `path`. Until the rename `path` is unchanged. Errors: IoError, Cancelled.
  void commit();
  /// Makes the destructor remove the file, even if the file has the name `under_way`.
  void discard() { is_kept_ = false; }

 private:
  void copy_to_target() const;  ///< for a device or pipe

  std::filesystem::path path_;    ///< the argument of the constructor, for messages
  std::filesystem::path target_;  ///< follow_links(path)
  FileDescriptor file_;
  std::filesystem::path name_;  ///< temporary name of the incomplete file; empty if it has no name
  bool is_kept_ = false;        ///< the destructor does not remove an incomplete file
};

/// Writes `content` to an AtomicFile, or to standard output for "-". Errors: IoError; Cancelled if interrupted().
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
