// Reads the CSV of scattered points that `eval`, `lookup` and `mueller` take.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dolp {

enum class PointsKind {
  kDirections,  ///< eval, lookup: any of theta_deg, sigma, q, n, k, wavelength_um, at least one
  kGeometries,  ///< mueller: theta_i_deg, theta_r_deg, delta_phi_deg, and any of sigma, q, n, k
};

/// The points in the file's order; a column that the file does not have is nullopt.
struct Points {
  std::string name;               ///< of the file, for messages: its path, or stdin
  std::string header;             ///< column names as given, joined by commas, no blanks around them
  std::vector<std::string> rows;  ///< the input cells as typed, joined by commas, no blanks around them
  std::optional<std::vector<double>> theta_deg, theta_i_deg, theta_r_deg, delta_phi_deg;
  std::optional<std::vector<double>> sigma, q, n, k, wavelength_um;
  std::size_t size() const { return rows.size(); }
  /// The line that a row stands on: the header is line 1, and no line between the rows is empty.
  std::size_t line(std::size_t row) const { return row + 2; }
};

/// Reads the points at `path` ("-" is stdin). A header without rows is a valid list of no points.
///
/// Accepts CRLF line ends, a UTF-8 byte order mark, blanks around cells and empty lines at the end of the file.
/// Units: degrees; delta_phi_deg = 180 is the specular side, range [-360, 360].
/// Errors: InputError, one line that names file, line, column, value and allowed range; a file that cannot be opened is
/// an InputError too.
Points read_points(const std::string& path, PointsKind kind);

/// The same for a text in memory; `path_name` is for messages.
Points parse_points(const std::string& text, const std::string& path_name, PointsKind kind);

}  // namespace dolp
