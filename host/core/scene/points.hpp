// Reads the CSV of scattered points that `eval`, `lookup` and `mueller` take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <dolp/options.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/scene_entry.hpp"

namespace dolp {

enum class PointsKind {
  kDirections,  ///< eval, lookup: any of theta_deg, sigma, q, n, k, wavelength_um and numbers of films, at least one
  kGeometries,  ///< mueller: theta_i_deg, theta_r_deg, delta_phi_deg, and any of sigma, q, n, k and numbers of films
};

/// The points in their order; a column that they do not have is nullopt.
struct Points {
  std::string name;  ///< for messages: the path of the file, "stdin", or "points" for arrays
  std::size_t count = 0;
  std::string header;             ///< column names as given, joined by commas, no blanks around them
  std::vector<std::string> rows;  ///< input cells as typed, joined by commas, no blanks around them; empty for arrays
  std::vector<std::string> left_out;  ///< columns of the file that are results
  using Column = std::optional<std::vector<double>>;
  AxisArray<Column> coordinates;
  AxisLabels labels;  ///< texts in columns of a file; the values of these columns are positions in this list
  /// Numbers of films, by layer (from 0) and part: columns called as the keys, "surface.coating.1.thickness_um".
  std::map<std::pair<std::size_t, FilmValue::Part>, Column> films;
  bool has_winds = false;                          ///< sigma was given as winds
  Column theta_i_deg, theta_r_deg, delta_phi_deg;  ///< for kGeometries, which has no theta_deg and wavelength_um
  std::size_t header_line = 0;                     ///< 0 for arrays
  std::vector<std::uint32_t> row_lines;            ///< the line of each row; empty for arrays
  std::size_t size() const { return count; }
  Column& operator[](Axis axis) { return coordinates[axis]; }
  const Column& operator[](Axis axis) const { return coordinates[axis]; }
  /// The value of a row as messages show it.
  std::string text_at(Axis axis, std::size_t row) const;
  /// The numbers of films of a row.
  std::vector<FilmValue> films_at(std::size_t row) const;
  /// The beginning of a message about a row, "file:line" or "points[row]", and about the columns.
  std::string where(std::size_t row) const;
  std::string where() const;
};

/// The value of a row, or `fallback` without such a column.
inline double value_or(const Points::Column& column, std::size_t row, double fallback) {
  return column ? (*column)[row] : fallback;
}

/// For each point, the position in `known` of the label in its column. Case does not matter. A part of a label is
/// enough if no other label has it. Errors: InputError with the known labels.
std::vector<double> label_positions(const Points& points, Axis axis, const AxisLabels& known);

/// Points in memory: `count` of them.
/// Errors: InputError as for a file, and for a column of another length.
Points points_of(std::span<const Column> columns, std::size_t count, PointsKind kind);

/// Reads the points at `path` ("-" is stdin). A header without rows is a valid list of no points.
///
/// Accepts CRLF line ends, a UTF-8 byte order mark, blanks and double quotes around cells, lines that begin with # and
/// empty lines at the end of the file. Leaves out columns whose names are in `results`.
/// Units: degrees; delta_phi_deg = 180 is the specular side, range [-360, 360].
/// Errors: InputError, one line that names file, line, column, value and allowed range; a file that cannot be opened is
/// an InputError too.
Points read_points(const std::string& path, PointsKind kind, const std::vector<std::string>& results = {});

/// Reads points from a text in memory; `path_name` is for messages.
Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind,
                    const std::vector<std::string>& results = {});

}  // namespace dolp
