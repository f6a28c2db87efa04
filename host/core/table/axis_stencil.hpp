// Selects the values of a table's axis that an interpolation reads, and their weights.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace dolp {

/// Most values that an interpolation reads of an axis, or compares.
inline constexpr std::size_t kMostStencil = 7;

/// Neighbouring values of an axis, by their rank in ascending order; the weights add up to 1.
struct Stencil {
  std::size_t first = 0;
  std::size_t count = 0;
  std::array<double, kMostStencil> weights{};
};

/// An axis as an interpolation sees it: a coordinate in which the table's quantities are smooth, ascending.
class LookupAxis {
 public:
  enum class Scale {
    kLinear,     ///< x
    kLogarithm,  ///< ln(x - origin), x > origin
  };

  /// Values in any order, all different. Where a value is not above `origin` a logarithmic scale becomes linear.
  LookupAxis(const std::vector<double>& values, Scale scale, double origin = 0.0);

  double min() const { return values_.front(); }
  double max() const { return values_.back(); }
  double coordinate_at(std::size_t rank) const { return coordinates_[rank]; }
  std::size_t size() const { return values_.size(); }
  /// The axis has a single value, within rounding of its last digits, or the range contains it.
  bool contains(double value) const;

  /// The position in the table of a value, by its rank in ascending order.
  std::size_t position(std::size_t rank) const { return positions_[rank]; }

  /// Where a value lies. Domain: contains(value).
  struct Location {
    double coordinate = 0.0;
    std::size_t next = 0;   ///< the first value above it, or the value itself
    bool is_value = false;  ///< true if it is a value of the axis
  };
  Location locate(double value) const;

  /// Lagrange interpolation from the `count` values around a location, or from all values if there are fewer. A
  /// location at a value of the axis gives only this value. `shift` moves the window by so many values, as long as it
  /// contains the location. Domain: count from 2 to kMostStencil.
  Stencil stencil(const Location& location, std::size_t count, int shift = 0) const;

  /// The factors by which `count` values from `first` give the divided difference over them: 1 / product of x_i - x_j
  /// over the other values. Domain: count from 2 to kMostStencil, first + count <= size().
  std::span<const double> divided_difference(std::size_t first, std::size_t count) const {
    return std::span(factors_[count][first]).first(count);
  }
  /// The product of the distances of a location from `count` values.
  double distances(const Location& location, std::size_t first, std::size_t count) const;

 private:
  double coordinate(double value) const;

  Scale scale_;
  double origin_;
  std::vector<double> values_;          ///< ascending
  std::vector<double> coordinates_;     ///< coordinate of each of values_
  std::vector<std::size_t> positions_;  ///< position in the table of each of values_
  /// For each count, window and value: divided_difference.
  std::array<std::vector<std::array<double, kMostStencil>>, kMostStencil + 1> factors_;
};

}  // namespace dolp
