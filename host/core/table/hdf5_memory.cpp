#include "table/hdf5_memory.hpp"

#include <H5FDpublic.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace dolp {
namespace {

/// An open file, as HDF5 passes it around.
struct OpenFile {
  H5FD_t base{};  // of HDF5, which wants it first
  Hdf5Memory* memory = nullptr;
};

Hdf5Memory& memory_of(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file)->memory; }

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const void* info = H5Pget_driver_info(access);
  auto* file = new (std::nothrow) OpenFile;
  if (file && info) std::memcpy(&file->memory, info, sizeof file->memory);
  return &file->base;
}

herr_t close_file(H5FD_t* file) {
  delete reinterpret_cast<OpenFile*>(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags) *flags = 0;
  return 0;
}

haddr_t end(const H5FD_t* file, H5FD_mem_t) { return memory_of(file).size(); }

herr_t set_end(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  memory_of(file).set_size(address);
  return 0;
}

herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* bytes) {
  memory_of(file).read(address, static_cast<char*>(bytes), size);
  return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* bytes) {
  memory_of(file).write(address, static_cast<const char*>(bytes), size);
  return 0;
}

H5FD_class_t driver() {
  constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;  // metadata and values apart
  H5FD_class_t driver{};
  driver.name = "dolp memory";
  driver.maxaddr = HADDR_MAX;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(Hdf5Memory*);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = end;
  driver.set_eoa = set_end;
  driver.get_eof = end;
  driver.read = read_bytes;
  driver.write = write_bytes;
  std::ranges::copy(kMap, driver.fl_map);
  return driver;
}

}  // namespace

Hdf5Handle Hdf5Memory::access() {
  static const H5FD_class_t kDriver = driver();
  static const hid_t kNumber = H5FDregister(&kDriver);
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Hdf5Memory* self = this;
  if (kNumber < 0 || !access || H5Pset_driver(access.id(), kNumber, &self) < 0) throw std::bad_alloc();
  return access;
}

void Hdf5Memory::read(std::uint64_t offset, char* bytes, std::size_t count) const {
  while (count > 0) {
    const std::size_t first = offset % kPage;
    const std::size_t part = std::min(count, kPage - first);
    const auto page = pages_.find(offset / kPage);
    if (page == pages_.end()) {
      std::fill_n(bytes, part, '\0');
    } else {
      std::copy_n(page->second.begin() + first, part, bytes);
    }
    offset += part;
    bytes += part;
    count -= part;
  }
}

void Hdf5Memory::write(std::uint64_t offset, const char* bytes, std::size_t count) {
  try {
    while (count > 0) {
      const std::size_t first = offset % kPage;
      const std::size_t part = std::min(count, kPage - first);
      std::copy_n(bytes, part, pages_[offset / kPage].begin() + first);
      offset += part;
      bytes += part;
      count -= part;
    }
  } catch (const std::bad_alloc&) {
    is_whole_ = false;
  }
}

}  // namespace dolp
