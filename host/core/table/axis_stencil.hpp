#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace dolp {

/// Most values of an axis that an interpolation and its error estimate use.
inline constexpr std::size_t kMostStencil = 7;

/// Neighbouring values of an axis, with weights for interpolation. `first`: rank of the first one in ascending order.
struct Stencil {
  std::size_t first = 0;
  std::size_t count = 0;
  std::array<double, kMostStencil> weights{};
};

/// The values of an axis, with the scale on which the quantities of the table are smooth.
class LookupAxis {
 public:
  enum class Scale {
    kLinear,     ///< x
    kLogarithm,  ///< ln(x - origin), for x > origin
  };

  /// `values`: in any order, all different. If the smallest is not above `origin`, the scale is linear.
  LookupAxis(const std::vector<double>& values, Scale scale, double origin = 0.0);

  double min() const { return values_.front(); }
  double max() const { return values_.back(); }
  double coordinate_at(std::size_t rank) const { return coordinates_[rank]; }
  std::size_t size() const { return values_.size(); }
  /// True if `value` lies between the smallest and the largest value of the axis, or equals one of them up to rounding.
  bool contains(double value) const;

  /// The position in the table of the value with this rank in ascending order.
  std::size_t position(std::size_t rank) const { return positions_[rank]; }

  /// Where a value lies among the values of the axis. Domain: contains(value).
  struct Location {
    double coordinate = 0.0;
    std::size_t next = 0;  ///< rank of an equal value, else of the first value above
    bool is_value = false;
  };
  Location locate(double value) const;

  /// Lagrange interpolation at a location, from the `count` values around it, or from all values if they are fewer. If
  /// the location is a value of the axis, only this value is used. `shift` moves the window of values, which still
  /// contains the location. Domain: count from 2 to kMostStencil.
  Stencil stencil(const Location& location, std::size_t count, int shift = 0) const;

  /// The factors of the values x_i of ranks first, ..., first + count - 1 in their divided difference: 1 / product of
  /// (x_i - x_j) over j != i. Domain: count from 2 to kMostStencil.
  std::span<const double> divided_difference(std::size_t first, std::size_t count) const {
    return std::span(factors_[count][first]).first(count);
  }
  /// The product of the distances of a location from the `count` values from rank `first`.
  double distances(const Location& location, std::size_t first, std::size_t count) const;

 private:
  double coordinate(double value) const;

  Scale scale_;
  double origin_;
  std::vector<double> values_;  ///< ascending
  std::vector<double> coordinates_;
  std::vector<std::size_t> positions_;  ///< positions of values_ in the table
  /// factors_[count][first] is divided_difference(first, count).
  std::array<std::vector<std::array<double, kMostStencil>>, kMostStencil + 1> factors_;
};

}  // namespace dolp
