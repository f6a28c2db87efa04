// A map over two numbers of a scene, from 16 x 16 to 128 x 128 entries, and its lines of equal value.
#pragma once

#include "explore/background.hpp"
#include "explore/scale.hpp"

namespace dolp::explore {

/// One axis of a map: the zenith, or a number of the scene.
struct MapAxis {
  std::string name = "theta";  ///< in files of sessions
  std::string label = "θ [°]";
  std::string key = {};  ///< of the scene; empty for the zenith
  Scale scale = {0.0, 90.0};

  /// The column of points that has its values; empty for the temperature, which changes the scene.
  std::string column() const;
  /// The order in which a grid or a list has axes, the slowest first.
  std::size_t rank() const;
  /// True if a table can have the axis.
  bool is_of_tables() const;
  friend bool operator==(const MapAxis&, const MapAxis&) = default;
};

/// The axes that maps of a scene can have. Their ranges are those of the scene's grid or of sliders, extended to the
/// scene's values.
std::vector<MapAxis> map_axes(const Scene& scene, double theta_max_deg);

/// A part of an axis of wavelengths in which the scene is known: all of it for built-in materials, most of it for
/// files. Its ends are equal where only one wavelength is known.
Scale known_part(const Scene& scene, const MapAxis& axis);

/// Why a map of a scene cannot have a range along an axis; empty if it can.
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
    std::size_t batch;  ///< values along the slower axis in one part of the job
  };
  // The first level takes two values at a time, because each part delays the curve of a drag.
  static constexpr std::array<Level, 3> kLevels = {{{16, 1e-2, 2}, {64, 1e-2, 8}, {128, 0.0, 4}}};

  explicit HeatMap(const Scene& scene) : scene_(scene) {}

  /// Switches to this map. `key` identifies the content of the scene without the parameters that the axes vary. Without
  /// an axis for it the zenith is `theta_deg`.
  void follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
              double theta_deg);

  std::optional<Job> wanted(std::size_t level) const;
  /// Takes results of this map; false for other results. The first level is shown when it is complete.
  bool take(const JobPart& news);
  bool is_finished() const { return is_current() && is_complete(kLevels.size() - 1); }
  /// True if the map on display is the scene's, at the first level at least.
  bool is_coarse_done() const { return is_current() && !points_[0].empty(); }
  /// True if the first level is begun and not complete.
  bool is_arriving() const { return arriving_key_ == key_ && !arriving_.empty(); }
  /// True if the map on display belongs to an earlier scene.
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
  /// True if x is the slower axis, so that points are in columns.
  bool is_turned() const { return x_.rank() < y_.rank(); }
  const MapAxis& slower() const { return is_turned() ? x_ : y_; }
  const MapAxis& faster() const { return is_turned() ? y_ : x_; }
  /// Values along the slower axis in one part of a job.
  std::size_t batch(std::size_t level) const { return slower().column().empty() ? 1 : kLevels[level].batch; }
  /// The entries from a position along the slower axis.
  PointList part(std::size_t level, std::size_t first) const;
  /// The point nearest to an entry of the finest begun level.
  const Point& point_at(std::size_t finest, std::size_t row, std::size_t column) const;

  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  MapAxis x_, y_{.name = "sigma"};
  double theta_deg_ = 0.0;
  std::string shown_key_;                                  ///< key of the map on display
  std::array<std::vector<Point>, kLevels.size()> points_;  ///< the faster axis first
  std::string arriving_key_;
  std::vector<Point> arriving_;  ///< points of the first level that is not complete
  std::size_t version_ = 0;
};

}  // namespace dolp::explore
