#include "table/table_store.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <dolp/errors.hpp>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <utility>

#include <dolp/status.hpp>
#include "model/scene_entry.hpp"
#include "table/hdf5_handle.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kMostOverhead = 1U << 20U;  ///< bound of the bytes besides values: shapes, names, units

/// A file in memory, without a name. Only the bytes that are written take memory; all other bytes read as zero.
class MemoryFile {
 public:
  /// `table`: path of the table, for messages. Errors: IoError.
  explicit MemoryFile(std::string table) : table_(std::move(table)), descriptor_(::memfd_create("dolp", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail(std::strerror(errno));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(descriptor_); }

  [[noreturn]] void fail(const std::string& why) const {
    throw IoError(table_ + ": cannot make the table's head in memory: " + why);
  }
  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }
  std::uint64_t size() const {
    struct stat status {};
    return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
  }
  std::vector<char> read(std::uint64_t first, std::uint64_t end) const {
    std::vector<char> bytes(end - first);
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t count = ::pread(descriptor_, &bytes[done], bytes.size() - done, static_cast<off_t>(first + done));
      if (count <= 0) fail("it cannot be read back");
      done += static_cast<std::size_t>(count);
    }
    return bytes;
  }

 private:
  std::string table_;
  int descriptor_;
};

struct Hdf5Failure {
  std::string reason;      ///< error in HDF5's words; empty if HDF5 had no memory for it
  bool is_memory = false;  ///< true if memory was lacking

  static herr_t add(unsigned, const H5E_error2_t* error, void* failure) {
    auto& first_failure = *static_cast<Hdf5Failure*>(failure);
    if (first_failure.reason.empty() && error->desc) first_failure.reason = error->desc;
    first_failure.is_memory |=
        error->maj_num == H5E_RESOURCE || error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC;
    return 0;
  }
};

/// Makes HDF5 objects in a MemoryFile. Errors: if a call of HDF5 fails, std::bad_alloc or IoError with HDF5's reason.
class Writer {
 public:
  explicit Writer(const MemoryFile& memory) : memory_(memory) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // keeps HDF5 from printing errors
    const Hdf5Handle access = take(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    check(H5Pset_fapl_stdio(access.id()));  // the default driver would need a file with a name
    check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18));
    const Hdf5Handle creation = take(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    // The netCDF library refuses to write to a file that does not store in which order its objects were created.
    check(H5Pset_link_creation_order(creation.id(), kOrdered));
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    check(H5Pset_obj_track_times(creation.id(), false));  // without times, a scene gives the same bytes in each run
    file_ = take(H5Fcreate(memory.path().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  }

  const Hdf5Handle& file() const { return file_; }

  void check(herr_t code) const {
    if (code >= 0) return;
    Hdf5Failure failure;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, Hdf5Failure::add, &failure);
    if (failure.is_memory || failure.reason.empty()) throw std::bad_alloc();
    memory_.fail("HDF5: " + failure.reason);
  }

  void put_text(const Hdf5Handle& object, const char* name, const std::string& text) const {
    const Hdf5Handle type = text_type(std::max<std::size_t>(text.size(), 1));
    put(object, name, type.id(), type.id(), take(H5Screate(text.empty() ? H5S_NULL : H5S_SCALAR), H5Sclose),
        text.empty() ? nullptr : text.data());
  }
  Hdf5Handle text_type(std::size_t width) const {
    Hdf5Handle type = take(H5Tcopy(H5T_C_S1), H5Tclose);
    check(H5Tset_size(type.id(), width));
    check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8));
    return type;
  }
  void put_number(const Hdf5Handle& object, const char* name, double value) const {
    const hsize_t count = 1;
    put(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, take(H5Screate_simple(1, &count, nullptr), H5Sclose), &value);
  }
  // The masks are int: CF-1.8 has no unsigned int, and they must have the type of the status variable.
  void put_status_bits(const Hdf5Handle& object) const {
    std::array<int, kStatusBits.size()> masks{};
    std::array<const char*, kStatusBits.size()> meanings{};
    std::ranges::transform(kStatusBits, masks.begin(), [](const StatusBit& bit) { return static_cast<int>(bit.mask); });
    std::ranges::transform(kStatusBits, meanings.begin(), &StatusBit::meaning);
    const hsize_t count = masks.size();
    put(object, "flag_masks", H5T_STD_I32LE, H5T_NATIVE_INT, take(H5Screate_simple(1, &count, nullptr), H5Sclose),
        masks.data());
    put_text(object, "flag_meanings", fmt::format("{}", fmt::join(meanings, " ")));
  }

  /// Reserves space for the variable in the file. Values are not compressed, because compression takes longer than
  /// writing. They are not in chunks either, because HDF5 finds chunks through an index that has no checksum.
  Hdf5Handle define(const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* fill,
                    H5D_alloc_time_t allocation = H5D_ALLOC_TIME_EARLY) const {
    const Hdf5Handle creation = take(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    check(H5Pset_obj_track_times(creation.id(), false));
    // Without fill values, each variable is written only once. HDF5 requires fill values for texts of variable length.
    if (H5Tis_variable_str(type) <= 0) check(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER));
    check(H5Pset_alloc_time(creation.id(), allocation));
    if (fill) check(H5Pset_fill_value(creation.id(), type, fill));
    const Hdf5Handle space = take(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    return take(H5Dcreate2(file_.id(), name, type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Dclose);
  }

  void write(const Hdf5Handle& variable, hid_t memory_type, const void* values) const {
    check(H5Dwrite(variable.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  }

 private:
  static constexpr unsigned kOrdered = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

  Hdf5Handle take(hid_t id, Hdf5Handle::Close close) const {
    check(id < 0 ? -1 : 0);
    return {id, close};
  }
  void put(const Hdf5Handle& object, const char* name, hid_t type, hid_t memory_type, const Hdf5Handle& space,
           const void* value) const {
    const Hdf5Handle attribute =
        take(H5Acreate2(object.id(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (value) check(H5Awrite(attribute.id(), memory_type, value));
  }

  const MemoryFile& memory_;
  Hdf5Handle file_;
};

void put_long_text(const Writer& writer, const std::string& name, const std::string& text) {
  const std::vector<hsize_t> shape = {text.size()};
  const Hdf5Handle length =  // this variable is never written, so that it takes no space
      writer.define((name + "_length").c_str(), H5T_IEEE_F32BE, shape, nullptr, H5D_ALLOC_TIME_LATE);
  // For the netCDF library, this text marks a dimension without coordinates. It ends with the length in 10 characters.
  std::string digits = std::to_string(text.size());
  digits.insert(0, 10 - std::min<std::size_t>(digits.size(), 10), ' ');
  writer.check(H5DSset_scale(length.id(), ("This is a netCDF dimension but not a netCDF variable." + digits).c_str()));
  const Hdf5Handle variable = writer.define(name.c_str(), H5T_C_S1, shape, nullptr);
  writer.check(H5DSattach_scale(variable.id(), length.id(), 0));
  writer.write(variable, H5T_C_S1, text.data());
}

void put_more(const Writer& writer, const std::vector<Attribute>& attributes) {
  for (const Attribute& attribute : attributes) {
    if (const auto* number = std::get_if<double>(&attribute.value)) {
      writer.put_number(writer.file(), attribute.name.c_str(), *number);
    } else if (const auto& text = std::get<std::string>(attribute.value); text.size() > kMostAttributeBytes) {
      put_long_text(writer, attribute.name, text);
    } else {
      writer.put_text(writer.file(), attribute.name.c_str(), text);
    }
  }
}

void put_attributes(const Writer& writer, const TableHead& head) {
  writer.put_text(writer.file(), kConventions, kConventionsOfFiles);
  put_more(writer, head.attributes);
  if (const std::string data = spectral_data_of(head); !data.empty()) put_more(writer, {{kSpectralData, data}});
}

/// Writes a coordinate. If `along` is null, the coordinate is an axis of its own. Else it has a value for each value of
/// the axis `along`. If the table lacks this axis, its handle is empty, and the coordinate has a single value.
template <class Described>
Hdf5Handle put_coordinate(const Writer& writer, const Described& described, const std::vector<double>& values,
                          const Hdf5Handle* along = nullptr) {
  const std::vector<hsize_t> shape(!along || *along ? 1 : 0, values.size());
  Hdf5Handle variable = writer.define(described.name, H5T_IEEE_F64LE, shape, nullptr);
  if (!along) writer.check(H5DSset_scale(variable.id(), described.name));
  if (along && *along) writer.check(H5DSattach_scale(variable.id(), along->id(), 0));
  writer.put_text(variable, "long_name", described.long_name);
  writer.put_text(variable, "units", described.units);
  writer.write(variable, H5T_NATIVE_DOUBLE, values.data());
  return variable;
}

/// Writes the labels of an axis as texts of variable length, because texts of fixed length crash the netCDF library.
Hdf5Handle put_labels(const Writer& writer, const TableHead& head, Axis axis) {
  const AxisDescription& described = description_of(axis);
  std::vector<const char*> labels;
  for (const double value : head.axes[axis]) labels.push_back(head.label(axis, value).c_str());
  const Hdf5Handle type = writer.text_type(H5T_VARIABLE);
  Hdf5Handle variable = writer.define(described.name, type.id(), {labels.size()}, nullptr);
  writer.check(H5DSset_scale(variable.id(), described.name));
  writer.put_text(variable, "long_name", described.long_name);
  writer.write(variable, type.id(), labels.data());
  return variable;
}

using AxisVariables = AxisArray<Hdf5Handle>;  ///< the handle of an absent axis is empty

AxisVariables put_axes(const Writer& writer, const TableHead& head) {
  AxisVariables axes;
  for (const Axis axis : kAllAxes) {
    const AxisDescription& described = description_of(axis);
    const std::vector<double>& values = head.axes[axis];
    if (values.empty()) continue;
    axes[axis] = described.has_labels ? put_labels(writer, head, axis) : put_coordinate(writer, described, values);
  }
  if (!head.wind_m_s.empty()) put_coordinate(writer, kWind, head.wind_m_s, &axes[Axis::kSigma]);
  for (const TableCurve& described : kTableCurves) {
    const std::vector<double>& used = (head.*described.curve).used;
    if (!used.empty()) put_coordinate(writer, described, used, &axes[Axis::kWavelength]);
  }
  return axes;
}

/// Creates a variable over the axes of the table and, if `beta` is not null, over the further dimension beta.
Hdf5Handle define_over_axes(const Writer& writer, const TableHead& head, const AxisVariables& axes, const char* name,
                            hid_t type, const void* fill, const Hdf5Handle* beta = nullptr) {
  std::vector<hsize_t> shape;
  for (const std::vector<double>& values : head.axes) {
    if (!values.empty()) shape.push_back(values.size());
  }
  if (beta) shape.push_back(head.beta_deg.size());
  Hdf5Handle variable = writer.define(name, type, shape, fill);
  unsigned dimension = 0;
  for (const Hdf5Handle& axis : axes) {
    if (axis) writer.check(H5DSattach_scale(variable.id(), axis.id(), dimension++));
  }
  if (beta) writer.check(H5DSattach_scale(variable.id(), beta->id(), dimension));
  if (const std::string names = coordinates_of(head); !names.empty()) writer.put_text(variable, "coordinates", names);
  return variable;
}

std::uint64_t offset_of(const Writer& writer, const Hdf5Handle& variable) {
  const haddr_t offset = H5Dget_offset(variable.id());
  writer.check(offset == HADDR_UNDEF ? -1 : 0);
  return offset;
}

/// Defines a variable. Returns the offset of its values. `qualifiers`: names of variables with its error and status.
template <class Described>
std::uint64_t put_variable(const Writer& writer, const TableHead& head, const AxisVariables& axes,
                           const Described& described, const std::string& units, const char* qualifiers,
                           const Hdf5Handle* beta = nullptr) {
  constexpr double kFill = std::numeric_limits<double>::quiet_NaN();
  const Hdf5Handle variable = define_over_axes(writer, head, axes, described.name, H5T_IEEE_F64LE, &kFill, beta);
  writer.put_number(variable, "_FillValue", kFill);
  writer.put_text(variable, "long_name", described.long_name);
  writer.put_text(variable, "units", units);
  if (*qualifiers != '\0') writer.put_text(variable, "ancillary_variables", qualifiers);
  return offset_of(writer, variable);
}

std::uint64_t put_status(const Writer& writer, const TableHead& head, const AxisVariables& axes) {
  const Hdf5Handle status = define_over_axes(writer, head, axes, "status", H5T_STD_I32LE, nullptr);
  writer.put_text(status, "long_name", "status bits of the entry; 0 where nothing is wrong");
  writer.put_text(status, "units", "1");
  writer.put_status_bits(status);
  return offset_of(writer, status);
}

std::uint64_t bytes_of(const std::vector<Attribute>& attributes) {
  std::uint64_t bytes = 0;
  for (const Attribute& attribute : attributes) {
    const auto* text = std::get_if<std::string>(&attribute.value);
    bytes += attribute.name.size() + (text ? text->size() : sizeof(double));
  }
  return bytes;
}

std::uint64_t most_bytes(const TableLayout& layout) {
  const TableHead& head = layout.head;
  const std::size_t of_entry =
      layout.quantities.size() + 1 + layout.responses.size() * std::max<std::size_t>(head.beta_deg.size(), 1);
  std::uint64_t numbers = head.wind_m_s.size() + head.beta_deg.size() + head.size() * of_entry;
  for (const std::vector<double>& values : head.axes) numbers += values.size();
  for (const Axis axis : kAllAxes) {
    for (const std::string& label : head.labels[axis]) numbers += label.size() * head.axes[axis].size();
  }
  for (const TableCurve& described : kTableCurves) numbers += (head.*described.curve).used.size();
  return numbers * sizeof(double) + bytes_of(head.attributes) + spectral_data_of(head).size() + kMostOverhead;
}

/// Refuses a file longer than the system allows, because HDF5 would crash when the file cannot grow.
void check_room(const AtomicFile& file, std::uint64_t bytes) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || bytes <= limit.rlim_cur) return;
  throw IoError(fmt::format("{}: takes up to {} bytes, and files may have {} here (ulimit -f)", file.path().string(),
                            bytes, limit.rlim_cur));
}

}  // namespace

struct TableStore::Impl {
  TableLayout layout;
  AtomicFile& file;
  MemoryFile memory;
  Writer writer{memory};
  std::vector<std::uint64_t> offsets;  ///< offset of the values of each variable, in the order of for_each_variable

  Impl(TableLayout of_file, AtomicFile& of_table)
      : layout(std::move(of_file)), file(of_table), memory(of_table.path().string()) {
    const TableHead& head = layout.head;
    put_attributes(writer, head);
    const AxisVariables axes = put_axes(writer, head);
    const Hdf5Handle beta = head.beta_deg.empty() ? Hdf5Handle() : put_coordinate(writer, kBeta, head.beta_deg);
    for (const Quantity quantity : layout.quantities) {
      const QuantityDescription& described = description_of(quantity);
      offsets.push_back(put_variable(writer, head, axes, described, units_of(quantity, head.stokes_units),
                                     beta ? kResponseQualifier : described.ancillary));
    }
    for (const ResponseVariable variable : layout.responses) {
      const ResponseDescription& described = description_of(variable);
      offsets.push_back(put_variable(writer, head, axes, described, "1", described.has_beta ? kResponseQualifier : "",
                                     described.has_beta ? &beta : nullptr));
    }
    if (layout.has_status) offsets.push_back(put_status(writer, head, axes));
  }

  /// Calls use(offset in the file, values) for each run of values that is contiguous in the part and in the file.
  template <class Values, class Use>
  void each_run(Values& part, const PerAxis& first, const Use& use) const {
    std::size_t variable = 0;
    for_each_variable(layout, [&](const auto& of, std::size_t width) {
      const std::span values(of(part));
      const std::uint64_t offset = offsets[variable++];
      for_each_run(first, part.counts(), layout.head.counts(), [&](const GridRun& run) {
        use(offset + run.in_whole * width * sizeof(values[0]), values.subspan(run.in_part * width, run.count * width));
      });
    });
  }

  void write_gaps() {
    writer.check(H5Fflush(writer.file().id(), H5F_SCOPE_GLOBAL));
    std::vector<std::pair<std::uint64_t, std::uint64_t>> values;
    const TableValues none;
    for_each_variable(layout, [&](const auto& of, std::size_t width) {
      const std::uint64_t first = offsets[values.size()];
      values.emplace_back(first, first + layout.head.size() * width * sizeof(of(none)[0]));
    });
    const std::uint64_t size = memory.size();
    values.emplace_back(size, size);
    std::ranges::sort(values);
    std::uint64_t end = 0;
    for (const auto& [first, last] : values) {
      const std::vector<char> bytes = memory.read(end, first);
      file.write_at(end, bytes.data(), bytes.size());
      end = last;
    }
    file.resize(end);  // an earlier file with this name may be longer
  }
};

TableStore::TableStore(const TableLayout& layout, AtomicFile& file) {
  check_room(file, most_bytes(layout));
  impl_ = std::make_unique<Impl>(layout, file);
}

TableStore::~TableStore() = default;

ValueSums TableStore::write(const TableValues& part, const PerAxis& first) {
  impl_->each_run(part, first, [&](std::uint64_t offset, auto values) {
    impl_->file.write_at(offset, values.data(), values.size_bytes());
  });
  return sums_of(part, impl_->layout, first);
}

TableValues TableStore::read(const TableBox& box) const {
  TableValues part{head_of(impl_->layout.head, box)};
  for_each_variable(impl_->layout, [&](const auto& of, std::size_t width) { of(part).resize(part.size() * width); });
  impl_->each_run(part, box.first, [&](std::uint64_t offset, auto values) {
    impl_->file.read_at(offset, values.data(), values.size_bytes());
  });
  return part;
}

std::optional<ValueSums> TableStore::measured(const TableBox& box) const {
  try {
    return sums_of(read(box), impl_->layout, box.first);
  } catch (const IoError&) {  // for example if the file was cut short
    return std::nullopt;
  }
}

void TableStore::finish(std::vector<Attribute> more, const ValueSums& sums) {
  more.push_back({kValuesHash, values_hash(impl_->layout, sums)});
  check_room(impl_->file, most_bytes(impl_->layout) + bytes_of(more));
  put_more(impl_->writer, more);
  impl_->write_gaps();
}

}  // namespace dolp
