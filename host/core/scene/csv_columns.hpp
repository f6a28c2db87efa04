#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>
#include "scene/csv.hpp"

namespace dolp {

/// The form of the data files that users write: the line of names decides about the separator.
inline constexpr CsvForm kDataFile{.separator = std::nullopt};

struct CsvColumn {
  std::string name;
  NumberRange range = {};
  bool is_required = false;
  std::string other_name = {};  ///< a second name that the column may have
  std::string unit = {};        ///< unit for messages, if `name` does not contain it
  std::string if_twice = {};    ///< what a message adds if the file has this column twice
};

/// Units in which a file may give the column "wavelength_um".
enum class SpectralUnit { kMicrometres, kNanometres, kPerCentimetre, kElectronvolts };

/// A line of names and its meaning.
struct CsvHeader {
  std::vector<std::string> names;
  std::vector<std::optional<std::size_t>> cells;  ///< for each name the position in the list of known columns
  std::vector<SpectralUnit> units;
  std::vector<std::size_t> again;  ///< cells that give the wavelength again, in another unit
  std::size_t known = 0;           ///< number of names that are known
  std::string fault;               ///< why the line cannot name the columns; empty if it can
};

/// The columns of a file. The header may name them in any order, in upper or lower case. The column "wavelength_um" may
/// also be called wavelength_nm, wavenumber_cm or energy_eV, with its unit in brackets too, as in "lambda [nm]". Then
/// number() converts its values to um.
class CsvColumns {
 public:
  /// Reads the header at the reader's line. The names may also be in two lines: names, and units below them. They may
  /// also be in a comment above numbers. Then next() stays at these numbers. Ignores the columns in `ignored`. The
  /// first of several spectral columns counts. Errors: InputError for a repeated, missing or unknown name, and for
  /// numbers without names.
  static CsvColumns header_at(CsvReader& reader, const std::vector<CsvColumn>& known,
                              const std::vector<std::string>& ignored = {});
  /// Goes to the next line, and reads the header there. Errors: also InputError for a text without lines.
  static CsvColumns read_names(CsvReader& reader, const std::vector<CsvColumn>& known,
                               const std::vector<std::string>& ignored = {});
  /// The header in the last comment that names the numbers at the reader's line; nullopt if there is no such comment.
  static std::optional<CsvColumns> in_comments(const CsvReader& reader, const std::vector<CsvColumn>& known,
                                               const std::vector<std::string>& ignored = {});

  /// For a file without a header. Its rows have all columns in the order of `known`.
  explicit CsvColumns(std::vector<CsvColumn> known);

  bool has(std::string_view name) const { return find_cell(name).has_value(); }

  const std::vector<std::string>& names() const { return header_.names; }
  /// For each cell of a row, the position of its column in the list of known columns; nullopt if the column is ignored.
  const std::vector<std::optional<std::size_t>>& cells() const { return header_.cells; }

  /// The number of `row` in the column `name`; nullopt if the file lacks this column. Errors: InputError for a bad row.
  std::optional<double> number(const CsvReader& row, std::string_view name) const;
  double number_at(const CsvReader& row, std::size_t cell) const;
  /// True if `row` has the text nan in the column `name`.
  bool is_nan(const CsvReader& row, std::string_view name) const;

  /// Refuses a row with another separator than the header, with more cells, or with two different wavelengths.
  void check_row(const CsvReader& row) const;

 private:
  CsvColumns(std::vector<CsvColumn> known, CsvHeader header);
  std::optional<std::size_t> find_cell(std::string_view name) const;

  std::vector<CsvColumn> known_;
  CsvHeader header_;
};

std::string unknown_column(std::string_view name, const std::vector<CsvColumn>& known);

}  // namespace dolp
