#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <dolp/errors.hpp>
#include <limits>
#include <optional>
#include <ranges>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv_columns.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

// A record may have this many bytes beside its rows of numbers. YAML of 4 MiB with many nodes takes 1 GB of memory;
// rows of numbers take hardly more than their own bytes.
constexpr std::size_t kMostYamlBytes = 4U << 20U;
constexpr int kRangeSteps = 1000;  // steps of the search for wavelengths at which a formula gives an allowed n
// Noise may make a measured k slightly negative. A k below -kKNoise is an error or has the opposite sign convention.
constexpr double kKNoise = 1e-5;
constexpr NumberRange kSignedKRange{-kKRange.max, kKRange.max};
constexpr NumberRange kAnyRange{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
constexpr const char* kWavelengthColumn = "wavelength_um";

/// Collects the rows of n and k in the tables of a file, in any order, and appends them to the material.
class IndexRows {
 public:
  explicit IndexRows(Material& material) : material_(material) {}

  void add(const CsvReader& row, const CsvColumns& columns) {
    const double wavelength_um = columns.number(row, kWavelengthColumn).value();
    if (!kWavelengthUmRange.contains(wavelength_um)) return;
    for (const char* name : {"n", "k", "eps_1", "eps_2"}) {
      if (columns.is_nan(row, name)) return material_.unknown_um.push_back(wavelength_um);
    }
    const auto value = [&](const char* name) { return columns.number(row, name); };
    std::optional<double> n = value("n"), k = value("k");
    if (const std::optional<double> eps_1 = value("eps_1")) {
      const std::complex<double> index = std::sqrt(std::complex<double>(*eps_1, value("eps_2").value()));
      if (!kNRange.contains(index.real()))
        row.fail(fmt::format("eps_1 = {} and eps_2 = {}: n = {}; must be in {}", *eps_1, value("eps_2").value(),
                             index.real(), kNRange.text()));
      n = index.real();
      k = index.imag();
    }
    if (n) n_.push_back({wavelength_um, *n, row.line_number()});
    if (k) k_.push_back({wavelength_um, *k, row.line_number()});
  }

  void end_table() {
    append_rows(material_.n, std::exchange(n_, {}), {"n", 0.0, kNRange}, material_.source);
    k_tables_.push_back(std::exchange(k_, {}));
  }

  /// Appends the rows of k. Their sign follows from all of them.
  void end_file() {
    double least_k = 0.0, most_k = 0.0;
    for (const SpectralRow& row : k_tables_ | std::views::join) {
      least_k = std::min(least_k, row.value);
      most_k = std::max(most_k, row.value);
    }
    material_.is_conjugate = least_k < -kKNoise && most_k <= kKNoise;
    if (!material_.is_conjugate) material_.least_k = least_k;
    for (std::vector<SpectralRow>& rows : k_tables_) {
      for (SpectralRow& row : rows) row.value = allowed_k(row);
      append_rows(material_.k, std::move(rows), {"k", 0.0, kKRange}, material_.source);
    }
  }

 private:
  double allowed_k(const SpectralRow& row) const {
    if (material_.is_conjugate) return std::max(-row.value, 0.0);
    if (row.value >= -kKNoise) return std::max(row.value, 0.0);
    throw InputError(fmt::format("{}:{}: k = {}: out of range; must be a number in {}, or negative in all rows",
                                 material_.source, row.line, row.value, NumberRange{-kKNoise, kKRange.max}.text()));
  }

  Material& material_;
  std::vector<SpectralRow> n_, k_;
  std::vector<std::vector<SpectralRow>> k_tables_;
};

std::vector<CsvColumn> record_columns(const std::vector<std::string>& names) {
  std::vector<CsvColumn> columns = {{kWavelengthColumn, kPositiveRange, true}};
  for (const std::string& name : names) columns.push_back({name, name == "n" ? kNRange : kSignedKRange});
  return columns;
}

/// The columns of a file that is no YAML record. `other_wavelength`: a second name of the wavelength.
std::vector<CsvColumn> index_columns(const std::string& other_wavelength = {}) {
  const std::string if_twice =
      "if the file has several materials, copy the columns of one of them into a file of its own";
  return {{kWavelengthColumn, kPositiveRange, true, other_wavelength},
          {"n", kNRange, false, {}, {}, if_twice},
          {"k", kSignedKRange, false, {}, {}, if_twice},
          {"eps_1", kAnyRange, false, "eps1", {}, if_twice},
          {"eps_2", kAnyRange, false, "eps2", {}, if_twice}};
}

bool is_record_text(std::string_view text) { return text.starts_with("DATA:") || text.find("\nDATA:") != text.npos; }

bool is_lnk(const Material& material) { return lower_case(material.source).ends_with(".lnk"); }

constexpr const char* kReflectanceHint =
    "; if the file has a reflectance: a diffuse reflectance goes in surface.diffuse_file";

/// True if a file may be a spectrum of a reflectance library: ECOSTRESS, USGS, MODTRAN.
bool mentions_reflectance(std::string_view text) {
  constexpr std::size_t kHeadBytes = 4096;
  const std::string head = lower_case(text.substr(0, kHeadBytes));
  return std::ranges::any_of(std::array{"reflectance", "albedo", "splib"},
                             [&](const char* word) { return head.find(word) != std::string::npos; });
}

/// The columns of a table that begins with numbers. A comment may name them, even without the unit of the wavelength.
/// Those of optool's .lnk files need no names.
CsvColumns unnamed_columns(Material& material, CsvReader& row) {
  row.stay();
  if (const std::optional<CsvColumns> columns = CsvColumns::in_comments(row, index_columns())) return *columns;
  if (const std::optional<CsvColumns> columns = CsvColumns::in_comments(row, index_columns("wavelength"))) {
    material.has_guessed_unit = true;
    return *columns;
  }
  if (is_lnk(material)) return CsvColumns(record_columns({"n", "k"}));
  const bool has_few = row.cells().size() < 3;
  row.fail(
      fmt::format("the columns must be named first, in a line such as \"wavelength_um n k\"; other names are "
                  "wavelength_nm, wavenumber_cm, energy_eV, and eps_1 eps_2{}",
                  has_few ? kReflectanceHint : ""));
}

/// The columns of the table that begins at the reader's line.
CsvColumns index_header(Material& material, CsvReader& row) {
  CsvColumns columns =
      row.has_only_numbers() ? unnamed_columns(material, row) : CsvColumns::header_at(row, index_columns());
  if (columns.has("eps_1") != columns.has("eps_2")) row.fail("eps_1 and eps_2 must be given together");
  if (columns.has("eps_1") && (columns.has("n") || columns.has("k"))) {
    row.fail("eps_1 and eps_2 cannot be combined with n and k");
  }
  return columns;
}

/// Reads tables that each begin with names. In a .lnk file the first row of two numbers is the number of rows, and a
/// density.
void read_tables(Material& material, IndexRows& rows, CsvReader& row) {
  std::optional<CsvColumns> columns;
  std::optional<double> announced;
  double count = 0.0;
  while (row.next()) {
    const bool has_values = std::ranges::any_of(row.cells(), [](std::string_view cell) { return !cell.empty(); });
    const bool may_announce = count == 0.0 && !announced && is_lnk(material);
    if (may_announce && row.has_only_numbers() && row.cells().size() == 2) {
      announced = row.number(0, "number of rows");
    } else if (!columns || (has_values && !row.has_numbers())) {
      rows.end_table();
      columns = index_header(material, row);
    } else {
      rows.add(row, *columns);
      ++count;
    }
  }
  rows.end_table();
  if (announced && *announced > count) row.fail(fmt::format("ends after {} of {} rows", count, *announced));
}

void parse_csv(Material& material, IndexRows& rows, std::string_view text) {
  if (is_record_text(text)) throw InputError(material.source + ":1: is a YAML record; the name must end in .yml");
  CsvReader row(text, material.source, kDataFile);
  try {
    read_tables(material, rows, row);
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (!mentions_reflectance(text) || what.ends_with(kReflectanceHint)) throw;
    throw InputError(what + kReflectanceHint);
  }
}

std::string where(const Material& material, const YAML::Mark& mark) {
  return fmt::format("{}:{}: ", material.source, std::max(mark.line, 0) + 1);
}

[[noreturn]] void fail(const Material& material, const YAML::Node& node, const std::string& what) {
  throw InputError(where(material, node.Mark()) + what);
}

YAML::Node node_text(const Material& material, const YAML::Node& item, const char* key) {
  const YAML::Node text = item[key];
  if (!text || !text.IsScalar()) fail(material, item, fmt::format("{}: missing; a DATA item must have it", key));
  return text;
}

/// Reads the numbers in a text of a YAML file. The text after `data: |` begins one line below the mark `|`.
CsvReader text_rows(const Material& material, const YAML::Node& text) {
  const bool is_block = text.Scalar().find('\n') != std::string::npos;
  return {text.Scalar(),
          material.source,
          {.separator = ' ', .first_line = static_cast<std::size_t>(text.Mark().line) + (is_block ? 2 : 1)}};
}

std::vector<double> parse_numbers(const Material& material, const YAML::Node& text, const char* key) {
  std::vector<double> numbers;
  for (CsvReader row = text_rows(material, text); row.next();) {
    for (std::size_t i = 0; i < row.cells().size(); ++i) numbers.push_back(row.number(i, key));
  }
  return numbers;
}

/// Reads a DATA item with a formula for n. known_range() needs rows in the table of n. So the table gets two rows: the
/// first and the last wavelength at which the formula gives an allowed n.
void read_formula(Material& material, const YAML::Node& item, int number) {
  const YAML::Node range = node_text(material, item, "wavelength_range");
  const YAML::Node coefficients = node_text(material, item, "coefficients");
  const std::vector<double> ends_um = parse_numbers(material, range, "wavelength_range");
  if (ends_um.size() != 2) {
    fail(material, range, fmt::format("wavelength_range = {}: must be two numbers, in um", one_line(range.Scalar())));
  }
  const Dispersion formula{number, parse_numbers(material, coefficients, "coefficients")};
  const std::vector<std::size_t> counts = coefficient_counts(number);
  if (std::ranges::find(counts, formula.coefficients.size()) == counts.end()) {
    fail(material, coefficients,
         fmt::format("coefficients = {}: {} numbers; formula {} takes {}", one_line(coefficients.Scalar()),
                     formula.coefficients.size(), number, fmt::join(counts, ", ")));
  }
  const double low_um = std::max(std::ranges::min(ends_um), kWavelengthUmRange.min);
  const double high_um = std::min(std::ranges::max(ends_um), kWavelengthUmRange.max);
  std::vector<double> known_um;
  for (int i = 0; low_um <= high_um && i <= kRangeSteps; ++i) {
    const double wavelength_um = std::lerp(low_um, high_um, static_cast<double>(i) / kRangeSteps);
    if (kNRange.contains(formula.at(wavelength_um))) known_um.push_back(wavelength_um);
  }
  if (known_um.empty()) {
    fail(material, coefficients, fmt::format("n is in {} nowhere in the range of the formula", kNRange.text()));
  }
  for (const double end_um : {known_um.front(), known_um.back()}) {
    material.n.wavelength_um.push_back(end_um);
    material.n.value.push_back(formula.at(end_um));
  }
  material.n.formula = formula;
}

int formula_number(std::string_view type) {
  int number = kDispersionFormulas;
  while (number > 0 && type != fmt::format("formula {}", number)) --number;
  return number;
}

void check_keys(const Material& material, const YAML::Node& item, const std::vector<std::string>& keys) {
  for (const auto& pair : item) {
    const std::string& key = pair.first.Scalar();
    if (std::ranges::find(keys, key) != keys.end()) continue;
    fail(material, pair.first,
         fmt::format("{}: {}: a DATA item has the keys {}", one_line(key), one_line(pair.second.Scalar()),
                     fmt::join(keys, " and ")));
  }
}

void read_item(Material& material, IndexRows& rows, const YAML::Node& item) {
  if (!item.IsMap()) fail(material, item, "a DATA item has the keys type and data");
  const YAML::Node type = node_text(material, item, "type");
  const std::string& name = type.Scalar();
  const int formula = formula_number(name);
  const bool is_nk = name == "tabulated nk", has_n = is_nk || name == "tabulated n";
  if (formula == 0 && !has_n && name != "tabulated k") {
    fail(material, type,
         fmt::format("type = {}: must be tabulated nk, tabulated n, tabulated k or formula 1 to {}", one_line(name),
                     kDispersionFormulas));
  }
  const bool is_second = !material.n.wavelength_um.empty();
  if (is_second && (formula != 0 || (has_n && material.n.formula.number != 0))) {
    fail(material, type, fmt::format("type = {}: n is given twice", one_line(name)));
  }
  if (formula != 0) {
    check_keys(material, item, {"type", "wavelength_range", "coefficients"});
    return read_formula(material, item, formula);
  }
  check_keys(material, item, {"type", "data", "wavelength_range"});  // a table may have wavelength_range, too
  std::vector<std::string> names;
  if (has_n) names.emplace_back("n");
  if (!has_n || is_nk) names.emplace_back("k");
  const CsvColumns columns(record_columns(names));
  for (CsvReader row = text_rows(material, node_text(material, item, "data")); row.next();) rows.add(row, columns);
  rows.end_table();
}

std::string kind_without_data(const YAML::Node& root) {
  if (root.IsSequence()) return "it is a catalogue, a list of records";
  if (!root.IsMap()) return "it has no keys; a CSV must have another name than .yml";
  if (root["ABOUT"] || root["NAMES"]) return "it describes a material; the records are the files beside it";
  return "it has no list DATA";
}

/// Refuses a record that is long without its rows of numbers.
void check_yaml_size(const Material& material, std::string_view text) {
  std::size_t bytes = 0;
  for (const std::string_view line : split_lines(text)) {
    const std::string_view cells = trim(line);
    const bool begins_with_digit = !cells.empty() && cells.front() >= '0' && cells.front() <= '9';
    const bool is_row = begins_with_digit && cells.find_first_not_of("0123456789+-.eE \t") == cells.npos;
    if (!is_row) bytes += line.size() + 1;
  }
  if (bytes > kMostYamlBytes)
    throw InputError(
        fmt::format("{}: is longer than {} bytes without its rows of numbers", material.source, kMostYamlBytes));
}

void parse_yaml(Material& material, IndexRows& rows, const std::string& text) {
  check_yaml_size(material, text);
  try {
    const YAML::Node record = YAML::Load(text);
    const YAML::Node data = record.IsMap() ? record["DATA"] : YAML::Node();
    if (!data.IsDefined() || data.IsNull()) fail(material, record, "no values of n: " + kind_without_data(record));
    if (!data.IsSequence()) fail(material, data, "DATA: must be a list of items");
    for (const YAML::Node& item : data) read_item(material, rows, item);
  } catch (const YAML::DeepRecursion& error) {
    throw InputError(where(material, error.mark) + "nested too deeply");
  } catch (const YAML::Exception& error) {
    throw InputError(where(material, error.mark) + "not valid YAML: " + one_line(error.msg));
  }
}

}  // namespace

Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix) {
  const std::string lower_path = lower_case(path);
  const bool is_record = lower_path.ends_with(".yml") || lower_path.ends_with(".yaml");
  const std::string text = read_named_file(path, prefix);
  Material material;
  material.name = path.substr(path.find_last_of('/') + 1);
  material.source = path;
  IndexRows rows(material);
  if (is_record) {
    parse_yaml(material, rows, text);
  } else {
    parse_csv(material, rows, text);
  }
  rows.end_file();
  if (material.n.wavelength_um.empty()) {
    throw InputError(fmt::format("{}:1: no values of n{} at wavelengths in {} um", path,
                                 material.k.wavelength_um.empty() ? "" : ", only of k,", kWavelengthUmRange.text()));
  }
  return fit_to_spectrum(material, spectrum, prefix);
}

}  // namespace dolp
