#include "table/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "base/text.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"
#include "table/netcdf_file.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

constexpr std::size_t kEntriesAtOnce = std::size_t{1} << 18U;  // entries that read_entries reads at a time
constexpr std::size_t kMostAngles = 1024;                      // most angles of a response table

namespace fs = std::filesystem;

constexpr std::size_t kMostShrinking = 1032;  // largest factor by which a tool may have compressed values (deflate)
constexpr std::size_t kMostStoredTextBytes = 64U << 20U;  // size limit of a text; a scene has at most 16 MiB

/// Refuses what netCDF-C should not open: files of other formats, and files with a damaged head. In a file, netCDF-C
/// reads zeros beyond the end, and it could fill all memory. In memory, it does not.
bool is_sound(const fs::path& path) {
  constexpr std::size_t kMostHeadBytes = 2 * kMostTextBytes;
  std::string head(std::min<std::uintmax_t>(fs::file_size(path), kMostHeadBytes), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!head.starts_with("CDF")) return head.starts_with("\x89HDF");  // tables of dolp 0.2
  NetcdfFile opened;
  return opened.open([&](int* id) { return nc_open_mem("head", NC_NOWRITE, head.size(), head.data(), id); }) ==
         NC_NOERR;
}

/// An open netCDF file of any format. Errors: InputError that begins with the file's name.
class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path) {
    check_regular_file(path.string(), path.string() + ": ");
    bytes_ = fs::file_size(path);
    const std::string name = fs::absolute(path).string();  // netCDF-C takes some relative names for addresses
    const auto open = [&](int* id) { return nc_open(name.c_str(), NC_NOWRITE, id); };
    const int status = is_sound(path) ? file_.open(open) : NC_ENOTNC;
    if (is_lack_of_memory(status)) throw std::bad_alloc();
    if (status != NC_NOERR) fail("is not a NetCDF table of dolp, or cannot be read");
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_.string() + ": " + what); }

  /// `name`: the variable or attribute that is read, for messages.
  template <class Function, class... Arguments>
  void call(const std::string& name, const Function& function, Arguments... arguments) const {
    const int status = file_.call(function, arguments...);
    if (is_lack_of_memory(status)) throw std::bad_alloc();
    if (status != NC_NOERR) fail(name + ": cannot be read; the file is damaged");
  }

  std::optional<int> find(const std::string& name) const {
    int variable = 0;
    const int status = file_.call(nc_inq_varid, name.c_str(), &variable);
    return status == NC_NOERR ? std::optional(variable) : std::nullopt;
  }

  std::vector<std::size_t> variable_shape(int variable, const std::string& name) const {
    int rank = 0;
    call(name, nc_inq_varndims, variable, &rank);
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    call(name, nc_inq_vardimid, variable, dimensions.data());
    std::vector<std::size_t> shape(dimensions.size());
    for (std::size_t i = 0; i < shape.size(); ++i) call(name, nc_inq_dimlen, dimensions[i], &shape[i]);
    return shape;
  }

  nc_type variable_type(int variable, const std::string& name) const {
    nc_type type = NC_NAT;
    call(name, nc_inq_vartype, variable, &type);
    return type;
  }

  /// Refuses a variable that claims more values than a file of this size can hold, before memory is allocated.
  void check_claim(const std::string& name, std::size_t bytes) const {
    if (bytes / kMostShrinking <= bytes_) return;
    fail(fmt::format("{}: {} bytes are claimed, which a file of {} cannot hold", name, bytes, bytes_));
  }

  const NetcdfFile& file() const { return file_; }

 private:
  fs::path path_;
  std::uintmax_t bytes_ = 0;
  NetcdfFile file_;
};

/// The values of a list or a single number; empty if the file lacks it. Errors: InputError for more than `most` values.
std::vector<double> read_numbers(const Reader& reader, const std::string& name, std::size_t most) {
  const std::optional<int> variable = reader.find(name);
  if (!variable) return {};
  const std::vector<std::size_t> shape = reader.variable_shape(*variable, name);
  const std::size_t count = shape.empty() ? 1 : shape.front();
  if (shape.size() > 1) reader.fail(name + ": is not a list");
  if (count > most)
    reader.fail(fmt::format("{}: {} values; a table has at most {} entries", name, count, kMostTableEntries));
  reader.check_claim(name, count * sizeof(double));
  std::vector<double> values(count);
  reader.call(name, nc_get_var_double, *variable, values.data());
  return values;
}

/// True for a variable without a dimension, as the axes have in a part of a table that xarray saved.
bool is_lone(const Reader& reader, const std::string& name) {
  const std::optional<int> variable = reader.find(name);
  return variable && reader.variable_shape(*variable, name).empty();
}

std::vector<double> read_axis(const Reader& reader, const std::string& name, std::size_t most) {
  if (is_lone(reader, name)) reader.fail(name + ": has one value and no dimension, as in a part of a table");
  return read_numbers(reader, name, most);
}

/// The texts of `stored`, as netCDF-C allocated them.
std::vector<std::string> take_texts(std::vector<char*>& stored) {
  std::vector<std::string> texts;
  for (const char* text : stored) texts.emplace_back(text ? text : "");
  nc_free_string(stored.size(), stored.data());
  return texts;
}

/// The texts of a variable: texts of variable length, or rows of letters, padded with zero bytes.
std::vector<std::string> read_texts(const Reader& reader, const std::string& name, std::size_t most) {
  const std::optional<int> variable = reader.find(name);
  if (!variable) return {};
  std::vector<std::size_t> shape = reader.variable_shape(*variable, name);
  const bool has_letters = reader.variable_type(*variable, name) == NC_CHAR;
  if (has_letters && shape.size() == 1) shape.insert(shape.begin(), 1);
  const bool is_list = has_letters ? shape.size() == 2 : reader.variable_type(*variable, name) == NC_STRING;
  if (!is_list || shape.empty() || shape[0] > most) reader.fail(name + ": is not a list of texts");
  const std::size_t width = has_letters ? shape[1] : sizeof(char*);
  if (width > kMostStoredTextBytes) reader.fail(name + ": the text is too long");
  reader.check_claim(name, shape[0] * width);
  if (!has_letters) {
    std::vector<char*> stored(shape[0], nullptr);
    reader.call(name, nc_get_var_string, *variable, stored.data());
    return take_texts(stored);
  }
  std::string letters(shape[0] * width, '\0');
  reader.call(name, nc_get_var_text, *variable, letters.data());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < shape[0]; ++i) {
    std::string& text = texts.emplace_back(letters.substr(i * width, width));
    text.erase(text.find_last_not_of('\0') + 1);
  }
  return texts;
}

/// The labels of an axis. Files of dolp 0.2 and of xarray have them in a variable with the name of the axis.
std::vector<std::string> read_labels(const Reader& reader, Axis axis, std::size_t most) {
  if (axis == Axis::kMaterial && reader.find(kMaterialName.name)) return read_texts(reader, kMaterialName.name, most);
  const std::vector<double> low = read_numbers(reader, kBandLow.name, most);
  if (axis != Axis::kBand || low.empty()) return read_texts(reader, describe(axis).name, most);
  const std::vector<double> high = read_numbers(reader, kBandHigh.name, low.size());
  if (high.size() != low.size()) reader.fail(kBandHigh.name + std::string(": is cut short"));
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < low.size(); ++i) labels.push_back(Spectrum{low[i], high[i]}.label());
  return labels;
}

std::optional<std::variant<std::string, double>> read_attribute(const Reader& reader, int variable,
                                                                const std::string& name) {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  reader.call(name, nc_inq_att, variable, name.c_str(), &type, &length);
  reader.check_claim(name, length);
  if (type == NC_CHAR) {
    std::string text(length, '\0');
    reader.call(name, nc_get_att_text, variable, name.c_str(), text.data());
    return text.substr(0, text.find_last_not_of('\0') + 1);  // other writers end texts by a zero byte
  }
  if (length != 1) return std::nullopt;
  if (type == NC_STRING) {
    std::vector<char*> stored(1, nullptr);
    reader.call(name, nc_get_att_string, variable, name.c_str(), stored.data());
    return take_texts(stored).front();
  }
  double value = 0.0;
  const int status = reader.file().call(nc_get_att_double, variable, name.c_str(), &value);
  return status == NC_NOERR ? std::optional(std::variant<std::string, double>(value)) : std::nullopt;
}

/// The n, k or E0 of the scene with its own wavelengths, as files of dolp 0.2 store it in variables; else an empty
/// curve.
Curve read_scene_curve(const Reader& reader, const TableCurve& described) {
  Curve curve;
  curve.wavelength_um = read_numbers(reader, described.name + std::string("_wavelength"), kMostTableEntries);
  if (!curve.wavelength_um.empty()) curve.values = read_numbers(reader, described.name, kMostTableEntries);
  if (curve.values.size() != curve.wavelength_um.size()) reader.fail(described.name + std::string(": is cut short"));
  return curve;
}

std::optional<std::string> find_text(const Reader& reader, int variable, const char* name) {
  int number = 0;
  if (reader.file().call(nc_inq_attid, variable, name, &number) != NC_NOERR) return std::nullopt;
  const auto value = read_attribute(reader, variable, name);
  const auto* text = value ? std::get_if<std::string>(&*value) : nullptr;
  return text ? std::optional(*text) : std::nullopt;
}

/// All attributes of the table, without those that belong to the file format.
std::vector<Attribute> read_attributes(const Reader& reader) {
  int count = 0;
  reader.call("the attributes", nc_inq_natts, &count);
  std::vector<Attribute> attributes;
  for (int i = 0; i < count; ++i) {
    std::array<char, NC_MAX_NAME + 1> buffer{};
    reader.call("the attributes", nc_inq_attname, NC_GLOBAL, i, buffer.data());
    const std::string name(buffer.data());
    if (name == kConventions || name == kValuesHash || name.starts_with('_')) continue;
    if (auto value = read_attribute(reader, NC_GLOBAL, name)) attributes.push_back({name, std::move(*value)});
  }
  return attributes;
}

/// Files of dolp 0.2 have long texts in variables.
void append_long_texts(const Reader& reader, std::vector<Attribute>& attributes) {
  for (const char* name : {"title", "history", "scene", "scene_path", "scene_overrides", "surroundings_profile",
                           "coating", "reflectance", "materials", kSpectralData}) {
    for (std::string& text : read_texts(reader, name, 1)) attributes.push_back({name, std::move(text)});
  }
}

}  // namespace

struct TableReader::Impl {
  Reader reader;
  TableLayout layout;
  TableHead& head = layout.head;
  std::vector<std::pair<std::string, int>> open;  // variables in the order of for_each_variable

  explicit Impl(const fs::path& path) : reader(path) {}

  void read_axes() {
    std::size_t most = kMostTableEntries;
    for (const Axis axis : kAllAxes) {
      std::vector<double>& values = head.axes[axis];
      if (describe(axis).has_labels) {
        head.labels[axis] = read_labels(reader, axis, most);
        values.resize(head.labels[axis].size());
        std::iota(values.begin(), values.end(), 0.0);
      } else {
        values = read_axis(reader, describe(axis).name, most);
      }
      if (values.empty() && describe(axis).is_required)
        reader.fail("is not a table of dolp (no axis theta, sigma or q)");
      most /= std::max<std::size_t>(values.size(), 1);
    }
    head.beta_deg = read_numbers(reader, kBeta.name, kMostAngles);
    head.wind_m_s = read_numbers(reader, kWind.name, kMostTableEntries);
    if (!head.wind_m_s.empty() && head.wind_m_s.size() != head.axes[Axis::kSigma].size())
      reader.fail("is not a table of dolp (wind_m_s is not over sigma)");
  }

  /// `more`: dimensions of the variable besides the axes.
  bool find(const char* name, std::size_t value_bytes, const std::vector<std::size_t>& more = {}) {
    const std::optional<int> variable = reader.find(name);
    if (!variable) return false;
    std::vector<std::size_t> shape;
    for (const std::vector<double>& values : head.axes) {
      if (!values.empty()) shape.push_back(values.size());
    }
    shape.insert(shape.end(), more.begin(), more.end());
    if (reader.variable_shape(*variable, name) != shape)
      reader.fail(fmt::format("is not a table of dolp ({} is not over its axes)", name));
    reader.check_claim(name, head.size() * value_bytes * (more.empty() ? 1 : more.front()));
    open.emplace_back(name, *variable);
    return true;
  }

  void find_variables() {
    for (const Quantity quantity : kAllQuantities) {
      const QuantityDescription& described = describe(quantity);
      if (!find(described.name, sizeof(double))) continue;
      layout.quantities.push_back(quantity);
      if (!described.units)
        head.stokes_units = find_text(reader, open.back().second, "units").value_or(head.stokes_units);
    }
    for (const ResponseVariable variable : kAllResponseVariables) {
      const ResponseDescription& described = describe(variable);
      std::vector<std::size_t> more;
      if (described.has_beta) more.push_back(head.beta_deg.size());
      if (!head.beta_deg.empty() && find(described.name, sizeof(double), more)) layout.responses.push_back(variable);
    }
    for (DerivativeColumn& column : derivative_columns(derivative_keys(head))) {
      if (!find(column.name.c_str(), sizeof(double))) continue;
      column.units = find_text(reader, open.back().second, "units").value_or("");
      layout.derivatives.push_back(std::move(column));
    }
    layout.has_status = find("status", sizeof(std::uint32_t));
    if (open.empty()) reader.fail("is not a table of dolp (none of its variables is there)");
  }

  void read_curves() {
    for (const TableCurve& described : kTableCurves) {
      Curve& curve = head.*described.curve;
      curve = read_scene_curve(reader, described);
      if (!curve.values.empty()) continue;
      curve.used = read_numbers(reader, described.name, kMostTableEntries);
      if (!curve.used.empty() && curve.used.size() != head.counts()[Axis::kWavelength])
        reader.fail(described.name + std::string(": is cut short"));
    }
  }

  template <class Value>
  void read(std::size_t number, const GridBox& box, std::vector<Value>& values, std::size_t width) const {
    const auto& [name, variable] = open[number];
    values.resize(grid_size(box.count) * width);
    const int status = get_values(reader.file(), variable, Hyperslab(head, box, width), values.data());
    if (status != NC_NOERR) reader.fail(name + ": cannot be read; the file is damaged");
  }
};

TableReader::TableReader(const fs::path& path) : impl_(std::make_unique<Impl>(path)) {
  impl_->read_axes();
  impl_->head.attributes = read_attributes(impl_->reader);
  impl_->find_variables();
  impl_->read_curves();
  append_long_texts(impl_->reader, impl_->head.attributes);
  take_spectral_data(impl_->head, path.string());
}

TableReader::~TableReader() = default;

const TableLayout& TableReader::layout() const { return impl_->layout; }

TableValues TableReader::read(const GridBox& box) const {
  TableValues part{part_head(head(), box)};
  part.derivatives = layout().derivatives;
  std::size_t number = 0;
  for_each_variable(layout(), [&](const auto& of, std::size_t width) { impl_->read(number++, box, of(part), width); });
  return part;
}

void TableReader::check_hash(const ValueSums& sums) const {
  const std::optional<std::string> hash = find_text(impl_->reader, NC_GLOBAL, kValuesHash);
  if (!hash) impl_->reader.fail("has no text attribute values_hash: its values are not known to be those of dolp");
  if (*hash == values_hash(layout(), sums)) return;
  impl_->reader.fail(
      "the values are not those that dolp wrote (attribute values_hash): the file was changed or is damaged, or has "
      "not all values");
}

ValueSums TableReader::value_sums(const TableValues& part, const GridBox& box) const {
  return dolp::value_sums(part, layout(), box.first);
}

TableValues TableReader::read_entries(std::span<const std::size_t> positions, const Progress& progress) const {
  TableValues entries{head()};
  entries.derivatives = layout().derivatives;
  ValueSums sums;
  std::size_t before = 0;
  const std::size_t at_once = kEntriesAtOnce / std::max<std::size_t>(head().beta_deg.size(), 1);
  for (const GridBox& box : grid_boxes(head().counts(), at_once)) {
    if (progress && !progress(before, head().size())) throw Cancelled();
    const TableValues part = read(box);
    add(sums, value_sums(part, box));
    const std::size_t end = before + grid_size(box.count);
    for (; !positions.empty() && positions.front() < end; positions = positions.subspan(1)) {
      const std::size_t position = positions.front() - before;
      for_each_variable(layout(), [&](const auto& of, std::size_t width) {
        const auto entry_values = std::span(of(part)).subspan(position * width, width);
        of(entries).insert(of(entries).end(), entry_values.begin(), entry_values.end());
      });
    }
    before = end;
  }
  check_hash(sums);
  return entries;
}

std::vector<Attribute> read_attributes(const fs::path& path) {
  const Reader reader(path);
  TableHead head;
  head.attributes = read_attributes(reader);
  append_long_texts(reader, head.attributes);
  for (const TableCurve& described : kTableCurves) head.*described.curve = read_scene_curve(reader, described);
  if (std::string data = spectral_data_text(head); !data.empty())
    head.attributes.push_back({kSpectralData, std::move(data)});
  return head.attributes;
}

std::vector<std::pair<std::string, double>> read_lone_values(const fs::path& path) {
  const Reader reader(path);
  std::vector<std::pair<std::string, std::string>> names = {{kWind.name, kWind.column}};  // and columns
  for (const Axis axis : kAllAxes) {
    if (!describe(axis).has_labels) names.emplace_back(describe(axis).name, describe(axis).column);
  }
  int variables = 0;
  reader.call("the variables", nc_inq_nvars, &variables);
  for (int i = 0; i < variables; ++i) {
    std::array<char, NC_MAX_NAME + 1> name{};
    reader.call("the variables", nc_inq_varname, i, name.data());
    if (std::string_view(name.data()).find('.') != std::string_view::npos) names.emplace_back(name.data(), name.data());
  }
  std::vector<std::pair<std::string, double>> values;
  for (const auto& [name, column] : names) {
    if (is_lone(reader, name)) values.emplace_back(column, read_numbers(reader, name, 1).front());
  }
  return values;
}

TableValues read_table(const fs::path& path) {
  const TableReader reader(path);
  const GridBox all{{}, reader.head().counts()};
  TableValues table = reader.read(all);
  reader.check_hash(reader.value_sums(table, all));
  return table;
}

}  // namespace dolp
