// Axes of grids and tables, and the entries of a scene: a grid or scattered points.
#pragma once

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

Axes axes_of(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q,
             std::vector<double> wavelength_um = {}, std::vector<double> n = {}, std::vector<double> k = {});

/// The values first[axis], ..., first[axis] + count[axis] - 1 of each axis that is not empty.
Axes part_of(const Axes& axes, const PerAxis& first, const PerAxis& count);

/// Index on each axis of the entry at a position of a table.
PerAxis positions_on_axes(std::size_t position, const PerAxis& counts);

/// Number of values on each axis, 1 for an empty axis; and the product of these numbers.
PerAxis counts_of(const Axes& axes);
std::size_t size_of(const PerAxis& counts);

/// One point of a table or of a list of points. Without an `index` it has the scene's material.
struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;
  std::uint32_t variant = 0;  ///< position in SceneEntries::variants
};

/// A number of a film that replaces the scene's number.
struct FilmValue {
  enum class Part : std::uint8_t { kN, kK, kThickness };
  std::size_t layer = 0;  ///< from 0, from the outside in
  Part part = Part::kThickness;
  double value = 0.0;
  friend auto operator<=>(const FilmValue&, const FilmValue&) = default;
};

/// Other changes of the scene by an entry. Neighbours mostly share a variant; each variant has its own radiometry.
struct SceneVariant {
  std::optional<double> wavelength_um = {};               ///< without one: the scene's spectrum
  std::optional<std::uint32_t> material = {}, band = {};  ///< positions in the scene's lists
  std::optional<double> temperature_K = {};               ///< temperature of the surface
  std::vector<FilmValue> films = {};
  friend auto operator<=>(const SceneVariant&, const SceneVariant&) = default;
};

/// The axes that make variants, in the order of tables: all entries of a variant follow each other there.
inline constexpr std::array kVariantAxes = {Axis::kMaterial, Axis::kBand, Axis::kWavelength, Axis::kTemperature};

/// Gives a variant the value of an axis.
void set_value(SceneVariant& variant, Axis axis, double value);

/// The variants of a grid, in the order of its entries.
std::vector<SceneVariant> variants_of(const Axes& axes);

/// Neighbours of a part of a grid that are neighbours in the whole as well.
struct GridRun {
  std::size_t in_part = 0;
  std::size_t in_whole = 0;
  std::size_t count = 0;
};

/// The product of the axes of a grid, or a list of points. An entry is its position; a grid has no list of them.
class SceneEntries {
 public:
  SceneEntries() = default;
  SceneEntries(std::vector<SceneEntry> points, std::vector<SceneVariant> variants = {{}})  // NOLINT: a list is entries
      : variants_(std::move(variants)), points_(std::move(points)) {}
  SceneEntries(std::initializer_list<SceneEntry> points) : points_(points) {}
  /// `index`: index of the surface, for a grid with an axis of only n or only k.
  static SceneEntries of_grid(Axes axes, const OpticalConstants& index);
  static SceneEntries grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q);

  bool is_grid() const { return is_grid_; }
  std::size_t size() const { return is_grid_ ? size_of(counts_) : points_.size(); }
  bool empty() const { return size() == 0; }
  SceneEntry operator[](std::size_t entry) const;
  auto all() const {
    return std::views::iota(std::size_t{0}, size()) |
           std::views::transform([this](std::size_t i) { return (*this)[i]; });
  }
  /// At least one variant. A grid has all combinations of kVariantAxes; a list has the variants of its points.
  const std::vector<SceneVariant>& variants() const { return variants_; }

  // For a grid.
  const Axes& axes() const { return axes_; }
  const PerAxis& counts() const { return counts_; }
  const std::vector<double>& theta_deg() const { return axes_[Axis::kTheta]; }
  const std::vector<double>& sigma() const { return axes_[Axis::kSigma]; }
  const std::vector<double>& q() const { return axes_[Axis::kQ]; }
  PerAxis axis_positions(std::size_t entry) const { return positions_on_axes(entry, counts_); }
  /// Entries that differ only in sigma and q.
  std::size_t entries_per_direction() const { return sigma().size() * q().size(); }
  const OpticalConstants& index() const { return index_; }
  /// The variant of an entry of a grid.
  std::size_t variant_at(const PerAxis& on_axes) const;
  bool has_own_index() const { return !axes_[Axis::kN].empty() || !axes_[Axis::kK].empty(); }
  /// The index of an entry. Domain: a grid with an axis of n or k.
  OpticalConstants index_at(const PerAxis& on_axes) const;

  /// The entries at some positions, as points with only the variants that they use.
  SceneEntries chosen(std::span<const std::size_t> positions) const;
  /// Cuts into parts of at most `most` entries. Parts of a grid are grids: whole directions, with all wavelengths and
  /// indices, where these fit. Parts of a list have consecutive points.
  std::vector<SceneEntries> parts(std::size_t most) const;
  /// The part of a grid that has only the values first[i], ..., first[i] + count[i] - 1 of each axis.
  SceneEntries part(const PerAxis& first, const PerAxis& count) const;
  /// For a part: the positions at which its axes begin in the whole, and the numbers of values there.
  const PerAxis& first() const { return first_; }
  PerAxis first_in(const SceneEntries& whole) const;
  const PerAxis& whole() const { return whole_; }
  const Axes& whole_axes() const { return *whole_axes_; }
  /// The position of an entry of the whole, if the part has it.
  std::optional<std::size_t> position_of(std::size_t in_whole) const;

 private:
  bool is_grid_ = false;
  Axes axes_;
  OpticalConstants index_;
  PerAxis counts_ = {};
  PerAxis first_ = {};
  PerAxis whole_ = {};
  std::shared_ptr<const Axes> whole_axes_;
  std::vector<SceneVariant> variants_ = {{}};
  std::vector<SceneEntry> points_;
};

/// Calls use(run) for each run of a part. The part begins at `first` and has `count` values of each axis; the whole has
/// `whole`.
void for_each_run(const PerAxis& first, const PerAxis& count, const PerAxis& whole,
                  const std::function<void(const GridRun&)>& use);

}  // namespace dolp
