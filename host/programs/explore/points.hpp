// Points of curves and maps, and the quantities of them that can be shown.
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
  std::vector<double> wavelength_um = {};  ///< of each point; empty: the scene's, as on a grid
  bool has_winds = false;
  bool is_grid = false;  ///< all combinations, q fastest: what they share is computed once

  const char* roughness() const { return has_winds ? "wind_m_s" : "sigma"; }
  std::size_t size() const;
  std::vector<Column> columns() const;
};

/// True where a wind gives the surface its sigma.
bool has_wind(const Scene& scene);

/// Zeniths of a scene's surface.
PointList points_at(const Scene& scene, std::vector<double> theta_deg);

/// `count` zeniths from `from` to `to`, both included.
std::vector<double> zeniths(double from_deg, double to_deg, std::size_t count);

/// Errors: those of Evaluator.
Results evaluate(Evaluator& evaluator, const Scene& scene, const PointList& list, const RunOptions& options);

/// The results at a point, in the units of a table.
struct Point : PointResult {
  double theta_deg = 0.0;
  double sigma = 0.0;  ///< or the wind of a scene that has one
  double q = 0.0;

  /// True where the status has none of the bits that make DOLP meaningless or void its promise.
  bool is_good() const;
  /// True where there are limits between which DOLP lies with all bounces.
  bool has_bracket() const;
};

std::vector<Point> points_of(const PointList& list, const Results& results);

/// "good", or the meaning of status bits, in few words.
std::string status_text(std::uint32_t status);

/// Quantities that a curve or a map can show.
enum class Plotted : std::uint8_t { kDolp, kSignedDolp, kRhoS, kRhoP, kEmissivityS, kEmissivityP, kAlbedo };

struct PlottedDescription {
  Plotted quantity;
  const char* name;               ///< UTF-8
  const char* meaning;            ///< UTF-8, with the equation
  bool in_percent;                ///< shown times 100
  bool needs_rho;                 ///< a plan that drops effects may not give it
  double (*value)(const Point&);  ///< NaN where the model gives none
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
