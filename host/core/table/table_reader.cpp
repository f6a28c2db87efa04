// Reads tables with HDF5, because the netCDF library follows dimension scales and hangs if they are damaged.
#include "table/table_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "base/text.hpp"
#include "model/scene_entry.hpp"
#include "table/hdf5_handle.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

constexpr std::size_t kEntriesAtOnce = std::size_t{1} << 18U;  // entries that read_entries reads at a time
constexpr std::size_t kMostAngles = 1024;                      // most angles of a response table

namespace fs = std::filesystem;

constexpr std::size_t kMostShrinking = 1032;  // largest factor by which a tool may have compressed values (deflate)
constexpr std::size_t kMostStoredTextBytes = 64U << 20U;  // size limit of a text; a scene has at most 16 MiB

constexpr const char* kPartHint =
    "as in a part of a table; in Python dolp.lookup(xarray.load_dataset(FILE), ...) takes parts";

/// An open HDF5 file. Errors: InputError that begins with the file's name.
class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path) {
    check_regular_file(path.string(), path.string() + ": ");
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // keeps HDF5 from printing errors
    file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
    if (!file_ || H5Fget_filesize(file_.id(), &bytes_) < 0) fail("is not a NetCDF table of dolp, or cannot be read");
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  /// If a file cannot be closed, for example because its server is gone, HDF5 keeps it half closed and crashes at exit.
  /// So dup2 closes the file itself, and the file's descriptor becomes /dev/null, which HDF5 can close.
  ~Reader() {
    void* descriptor = nullptr;
    const int other = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (other >= 0 && H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, &descriptor) >= 0)
      ::dup2(other, *static_cast<int*>(descriptor));
    if (other >= 0) ::close(other);
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_.string() + ": " + what); }
  void check(herr_t code, const std::string& what) const {
    if (code < 0) fail(what + ": cannot be read; the file is damaged");
  }

  Hdf5Handle take(hid_t id, Hdf5Handle::Close close, const std::string& name) const {
    check(id < 0 ? -1 : 0, name);
    return {id, close};
  }

  const Hdf5Handle& file() const { return file_; }

  /// The variable `name`, or an empty handle if the file lacks it. Refuses a variable whose values are in another file.
  Hdf5Handle find(const std::string& name) const {
    const htri_t exists = H5Lexists(file_.id(), name.c_str(), H5P_DEFAULT);
    check(exists, name);
    if (exists == 0) return {};
    H5L_info_t link{};
    check(H5Lget_info(file_.id(), name.c_str(), &link, H5P_DEFAULT), name);
    if (link.type != H5L_TYPE_HARD) fail(name + ": is a link; a table holds all of its values");
    Hdf5Handle variable = take(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, name);
    const Hdf5Handle creation = take(H5Dget_create_plist(variable.id()), H5Pclose, name);
    if (H5Pget_layout(creation.id()) == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0) {
      fail(name + ": its values are in another file; a table holds all of its values");
    }
    return variable;
  }

  std::vector<hsize_t> shape_of(const Hdf5Handle& variable, const std::string& name) const {
    const Hdf5Handle space = take(H5Dget_space(variable.id()), H5Sclose, name);
    const int rank = H5Sget_simple_extent_ndims(space.id());
    check(rank, name);
    std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
    check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), name);
    return shape;
  }

  /// Refuses a variable that claims more values than a file of this size can hold, before memory is allocated.
  void check_claim(const std::string& name, std::size_t bytes) const {
    if (bytes / kMostShrinking <= bytes_) return;
    fail(fmt::format("{}: {} bytes are claimed, which a file of {} cannot hold", name, bytes, bytes_));
  }

  void read(const Hdf5Handle& variable, const std::string& name, hid_t type, void* values) const {
    check(H5Dread(variable.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
  }

 private:
  fs::path path_;
  hsize_t bytes_ = 0;
  Hdf5Handle file_;
};

bool is_of_class(hid_t type, H5T_class_t wanted) { return H5Tget_class(type) == wanted; }

/// The values of a variable that is a list; empty if the file lacks it. Errors: InputError for more than `most` values.
std::vector<double> read_list(const Reader& reader, const std::string& name, std::size_t most,
                              bool may_be_scalar = false) {
  const Hdf5Handle variable = reader.find(name);
  if (!variable) return {};
  std::vector<hsize_t> shape = reader.shape_of(variable, name);
  if (may_be_scalar && shape.empty()) shape = {1};
  if (shape.empty()) reader.fail(name + ": has one value and no dimension, " + kPartHint);
  if (shape.size() != 1) reader.fail(name + ": is not a list");
  if (shape[0] > most) {
    reader.fail(fmt::format("{}: {} values; a table has at most {} entries", name, shape[0], kMostTableEntries));
  }
  reader.check_claim(name, shape[0] * sizeof(double));
  std::vector<double> values(shape[0]);
  reader.read(variable, name, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

/// Reads `count` texts, of equal length (padded with zero bytes) or of variable length. `read` copies them to memory.
template <class Read>
std::vector<std::string> read_texts(const Reader& reader, const std::string& name, const Hdf5Handle& type,
                                    const Hdf5Handle& space, std::size_t count, const Read& read) {
  std::vector<std::string> texts;
  const std::size_t width = H5Tget_size(type.id());
  if (width > kMostStoredTextBytes) reader.fail(name + ": the text is too long");
  reader.check_claim(name, count * width);
  if (H5Tis_variable_str(type.id()) > 0) {
    std::vector<char*> stored(count, nullptr);
    reader.check(read(stored.data()), name);
    for (const char* text : stored) texts.emplace_back(text ? text : "");
    reader.check(H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, stored.data()), name);
  } else {
    std::string stored(count * width, '\0');
    reader.check(read(stored.data()), name);
    for (std::size_t i = 0; i < count; ++i) {
      std::string& text = texts.emplace_back(stored.substr(i * width, width));
      text.erase(text.find_last_not_of('\0') + 1);
    }
  }
  return texts;
}

std::vector<std::string> read_labels(const Reader& reader, const std::string& name, std::size_t most) {
  const Hdf5Handle variable = reader.find(name);
  if (!variable) return {};
  const std::vector<hsize_t> shape = reader.shape_of(variable, name);
  const Hdf5Handle type = reader.take(H5Dget_type(variable.id()), H5Tclose, name);
  const Hdf5Handle space = reader.take(H5Dget_space(variable.id()), H5Sclose, name);
  if (!is_of_class(type.id(), H5T_STRING) || shape.size() != 1 || shape[0] > most)
    reader.fail(name + ": is not a list of texts");
  return read_texts(reader, name, type, space, shape[0], [&](void* memory) {
    return H5Dread(variable.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, memory);
  });
}

std::optional<std::variant<std::string, double>> read_value(const Reader& reader, const Hdf5Handle& attribute,
                                                            const std::string& name) {
  const Hdf5Handle space = reader.take(H5Aget_space(attribute.id()), H5Sclose, name);
  const Hdf5Handle type = reader.take(H5Aget_type(attribute.id()), H5Tclose, name);
  const bool is_text = is_of_class(type.id(), H5T_STRING);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (is_text && count == 0) return std::string();
  if (count != 1) return std::nullopt;
  const auto read = [&](void* memory) { return H5Aread(attribute.id(), type.id(), memory); };
  if (is_text) return read_texts(reader, name, type, space, 1, read).front();
  if (!is_of_class(type.id(), H5T_FLOAT) && !is_of_class(type.id(), H5T_INTEGER)) return std::nullopt;
  double value = 0.0;
  reader.check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value), name);
  return value;
}

std::optional<std::string> find_text(const Reader& reader, const Hdf5Handle& object, const char* name) {
  const htri_t exists = H5Aexists(object.id(), name);
  reader.check(exists, name);
  if (exists == 0) return std::nullopt;
  const Hdf5Handle attribute = reader.take(H5Aopen(object.id(), name, H5P_DEFAULT), H5Aclose, name);
  const auto value = read_value(reader, attribute, name);
  const auto* text = value ? std::get_if<std::string>(&*value) : nullptr;
  return text ? std::optional(*text) : std::nullopt;
}

/// The attribute at `position`, in the order of creation or, if the file does not keep this order, sorted by name.
Hdf5Handle attribute_at(const Reader& reader, hsize_t position) {
  for (const H5_index_t index : {H5_INDEX_CRT_ORDER, H5_INDEX_NAME}) {
    Hdf5Handle attribute(
        H5Aopen_by_idx(reader.file().id(), ".", index, H5_ITER_INC, position, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute) return attribute;
  }
  reader.fail("an attribute cannot be read; the file is damaged");
}

/// All attributes of the table, without those that belong to the file format.
std::vector<Attribute> read_attributes(const Reader& reader) {
  H5O_info_t info{};
  reader.check(H5Oget_info2(reader.file().id(), &info, H5O_INFO_NUM_ATTRS), "the attributes");
  std::vector<Attribute> attributes;
  for (hsize_t i = 0; i < info.num_attrs; ++i) {
    const Hdf5Handle attribute = attribute_at(reader, i);
    std::array<char, 256> buffer{};
    reader.check(static_cast<herr_t>(H5Aget_name(attribute.id(), buffer.size(), buffer.data())), "an attribute");
    const std::string name(buffer.data());
    if (name == kConventions || name == kValuesHash || name.starts_with('_')) continue;
    if (auto value = read_value(reader, attribute, name)) attributes.push_back({name, std::move(*value)});
  }
  return attributes;
}

void append_long_texts(const Reader& reader, std::vector<Attribute>& attributes) {
  for (const char* name : {"title", "history", "scene", "scene_path", "scene_overrides", "surroundings_profile",
                           "coating", "reflectance", "materials", kSpectralData}) {
    const Hdf5Handle variable = reader.find(name);
    if (!variable) continue;
    const Hdf5Handle type = reader.take(H5Dget_type(variable.id()), H5Tclose, name);
    const std::vector<hsize_t> shape = reader.shape_of(variable, name);
    const bool is_text = is_of_class(type.id(), H5T_STRING) && H5Tget_size(type.id()) == 1 && shape.size() == 1;
    if (!is_text || shape[0] > kMostStoredTextBytes) reader.fail(std::string(name) + ": is no text, or too long");
    reader.check_claim(name, shape[0]);
    std::string text(shape[0], '\0');
    reader.read(variable, name, type.id(), text.data());
    attributes.push_back({name, std::move(text)});
  }
}

}  // namespace

struct TableReader::Impl {
  Reader reader;
  TableLayout layout;
  TableHead& head = layout.head;
  std::vector<std::pair<std::string, Hdf5Handle>> open;  // variables in the order of for_each_variable

  explicit Impl(const fs::path& path) : reader(path) {}

  void read_axes() {
    std::size_t most = kMostTableEntries;
    for (const Axis axis : kAllAxes) {
      std::vector<double>& values = head.axes[axis];
      if (description_of(axis).has_labels) {
        head.labels[axis] = read_labels(reader, description_of(axis).name, most);
        values.resize(head.labels[axis].size());
        std::iota(values.begin(), values.end(), 0.0);
      } else {
        values = read_list(reader, description_of(axis).name, most);
      }
      if (values.empty() && description_of(axis).is_required)
        reader.fail("is not a table of dolp (no axis theta, sigma or q)");
      most /= std::max<std::size_t>(values.size(), 1);
    }
    head.beta_deg = read_list(reader, kBeta.name, kMostAngles);
    head.wind_m_s = read_list(reader, kWind.name, kMostTableEntries);
    if (!head.wind_m_s.empty() && head.wind_m_s.size() != head.axes[Axis::kSigma].size())
      reader.fail("is not a table of dolp (wind_m_s is not over sigma)");
  }

  bool find(const char* name, std::size_t value_bytes, bool has_beta = false) {
    Hdf5Handle variable = reader.find(name);
    if (!variable) return false;
    std::vector<hsize_t> shape;
    for (const std::vector<double>& values : head.axes) {
      if (!values.empty()) shape.push_back(values.size());
    }
    if (has_beta) shape.push_back(head.beta_deg.size());
    if (reader.shape_of(variable, name) != shape)
      reader.fail(fmt::format("is not a table of dolp ({} is not over its axes)", name));
    reader.check_claim(name, head.size() * value_bytes * (has_beta ? head.beta_deg.size() : 1));
    open.emplace_back(name, std::move(variable));
    return true;
  }

  void find_variables() {
    for (const Quantity quantity : kAllQuantities) {
      const QuantityDescription& described = description_of(quantity);
      if (!find(described.name, sizeof(double))) continue;
      layout.quantities.push_back(quantity);
      if (described.has_stokes_units)
        head.stokes_units = find_text(reader, open.back().second, "units").value_or(head.stokes_units);
    }
    for (const ResponseVariable variable : kAllResponseVariables) {
      const ResponseDescription& described = description_of(variable);
      if (!head.beta_deg.empty() && find(described.name, sizeof(double), described.has_beta))
        layout.responses.push_back(variable);
    }
    layout.has_status = find("status", sizeof(std::uint32_t));
    if (layout.quantities.empty()) reader.fail("is not a table of dolp (none of its variables is there)");
  }

  void read_curves() {
    for (const TableCurve& described : kTableCurves) {
      Curve& curve = head.*described.curve;
      // Files of dolp 0.2 store n, k and E0 of the scene as variables with their own wavelengths, not in an attribute.
      curve.wavelength_um = read_list(reader, described.name + std::string("_wavelength"), kMostTableEntries);
      const bool is_of_scene = !curve.wavelength_um.empty();
      std::vector<double>& values = is_of_scene ? curve.values : curve.used;
      values = read_list(reader, described.name, kMostTableEntries, true);
      const std::size_t count = is_of_scene ? curve.wavelength_um.size() : head.counts()[Axis::kWavelength];
      if (values.size() != count && (is_of_scene || !values.empty()))
        reader.fail(described.name + std::string(": is cut short"));
    }
  }

  template <class Value>
  void read(std::size_t number, const TableBox& box, std::vector<Value>& values, std::size_t width) const {
    const auto& [name, variable] = open[number];
    std::vector<hsize_t> first, count;
    for (const Axis axis : kAllAxes) {
      if (head.axes[axis].empty()) continue;
      first.push_back(box.first[axis]);
      count.push_back(box.count[axis]);
    }
    if (reader.shape_of(variable, name).size() > count.size()) {  // a variable with the further dimension beta
      first.push_back(0);
      count.push_back(width);
    }
    values.resize(size_of(box.count) * width);
    const hid_t type = std::is_same_v<Value, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT;
    const Hdf5Handle in_file = reader.take(H5Dget_space(variable.id()), H5Sclose, name);
    const Hdf5Handle in_memory =
        reader.take(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose, name);
    reader.check(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr), name);
    reader.check(H5Dread(variable.id(), type, in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()), name);
  }
};

TableReader::TableReader(const fs::path& path) : impl_(std::make_unique<Impl>(path)) {
  impl_->read_axes();
  impl_->find_variables();
  impl_->read_curves();
  impl_->head.attributes = read_attributes(impl_->reader);
  append_long_texts(impl_->reader, impl_->head.attributes);
  take_spectral_data(impl_->head, path.string());
}

TableReader::~TableReader() = default;

const TableLayout& TableReader::layout() const { return impl_->layout; }

TableValues TableReader::read(const TableBox& box) const {
  TableValues part{head_of(head(), box)};
  std::size_t number = 0;
  for_each_variable(layout(), [&](const auto& of, std::size_t width) { impl_->read(number++, box, of(part), width); });
  return part;
}

void TableReader::check_hash(const ValueSums& sums) const {
  const std::optional<std::string> hash = find_text(impl_->reader, impl_->reader.file(), kValuesHash);
  if (!hash) impl_->reader.fail("has no text attribute values_hash: its values are not known to be those of dolp");
  if (*hash == values_hash(layout(), sums)) return;
  impl_->reader.fail(
      "the values are not those that dolp wrote (attribute values_hash): the file was changed or is damaged, or has "
      "not all values, " +
      std::string(kPartHint));
}

ValueSums TableReader::sums_of(const TableValues& part, const TableBox& box) const {
  return dolp::sums_of(part, layout(), box.first);
}

TableValues TableReader::read_entries(std::span<const std::size_t> positions, const Progress& progress) const {
  TableValues entries{head()};
  ValueSums sums;
  std::size_t before = 0;
  const std::size_t at_once = kEntriesAtOnce / std::max<std::size_t>(head().beta_deg.size(), 1);
  for (const TableBox& box : boxes_in_order(head().counts(), at_once)) {
    if (progress && !progress(before, head().size())) throw Cancelled();
    const TableValues part = read(box);
    add(sums, sums_of(part, box));
    const std::size_t end = before + size_of(box.count);
    for (; !positions.empty() && positions.front() < end; positions = positions.subspan(1)) {
      const std::size_t position = positions.front() - before;
      for_each_variable(layout(), [&](const auto& of, std::size_t width) {
        const auto of_entry = std::span(of(part)).subspan(position * width, width);
        of(entries).insert(of(entries).end(), of_entry.begin(), of_entry.end());
      });
    }
    before = end;
  }
  check_hash(sums);
  return entries;
}

TableValues read_table(const fs::path& path) {
  const TableReader reader(path);
  const TableBox all{{}, reader.head().counts()};
  TableValues table = reader.read(all);
  reader.check_hash(reader.sums_of(table, all));
  return table;
}

}  // namespace dolp
