// The entries of a scene: a grid or scattered points.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include "model/axes.hpp"
#include "model/optical_constants.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// One point of a table or of a list of points. Without an `index` of its own it has the scene's material.
struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;
  std::uint32_t variant = 0;  ///< position in SceneEntries::variants
};

/// A number of a film that an entry has instead of the scene's.
struct FilmValue {
  enum class Part : std::uint8_t { kN, kK, kThickness };
  std::size_t layer = 0;  ///< from 0, from the outside in
  Part part = Part::kThickness;
  double value = 0.0;
  friend auto operator<=>(const FilmValue&, const FilmValue&) = default;
};

/// What else entries change in the scene. Neighbours mostly share it, and it has a radiometry of its own.
struct SceneVariant {
  std::optional<double> wavelength_um = {};               ///< without one: the scene's spectrum
  std::optional<std::uint32_t> material = {}, band = {};  ///< positions among those of the scene
  std::optional<double> temperature_K = {};               ///< of the surface
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
  /// `index`: that of the surface, for a grid with an axis of only n or only k.
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
  /// At least one. A grid has all combinations of kVariantAxes, a list those among its points.
  const std::vector<SceneVariant>& variants() const { return variants_; }

  // Of a grid.
  const Axes& axes() const { return axes_; }
  const PerAxis& counts() const { return counts_; }
  const std::vector<double>& theta_deg() const { return axes_[Axis::kTheta]; }
  const std::vector<double>& sigma() const { return axes_[Axis::kSigma]; }
  const std::vector<double>& q() const { return axes_[Axis::kQ]; }
  PerAxis place(std::size_t entry) const { return place_of(entry, counts_); }
  /// Entries that differ only in sigma and q.
  std::size_t entries_per_direction() const { return sigma().size() * q().size(); }
  const OpticalConstants& index() const { return index_; }
  /// The variant of an entry of a grid.
  std::size_t variant_at(const PerAxis& place) const;
  bool has_own_index() const { return !axes_[Axis::kN].empty() || !axes_[Axis::kK].empty(); }
  /// The index of an entry, of a grid with an axis of n or k.
  OpticalConstants index_at(const PerAxis& place) const;

  /// The entries at some positions, as points with the variants among them.
  SceneEntries chosen(std::span<const std::size_t> positions) const;
  /// Parts of at most `most` entries each: of a grid as many directions of all wavelengths and indices as fit, else
  /// parts of these, each a grid; of points consecutive ones.
  std::vector<SceneEntries> parts(std::size_t most) const;
  /// The part of a grid that has only the values first[i], ..., first[i] + count[i] - 1 of each axis.
  SceneEntries part(const PerAxis& first, const PerAxis& count) const;
  /// For a part: where its axes begin in the whole, and how many values they have there.
  const PerAxis& first() const { return first_; }
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

/// Calls use(run) for a part, that begins at `first` and has `count` values of each axis, of a whole with `whole`
/// values.
void for_each_run(const PerAxis& first, const PerAxis& count, const PerAxis& whole,
                  const std::function<void(const GridRun&)>& use);

}  // namespace dolp
