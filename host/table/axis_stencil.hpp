// Which values of a table's axis an interpolation reads, and with which weights.
#pragma once

#include <cstddef>
#include <vector>

namespace dolp {

/// Weighted positions on an axis; the weights add up to 1.
struct Stencil {
  std::vector<std::size_t> positions;  ///< in the order of the table
  std::vector<double> weights;
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
  std::size_t size() const { return values_.size(); }
  /// The axis has a single value, within rounding of its last digits, or the range contains it.
  bool contains(double value) const;

  /// Lagrange interpolation at `value` from the `count` values around it, as many as there are; where the value is one
  /// of the axis, that alone. `shift` moves the window by so many values, where it still contains the value; by nothing
  /// otherwise.
  /// Domain: contains(value).
  Stencil stencil(double value, std::size_t count, int shift = 0) const;

 private:
  double coordinate(double value) const;

  Scale scale_;
  double origin_;
  std::vector<double> values_;          ///< ascending
  std::vector<double> coordinates_;     ///< of values_
  std::vector<std::size_t> positions_;  ///< in the table, of values_
};

}  // namespace dolp
