#include "plan/reflectance_curve.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <ranges>
#include <utility>

#include "model/angles.hpp"
#include "model/smooth_surface.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

constexpr std::size_t kFewestCells = 64;
constexpr std::size_t kMostCells = 4096;
constexpr double kShareOfTolerance = 0.02;
constexpr double kLeastLevel = 1e-3;  // replaces a smaller reflectance_level(), to which the tolerance is relative
constexpr double kSafety = 2.0;       // error bound divided by the largest error at the tested positions

/// R_s, 1 - R_s and the split (R_s - R_p) / sin^2(beta) at one angle.
using CurveValues = std::array<double, 3>;
using Cubics = std::array<std::array<double, 4>, 3>;
constexpr std::size_t kSplit = 2;

CurveValues curve_values(const SmoothAbsorptance& absorbed) { return {1.0 - absorbed.s, absorbed.s, absorbed.split}; }

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
  const FacetOptics& optics() const { return optics_; }
  const SmoothAbsorptance& operator[](std::size_t i) const { return absorptances_[i]; }

  /// The variable of the table.
  double variable(std::size_t i) const {
    return static_cast<double>(i) / static_cast<double>(absorptances_.size() - 1);
  }
  double cosine(std::size_t i) const {
    constexpr double kLeastCosine = 1e-12;  // smooth_absorptance() does not allow 0, where films reflect everything
    const double square = variable(i) * variable(i);
    return std::clamp(optics_.measured ? 1.0 - square : square, kLeastCosine, 1.0);
  }

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
      absorptances_[i] = smooth_absorptance(optics_, cosine(i));
  }

  const FacetOptics& optics_;
  std::vector<SmoothAbsorptance> absorptances_;
};

/// CurveValues at the sixths of a cell.
using CellValues = std::array<CurveValues, 7>;

Cubics cubics_through(const CellValues& values) {
  Cubics cubics;
  for (std::size_t part = 0; part < cubics.size(); ++part)
    cubics[part] = cubic_through(values[0][part], values[2][part], values[4][part], values[6][part]);
  return cubics;
}

void append(std::vector<std::array<double, 2>>& nodes, const Cubics& cubics) {
  for (const std::array<double, 4>& cubic : cubics) {
    nodes.push_back({cubic[0], cubic[1]});
    nodes.push_back({cubic[2], cubic[3]});
  }
}

/// A cell, with a kink where other cubics begin. Without a kink, its place is beyond the cell.
struct Cell {
  std::size_t number = 0;
  Cubics before = {};
  double kink = 2.0;
  Cubics after = {};
};

CellValues cell_values(const Sixths& sixths, std::size_t cell) {
  CellValues values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = curve_values(sixths[6 * cell + i]);
  return values;
}

void add_errors(ReflectanceCurve& curve, const Sixths& sixths, const Cell& cell, const CellValues& values) {
  const std::size_t first = 6 * cell.number, last = first + 6;
  const double start = sixths.variable(first), end = sixths.variable(last);
  const double least_cosine = std::min(sixths.cosine(first), sixths.cosine(last));
  // Change of ln(variable), times 2, with the relative rounding error of cos(beta)
  const double relative = sixths.optics().measured ? 0.5 / end : end;
  for (std::size_t part = 0; part < cell.before.size(); ++part) {
    // Moments contain the split times sin^2(beta), so the error of the split has this weight.
    const double weight = part == kSplit ? 1.0 - least_cosine * least_cosine : 1.0;
    for (const std::size_t i : {1U, 3U, 5U}) {
      const double x = static_cast<double>(i) / 6.0;
      const double off = std::abs(at((x > cell.kink ? cell.after : cell.before)[part], x) - values[i][part]);
      curve.error = std::max(curve.error, kSafety * weight * off);
    }
    const double change = std::abs(values[6][part] - values[0][part]) / (end - start);
    curve.steepness = std::max(curve.steepness, weight * change * relative);
  }
}

double curve_u(double beta_deg) { return std::numbers::sqrt2 * std::sin(beta_deg * std::numbers::pi / 360.0); }

/// The cell of measured reflectances, split at its first row.
Cell measured_cell(const Sixths& sixths, std::size_t number) {
  const MeasuredReflectance& measured = *sixths.optics().measured;
  const auto cubics_below = [&](std::size_t row) {
    CellValues values;
    for (std::size_t i = 0; i < values.size(); i += 2)
      values[i] = curve_values(measured_absorptance(measured, row, sixths.cosine(6 * number + i)));
    return cubics_through(values);
  };
  const std::size_t row = measured.row_above(std::acos(sixths.cosine(6 * number)) * 180.0 / std::numbers::pi);
  Cell cell{number, cubics_below(row)};
  const double place =
      curve_u(measured.beta_deg[row]) * static_cast<double>(sixths.cells()) - static_cast<double>(number);
  if (row + 1 == measured.beta_deg.size() || place >= 1.0) return cell;
  cell.kink = place;
  cell.after = cubics_below(row + 1);
  return cell;
}

/// So many cells that measured angles are in different cells, if the limit allows it.
std::size_t fewest_cells(const FacetOptics& optics) {
  if (!optics.measured) return kFewestCells;
  double step = 1.0 / static_cast<double>(kFewestCells);
  const std::vector<double>& beta_deg = optics.measured->beta_deg;
  for (std::size_t i = 1; i < beta_deg.size(); ++i)
    step = std::min(step, curve_u(beta_deg[i]) - curve_u(beta_deg[i - 1]));
  if (step * static_cast<double>(kMostCells) < 1.0) return kMostCells;
  return std::bit_ceil(static_cast<std::size_t>(std::ceil(1.0 / step)));
}

ReflectanceCurve make_curve(const Sixths& sixths) {
  ReflectanceCurve curve{.cells = sixths.cells()};
  curve.nodes.reserve(DOLP_CURVE_NODES * curve.cells);
  std::vector<std::array<double, 2>> kinks, beyond;  // films have neither
  for (std::size_t i = 0; i < curve.cells; ++i) {
    const CellValues values = cell_values(sixths, i);
    const Cell cell = sixths.optics().measured ? measured_cell(sixths, i) : Cell{i, cubics_through(values)};
    append(curve.nodes, cell.before);
    add_errors(curve, sixths, cell, values);
    if (!sixths.optics().measured) continue;
    kinks.push_back({cell.kink, static_cast<double>((DOLP_CURVE_NODES + 1) * curve.cells + beyond.size())});
    if (cell.kink < 1.0) append(beyond, cell.after);
  }
  curve.nodes.insert(curve.nodes.end(), kinks.begin(), kinks.end());
  curve.nodes.insert(curve.nodes.end(), beyond.begin(), beyond.end());
  return curve;
}

/// A pole over cos(beta) that models the steepest part of R_s or R_p. Its real part is where this part lies. Its
/// imaginary part, at most 1, is the width of this part: half the range of the reflectance, divided by the slope.
std::complex<double> steepest_pole(const Sixths& sixths) {
  std::complex<double> pole(0.0, 1.0);
  for (const double SmoothAbsorptance::*part : {&SmoothAbsorptance::s, &SmoothAbsorptance::p}) {
    std::vector<std::pair<double, double>> curve;  // cos(beta) and the absorptance
    for (std::size_t cell = 1; cell <= sixths.cells(); ++cell)
      curve.emplace_back(sixths.cosine(6 * cell), sixths[6 * cell].*part);
    const auto [least, most] = std::ranges::minmax(curve | std::views::values);
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const double run = std::abs(curve[i + 1].first - curve[i].first);
      const double slope = std::abs(curve[i + 1].second - curve[i].second) / run;
      const double width = 0.5 * (most - least) / std::max(slope, 0.5 * (most - least));
      if (width < pole.imag()) pole = {0.5 * (curve[i].first + curve[i + 1].first), width};
    }
  }
  return pole;
}

/// The change of R_s and R_p with beta, per degree, beside an angle: before it if `step_deg` is negative, else after
/// it. `row`: the row at the larger end of the interval.
std::array<double, 2> slopes_beside(const MeasuredReflectance& measured, std::size_t row, double beta_deg,
                                    double step_deg) {
  const auto at = [&](double angle_deg) { return measured_absorptance(measured, row, cos_sin_deg(angle_deg).cos); };
  const SmoothAbsorptance near = at(beta_deg), far = at(beta_deg + step_deg);
  return {(near.s - far.s) / step_deg, (near.p - far.p) / step_deg};
}

struct Kink {
  double size = 0.0;
  std::vector<double> splits_deg;  ///< angles that resolve it
};

/// Size of a kink at an angle between two intervals, which end at the rows `before` and `after`: the jump of dR/dbeta
/// times an eighth of the smaller interval. This is how far the curve differs from a smooth one.
double kink_size(const MeasuredReflectance& measured, double beta_deg, std::size_t before, std::size_t after) {
  constexpr double kStep = 1e-3;  // share of an interval
  const auto length_deg = [&](std::size_t row) { return measured.beta_deg[row] - measured.beta_deg[row - 1]; };
  const auto [s_before, p_before] = slopes_beside(measured, before, beta_deg, -kStep * length_deg(before));
  const auto [s_after, p_after] = slopes_beside(measured, after, beta_deg, kStep * length_deg(after));
  return 0.125 * std::min(length_deg(before), length_deg(after)) *
         std::max(std::abs(s_after - s_before), std::abs(p_after - p_before));
}

std::vector<Kink> find_kinks(const MeasuredReflectance& measured) {
  std::vector<Kink> kinks;
  for (std::size_t row = 1; row + 1 < measured.beta_deg.size(); ++row)
    kinks.push_back({kink_size(measured, measured.beta_deg[row], row, row + 1), {measured.beta_deg[row]}});
  // At normal incidence R goes on as in a mirror: it has the tip of a cone. Arcs that shrink toward it resolve it.
  const double first_deg = measured.beta_deg[1];
  const auto [s, p] = slopes_beside(measured, 1, 0.0, 1e-3 * first_deg);
  const double jump = 2.0 * std::max(std::abs(s), std::abs(p));
  kinks.push_back({0.125 * first_deg * jump, {0.0, 0.25 * first_deg, 0.0625 * first_deg}});
  if (const std::optional<double> limit_deg = difference_limit_deg(measured))
    kinks.push_back({kink_size(measured, *limit_deg, 1, 1), {*limit_deg}});
  std::ranges::sort(kinks, std::ranges::greater(), &Kink::size);
  return kinks;
}

}  // namespace

RowKinks row_kinks(const FacetOptics& optics, double tolerance, std::size_t most) {
  RowKinks kinks;
  if (!optics.measured) return kinks;
  const double least = kLeastKink * tolerance * std::max(reflectance_level(optics), kLeastLevel);
  for (const Kink& kink : find_kinks(*optics.measured)) {
    if (kink.size > least && kinks.split_deg.size() + kink.splits_deg.size() <= most) {
      kinks.split_deg.insert(kinks.split_deg.end(), kink.splits_deg.begin(), kink.splits_deg.end());
    } else {
      kinks.unsplit = std::hypot(kinks.unsplit, kink.size);
    }
  }
  return kinks;
}

ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance) {
  const double wanted = kShareOfTolerance * tolerance * std::max(reflectance_level(optics), kLeastLevel);
  Sixths sixths(optics, fewest_cells(optics));
  ReflectanceCurve curve;
  while (true) {
    curve = make_curve(sixths);
    if (curve.error <= wanted || curve.cells == kMostCells) break;
    sixths.divide();
  }
  curve.pole = optics.measured ? std::complex<double>(0.0, 1.0) : steepest_pole(sixths);  // between kinks it is smooth
  return curve;
}

}  // namespace dolp
