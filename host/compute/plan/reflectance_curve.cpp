#include "plan/reflectance_curve.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "model/smooth_surface.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

constexpr std::size_t kFewestCells = 64;
constexpr std::size_t kMostCells = 4096;
constexpr double kShareOfTolerance = 0.02;
constexpr double kLeastLevel = 1e-3;  // replaces a smaller reflectance_level(), to which the tolerance is relative
constexpr double kSafety = 2.0;       // error bound divided by the largest error at the tested positions

/// R_s, 1 - R_s and the split (R_s - R_p) / sin^2(beta) at one angle.
using Values = std::array<double, 3>;
constexpr std::size_t kSplit = 2;

Values curve_values(const SmoothAbsorptance& absorbed) { return {1.0 - absorbed.s, absorbed.s, absorbed.split}; }

SmoothAbsorptance absorptance_at(const FacetOptics& optics, double v) {
  constexpr double kLeastCosine = 1e-12;  // smooth_absorptance() does not allow 0, where films reflect everything
  return smooth_absorptance(optics, std::clamp(v * v, kLeastCosine, 1.0));
}

/// Coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
std::array<double, 4> cubic_through(double a, double b, double c, double d) {
  return {a, -5.5 * a + 9.0 * b - 4.5 * c + d, 9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d, 13.5 * (b - c) + 4.5 * (d - a)};
}

double at(const std::array<double, 4>& cubic, double x) {
  return cubic[0] + x * (cubic[1] + x * (cubic[2] + x * cubic[3]));
}

/// Absorptances at the sixths of all cells. A cell uses numbers 0, 2, 4 and 6 for its cubics, and tests 1, 3 and 5.
class Sixths {
 public:
  Sixths(const FacetOptics& optics, std::size_t cells) : optics_(optics), absorptances_(6 * cells + 1) { compute(1); }

  std::size_t cells() const { return absorptances_.size() / 6; }
  double v(std::size_t i) const { return static_cast<double>(i) / static_cast<double>(absorptances_.size() - 1); }
  const SmoothAbsorptance& operator[](std::size_t i) const { return absorptances_[i]; }

  /// Doubles the number of cells. Computes only the absorptances between the known ones.
  void divide() {
    std::vector<SmoothAbsorptance> divided(2 * absorptances_.size() - 1);
    for (std::size_t i = 0; i < absorptances_.size(); ++i) divided[2 * i] = absorptances_[i];
    absorptances_ = std::move(divided);
    compute(2);
  }

 private:
  void compute(std::size_t step) {
    for (std::size_t i = step - 1; i < absorptances_.size(); i += step)
      absorptances_[i] = absorptance_at(optics_, v(i));
  }

  const FacetOptics& optics_;
  std::vector<SmoothAbsorptance> absorptances_;
};

void add_cell(ReflectanceCurve& curve, const Sixths& sixths, std::size_t cell) {
  const double start = sixths.v(6 * cell), end = sixths.v(6 * cell + 6);
  std::array<Values, 7> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = curve_values(sixths[6 * cell + i]);
  for (std::size_t part = 0; part < 3; ++part) {
    const std::array<double, 4> cubic =
        cubic_through(values[0][part], values[2][part], values[4][part], values[6][part]);
    curve.nodes.push_back({cubic[0], cubic[1]});
    curve.nodes.push_back({cubic[2], cubic[3]});
    // Moments contain the split times sin^2(beta) = 1 - v^4, so the error of the split has this weight.
    const double weight = part == kSplit ? 1.0 - start * start * start * start : 1.0;
    for (const std::size_t i : {1U, 3U, 5U}) {
      const double off = std::abs(at(cubic, static_cast<double>(i) / 6.0) - values[i][part]);
      curve.error = std::max(curve.error, kSafety * weight * off);
    }
    const double change = std::abs(values[6][part] - values[0][part]) / (end - start);
    curve.steepness = std::max(curve.steepness, weight * change * end);
  }
}

/// A pole over cos(beta) that models the steepest part of R_s or R_p. Its real part is where this part lies. Its
/// imaginary part, at most 1, is the width of this part: half the range of the reflectance, divided by the slope.
std::complex<double> steepest_pole(const Sixths& sixths) {
  std::complex<double> pole(0.0, 1.0);
  for (const double SmoothAbsorptance::*part : {&SmoothAbsorptance::s, &SmoothAbsorptance::p}) {
    std::vector<std::pair<double, double>> curve;  // cos(beta) and the absorptance
    for (std::size_t cell = 1; cell <= sixths.cells(); ++cell) {
      const double v = sixths.v(6 * cell);
      curve.emplace_back(v * v, sixths[6 * cell].*part);
    }
    const auto [least, most] = std::ranges::minmax(curve | std::views::values);
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const double slope = std::abs(curve[i + 1].second - curve[i].second) / (curve[i + 1].first - curve[i].first);
      const double width = 0.5 * (most - least) / std::max(slope, 0.5 * (most - least));
      if (width < pole.imag()) pole = {0.5 * (curve[i].first + curve[i + 1].first), width};
    }
  }
  return pole;
}

}  // namespace

ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance) {
  const double wanted = kShareOfTolerance * tolerance * std::max(reflectance_level(optics), kLeastLevel);
  Sixths sixths(optics, kFewestCells);
  ReflectanceCurve curve;
  while (true) {
    curve = {.cells = sixths.cells()};
    for (std::size_t cell = 0; cell < curve.cells; ++cell) add_cell(curve, sixths, cell);
    if (curve.error <= wanted || curve.cells == kMostCells) break;
    sixths.divide();
  }
  curve.pole = steepest_pole(sixths);
  return curve;
}

}  // namespace dolp
