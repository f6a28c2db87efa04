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
  /// For the commands `eval` and `lookup`. At least one column: an axis (theta_deg, sigma, n, ...) or a film's value.
  kDirections,
  /// For the command `mueller`. Required columns: theta_i_deg, theta_r_deg, delta_phi_deg, which are values on the axes
  /// theta, view zenith and relative azimuth. Optional columns: sigma or wind_m_s, q, n, k, and values of films.
  kGeometries,
};

/// Scattered points, in the order of the input. A column that the input lacks is nullopt.
struct Points {
  std::string name;  ///< name for messages: the path of the file, "stdin", or "points" for arrays
  std::size_t count = 0;
  std::string header;                 ///< column names as given, joined by commas
  std::vector<std::string> rows;      ///< cells of each row as typed, joined by commas; empty for arrays
  std::vector<std::string> left_out;  ///< columns of the file that are not read because they are results
  using Column = std::optional<std::vector<double>>;
  AxisArray<Column> coordinates;
  /// The different names of materials and bands in the file. The columns of these axes hold positions in these lists.
  AxisLabels labels;
  /// Columns such as "surface.coating.1.thickness_um". Map key: the layer (0 for coating.1), and n, k or thickness.
  std::map<std::pair<std::size_t, FilmValue::Part>, Column> films;
  bool has_winds = false;                ///< true if the points have winds instead of sigmas
  std::size_t header_line = 0;           ///< line of the header in the file; 0 for arrays
  std::vector<std::uint32_t> row_lines;  ///< line of each row in the file; empty for arrays
  std::size_t size() const { return count; }
  Column& operator[](Axis axis) { return coordinates[axis]; }
  const Column& operator[](Axis axis) const { return coordinates[axis]; }
  /// The value on `axis` of a row, as messages show it.
  std::string text_at(Axis axis, std::size_t row) const;
  std::vector<FilmValue> films_at(std::size_t row) const;
  /// Beginning of a message about a row: "file:line" or "points[row]". Without `row`: about the header.
  std::string where(std::size_t row) const;
  std::string where() const;
};

inline double value_or(const Points::Column& column, std::size_t row, double fallback) {
  return column ? (*column)[row] : fallback;
}

/// For each point, finds its label in the list `known` and returns the position. Case does not matter. A part of a
/// label is enough if no other label contains it. Errors: InputError that lists the known labels.
std::vector<double> label_positions(const Points& points, Axis axis, const AxisLabels& known);

/// Points from arrays. Errors: errors of read_points, and InputError if a column's length is neither 1 nor `count`.
Points make_points(std::span<const Column> columns, std::size_t count, PointsKind kind);

/// Reads the points in the CSV file at `path` ("-" is stdin). A header without rows is a valid list of no points.
/// Leaves out columns whose names are in `results`. Angles are in degrees. delta_phi_deg = 180 is the specular side.
/// Errors: InputError for a wrong value, with file, line, column and range. InputError if the file cannot be opened.
Points read_points(const std::string& path, PointsKind kind, const std::vector<std::string>& results = {});

Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind,
                    const std::vector<std::string>& results = {});

}  // namespace dolp
