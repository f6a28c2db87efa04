#include "scene/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <iterator>
#include <utility>

#include "base/text.hpp"

namespace dolp {
namespace {

constexpr const char* kSpectralColumn = "wavelength_um";
constexpr double kNanometresPerMicrometre = 1e3;
constexpr double kMicrometresTimesPerCentimetre = 1e4;
// h c / e in um eV, exact in the SI of 2019.
constexpr double kMicrometresTimesElectronvolts = 1.2398419843320026;

struct UnitNames {
  SpectralUnit unit;
  std::vector<std::string> quantities;  // that may have the unit
  std::vector<std::string> units;
};

const std::vector<UnitNames>& unit_names() {
  const std::vector<std::string> lengths = {"wavelength", "wavelengths", "lambda", "wl", "wave"};
  static const std::vector<UnitNames> names = {
      {SpectralUnit::kMicrometres,
       lengths,
       {"um", "\xC2\xB5m", "\xCE\xBCm", "micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres"}},
      {SpectralUnit::kNanometres, lengths, {"nm", "nanometer", "nanometers", "nanometre", "nanometres"}},
      {SpectralUnit::kPerCentimetre, {"wavenumber", "wavenumbers", "wn"}, {"cm", "cm-1", "cm^-1", "1/cm", "cm**-1"}},
      {SpectralUnit::kElectronvolts, {"energy", "photon energy"}, {"ev"}}};
  return names;
}

/// The unit of a spectral column: of "wavelength_um", "Wavelength (micron)", "(um)", and of WAVL and WAVN in files of
/// the Aerosol Refractive Index Archive (ARIA).
std::optional<SpectralUnit> spectral_unit(std::string_view name) {
  const std::string text = lower_case(name);
  if (text == "wl" || text == "wavl") return SpectralUnit::kMicrometres;
  if (text == "wavn") return SpectralUnit::kPerCentimetre;
  const std::size_t bracket = text.find_first_of("([");
  const std::size_t cut = std::min(bracket == std::string::npos ? text.rfind('_') : bracket, text.size());
  const std::string quantity(trim(std::string_view(text).substr(0, cut), " _"));
  const std::string unit(trim(std::string_view(text).substr(cut), " _()[]"));
  for (const UnitNames& names : unit_names()) {
    const bool is_quantity =
        (quantity.empty() && bracket == 0) || std::ranges::find(names.quantities, quantity) != names.quantities.end();
    if (is_quantity && std::ranges::find(names.units, unit) != names.units.end()) return names.unit;
  }
  return std::nullopt;
}

double in_micrometres(double value, SpectralUnit unit) {
  switch (unit) {
    case SpectralUnit::kMicrometres:
      return value;
    case SpectralUnit::kNanometres:
      return value / kNanometresPerMicrometre;
    case SpectralUnit::kPerCentimetre:
      return kMicrometresTimesPerCentimetre / value;
    case SpectralUnit::kElectronvolts:
      return kMicrometresTimesElectronvolts / value;
  }
  return value;
}

std::string column_names(const std::vector<CsvColumn>& columns) {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) {
    const bool is_spectral = column.name == kSpectralColumn;
    const std::string unit = is_spectral ? "or wavelength_nm, wavenumber_cm, energy_eV" : column.unit;
    names.push_back(unit.empty() ? column.name : fmt::format("{} ({})", column.name, unit));
  }
  return join(names);
}

/// A name in lower case without the unit of a pure number: "n" for "N (-)".
std::string bare_name(std::string_view name) {
  const std::size_t bracket = std::min(name.find_first_of("(["), name.size());
  const std::string_view unit = trim(name.substr(bracket), " ()[]");
  const bool is_pure = unit.empty() || unit == "-" || unit == "1";
  return lower_case(trim(is_pure ? name.substr(0, bracket) : name));
}

std::optional<std::size_t> column_position(const std::vector<CsvColumn>& columns, std::string_view name) {
  const std::string wanted = bare_name(name);
  const bool is_spectral = spectral_unit(name).has_value();
  const auto found = std::ranges::find_if(columns, [&](const CsvColumn& column) {
    return lower_case(column.name) == wanted || (!wanted.empty() && lower_case(column.other_name) == wanted) ||
           (is_spectral && column.name == kSpectralColumn);
  });
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

/// The meaning of names, and the first fault in them.
CsvHeader examine(std::vector<std::string> names, const std::vector<CsvColumn>& known,
                  const std::vector<std::string>& ignored) {
  CsvHeader header;
  header.names = std::move(names);
  const auto add_fault = [&](std::string fault) {
    if (header.fault.empty()) header.fault = std::move(fault);
  };
  for (const std::string& name : header.names) {
    std::optional<std::size_t> column = column_position(known, name);
    const std::optional<SpectralUnit> unit = spectral_unit(name);
    if (column) ++header.known;
    if (!column && std::ranges::find(ignored, name) == ignored.end()) add_fault(unknown_column(name, known));
    const auto first = column ? std::ranges::find(header.cells, column) : header.cells.end();
    if (first != header.cells.end()) {
      const bool is_other_unit = unit && header.units[static_cast<std::size_t>(first - header.cells.begin())] != *unit;
      const std::string& more = known[*column].if_twice;
      if (is_other_unit)
        header.again.push_back(header.cells.size());
      else
        add_fault(fmt::format("column \"{}\" appears twice{}", known[*column].name, more.empty() ? "" : "; " + more));
      column.reset();
    }
    header.cells.push_back(column);
    header.units.push_back(unit.value_or(SpectralUnit::kMicrometres));
  }
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i].is_required || std::ranges::find(header.cells, std::optional(i)) != header.cells.end()) continue;
    missing.push_back(fmt::format("column \"{}\" is missing, a number in {}", known[i].name, known[i].range.text()));
  }
  if (!missing.empty()) add_fault(fmt::format("{}", fmt::join(missing, "; ")));
  return header;
}

std::vector<std::string> names_in(std::string_view line, char separator) {
  const std::vector<std::string_view> cells = split_cells(line, separator);
  return {cells.begin(), cells.end()};
}

/// Names of columns with their units from the line below. Empty if the lines have different numbers of cells.
std::vector<std::string> names_with_units(std::string_view line, std::string_view below, char separator) {
  std::vector<std::string> names = names_in(line, separator);
  const std::vector<std::string> units = names_in(below, separator);
  if (names.size() != units.size()) return {};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string_view unit = trim(units[i], " ()[]-");
    if (!unit.empty()) names[i] += fmt::format(" ({})", unit);
  }
  return names;
}

struct Candidate {
  CsvHeader header;
  char separator = ',';
  bool is_below = false;  // the names reach into the line below the reader's line
};

/// The readings of the reader's line as a header, and of the line below it if this has no numbers either.
std::vector<Candidate> header_candidates(const CsvReader& reader, const std::vector<CsvColumn>& known,
                                         const std::vector<std::string>& ignored) {
  const auto separators = [&](std::string_view line) {
    return reader.separator() ? std::vector<char>{*reader.separator()} : separators_in(line);
  };
  std::vector<Candidate> candidates;
  for (const char separator : separators(reader.line()))
    candidates.push_back({examine(names_in(reader.line(), separator), known, ignored), separator, false});
  const std::string_view below = reader.line_below();
  if (below.empty()) return candidates;
  for (const char separator : separators(below)) {
    const std::vector<std::string> names = names_in(below, separator);
    if (std::ranges::any_of(names, [](const std::string& name) { return parse_number(name).has_value(); })) continue;
    candidates.push_back({examine(names, known, ignored), separator, true});
    candidates.push_back({examine(names_with_units(reader.line(), below, separator), known, ignored), separator, true});
  }
  return candidates;
}

constexpr std::array<std::pair<char, const char*>, 4> kSeparatorNames = {
    {{';', "semicolons"}, {',', "commas"}, {'\t', "tabs"}, {' ', "blanks"}}};

/// Refuses a row with a cell that holds several numbers, because they are separated otherwise than the names.
void check_separators(const CsvReader& row) {
  const auto used = std::ranges::find(kSeparatorNames, row.separator().value_or(','), [](auto& p) { return p.first; });
  for (const auto& [character, name] : kSeparatorNames) {
    for (const std::string_view cell : row.cells()) {
      const std::vector<std::string_view> pieces = split(cell, character);
      const bool is_row =
          std::ranges::any_of(pieces, [](std::string_view piece) { return parse_number(piece).has_value(); });
      if (character != ',' && pieces.size() > 1 && is_row)
        row.fail(fmt::format("{}: cells must be separated by {}, not {}; numbers must have a decimal point",
                             one_line(row.line()), used->second, name));
    }
  }
}

}  // namespace

CsvColumns CsvColumns::header_at(CsvReader& reader, const std::vector<CsvColumn>& known,
                                 const std::vector<std::string>& ignored) {
  if (std::optional<CsvColumns> columns = in_comments(reader, known, ignored)) {
    reader.stay();
    return *columns;
  }
  if (reader.has_only_numbers()) reader.fail("the columns must be named first: " + column_names(known));
  const std::vector<Candidate> candidates = header_candidates(reader, known, ignored);
  auto best = std::ranges::find_if(candidates, [](const Candidate& one) { return one.header.fault.empty(); });
  const bool is_header = best != candidates.end();
  if (!is_header)
    best = std::ranges::max_element(candidates, {}, [](const Candidate& one) { return one.header.known; });
  if (best->is_below) reader.next();
  if (!is_header) reader.fail(best->header.fault);
  reader.separate_by(best->separator);
  return {known, best->header};
}

CsvColumns CsvColumns::read_names(CsvReader& reader, const std::vector<CsvColumn>& known,
                                  const std::vector<std::string>& ignored) {
  if (!reader.next()) reader.fail("the file is empty; a line of column names is expected: " + column_names(known));
  return header_at(reader, known, ignored);
}

std::optional<CsvColumns> CsvColumns::in_comments(const CsvReader& reader, const std::vector<CsvColumn>& known,
                                                  const std::vector<std::string>& ignored) {
  if (!reader.has_only_numbers()) return std::nullopt;
  for (auto comment = reader.comments().rbegin(); comment != reader.comments().rend(); ++comment) {
    // The names may follow other text, as in "FORMAT=WAVL N K" and "the columns are: lambda[um] n k".
    const std::string_view text = comment->substr(comment->find_last_of("#!%=:") + 1);
    for (const char separator : separators_in(text)) {
      CsvHeader header = examine(names_in(text, separator), known, ignored);
      const bool names_all = header.fault.empty() && header.names.size() == reader.cells().size();
      if (names_all) return CsvColumns(known, std::move(header));
    }
  }
  return std::nullopt;
}

CsvColumns::CsvColumns(std::vector<CsvColumn> known) : known_(std::move(known)) {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    header_.cells.emplace_back(i);
    header_.units.push_back(SpectralUnit::kMicrometres);
    header_.names.push_back(known_[i].name);
  }
}

CsvColumns::CsvColumns(std::vector<CsvColumn> known, CsvHeader header)
    : known_(std::move(known)), header_(std::move(header)) {}

std::optional<std::size_t> CsvColumns::find_cell(std::string_view name) const {
  for (std::size_t cell = 0; cell < header_.cells.size(); ++cell) {
    if (header_.cells[cell] && known_[*header_.cells[cell]].name == name) return cell;
  }
  return std::nullopt;
}

std::optional<double> CsvColumns::number(const CsvReader& row, std::string_view name) const {
  check_row(row);
  const std::optional<std::size_t> cell = find_cell(name);
  return cell ? std::optional(number_at(row, *cell)) : std::nullopt;
}

double CsvColumns::number_at(const CsvReader& row, std::size_t cell) const {
  const CsvColumn& column = known_[*header_.cells[cell]];
  const SpectralUnit unit = header_.units[cell];
  const bool is_converted = unit != SpectralUnit::kMicrometres;
  if (cell < row.cells().size()) {
    const std::optional<double> value = parse_number(row.cells()[cell]);
    const std::optional<double> converted = value ? std::optional(in_micrometres(*value, unit)) : std::nullopt;
    if (converted && column.range.contains(*converted)) return *converted;
    if (!value) check_separators(row);
    if (converted && is_converted)
      row.fail(fmt::format("{} = {}: is {:.6g} um, and must be a number in {} um", header_.names[cell], *value,
                           *converted, column.range.text()));
  }
  // throws, because the value is missing or not allowed
  return row.number(cell, is_converted ? header_.names[cell] : column.name, &column.range);
}

bool CsvColumns::is_nan(const CsvReader& row, std::string_view name) const {
  const std::optional<std::size_t> cell = find_cell(name);
  return cell && *cell < row.cells().size() && is_nan_text(row.cells()[*cell]);
}

void CsvColumns::check_row(const CsvReader& row) const {
  const std::size_t width = row.cells().size();
  if (width > header_.cells.size()) {
    check_separators(row);
    const std::string_view extra = row.cells()[header_.cells.size()];
    if (extra.empty())
      row.fail(fmt::format("the row goes on after column {}, the last; no separator may follow", header_.names.back()));
    row.fail(fmt::format("{}: one value too many after column {}, the last{}", one_line(extra), header_.names.back(),
                         width == 2 * header_.cells.size() ? "; numbers must have a decimal point" : ""));
  }
  if (width < header_.cells.size()) return check_separators(row);  // number() reports the first column without a value
  constexpr double kRounded = 0.01;  // relative difference of wavelengths that rounding in a file may cause
  for (const std::size_t cell : header_.again) {
    const std::size_t first = *find_cell(kSpectralColumn);
    const std::optional<double> value = parse_number(row.cells()[cell]);
    if (!value) continue;
    const double um = in_micrometres(*value, header_.units[cell]);
    if (std::abs(um - number_at(row, first)) > kRounded * um)
      row.fail(fmt::format("{} = {}: is {:.6g} um, but {} is another wavelength; leave out one of both columns",
                           header_.names[cell], *value, um, header_.names[first]));
  }
}

std::string unknown_column(std::string_view name, const std::vector<CsvColumn>& known) {
  std::vector<std::string> names;
  for (const CsvColumn& column : known) names.push_back(column.name);
  const std::optional<std::string> near = near_name(name, names);
  return fmt::format("column \"{}\" is unknown; {}allowed are {}", one_line(name),
                     near ? fmt::format("the nearest known is {}, ", *near) : "", column_names(known));
}

}  // namespace dolp
