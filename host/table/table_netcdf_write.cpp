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

#include "table/table_netcdf.hpp"

namespace dolp {
namespace {

constexpr const char* kConventions = "CF-1.8";
// The netCDF library stores attributes of less than 64 KiB.
constexpr std::size_t kMostAttributeBytes = 64'000;
constexpr std::size_t kExpectedOverhead = 1U << 20U;

// CF-1.8 has no unsigned int, and wants masks of the variable's own type.
constexpr std::array<int, 4> kFlagMasks = {1, 2, 4, 8};
constexpr const char* kFlagMeanings =
    "reflectance_outside_zero_to_one tolerance_not_met outside_model_domain intensity_not_positive";

/// Makes the objects of one file; a call that fails throws std::bad_alloc.
class Writer {
 public:
  explicit Writer(std::size_t expected_bytes) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // messages are ours
    const Hdf5Handle access = take(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    // One block of memory for the whole file, so that it does not grow piece by piece.
    check(H5Pset_fapl_core(access.id(), expected_bytes, false));
    check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18));
    const Hdf5Handle creation = take(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    // Without an order of creation the netCDF library opens a file for reading only.
    check(H5Pset_link_creation_order(creation.id(), kOrdered));
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    file_ = take(H5Fcreate("table", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  }

  const Hdf5Handle& file() const { return file_; }
  Hdf5Handle take_file() { return std::move(file_); }

  void check(herr_t code) const {
    if (code < 0) throw std::bad_alloc();  // a file in memory can want nothing else
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
  void put_masks(const Hdf5Handle& object) const {
    const hsize_t count = kFlagMasks.size();
    put(object, "flag_masks", H5T_STD_I32LE, H5T_NATIVE_INT, take(H5Screate_simple(1, &count, nullptr), H5Sclose),
        kFlagMasks.data());
  }

  /// A variable without values. Uncompressed: zlib saves half of the file and takes longer than all the rest of a
  /// table. In one piece: what points to pieces has no checksum.
  Hdf5Handle define(const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* fill) const {
    const Hdf5Handle creation = take(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_attr_creation_order(creation.id(), kOrdered));
    check(H5Pset_obj_track_times(creation.id(), false));  // same scene, same bytes
    // Every variable is written whole; to fill it first would write it twice.
    check(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER));
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

void put_attributes(const Writer& writer, const std::vector<Attribute>& attributes) {
  writer.put_text(writer.file(), "Conventions", kConventions);
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

using AxisVariables = std::array<Hdf5Handle, kNetcdfAxes.size()>;

AxisVariables put_axes(const Writer& writer, const Table& table) {
  AxisVariables axes;
  for (std::size_t i = 0; i < kNetcdfAxes.size(); ++i) {
    const NetcdfAxis& axis = kNetcdfAxes[i];
    const std::vector<double>& values = table.*axis.values;
    axes[i] = writer.define(axis.name, H5T_IEEE_F64LE, {values.size()}, nullptr);
    writer.check(H5DSset_scale(axes[i].id(), axis.name));
    writer.put_text(axes[i], "long_name", axis.long_name);
    writer.put_text(axes[i], "units", axis.units);
    writer.write(axes[i], H5T_NATIVE_DOUBLE, values.data());
  }
  return axes;
}

Hdf5Handle define_over_axes(const Writer& writer, const Table& table, const AxisVariables& axes, const char* name,
                            hid_t type, const void* fill) {
  std::vector<hsize_t> shape;
  for (const NetcdfAxis& axis : kNetcdfAxes) shape.push_back((table.*axis.values).size());
  Hdf5Handle variable = writer.define(name, type, shape, fill);
  for (unsigned i = 0; i < axes.size(); ++i) writer.check(H5DSattach_scale(variable.id(), axes[i].id(), i));
  return variable;
}

void put_variables(const Writer& writer, const Table& table, const AxisVariables& axes) {
  constexpr double kFill = std::numeric_limits<double>::quiet_NaN();
  for (const TableVariable& described : table_variables()) {
    const std::vector<double>& values = table.*described.values;
    if (values.empty()) continue;
    const Hdf5Handle variable = define_over_axes(writer, table, axes, described.name, H5T_IEEE_F64LE, &kFill);
    writer.put_number(variable, "_FillValue", kFill);
    writer.put_text(variable, "long_name", described.long_name);
    writer.put_text(variable, "units", described.has_stokes_units ? table.stokes_units : "1");
    if (*described.ancillary != '\0') writer.put_text(variable, "ancillary_variables", described.ancillary);
    writer.write(variable, H5T_NATIVE_DOUBLE, values.data());
  }
}

void put_status(const Writer& writer, const Table& table, const AxisVariables& axes) {
  const Hdf5Handle status = define_over_axes(writer, table, axes, "status", H5T_STD_I32LE, nullptr);
  writer.put_text(status, "long_name", "status bits of the entry; 0 where nothing is wrong");
  writer.put_text(status, "units", "1");
  writer.put_masks(status);
  writer.put_text(status, "flag_meanings", kFlagMeanings);
  writer.write(status, H5T_NATIVE_UINT, table.status.data());
}

void put_curves(const Writer& writer, const Table& table) {
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = table.*described.curve;
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

std::size_t expected_bytes(const Table& table) {
  std::size_t bytes = kExpectedOverhead + table.size() * (table_variables().size() + 1) * sizeof(double);
  for (const Attribute& attribute : table.attributes) {
    if (const auto* text = std::get_if<std::string>(&attribute.value)) bytes += text->size();
  }
  return bytes;
}

}  // namespace

// FNV-1a over 64-bit words: a change of one word always changes the result.
std::string values_hash(const Table& table) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3U; };
  const auto add_all = [&add](const std::vector<double>& values) {
    add(values.size());
    for (const double value : values) add(std::bit_cast<std::uint64_t>(value));
  };
  for (const NetcdfAxis& axis : kNetcdfAxes) add_all(table.*axis.values);
  for (const TableVariable& variable : table_variables()) add_all(table.*variable.values);
  for (const std::uint32_t status : table.status) add(status);
  for (const TableCurve& described : kTableCurves) {
    if ((table.*described.curve).values.empty()) continue;
    add_all((table.*described.curve).wavelength_um);
    add_all((table.*described.curve).values);
  }
  return fmt::format("fnv1a64:{:016x}", hash);
}

NetcdfImage::NetcdfImage(const Table& table) {
  Writer writer(expected_bytes(table));
  put_attributes(writer, table.attributes);
  writer.put_text(writer.file(), kValuesHash, values_hash(table));
  const AxisVariables axes = put_axes(writer, table);
  put_variables(writer, table, axes);
  if (!table.status.empty()) put_status(writer, table, axes);
  put_curves(writer, table);
  writer.check(H5Fflush(writer.file().id(), H5F_SCOPE_GLOBAL));
  void* memory = nullptr;
  writer.check(H5Fget_vfd_handle(writer.file().id(), H5P_DEFAULT, &memory));
  const ssize_t size = H5Fget_file_image(writer.file().id(), nullptr, 0);
  writer.check(size < 0 ? -1 : 0);
  bytes_ = {*static_cast<const char**>(memory), static_cast<std::size_t>(size)};
  file_ = writer.take_file();
}

}  // namespace dolp
