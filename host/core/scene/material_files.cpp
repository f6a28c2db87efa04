// The user's own refractive indices: refractiveindex.info database records and CSV files.
#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <dolp/errors.hpp>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

// Ten times the longest records of the database; any text of that size is read within seconds.
constexpr std::size_t kMostRecordBytes = 2U << 20U;
// A formula that has poles or roots of n^2 inside its range is wrong; this many wavelengths are checked for them.
constexpr int kFormulaChecks = 1000;

/// Contents of the rows of a table after the wavelength.
struct Columns {
  bool has_n = false;
  bool has_k = false;
  std::size_t count() const { return 1U + (has_n ? 1U : 0U) + (has_k ? 1U : 0U); }
};

void append_row(Material& material, const Columns& columns, const CsvReader& row) {
  const std::size_t cells = row.cells().size();
  if (cells != columns.count()) {
    row.fail(fmt::format("{}: {} values; {} are expected", one_line(row.line()), cells, columns.count()));
  }
  std::optional<double> n, k;
  const double wavelength_um = row.number(0, "wavelength_um");
  if (columns.has_n) n = row.number(1, "n");
  if (columns.has_k) k = row.number(cells - 1, "k");
  append_index(material, wavelength_um, n, k, row.where());
}

/// The columns called "n", "k" or "nk"; nullopt for another text.
std::optional<Columns> columns_of(std::string_view names) {
  if (names != "n" && names != "k" && names != "nk") return std::nullopt;
  return Columns{names.front() == 'n', names.back() == 'k'};
}

/// The columns that a line of names announces, nullopt where it announces none.
std::optional<Columns> parse_column_names(const std::vector<std::string_view>& cells) {
  const std::string first = lower_case(cells[0]);
  if (first != "wl" && first != "wavelength_um") return std::nullopt;
  std::string others;
  for (std::size_t i = 1; i < cells.size(); ++i) others += lower_case(cells[i]);
  return columns_of(others);
}

void parse_csv(Material& material, std::string_view text) {
  std::optional<Columns> columns;
  for (CsvReader row(text, material.source); row.next();) {
    if (const auto named = parse_column_names(row.cells())) {
      columns = named;
    } else if (columns) {
      append_row(material, *columns, row);
    } else {
      row.fail("the columns must be named first: wavelength_um (or wl), then n, k or both");
    }
  }
}

std::string place(const Material& material, const YAML::Mark& mark) {
  return fmt::format("{}:{}: ", material.source, std::max(mark.line, 0) + 1);
}

[[noreturn]] void fail(const Material& material, const YAML::Node& node, const std::string& what) {
  throw InputError(place(material, node.Mark()) + what);
}

/// The text of a key that the item must have.
YAML::Node text_of(const Material& material, const YAML::Node& item, const char* key) {
  const YAML::Node text = item[key];
  if (!text || !text.IsScalar()) fail(material, item, fmt::format("{}: missing; a DATA item must have it", key));
  return text;
}

/// Reader of the numbers in a text. The text of "data: |" begins on the next line.
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

/// The table of a formula holds the ends of its range; in between the formula itself is evaluated.
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
  for (const double end_um : ends_um) {
    append_index(material, end_um, formula.at(end_um), std::nullopt, place(material, range.Mark()));
  }
  for (int i = 1; i < kFormulaChecks; ++i) {
    const double wavelength_um = std::lerp(ends_um[0], ends_um[1], static_cast<double>(i) / kFormulaChecks);
    if (const double n = formula.at(wavelength_um); !kNRange.contains(n)) {
      fail(material, coefficients, fmt::format("n = {} at {} um: must be in {}", n, wavelength_um, kNRange.text()));
    }
  }
  material.n.formula = formula;
}

/// 1 to kDispersionFormulas; 0 for a type that is no formula.
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

void read_item(Material& material, const YAML::Node& item) {
  if (!item.IsMap()) fail(material, item, "a DATA item has the keys type and data");
  const YAML::Node type = text_of(material, item, "type");
  const std::string& name = type.Scalar();
  const int formula = formula_of(name);
  const std::optional<Columns> columns = name.starts_with("tabulated ") ? columns_of(name.substr(10)) : std::nullopt;
  if (formula == 0 && !columns) {
    fail(material, type,
         fmt::format("type = {}: must be tabulated nk, tabulated n, tabulated k or formula 1 to {}", one_line(name),
                     kDispersionFormulas));
  }
  const bool has_n = !material.n.wavelength_um.empty();
  if (has_n && (formula != 0 || (columns->has_n && material.n.formula.number != 0))) {
    fail(material, type, fmt::format("type = {}: n is given twice", one_line(name)));
  }
  if (formula != 0) {
    check_keys(material, item, {"type", "wavelength_range", "coefficients"});
    return read_formula(material, item, formula);
  }
  check_keys(material, item, {"type", "data"});
  const YAML::Node data = text_of(material, item, "data");
  for (CsvReader row = rows_of(material, data); row.next();) append_row(material, *columns, row);
}

/// Reads the DATA items; everything else in the record is ignored.
void parse_yaml(Material& material, const std::string& text) {
  try {
    const YAML::Node record = YAML::Load(text);
    const YAML::Node data = record.IsMap() ? record["DATA"] : YAML::Node();
    if (data.IsDefined() && !data.IsNull() && !data.IsSequence()) fail(material, data, "DATA: must be a list of items");
    for (const YAML::Node& item : data) read_item(material, item);
  } catch (const YAML::DeepRecursion& error) {
    throw InputError(place(material, error.mark) + "nested too deeply");
  } catch (const YAML::Exception& error) {
    throw InputError(place(material, error.mark) + "not valid YAML: " + one_line(error.msg));
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
  if (is_record) {
    parse_yaml(material, text);
  } else {
    parse_csv(material, text);
  }
  if (material.n.wavelength_um.empty()) throw InputError(path + ":1: no values of n");
  return fit_to_spectrum(material, spectrum, prefix);
}

}  // namespace dolp
