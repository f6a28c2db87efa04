#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

// The longest record of refractiveindex.info has 2.6 MB. Reading 4 MiB takes up to 2 s and 0.7 GB of memory.
constexpr std::size_t kMostRecordBytes = 4U << 20U;
constexpr int kRangeSteps = 1000;  // steps of the search for wavelengths at which a formula gives an allowed n
// Noise may make a measured k slightly negative. A k below -kKNoise is an error or has the opposite sign convention.
constexpr double kKNoise = 1e-5;
constexpr NumberRange kNoisyKRange{-kKNoise, kKRange.max};

/// Collects the rows of n and k in one table of a file, in any order, and appends them to the material.
class IndexRows {
 public:
  explicit IndexRows(Material& material) : material_(material) {}

  void add(const CsvReader& row, const CsvColumns& columns) {
    const double wavelength_um = columns.number(row, "wavelength_um").value();
    if (!kWavelengthUmRange.contains(wavelength_um)) return;
    if (const std::optional<double> n = columns.number(row, "n")) n_.push_back({wavelength_um, *n, row.line_number()});
    if (const std::optional<double> k = columns.number(row, "k")) {
      material_.least_k = std::min(material_.least_k, *k);
      k_.push_back({wavelength_um, std::max(*k, 0.0), row.line_number()});
    }
  }

  void end_table() {
    append_rows(material_.n, std::exchange(n_, {}), {"n", 0.0, kNRange}, material_.source);
    append_rows(material_.k, std::exchange(k_, {}), {"k", 0.0, kKRange}, material_.source);
  }

 private:
  Material& material_;
  std::vector<SpectralRow> n_, k_;
};

std::vector<CsvColumn> index_columns(bool has_n = true, bool has_k = true) {
  std::vector<CsvColumn> columns = {{"wavelength_um", kPositiveRange, true, "wl"}};
  if (has_n) columns.push_back({"n", kNRange});
  if (has_k) columns.push_back({"k", kNoisyKRange});
  return columns;
}

bool is_record_text(std::string_view text) { return text.starts_with("DATA:") || text.find("\nDATA:") != text.npos; }

void parse_csv(Material& material, IndexRows& rows, std::string_view text) {
  if (is_record_text(text)) throw InputError(material.source + ":1: is a YAML record; the name must end in .yml");
  std::optional<CsvColumns> columns;
  for (CsvReader row(text, material.source); row.next();) {
    const bool has_values = std::ranges::any_of(row.cells(), [](std::string_view cell) { return !cell.empty(); });
    if (!columns || (has_values && !row.has_numbers())) {
      rows.end_table();
      columns.emplace(row, index_columns());
    } else {
      rows.add(row, *columns);
    }
  }
  rows.end_table();
}

std::string where(const Material& material, const YAML::Mark& mark) {
  return fmt::format("{}:{}: ", material.source, std::max(mark.line, 0) + 1);
}

[[noreturn]] void fail(const Material& material, const YAML::Node& node, const std::string& what) {
  throw InputError(where(material, node.Mark()) + what);
}

YAML::Node text_of(const Material& material, const YAML::Node& item, const char* key) {
  const YAML::Node text = item[key];
  if (!text || !text.IsScalar()) fail(material, item, fmt::format("{}: missing; a DATA item must have it", key));
  return text;
}

/// Reads the numbers in a text of a YAML file. The text after `data: |` begins one line below the mark `|`.
CsvReader rows_of(const Material& material, const YAML::Node& text) {
  const bool is_block = text.Scalar().find('\n') != std::string::npos;
  return {text.Scalar(),
          material.source,
          {.separator = ' ', .first_line = static_cast<std::size_t>(text.Mark().line) + (is_block ? 2 : 1)}};
}

std::vector<double> numbers_of(const Material& material, const YAML::Node& text, const char* key) {
  std::vector<double> numbers;
  for (CsvReader row = rows_of(material, text); row.next();) {
    for (std::size_t i = 0; i < row.cells().size(); ++i) numbers.push_back(row.number(i, key));
  }
  return numbers;
}

/// Reads a DATA item with a formula for n. known_range() needs rows in the table of n. So the table gets two rows: the
/// first and the last wavelength at which the formula gives an allowed n.
void read_formula(Material& material, const YAML::Node& item, int number) {
  const YAML::Node range = text_of(material, item, "wavelength_range");
  const YAML::Node coefficients = text_of(material, item, "coefficients");
  const std::vector<double> ends_um = numbers_of(material, range, "wavelength_range");
  if (ends_um.size() != 2) {
    fail(material, range, fmt::format("wavelength_range = {}: must be two numbers, in um", one_line(range.Scalar())));
  }
  const Dispersion formula{number, numbers_of(material, coefficients, "coefficients")};
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

int formula_of(std::string_view type) {
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
  const YAML::Node type = text_of(material, item, "type");
  const std::string& name = type.Scalar();
  const int formula = formula_of(name);
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
  const CsvColumns columns(index_columns(has_n, !has_n || is_nk));
  for (CsvReader row = rows_of(material, text_of(material, item, "data")); row.next();) rows.add(row, columns);
  rows.end_table();
}

std::string kind_without_data(const YAML::Node& root) {
  if (root.IsSequence()) return "it is a catalogue, a list of records";
  if (!root.IsMap()) return "it has no keys; a CSV must have another name than .yml";
  if (root["ABOUT"] || root["NAMES"]) return "it describes a material; the records are the files beside it";
  return "it has no list DATA";
}

void parse_yaml(Material& material, IndexRows& rows, const std::string& text) {
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
  const std::string text = read_named_file(path, prefix, is_record ? kMostRecordBytes : kMostTextBytes);
  Material material;
  material.name = path.substr(path.find_last_of('/') + 1);
  material.source = path;
  IndexRows rows(material);
  if (is_record) {
    parse_yaml(material, rows, text);
  } else {
    parse_csv(material, rows, text);
  }
  if (material.n.wavelength_um.empty()) {
    throw InputError(fmt::format("{}:1: no values of n{} at wavelengths in {} um", path,
                                 material.k.wavelength_um.empty() ? "" : ", only of k,", kWavelengthUmRange.text()));
  }
  return fit_to_spectrum(material, spectrum, prefix);
}

}  // namespace dolp
