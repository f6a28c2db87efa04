#include "table/axis_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace dolp {
namespace {

// Values with a smaller relative difference count as equal, such as 0.3 and the computed axis value 0.1 + 0.2.
constexpr double kSame = 4.0 * std::numeric_limits<double>::epsilon();

bool is_same(double a, double b) { return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b)); }

}  // namespace

LookupAxis::LookupAxis(const std::vector<double>& values, Scale scale, double origin)
    : scale_(scale), origin_(origin), positions_(values.size()) {
  std::iota(positions_.begin(), positions_.end(), std::size_t{0});
  std::ranges::sort(positions_, {}, [&](std::size_t i) { return values[i]; });
  for (const std::size_t i : positions_) values_.push_back(values[i]);
  if (!(values_.front() > origin_)) scale_ = Scale::kLinear;
  for (const double value : values_) coordinates_.push_back(coordinate(value));
  for (std::size_t count = 2; count <= std::min(kMostStencil, size()); ++count) {
    for (std::size_t first = 0; first + count <= size(); ++first) {
      std::array<double, kMostStencil>& factors = factors_[count].emplace_back();
      for (std::size_t i = 0; i < count; ++i) {
        double product = 1.0;
        for (std::size_t j = 0; j < count; ++j) {
          if (i != j) product *= coordinates_[first + i] - coordinates_[first + j];
        }
        factors[i] = 1.0 / product;
      }
    }
  }
}

double LookupAxis::coordinate(double value) const {
  return scale_ == Scale::kLinear ? value : std::log(value - origin_);
}

bool LookupAxis::contains(double value) const {
  return (min() <= value && value <= max()) || is_same(value, min()) || is_same(value, max());
}

LookupAxis::Location LookupAxis::locate(double value) const {
  const auto above = static_cast<std::size_t>(std::ranges::lower_bound(values_, value) - values_.begin());
  for (const std::size_t i : {above, above - 1}) {
    if (i < values_.size() && is_same(values_[i], value)) return {coordinates_[i], i, true};
  }
  return {coordinate(value), above, false};
}

Stencil LookupAxis::stencil(const Location& location, std::size_t count, int shift) const {
  if (location.is_value) return {location.next, 1, {1.0}};
  const auto size = static_cast<std::ptrdiff_t>(values_.size());
  const auto wanted = std::min(static_cast<std::ptrdiff_t>(count), size);
  const auto next = static_cast<std::ptrdiff_t>(location.next);  // values_[next - 1] < the value < values_[next]
  const std::ptrdiff_t centred = std::clamp<std::ptrdiff_t>(next - wanted / 2, 0, size - wanted);
  const std::ptrdiff_t first = std::clamp<std::ptrdiff_t>(
      std::clamp<std::ptrdiff_t>(centred + shift, next + 1 - wanted, next - 1), 0, size - wanted);
  Stencil stencil{static_cast<std::size_t>(first), static_cast<std::size_t>(wanted), {}};
  const std::array<double, kMostStencil>& factors = factors_[stencil.count][stencil.first];
  // Weight of value i: factors[i] times the product of (location - x_j) over the other values x_j of the stencil.
  double before = 1.0;
  for (std::size_t i = 0; i < stencil.count; ++i) {
    stencil.weights[i] = before * factors[i];
    before *= location.coordinate - coordinates_[stencil.first + i];
  }
  double after = 1.0;
  for (std::size_t i = stencil.count; i-- > 0;) {
    stencil.weights[i] *= after;
    after *= location.coordinate - coordinates_[stencil.first + i];
  }
  return stencil;
}

double LookupAxis::distances(const Location& location, std::size_t first, std::size_t count) const {
  double product = 1.0;
  for (std::size_t i = first; i < first + count; ++i) product *= location.coordinate - coordinates_[i];
  return product;
}

}  // namespace dolp
