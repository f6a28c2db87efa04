// The user's own refractive indices: refractiveindex.info database records and CSV files.
#include <fmt/format.h>

#include <cstddef>

#include "error.hpp"
#include "scene/csv.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

/// What the rows of a table hold after the wavelength.
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

/// The columns that a line of names announces, nullopt where it announces none.
std::optional<Columns> parse_column_names(const std::vector<std::string_view>& cells) {
  const std::string first = lower_case(cells[0]);
  if (first != "wl" && first != "wavelength_um") return std::nullopt;
  std::string others;
  for (std::size_t i = 1; i < cells.size(); ++i) others += lower_case(cells[i]) + ' ';
  if (others == "n k ") return Columns{true, true};
  if (others == "n ") return Columns{true, false};
  if (others == "k ") return Columns{false, true};
  return std::nullopt;
}

void parse_csv(Material& material, std::string_view text) {
  std::optional<Columns> columns;
  for (CsvReader row(text, material.source); row.next();) {
    if (const auto named = parse_column_names(row.cells())) {
      columns = named;
    } else if (columns) {
      append_row(material, *columns, row);
    } else {
      row.fail(one_line(row.line()) + ": the columns must be named first: wavelength_um (or wl), then n, k or both");
    }
  }
}

/// The value of a "key: value" or "- key: value" line, without quotes; nullopt where the line has another key.
std::optional<std::string_view> yaml_value(std::string_view line, std::string_view key) {
  line = trim(line);
  if (line.starts_with('-')) line = trim(line.substr(1));
  if (!line.starts_with(key) || !line.substr(key.size()).starts_with(':')) return std::nullopt;
  std::string_view value = trim(line.substr(key.size() + 1));
  const bool is_quoted = value.size() >= 2 && (value.front() == '"' || value.front() == '\'');
  return is_quoted ? value.substr(1, value.size() - 2) : value;
}

Columns parse_yaml_type(std::string_view type, const std::string& where) {
  if (type == "tabulated nk") return {true, true};
  if (type == "tabulated n") return {true, false};
  if (type == "tabulated k") return {false, true};
  throw InputError(fmt::format("{}type = {}: must be tabulated nk, tabulated n or tabulated k", where, one_line(type)));
}

/// Reads the DATA items; everything else in the record is of no interest here.
void parse_yaml(Material& material, std::string_view text) {
  bool is_in_data = false;
  bool is_in_rows = false;
  Columns columns;
  const std::vector<std::string_view> lines = split_lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    if (trim(line).empty() || trim(line).front() == '#') continue;
    const std::string where = fmt::format("{}:{}: ", material.source, i + 1);
    const bool is_item = trim(line).front() == '-';
    const bool is_top_level = line.front() != ' ' && !is_item;
    if (is_top_level) is_in_data = line.starts_with("DATA:");
    if (is_top_level || is_item) is_in_rows = false;
    if (!is_in_data || is_top_level) continue;
    if (const auto type = yaml_value(line, "type")) {
      columns = parse_yaml_type(*type, where);
    } else if (yaml_value(line, "data")) {
      is_in_rows = true;
    } else if (is_in_rows) {
      CsvReader row(line, material.source, {.separator = ' ', .first_line = i + 1});
      row.next();
      append_row(material, columns, row);
    } else {
      throw InputError(fmt::format("{}{}: a DATA item has the keys type and data", where, one_line(line)));
    }
  }
}

}  // namespace

Material read_material_file(const std::string& path, const Spectrum& spectrum, const std::string& prefix) {
  const std::string text = read_text(path, prefix);
  const std::string lower_path = lower_case(path);
  Material material;
  material.name = path.substr(path.find_last_of('/') + 1);
  material.source = path;
  if (lower_path.ends_with(".yml") || lower_path.ends_with(".yaml")) {
    parse_yaml(material, text);
  } else {
    parse_csv(material, text);
  }
  if (material.n.wavelength_um.empty()) throw InputError(path + ":1: no values of n");
  return fit_to_spectrum(material, spectrum, prefix);
}

}  // namespace dolp
