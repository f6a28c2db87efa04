// A map over two of theta, sigma and q, from 16 x 16 to 128 x 128 entries, and its lines of equal value.
#pragma once

#include "explore/background.hpp"
#include "explore/scale.hpp"

namespace dolp::explore {

/// One axis of a map: theta, sigma or the wind, or q.
struct MapAxis {
  Axis axis = Axis::kTheta;
  Scale scale;
  bool is_wind = false;  ///< the wind instead of sigma

  /// "θ [°]", "σ", "U [m/s]", "q".
  const char* label() const;
  /// The key of the scene that it varies; empty for the zenith.
  std::string key() const;
  friend bool operator==(const MapAxis&, const MapAxis&) = default;
};
inline constexpr std::array kMapAxes = {Axis::kTheta, Axis::kSigma, Axis::kQ};

/// The axis that a scene suggests: the range of its grid, or, without a range there, of the parameter's slider.
MapAxis suggested_axis(Axis axis, const Scene& scene, double theta_max_deg);

/// Why a map of a scene cannot have a range along an axis; empty where it can.
std::string refusal(const Scene& scene, const MapAxis& axis, const Scale& range);

/// The values of one quantity on a map.
/// Shape: count x count in rows, x fastest; y from the bottom up.
struct MapField {
  std::size_t count = 0;
  std::vector<double> values;  ///< NaN where there is no value
  std::vector<std::uint8_t> is_good;
  double min = 0.0;  ///< the least and the largest good value
  double max = 0.0;
};

/// A piece of a line; positions from 0 to 1 along both axes of the map.
struct Segment {
  double x0, y0, x1, y1;
};

/// The lines where a field has `level`, by marching squares with linear interpolation. Squares with a corner that is
/// not good have no lines.
std::vector<Segment> contour(const MapField& field, double level);

/// The results behind a map.
class HeatMap {
 public:
  struct Level {
    std::size_t count;  ///< rows, and columns
    double tolerance;   ///< the least tolerance; 0: the scene's
    std::size_t batch;  ///< rows in one part of the job
  };
  // The first level takes two rows at a time, because each part delays the curve of a drag.
  static constexpr std::array<Level, 3> kLevels = {{{16, 1e-2, 2}, {64, 1e-2, 8}, {128, 0.0, 4}}};

  explicit HeatMap(const Scene& scene) : scene_(scene) {}

  /// Switches to this map. `key` identifies the content of the scene without the parameters that the axes vary. Of
  /// theta, sigma and q the one without an axis is `theta_deg` or the scene's value.
  void follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
              double theta_deg);

  std::optional<Job> wanted(std::size_t level) const;
  /// Takes results of this map; false for other results. The first level is shown when it is complete.
  bool take(const JobPart& news);
  bool is_finished() const { return is_current() && is_complete(kLevels.size() - 1); }
  /// True where the map on display is the scene's, at the first level at least.
  bool is_coarse_done() const { return is_current() && !points_[0].empty(); }
  /// True where the first level is begun and not complete.
  bool is_arriving() const { return arriving_key_ == key_ && !arriving_.empty(); }
  /// True where the map on display belongs to an earlier scene.
  bool is_stale() const { return !shown_key_.empty() && !is_current(); }

  const MapAxis& x() const { return x_; }
  const MapAxis& y() const { return y_; }
  /// Rows of the finest complete level.
  std::size_t finished_count() const;
  /// The computed part of all levels, 0 to 1.
  double progress() const;
  /// Changes whenever the field changes.
  std::size_t version() const { return version_; }

  /// The finest level that has begun; a coarser level fills the rows that it lacks.
  MapField field(Plotted quantity) const;

 private:
  static constexpr std::size_t entries(std::size_t level) { return kLevels[level].count * kLevels[level].count; }
  bool is_current() const { return shown_key_ == key_; }
  bool is_complete(std::size_t level) const { return points_[level].size() == entries(level); }
  std::string key_of(std::size_t level) const;
  /// `batch` rows of a level.
  PointList rows(std::size_t level, std::size_t first) const;
  /// The point nearest to an entry of the finest begun level.
  const Point& point_at(std::size_t finest, std::size_t row, std::size_t column) const;

  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  MapAxis x_, y_;
  double theta_deg_ = 0.0;
  std::string shown_key_;                                  ///< key of the map on display
  std::array<std::vector<Point>, kLevels.size()> points_;  ///< row by row
  std::string arriving_key_;
  std::vector<Point> arriving_;  ///< points of the first level that is not complete
  std::size_t version_ = 0;
};

}  // namespace dolp::explore
