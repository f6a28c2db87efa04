#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <dolp/dolp.hpp>
#include <string>
#include <utility>
#include <vector>

namespace dolp::explore {

/// Points to compute. A column has one value per point, or one value for all.
struct PointList {
  std::vector<std::pair<std::string, std::vector<double>>> values;  ///< columns, named as in `dolp eval`

  std::vector<double>& operator[](const std::string& name);  ///< adds a column `name` if it is missing
  std::size_t size() const;                                  ///< number of points
  std::vector<Column> columns() const {
    std::vector<Column> columns;
    for (const auto& [name, column] : values) columns.push_back({name, column});
    return columns;
  }
};

bool has_wind(const Scene& scene);          ///< true if a wind speed determines sigma
bool has_cross_slopes(const Scene& scene);  ///< true if slopes differ along and across

/// Points at the zeniths `theta_deg` with the scene's slope distribution. The zenith is the first column.
PointList points_at(const Scene& scene, std::vector<double> theta_deg);

/// The results at a point, in the units that `dolp table` uses.
struct Point : PointResult {
  double theta_deg = 0.0;  ///< from the first column of the list

  /// True if the status has no bit that makes DOLP meaningless or voids its error bound.
  bool is_good() const { return promises_dolp(status) && std::isfinite(values[Quantity::kDolp]); }
  /// True if nothing is wrong with DOLP: it also meets its tolerance, and the model is right for the surface.
  bool is_trusted() const { return is_good() && (status & ~kRhoToleranceNotMet) == 0; }
  bool has_bracket() const {  // true if the result has dolp_low and dolp_high
    return std::isfinite(values[Quantity::kDolpLow]) && std::isfinite(values[Quantity::kDolpHigh]);
  }
};

std::vector<Point> result_points(const PointList& list, const Results& results);
std::string status_text(std::uint32_t status);  ///< "good", or a short text of the status bits

enum class Plotted : std::uint8_t {
  kDolp,
  kSignedDolp,
  kUOverI,
  kAolp,
  kRhoS,
  kRhoP,
  kEmissivityS,
  kEmissivityP,
  kAlbedo
};

struct PlottedDescription {
  Plotted quantity;
  const char* name;               ///< name in UTF-8
  const char* meaning;            ///< text in UTF-8, with the equation
  const char* unit;               ///< unit in plots; with "%", plots show 100 times the value
  bool needs_rho;                 ///< true: computed from rho, so a run must keep effects that change only rho
  double (*value)(const Point&);  ///< NaN where the model gives no value
  bool is_signed = false;
  bool is_angle = false;  ///< an angle of a line: 0 and 180 degrees are equal

  double shown(const Point& point) const { return scale() * value(point); }  ///< value() in the unit of label()
  double scale() const { return is_percent() ? 100.0 : 1.0; }
  bool is_percent() const { return *unit == '%'; }
  std::string label() const { return *unit ? std::string(name) + " [" + unit + ']' : name; }
  /// True if a line between two neighbouring values would cross all values, because an angle passes from 180 to 0.
  bool jumps(double a, double b) const { return is_angle && std::abs(a - b) > 90.0; }
};
extern const std::array<PlottedDescription, 9> kAllPlotted;

inline const PlottedDescription& described(Plotted quantity) {
  return kAllPlotted.at(static_cast<std::size_t>(quantity));
}

}  // namespace dolp::explore
