#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace dolp {

/// Largest number of axis values that an interpolation and its error estimate use.
inline constexpr std::size_t kMostStencil = 7;

/// Neighbouring axis values, with weights for interpolation. `first`: rank (place in ascending order) of the smallest.
struct Stencil {
  std::size_t first = 0;
  std::size_t count = 0;
  std::array<double, kMostStencil> weights{};
};

/// The values x of an axis of a table. An interpolation along the axis is a polynomial in x or in ln(x - origin).
class LookupAxis {
 public:
  enum class Scale {
    kLinear,     ///< x
    kLogarithm,  ///< ln(x - origin), for x > origin
  };

  /// `values`: in any order, all different. If the smallest value is not above `origin`, the scale is linear.
  LookupAxis(const std::vector<double>& values, Scale scale, double origin = 0.0);

  double min() const { return values_.front(); }
  double max() const { return values_.back(); }
  double coordinate_at(std::size_t rank) const { return coordinates_[rank]; }
  std::size_t size() const { return values_.size(); }
  /// True if `value` lies between the smallest and the largest value of the axis, or equals one of them up to rounding.
  bool contains(double value) const;

  /// Position on the table's axis, which may be unordered, of the value with this rank. Rank 0 is the smallest value.
  std::size_t position(std::size_t rank) const { return positions_[rank]; }

  /// Place of a value on the axis. Domain: contains(value).
  struct Location {
    double coordinate = 0.0;
    std::size_t next = 0;  ///< rank of the axis value that equals the value, else of the next larger axis value
    bool is_value = false;
  };
  Location locate(double value) const;

  /// Lagrange interpolation at a location. Uses the `count` axis values around it, or all values of a shorter axis. At
  /// a value of the axis, uses only this value. `shift` moves the window of used values up by this number of ranks,
  /// or down if it is negative. The location always stays inside the window. Domain: count from 2 to kMostStencil.
  Stencil stencil(const Location& location, std::size_t count, int shift = 0) const;

  /// The divided difference of data y_i at the coordinates x_i, with ranks i from first to first + count - 1, is the
  /// sum of f_i y_i. Returns f_i = 1 / product over j != i of (x_i - x_j). Domain: count from 2 to kMostStencil.
  std::span<const double> divided_difference(std::size_t first, std::size_t count) const {
    return std::span(factors_[count][first]).first(count);
  }
  /// Product of (location.coordinate - coordinate_at(i)) over the ranks i from first to first + count - 1.
  double distances(const Location& location, std::size_t first, std::size_t count) const;

 private:
  double coordinate(double value) const;

  Scale scale_;
  double origin_;
  std::vector<double> values_;  ///< ascending
  std::vector<double> coordinates_;
  std::vector<std::size_t> positions_;  ///< position on the table's axis of each value
  std::array<std::vector<std::array<double, kMostStencil>>, kMostStencil + 1> factors_;
};

}  // namespace dolp
