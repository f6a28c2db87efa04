// Points of curves and maps, and the quantities that a plot can show.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <dolp/dolp.hpp>
#include <string>
#include <vector>

namespace dolp::explore {

/// Points to compute: columns of one length, or the axes of a grid.
struct PointList {
  std::vector<double> theta_deg;
  std::vector<double> sigma;  ///< or winds, m/s
  std::vector<double> q;
  std::vector<double> wavelength_um = {};  ///< one value per point; empty, and on a grid: the scene's wavelength
  bool has_winds = false;
  bool is_grid = false;  ///< all combinations, q fastest: shared work is done once

  const char* roughness() const { return has_winds ? "wind_m_s" : "sigma"; }
  std::size_t size() const;
  std::vector<Column> columns() const;
};

/// True where a wind gives the surface its sigma.
bool has_wind(const Scene& scene);

/// A scene's surface at some zeniths.
PointList points_at(const Scene& scene, std::vector<double> theta_deg);

/// `count` zeniths from `from` to `to`, both included.
std::vector<double> zeniths(double from_deg, double to_deg, std::size_t count);

/// Computes the points of a list. Errors: as Evaluator::evaluate and Evaluator::table.
Results evaluate(Evaluator& evaluator, const Scene& scene, const PointList& list, const RunOptions& options);

/// The results at a point, in the units of a table.
struct Point : PointResult {
  double theta_deg = 0.0;
  double sigma = 0.0;  ///< or the wind of a scene that has one
  double q = 0.0;

  /// True where the status has no bit that makes DOLP meaningless or voids its error bound.
  bool is_good() const;
  /// True where the point has limits between which DOLP with all bounces lies.
  bool has_bracket() const;
};

std::vector<Point> points_of(const PointList& list, const Results& results);

/// "good", or the meaning of status bits, in few words.
std::string status_text(std::uint32_t status);

/// A quantity that a curve or a map can show.
enum class Plotted : std::uint8_t { kDolp, kSignedDolp, kRhoS, kRhoP, kEmissivityS, kEmissivityP, kAlbedo };

struct PlottedDescription {
  Plotted quantity;
  const char* name;               ///< UTF-8
  const char* meaning;            ///< UTF-8, with the equation
  bool in_percent;                ///< shown times 100
  bool needs_rho;                 ///< missing where the plan drops effects
  double (*value)(const Point&);  ///< NaN where the model gives no value
  bool is_signed = false;

  double scale() const { return in_percent ? 100.0 : 1.0; }
  /// "DOLP [%]".
  std::string label() const { return std::string(name) + (in_percent ? " [%]" : ""); }
};
extern const std::array<PlottedDescription, 7> kAllPlotted;

inline const PlottedDescription& described(Plotted quantity) {
  return kAllPlotted.at(static_cast<std::size_t>(quantity));
}

}  // namespace dolp::explore
