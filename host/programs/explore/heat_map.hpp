// A map over two of theta, sigma and q, from 16 x 16 to 128 x 128, and its lines of equal value.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/background.hpp"
#include "explore/scale.hpp"

namespace dolp::explore {

/// One axis of a map: theta, sigma or the wind, or q.
struct MapAxis {
  Axis axis = Axis::kTheta;
  Scale scale;
  bool is_wind = false;  ///< in the place of sigma

  /// "θ [°]", "σ", "U [m/s]", "q".
  const char* label() const;
  /// The key of the scene that it varies; empty for the zenith.
  std::string key() const;
  friend bool operator==(const MapAxis&, const MapAxis&) = default;
};
inline constexpr std::array kMapAxes = {Axis::kTheta, Axis::kSigma, Axis::kQ};

/// The axis as a scene suggests it: its grid where that has a range, else that of the parameter's slider.
MapAxis suggested_axis(Axis axis, const Scene& scene, double theta_max_deg);

/// The values of one quantity on a map.
/// Shape: count x count in rows, x fastest; y from the bottom up.
struct MapField {
  std::size_t count = 0;
  std::vector<double> values;  ///< NaN where there is none
  std::vector<std::uint8_t> is_good;
  double min = 0.0;  ///< of the good values
  double max = 0.0;
};

/// A piece of a line; positions from 0 to 1 along both axes of the map.
struct Segment {
  double x0, y0, x1, y1;
};

/// The lines where a field has `level`, by marching squares with linear interpolation. Squares with a corner that is
/// not good have none.
std::vector<Segment> contour(const MapField& field, double level);

/// The results behind a map.
class HeatMap {
 public:
  struct Level {
    std::size_t count;  ///< of rows and columns
    double tolerance;   ///< at least; 0: the scene's own
    std::size_t batch;  ///< rows at a time
  };
  // Two rows at a time of the first: a part delays the curve of a drag.
  static constexpr std::array<Level, 3> kLevels = {{{16, 1e-2, 2}, {64, 1e-2, 8}, {128, 0.0, 4}}};

  explicit HeatMap(const Scene& scene) : scene_(scene) {}

  /// Switches to this map. `key` identifies the content of the scene except the parameters that the axes vary. The
  /// third of theta, sigma and q is `theta_deg` or the scene's.
  void follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
              double theta_deg);

  std::optional<Job> wanted(std::size_t level) const;
  /// Takes what is this map's; false for the rest. The first level is shown when it is complete.
  bool take(const JobPart& news);
  bool is_finished() const;
  /// True where the map on display is that of the scene, at the first level at least.
  bool is_coarse_done() const { return shown_key_ == key_ && !points_[0].empty(); }
  /// True where the first level is begun and not complete.
  bool is_arriving() const { return arriving_key_ == key_ && !arriving_.empty(); }
  /// True where the map on display belongs to an earlier scene.
  bool is_stale() const { return !shown_key_.empty() && shown_key_ != key_; }

  const MapAxis& x() const { return x_; }
  const MapAxis& y() const { return y_; }
  /// Rows and columns, and the part of the next level that is there, for the legend.
  std::size_t finished_count() const;
  double progress() const;
  /// Changes with everything that changes the field.
  std::size_t version() const { return version_; }

  /// The finest that there is; rows that a level lacks come from the coarser one.
  MapField field(Plotted quantity) const;

 private:
  std::string key_of(std::size_t level) const;
  /// `batch` rows of a level.
  PointList rows(std::size_t level, std::size_t first) const;

  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  MapAxis x_, y_;
  double theta_deg_ = 0.0;
  std::string shown_key_;                                  ///< the map that the results are of
  std::array<std::vector<Point>, kLevels.size()> points_;  ///< row by row
  std::string arriving_key_;
  std::vector<Point> arriving_;  ///< of the first level
  std::size_t version_ = 0;
};

}  // namespace dolp::explore
