// Memory file for HDF5 that takes only the memory of the bytes written to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

#include "table/hdf5_handle.hpp"

namespace dolp {

/// A file whose written bytes alone take memory; the rest reads as zero. HDF5's own files in memory take memory
/// for values that have not been written, and its files on disk do not survive a disk that fills up.
class Hdf5Memory {
 public:
  Hdf5Memory() = default;
  Hdf5Memory(const Hdf5Memory&) = delete;
  Hdf5Memory& operator=(const Hdf5Memory&) = delete;

  /// A property list for H5Fcreate, whose file is this memory. Errors: std::bad_alloc.
  Hdf5Handle access();

  /// The length of the file.
  std::uint64_t size() const { return size_; }
  void set_size(std::uint64_t size) { size_ = size; }
  void read(std::uint64_t offset, char* bytes, std::size_t count) const;
  /// Loses bytes for which there is no memory: HDF5 cannot close a file that fails to be written.
  void write(std::uint64_t offset, const char* bytes, std::size_t count);
  /// False where bytes were lost.
  bool is_whole() const { return is_whole_; }

 private:
  static constexpr std::size_t kPage = 4096;
  std::map<std::uint64_t, std::array<char, kPage>> pages_;  ///< by number
  std::uint64_t size_ = 0;
  bool is_whole_ = true;
};

}  // namespace dolp
