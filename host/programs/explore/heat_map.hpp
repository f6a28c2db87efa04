#pragma once

#include "explore/background.hpp"
#include "explore/scale.hpp"

namespace dolp::explore {

struct MapAxis {
  std::string name = "theta";  ///< name in session files
  std::string label = "θ [°]";
  std::string key = {};  ///< scene key of the axis; empty for the zenith
  Scale scale = {0.0, 90.0};

  std::string column() const {  // name of the axis in PointList::values
    if (key.empty()) return "theta_deg";
    return key.starts_with("surface.coating") ? key : key.substr(key.find('.') + 1);
  }
  /// Axes in the order of tables, after films. Points in this order form a grid, and find samples for few spectra.
  std::size_t rank() const;
  friend bool operator==(const MapAxis&, const MapAxis&) = default;
};

/// The axes that maps of a scene can have. The range of an axis comes from the scene's grid, otherwise from the slider.
/// The range is extended to contain the scene's value.
std::vector<MapAxis> map_axes(const Scene& scene, double theta_max_deg);

/// The part of the wavelength axis `axis` in which n and k are known. For a material from a file, a search moves the
/// ends in large steps towards the scene's wavelength until n and k are known there. So the part may be too small.
Scale known_part(const Scene& scene, const MapAxis& axis);

std::string refusal(const Scene& scene, const MapAxis& axis, const Scale& range);  ///< why an axis cannot have `range`

/// Values of one quantity on a map: `count` rows of `count` values. x grows along a row, and y from row to row.
struct MapField {
  Plotted quantity = Plotted::kDolp;
  std::size_t count = 0;
  std::vector<double> values;  ///< NaN where the point is not good (Point::is_good) or has no value
  double min = 0.0;            ///< smallest value; `max` is the largest value
  double max = 0.0;
};

/// A straight piece of a contour line. Its coordinates are from 0 to 1 along both axes of the map.
struct Segment {
  double x0, y0, x1, y1;
};

/// The contour line of a field at `level`, by marching squares with linear interpolation. Skips squares with a NaN.
std::vector<Segment> contour(const MapField& field, double level);

/// A map over two numbers of a scene, or over the zenith and one number. It is computed from coarse to fine (kLevels).
class HeatMap {
 public:
  struct Level {
    std::size_t count;  ///< number of rows, and of columns
    double tolerance;   ///< the map has the larger one of this tolerance and the scene's tolerance
    std::size_t batch;  ///< number of columns, or of rows if the map is turned, that one job computes
  };
  // While the user drags a slider, the curve waits for the job that is running. So the jobs of level 0 are small.
  static constexpr std::array<Level, 3> kLevels = {{{16, 1e-2, 2}, {64, 1e-2, 8}, {128, 0.0, 4}}};

  explicit HeatMap(const Scene& scene) : scene_(scene) {}

  /// Switches to the map over the axes `x` and `y`. `key` identifies the map. It has no values of the numbers on these
  /// axes, because the map varies them. If neither axis is the zenith, the map is for the zenith `theta_deg`.
  void follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
              double theta_deg);

  std::vector<Job> wanted(std::size_t level) const;
  /// Stores results for this map; returns false for other results. The first level is shown only when it is complete.
  bool take(const JobResult& news);
  bool is_finished() const { return is_current() && is_complete(kLevels.size() - 1); }
  bool is_arriving() const { return arriving_key_ == key_ && !arriving_.empty(); }  ///< level 0 has some points
  bool is_stale() const { return !shown_key_.empty() && !is_current(); }  ///< the map on display is an earlier one

  const MapAxis& x() const { return x_; }
  const MapAxis& y() const { return y_; }
  std::size_t finished_count() const {  // rows of the finest complete level
    std::size_t finest = 0;
    for (std::size_t level = 0; level < kLevels.size(); ++level) {
      if (is_complete(level)) finest = kLevels[level].count;
    }
    return finest;
  }
  double progress() const {  // finished share of all levels, from 0 to 1
    std::size_t done = 0, all = 0;
    for (std::size_t level = 0; level < kLevels.size(); ++level) {
      all += entries(level);
      if (is_current()) done += points_[level].size();
    }
    return static_cast<double>(done) / static_cast<double>(all);
  }
  std::size_t version() const { return version_; }  ///< changes whenever the field changes

  /// Values on the grid of the finest level that has begun. A missing point has the value of the nearest coarser point.
  MapField field(Plotted quantity) const;

 private:
  static constexpr std::size_t entries(std::size_t level) { return kLevels[level].count * kLevels[level].count; }
  bool is_current() const { return shown_key_ == key_; }
  bool is_complete(std::size_t level) const { return points_[level].size() == entries(level); }
  std::string job_key(std::size_t level, std::size_t first) const;
  bool is_turned() const { return y_.rank() < x_.rank(); }      ///< true if jobs have rows and not columns
  PointList lines(std::size_t level, std::size_t first) const;  ///< points of the job that begins at a column or row
  /// Number of columns or rows of a level that the wanted map has.
  std::size_t known(std::size_t level) const {
    const std::size_t points = is_current() ? points_[level].size() : is_arriving() ? arriving_.size() : 0;
    return points / kLevels[level].count;
  }
  const Point& point_at(std::size_t finest, std::size_t row, std::size_t column) const;

  std::string key_;
  Scene scene_;
  bool keep_all_ = false;
  MapAxis x_, y_{.name = "sigma"};
  double theta_deg_ = 0.0;
  std::string shown_key_;                                  ///< key of the map on display
  std::array<std::vector<Point>, kLevels.size()> points_;  ///< points of each level, job after job
  std::string arriving_key_;
  std::vector<Point> arriving_;  ///< points of the first level of the map arriving_key_ while it is incomplete
  std::size_t version_ = 0;
};

}  // namespace dolp::explore
