#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include <dolp/status.hpp>
#include "table/hdf5_handle.hpp"
#include "table/hdf5_memory.hpp"
#include "table/table_netcdf.hpp"

namespace dolp {
namespace {

constexpr const char* kConventions = "CF-1.8";
// The netCDF library stores attributes of less than 64 KiB.
constexpr std::size_t kMostAttributeBytes = 64'000;

/// Makes the objects of one file in memory; a call that fails throws std::bad_alloc.
class Writer {
 public:
  explicit Writer(Hdf5Memory& memory) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // messages are ours
    const Hdf5Handle access = memory.access();
    check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18));
    const Hdf5Handle creation = take(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    // Without an order of creation the netCDF library opens a file for reading only.
    check(H5Pset_link_creation_order(creation.id(), kOrdered));
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    file_ = take(H5Fcreate("table", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  }

  const Hdf5Handle& file() const { return file_; }

  void check(herr_t code) const {
    if (code < 0) throw std::bad_alloc();  // a file in memory fails only for lack of memory
  }

  void put_text(const Hdf5Handle& object, const char* name, const std::string& text) const {
    const Hdf5Handle type = take(H5Tcopy(H5T_C_S1), H5Tclose);
    check(H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1)));
    check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8));
    put(object, name, type.id(), type.id(), take(H5Screate(text.empty() ? H5S_NULL : H5S_SCALAR), H5Sclose),
        text.empty() ? nullptr : text.data());
  }
  void put_number(const Hdf5Handle& object, const char* name, double value) const {
    const hsize_t one = 1;
    put(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, take(H5Screate_simple(1, &one, nullptr), H5Sclose), &value);
  }
  // CF-1.8 has no unsigned int, and wants masks of the variable's own type.
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

  /// A variable without values, which has its place in the file. Uncompressed: zlib saves half of the file and takes
  /// longer than all the rest of a table. In one piece: what points to pieces has no checksum.
  Hdf5Handle define(const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* fill) const {
    const Hdf5Handle creation = take(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    check(H5Pset_obj_track_times(creation.id(), false));  // same scene, same bytes
    // Every variable is written whole; to fill it first would write it twice.
    check(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER));
    check(H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY));
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

  Hdf5Handle file_;
};

/// A text as a variable over a dimension of its own.
void put_long_text(const Writer& writer, const std::string& name, const std::string& text) {
  const std::vector<hsize_t> shape = {text.size()};
  const Hdf5Handle length = writer.define((name + "_length").c_str(), H5T_IEEE_F32BE, shape, nullptr);
  // How the netCDF library marks a dimension without coordinates; the number is the length in ten digits.
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

void put_attributes(const Writer& writer, const std::vector<Attribute>& attributes) {
  writer.put_text(writer.file(), "Conventions", kConventions);
  put_more(writer, attributes);
}

/// The coordinate variables, of an axis that the table lacks none.
using AxisVariables = AxisArray<Hdf5Handle>;

AxisVariables put_axes(const Writer& writer, const TableHead& head) {
  AxisVariables axes;
  for (const Axis axis : kAllAxes) {
    const AxisDescription& described = description_of(axis);
    const std::vector<double>& values = head.axes[axis];
    if (values.empty()) continue;
    axes[axis] = writer.define(described.name, H5T_IEEE_F64LE, {values.size()}, nullptr);
    writer.check(H5DSset_scale(axes[axis].id(), described.name));
    writer.put_text(axes[axis], "long_name", described.long_name);
    writer.put_text(axes[axis], "units", described.units);
    writer.write(axes[axis], H5T_NATIVE_DOUBLE, values.data());
  }
  return axes;
}

Hdf5Handle define_over_axes(const Writer& writer, const TableHead& head, const AxisVariables& axes, const char* name,
                            hid_t type, const void* fill) {
  std::vector<hsize_t> shape;
  for (const std::vector<double>& values : head.axes) {
    if (!values.empty()) shape.push_back(values.size());
  }
  Hdf5Handle variable = writer.define(name, type, shape, fill);
  unsigned dimension = 0;
  for (const Hdf5Handle& axis : axes) {
    if (axis) writer.check(H5DSattach_scale(variable.id(), axis.id(), dimension++));
  }
  return variable;
}

/// Where the values of a variable are in the file.
std::uint64_t offset_of(const Hdf5Handle& variable) {
  const haddr_t offset = H5Dget_offset(variable.id());
  if (offset == HADDR_UNDEF) throw std::bad_alloc();
  return offset;
}

std::uint64_t put_variable(const Writer& writer, const TableHead& head, const AxisVariables& axes, Quantity quantity) {
  const QuantityDescription& described = description_of(quantity);
  constexpr double kFill = std::numeric_limits<double>::quiet_NaN();
  const Hdf5Handle variable = define_over_axes(writer, head, axes, described.name, H5T_IEEE_F64LE, &kFill);
  writer.put_number(variable, "_FillValue", kFill);
  writer.put_text(variable, "long_name", described.long_name);
  writer.put_text(variable, "units", units_of(quantity, head.stokes_units));
  if (*described.ancillary != '\0') writer.put_text(variable, "ancillary_variables", described.ancillary);
  return offset_of(variable);
}

std::uint64_t put_status(const Writer& writer, const TableHead& head, const AxisVariables& axes) {
  const Hdf5Handle status = define_over_axes(writer, head, axes, "status", H5T_STD_I32LE, nullptr);
  writer.put_text(status, "long_name", "status bits of the entry; 0 where nothing is wrong");
  writer.put_text(status, "units", "1");
  writer.put_status_bits(status);
  return offset_of(status);
}

void put_curves(const Writer& writer, const TableHead& head) {
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = head.*described.curve;
    if (curve.values.empty()) continue;
    const std::string coordinate = described.name + std::string("_wavelength");
    const Hdf5Handle wavelength = writer.define(coordinate.c_str(), H5T_IEEE_F64LE, {curve.values.size()}, nullptr);
    writer.check(H5DSset_scale(wavelength.id(), coordinate.c_str()));
    writer.put_text(wavelength, "long_name", "wavelength");
    writer.put_text(wavelength, "units", "um");
    writer.write(wavelength, H5T_NATIVE_DOUBLE, curve.wavelength_um.data());
    const Hdf5Handle variable = writer.define(described.name, H5T_IEEE_F64LE, {curve.values.size()}, nullptr);
    writer.check(H5DSattach_scale(variable.id(), wavelength.id(), 0));
    writer.put_text(variable, "long_name", described.long_name);
    writer.put_text(variable, "units", described.units);
    writer.write(variable, H5T_NATIVE_DOUBLE, curve.values.data());
  }
}

constexpr std::uint64_t kPrime = 0x100000001b3U;
constexpr std::uint64_t kPlaceFactor = 0x9e3779b97f4a7c15U;

/// A step of FNV-1a over 64-bit words.
std::uint64_t with_word(std::uint64_t hash, std::uint64_t word) { return (hash ^ word) * kPrime; }

std::uint64_t with_all(std::uint64_t hash, const std::vector<double>& values) {
  hash = with_word(hash, values.size());
  for (const double value : values) hash = with_word(hash, std::bit_cast<std::uint64_t>(value));
  return hash;
}

template <class Value, class Bits>
std::uint64_t sum_of(std::span<const Value> values, std::size_t first_place, const Bits& bits) {
  std::uint64_t sum = 0;
  std::uint64_t factor = first_place * kPlaceFactor;
  for (const Value value : values) {
    sum += bits(value) * (factor | 1U);
    factor += kPlaceFactor;
  }
  return sum;
}

}  // namespace

ValuesHash::ValuesHash(const TableHead& head) : hash_(0xcbf29ce484222325U) {
  for (const std::vector<double>& values : head.axes) hash_ = with_all(hash_, values);
  for (const TableCurve& described : kTableCurves) {
    if ((head.*described.curve).values.empty()) continue;
    hash_ = with_all(hash_, (head.*described.curve).wavelength_um);
    hash_ = with_all(hash_, (head.*described.curve).values);
  }
}

std::uint64_t ValuesHash::sum(std::span<const double> values, std::size_t first_place) {
  return sum_of(values, first_place, [](double value) { return std::bit_cast<std::uint64_t>(value); });
}

std::uint64_t ValuesHash::sum(std::span<const std::uint32_t> values, std::size_t first_place) {
  return sum_of(values, first_place, [](std::uint32_t value) { return std::uint64_t{value} + 1U; });
}

std::string ValuesHash::text(const Quantities& quantities, const Sums& sums) const {
  std::uint64_t hash = hash_;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (const char byte : std::string(i < quantities.size() ? description_of(quantities[i]).name : "status"))
      hash = with_word(hash, static_cast<unsigned char>(byte));
    hash = with_word(hash, sums[i]);
  }
  return fmt::format("placed64:{:016x}", hash);
}

struct NetcdfSkeleton::Impl {
  Hdf5Memory memory;
  Writer writer{memory};
  std::size_t entries = 0;
  bool has_status = false;
  std::vector<std::uint64_t> offsets;
};

NetcdfSkeleton::NetcdfSkeleton(const TableLayout& layout) : impl_(std::make_unique<Impl>()) {
  impl_->entries = layout.head.size();
  impl_->has_status = layout.has_status;
  const Writer& writer = impl_->writer;
  const TableHead& head = layout.head;
  put_attributes(writer, head.attributes);
  const AxisVariables axes = put_axes(writer, head);
  put_curves(writer, head);
  std::vector<std::uint64_t>& offsets = impl_->offsets;
  for (const Quantity quantity : layout.quantities) offsets.push_back(put_variable(writer, head, axes, quantity));
  if (layout.has_status) offsets.push_back(put_status(writer, head, axes));
}

NetcdfSkeleton::~NetcdfSkeleton() = default;

const std::vector<std::uint64_t>& NetcdfSkeleton::offsets() const { return impl_->offsets; }

void NetcdfSkeleton::add(const std::vector<Attribute>& attributes) { put_more(impl_->writer, attributes); }

std::vector<NetcdfSkeleton::Piece> NetcdfSkeleton::pieces() const {
  impl_->writer.check(H5Fflush(impl_->writer.file().id(), H5F_SCOPE_GLOBAL));
  // Between and around the values, where there is anything at all.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> values;
  for (std::size_t i = 0; i < impl_->offsets.size(); ++i) {
    const bool is_status = impl_->has_status && i + 1 == impl_->offsets.size();
    const std::size_t of_value = is_status ? sizeof(std::uint32_t) : sizeof(double);
    values.emplace_back(impl_->offsets[i], impl_->offsets[i] + impl_->entries * of_value);
  }
  std::ranges::sort(values);
  std::uint64_t end = 0;
  for (const auto& [first, last] : values) {
    gaps.emplace_back(end, first);
    end = last;
  }
  gaps.emplace_back(end, impl_->memory.size());
  std::vector<Piece> pieces;
  for (const auto& [first, last] : gaps) {
    if (first >= last) continue;
    Piece& piece = pieces.emplace_back(Piece{first, std::vector<char>(last - first)});
    impl_->memory.read(first, piece.bytes.data(), piece.bytes.size());
  }
  return pieces;
}

}  // namespace dolp
