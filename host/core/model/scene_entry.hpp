#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <dolp/axis.hpp>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include "model/facet_optics.hpp"
#include "model/slopes.hpp"

namespace dolp {

Axes make_axes(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q,
               std::vector<double> wavelength_um = {}, std::vector<double> n = {}, std::vector<double> k = {});

/// A part of a grid: on each axis, `count` values from position `first`.
struct GridBox {
  PerAxis first = {};
  PerAxis count = {};
};

/// Cuts each axis to the values of the box. Empty axes stay empty.
Axes axes_part(const Axes& axes, const GridBox& box);

/// Cuts a grid into boxes of at most `most` entries, but at least one. A box has all values of the last axes of
/// `order`, some values of one axis before them, and one value of each earlier axis. By default the boxes are in the
/// grid's order.
std::vector<GridBox> grid_boxes(const PerAxis& counts, std::size_t most,
                                const std::array<Axis, kAxisCount>& order = kAllAxes);

/// The position on each axis of entry number `position` in a table. `counts`: number of values on each axis.
PerAxis positions_on_axes(std::size_t position, const PerAxis& counts);

/// axis_counts: number of values on each axis, where an empty axis counts as 1. grid_size: the product of these
/// numbers.
PerAxis axis_counts(const Axes& axes);
std::size_t grid_size(const PerAxis& counts);

struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;  ///< nullopt: the material of the scene
  std::uint32_t variant = 0;              ///< position in SceneEntries::variants
  /// Zenith of the view, and azimuth between source and view; nullopt means the scene's values.
  std::optional<double> view_zenith_deg = {}, relative_azimuth_deg = {};
  friend bool operator==(const SceneEntry&, const SceneEntry&) = default;
};

/// The n, k, thickness or its spread of one film, which an entry uses instead of the scene's value.
struct FilmValue {
  enum class Part : std::uint8_t { kN, kK, kThickness, kSpread };
  std::size_t layer = 0;  ///< counts from 0, from the outside in
  Part part = Part::kThickness;
  double value = 0.0;
  friend auto operator<=>(const FilmValue&, const FilmValue&) = default;
};

/// Values that an entry uses instead of the scene's. Direction, slope shape and index are not here but in SceneEntry.
struct SceneVariant {
  std::optional<double> wavelength_um = {};               ///< nullopt: the scene's spectrum
  std::optional<std::uint32_t> material = {}, band = {};  ///< positions in SceneModel::materials and bands
  std::optional<double> temperature_K = {};               ///< temperature of the surface
  std::vector<FilmValue> films = {};
  friend auto operator<=>(const SceneVariant&, const SceneVariant&) = default;
};

/// The axes whose values are in SceneVariant. They are the first axes of a table, which vary slowest.
inline constexpr std::array kVariantAxes = {Axis::kMaterial, Axis::kBand, Axis::kWavelength, Axis::kTemperature};

void set_value(SceneVariant& variant, Axis axis, double value);

std::vector<SceneVariant> grid_variants(const Axes& axes);

/// `count` entries that are consecutive in a part (from `in_part`) and in the whole grid or list (from `in_whole`).
struct GridRun {
  std::size_t in_part = 0;
  std::size_t in_whole = 0;
  std::size_t count = 0;
};

/// The entries of a scene: a grid, which is the product of its axes, or a list of points.
class SceneEntries {
 public:
  SceneEntries() = default;
  SceneEntries(std::vector<SceneEntry> points, std::vector<SceneVariant> variants = {{}},  // NOLINT: a list is entries
               WindModel wind_model = WindModel::kIsotropic)
      : slopes_{.wind_model = wind_model}, variants_(std::move(variants)), points_(std::move(points)) {}
  SceneEntries(std::initializer_list<SceneEntry> points) : points_(points) {}
  /// `index`: index of the surface. It gives k if the grid has an axis of n only, and n if it has an axis of k only.
  /// `slopes`: of the scene, for entries without sigma_cross or azimuth on an axis.
  static SceneEntries grid(Axes axes, const OpticalConstants& index, const CrossSlopes& slopes = {});
  static SceneEntries grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q);

  bool is_grid() const { return is_grid_; }
  std::size_t size() const { return is_grid_ ? grid_size(counts_) : points_.size(); }
  bool empty() const { return size() == 0; }
  SceneEntry operator[](std::size_t entry) const {
    return is_grid_ ? grid_entry(axis_positions(entry)) : points_[entry];
  }
  auto all() const {
    return std::views::iota(std::size_t{0}, size()) |
           std::views::transform([this](std::size_t i) { return (*this)[i]; });
  }
  /// Each variant is a set of values that some entries use instead of the scene's. There is at least one. A grid has a
  /// variant for each combination of values on kVariantAxes.
  const std::vector<SceneVariant>& variants() const { return variants_; }

  /// A direction of a grid is a combination of theta, view zenith and relative azimuth. A direction's entries are
  /// consecutive, and so are the directions of one variant and index. In a list each entry has its own direction.
  std::size_t entries_per_direction() const {
    return is_grid_ ? sigma().size() * q().size() * counts_[Axis::kSigmaCross] * counts_[Axis::kSurfaceAzimuth] : 1;
  }
  bool has_own_cross_slopes() const;  ///< true if entries have their own sigma_cross, instead of the scene's
  bool has_own_index() const;         ///< true if some entries have their own n or k
  /// The n and k that entries have: the combinations of both axes of a grid, or n and k of each point that has them.
  std::vector<OpticalConstants> own_indices() const;

  /// A copy for a scene with other slopes. The points of a list have their own.
  SceneEntries with_slopes(const CrossSlopes& slopes) const { return is_grid_ ? grid(axes_, index_, slopes) : *this; }

  // The functions from here to index_at() need a grid.
  SceneEntry grid_entry(const PerAxis& on_axes) const;
  const Axes& axes() const { return axes_; }
  const PerAxis& counts() const { return counts_; }
  const std::vector<double>& theta_deg() const { return axes_[Axis::kTheta]; }
  const std::vector<double>& sigma() const { return axes_[Axis::kSigma]; }
  const std::vector<double>& q() const { return axes_[Axis::kQ]; }
  PerAxis axis_positions(std::size_t entry) const { return positions_on_axes(entry, counts_); }
  std::size_t directions() const {
    return counts_[Axis::kViewZenith] * counts_[Axis::kRelativeAzimuth] * counts_[Axis::kTheta];
  }
  const OpticalConstants& index() const { return index_; }
  const CrossSlopes& slopes() const { return slopes_; }
  /// The subscript in variants() for the entry with the axis positions `on_axes`.
  std::size_t variant_at(const PerAxis& on_axes) const;
  /// The refractive index at the positions `on_axes`. Domain: the grid has an axis of n or k.
  OpticalConstants index_at(const PerAxis& on_axes) const;

  /// True if all entries have their own value on the axis, instead of the scene's value.
  bool has_values(Axis axis) const;
  /// The value of an entry on an axis of numbers. Domain: has_values(axis).
  double value(const SceneEntry& entry, Axis axis) const;
  /// A copy in which the function changes each value on an axis of numbers. Domain: has_values(axis).
  SceneEntries changed(Axis axis, const std::function<double(double)>& change) const;

  /// A list of the entries at `positions`, with only the variants that these entries use.
  SceneEntries chosen(std::span<const std::size_t> positions) const;
  /// Cuts the entries into parts of at most `most` entries. The parts of a grid are grids, too.
  std::vector<SceneEntries> parts(std::size_t most) const;
  SceneEntries part(const GridBox& box) const;
  const PerAxis& first() const { return first_; }     ///< position of the part's first value on each axis of the grid
  PerAxis first_in(const SceneEntries& whole) const;  ///< like first(), but relative to `whole`, a larger part
  const PerAxis& whole() const { return whole_; }     ///< number of values on each axis of the whole grid
  const Axes& whole_axes() const { return *whole_axes_; }
  /// The grid of which this is a part. A list is returned as it is.
  SceneEntries whole_entries() const { return is_grid_ ? grid(*whole_axes_, index_, slopes_) : *this; }
  /// The number of entries in the whole grid or list.
  std::size_t whole_size() const { return is_grid_ ? grid_size(whole_) : std::max(whole_points_, points_.size()); }
  /// Converts an entry's position in the whole grid or list to its position in this part; nullopt if the part lacks the
  /// entry.
  std::optional<std::size_t> find_position(std::size_t in_whole) const;
  /// Calls `use` for the consecutive entries that this part shares with `whole`, a larger part.
  void for_each_run(const SceneEntries& whole, const std::function<void(const GridRun&)>& use) const;

 private:
  bool is_grid_ = false;
  Axes axes_;
  OpticalConstants index_;
  CrossSlopes slopes_;
  PerAxis counts_ = {};
  PerAxis first_ = {};
  PerAxis whole_ = {};
  std::shared_ptr<const Axes> whole_axes_;
  std::vector<SceneVariant> variants_ = {{}};
  std::vector<SceneEntry> points_;
  std::size_t first_point_ = 0, whole_points_ = 0;  ///< of a part of a list: position in the list, size of the list
};

/// Reads entries one by one. In a grid, reading the next entry is faster than SceneEntries::operator[].
class EntryReader {
 public:
  explicit EntryReader(const SceneEntries& entries) : entries_(entries) {}
  /// The entry number `position`. The reference is valid until the next call.
  const SceneEntry& operator[](std::size_t position);
  const PerAxis& on_axes() const { return on_axes_; }  ///< axis positions of the last entry of a grid

 private:
  const SceneEntries& entries_;
  std::optional<std::size_t> position_;
  PerAxis on_axes_ = {};
  SceneEntry entry_;
};

/// Calls `use` for each GridRun of a part of a grid. The grid has whole[axis] values on each axis.
void for_each_run(const GridBox& part, const PerAxis& whole, const std::function<void(const GridRun&)>& use);

}  // namespace dolp
