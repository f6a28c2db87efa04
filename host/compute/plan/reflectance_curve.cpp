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

/// R_s, 1 - R_s and the split (R_s - R_p) / sin^2(beta) at v = sqrt(cos(beta)).
using Values = std::array<double, 3>;
constexpr std::size_t kSplit = 2;

Values values_at(const FacetOptics& optics, double v) {
  constexpr double kLeastCosine = 1e-12;  // smooth_absorptance() does not allow 0, where films reflect everything
  const SmoothAbsorptance absorbed = smooth_absorptance(optics, std::clamp(v * v, kLeastCosine, 1.0));
  return {1.0 - absorbed.s, absorbed.s, absorbed.split};
}

/// Coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
std::array<double, 4> cubic_through(double a, double b, double c, double d) {
  return {a, -5.5 * a + 9.0 * b - 4.5 * c + d, 9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d, 13.5 * (b - c) + 4.5 * (d - a)};
}

double at(const std::array<double, 4>& cubic, double x) {
  return cubic[0] + x * (cubic[1] + x * (cubic[2] + x * cubic[3]));
}

void add_cell(ReflectanceCurve& curve, const FacetOptics& optics, double start, double width) {
  std::array<Values, 7> values;  // at sixths of the cell
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = values_at(optics, start + width * static_cast<double>(i) / 6.0);
  for (std::size_t part = 0; part < 3; ++part) {
    const std::array<double, 4> cubic =
        cubic_through(values[0][part], values[2][part], values[4][part], values[6][part]);
    curve.nodes.push_back({cubic[0], cubic[1]});
    curve.nodes.push_back({cubic[2], cubic[3]});
    // Moments contain the split times sin^2(beta) = 1 - v^4, so the error of the split has this weight.
    const double weight = part == kSplit ? 1.0 - std::pow(start, 4.0) : 1.0;
    for (const std::size_t i : {1U, 3U, 5U}) {
      const double off = std::abs(at(cubic, static_cast<double>(i) / 6.0) - values[i][part]);
      curve.error = std::max(curve.error, kSafety * weight * off);
    }
    const double change = std::abs(values[6][part] - values[0][part]) / width;
    curve.steepness = std::max(curve.steepness, weight * change * (start + width));
  }
}

/// A pole over cos(beta) that models the steepest part of R_s or R_p. Its real part is where this part lies. Its
/// imaginary part, at most 1, is the width of this part: half the range of the reflectance, divided by the slope.
std::complex<double> steepest_pole(const FacetOptics& optics, std::size_t cells) {
  std::complex<double> pole(0.0, 1.0);
  for (const double SmoothAbsorptance::*part : {&SmoothAbsorptance::s, &SmoothAbsorptance::p}) {
    std::vector<std::pair<double, double>> curve;  // cos(beta) and the absorptance
    for (std::size_t i = 1; i <= cells; ++i) {
      const double v = static_cast<double>(i) / static_cast<double>(cells);
      curve.emplace_back(v * v, smooth_absorptance(optics, v * v).*part);
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
  ReflectanceCurve curve;
  for (curve.cells = kFewestCells;; curve.cells *= 2) {
    curve.nodes.clear();
    curve.error = curve.steepness = 0.0;
    const double width = 1.0 / static_cast<double>(curve.cells);
    for (std::size_t cell = 0; cell < curve.cells; ++cell)
      add_cell(curve, optics, width * static_cast<double>(cell), width);
    if (curve.error <= wanted || curve.cells == kMostCells) break;
  }
  curve.pole = steepest_pole(optics, curve.cells);
  return curve;
}

}  // namespace dolp
