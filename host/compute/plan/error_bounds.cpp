#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "base/numbers.hpp"
#include "model/slopes.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr double kCosineRounding = 2.0 * std::numeric_limits<double>::epsilon();
constexpr double kGrazingCosine = 1e-9;  // smaller cosines of theta count as this one

// Relative rounding error of a sum, in unit roundoffs. It is large for heavy tails, where the masking table is a sum of
// many nearly equal terms, and at the critical line of total reflection, whose position loses digits.
double roundings(const KernelData& data, const kernel::ThetaNode& theta, const kernel::ShapeNode& shape,
                 const kernel::IndexNode& index) {
  if (index.critical_cos > 0.0) {
    const double grazing = 1.0 - std::log10(std::max(theta.c, kGrazingCosine));
    const double smooth = std::max(1.0, kSmoothM / shape.m);
    return std::min(kCriticalRoundings * smooth * grazing, kMostCriticalRoundings);
  }
  if (!data.needs_masking_table() || data.distribution == Distribution::kGaussian) return kRoundings;
  if (shape.q_minus_1 < kExtremeTailQ - 1.0) return kExtremeTailRoundings;
  const double heavy_tail_q = data.masking == Masking::kSmith ? kHeavyTailSmithQ : kHeavyTailQ;
  return shape.q_minus_1 < heavy_tail_q - 1.0 ? kHeavyTailRoundings : kRoundings;
}

// Mean absolute slope in one plane. Domain: q > 1.5 for the cauchy.
double mean_slope(Distribution distribution, const kernel::ShapeNode& shape) {
  const double gaussian = shape.m * shape.m * shape.marginal_norm;
  return distribution == Distribution::kGaussian ? gaussian : 2.0 * gaussian / shape.two_q_minus_3;
}

// Upper bound of the masking G. With smith masking, G is at most Smith's G1(theta), which is small near the horizon.
double masking_bound(Distribution distribution, Masking masking, const kernel::ThetaNode& theta,
                     const kernel::ShapeNode& shape) {
  if (masking != Masking::kSmith) return 1.0;
  return std::min(1.0, 2.0 * theta.c / (theta.c + theta.s * mean_slope(distribution, shape)));
}

double share_beyond(Distribution distribution, const kernel::ShapeNode& shape, double slope) {
  return steeper_share(distribution, {shape.m / std::numbers::sqrt2, shape.q_minus_1 + 1.0}, slope);
}

// Upper bound of what facets steeper than ShapeNode::cut, which the kernel omits, add to cos(theta) times the albedo.
double cut_bound(const KernelData& data, const kernel::ThetaNode& theta, const kernel::ShapeNode& shape) {
  const double reached = std::min(shape.cut, theta.end[DOLP_MAX_PIECES]);
  const double tail = share_beyond(data.distribution, shape, reached);
  if (data.scattering == Scattering::kMultiple) return theta.c * tail;
  if (shape.cut >= theta.end[DOLP_MAX_PIECES]) return 0.0;
  const double u = shape.cut / shape.m;
  const bool gaussian = data.distribution == Distribution::kGaussian;
  const double log_square = std::log1p(u * u);
  if (data.masking == Masking::kVCavity) return 2.0 * theta.c * tail;
  if (!gaussian && shape.q_minus_1 <= 0.5) return std::numeric_limits<double>::infinity();
  const double slopes = gaussian ? shape.m / pi * (u + 0.5 / u) * tail
                                 : 2.0 * shape.q_minus_1 * shape.m / pi *
                                       std::exp((0.5 - shape.q_minus_1) * log_square) / (2.0 * shape.q_minus_1 - 1.0);
  return masking_bound(data.distribution, data.masking, theta, shape) * (theta.c * tail + theta.s * slopes);
}

// Error of v-cavity masking, as a share of the albedo. G has other formulas on the two sides of a split line, and in
// grooves rays bounce once more. Next to the line the products e G of both formulas differ by about the distance, and
// the sum of e G is about cos(theta). If quotients and roots are inexact, the azimuth of the line is wrong by
// `distance` even if cos(theta) is far smaller.
double split_line_error(const KernelData& data, const kernel::ThetaNode& theta, double unit_roundoff) {
  const double distance = kLineRoundings * (unit_roundoff - kFloatRoundoff);
  return data.masking == Masking::kVCavity && distance > 0.0 ? distance * distance / theta.c : 0.0;
}

// Error of the masking G, as a share of the albedo. With smith it is infinite where the mean slope is: at q = 3/2.
double masking_error(const KernelData& data, const MomentsEntry& entry, double unit_roundoff) {
  const kernel::ThetaNode& theta = data.thetas[entry.theta];
  if (!data.needs_masking_table()) return split_line_error(data, theta, unit_roundoff);
  const kernel::ShapeNode& shape = data.shapes[entry.shape];
  if (!table_resolves(shape, theta.c, theta.s)) return 1.0;
  const bool may_diverge = data.masking == Masking::kSmith && data.distribution == Distribution::kCauchy;
  const double table = unit_roundoff > kDoubleRoundoff ? kMaskingTableErrorFloat : kMaskingTableErrorDouble;
  return table * (may_diverge ? 1.0 + kDivergingSlope / shape.two_q_minus_3 : 1.0);
}

// R_s, an upper bound of M00 = (R_s + R_p) / 2. The bound falls as cos(beta) grows.
double reflectance_s(const kernel::IndexNode& index, double cos_beta) {
  if (index.curve_cells != 0.0) return 1.0;  // with films R_s may grow with cos(beta)
  const std::complex<double> w =
      std::sqrt(std::complex<double>(index.n2m1_re + cos_beta * cos_beta, std::max(index.n2m1_im, 0.0)));
  return std::min(1.0, std::norm((cos_beta - w) / (cos_beta + w)));
}

// Upper bound of the share of light that is left after `bounces` bounces with cos(beta) >= a/2. Here a is the length of
// the ray's unit vector, projected on the plane across the groove. Azimuths with a < level have at most the share
// `missed` of the light, and at most the share `most` of it is left. At the other azimuths, each bounce leaves at most
// R_s at cos(beta) = level/2. So each level gives a bound, and the least bound is returned.
double left_after(const kernel::ThetaNode& theta, const kernel::IndexNode& index, double bounces, double most) {
  double least = most;
  for (double level = 1.0; level > 1e-6; level *= 0.5) {
    const double along = std::sqrt(std::max((level - theta.c) * (level + theta.c), 0.0));
    const double missed = along <= 0.0 ? 0.0 : along < theta.s ? 4.0 / pi * std::asin(along / theta.s) : 1.0;
    const double reflected = std::pow(reflectance_s(index, 0.5 * std::max(level, theta.c)), bounces);
    least = std::min(least, most * missed + reflected);
    if (reflected >= least) break;  // at lower levels even more light is left
  }
  return least;
}

// Upper bound of the share of light that facets steeper than ShapeNode::cut reflect. With single scattering it is R_s
// at the least cos(beta): a ray leaves a facet of slope t only if cos(beta) > cos(theta) sqrt(1 + t^2) / 2. In grooves,
// at least t min(pi/3, pi/2 - theta) - 1 bounces have the cos(beta) for which left_after() gives a bound.
double steep_reflectance(const KernelData& data, const kernel::IndexNode& index, const kernel::ThetaNode& theta,
                         const kernel::ShapeNode& shape) {
  if (data.scattering == Scattering::kSingle) {
    return reflectance_s(index, std::min(1.0, 0.5 * theta.c * std::hypot(1.0, shape.cut)));
  }
  const double slope = std::min(shape.cut, theta.end[DOLP_MAX_PIECES]);
  const double elevation = std::atan2(theta.c, theta.s);
  return left_after(theta, index, std::max(std::min(pi / 3.0, elevation) * slope - 1.0, 0.0), 1.0);
}

// Bound of the error in grooves with more than DOLP_MOST_BOUNCES bounces, where the kernel merges bounces into one. The
// kernel computes the light `reflected` for these grooves. If it is at most `least`, this light is itself the bound.
double many_bounces_bound(const KernelData& data, const kernel::ThetaNode& theta, const kernel::IndexNode& index,
                          const kernel::ShapeNode& shape, double reflected, double least) {
  const auto beyond = [&](double bounces, double most) {
    const double share = theta.c * share_beyond(data.distribution, shape, slope_with_bounces(bounces));
    return share <= data.rule.dimmest ? share : share * left_after(theta, index, kNotGrazing * bounces, most);
  };
  const double last = beyond(DOLP_LAST_BOUNCES, 1.0);
  if (index.critical_cos > 0.0) return last + beyond(DOLP_MOST_BOUNCES, 1.0);
  if (reflected <= least) return last + reflected;
  const double many = beyond(DOLP_MOST_BOUNCES, kManyBouncesError);
  const double very_many = beyond(kVeryManyBounces, kVeryManyBouncesError);
  return last + std::min(many + very_many, reflected);
}

double pair_factor(const KernelData& data, const kernel::IndexNode& index) {
  const bool is_multiple = data.scattering == Scattering::kMultiple;
  const double smooth = is_multiple ? kGroovePairFactor : data.needs_masking_table() ? kTablePairFactor : kPairFactor;
  return index.critical_cos > 0.0 || index.curve_cells < 0.0 ? kCriticalFactor * smooth : smooth;
}

// Error of a function of a sky. It comes from the table of the function, from corners (kinks) at which the azimuths are
// not split, and from rounding. Near the zenith, rounding is large because 1 - cos(theta_r) loses digits.
double sky_error(const KernelData& data, std::size_t function, double unit_roundoff) {
  return data.sky.error[function] + kUnsplitBends * data.sky.bends[function] + kSkyRoundings * unit_roundoff +
         data.sky.steepness[function] * std::sqrt(kSkyCosineRoundings * unit_roundoff);
}

// Rounding error of the Chebyshev polynomial T_degree(x), whose slope is at most degree^2.
double response_rounding(std::size_t degree, double unit_roundoff) {
  return kResponseRoundings * unit_roundoff * static_cast<double>(1 + degree * degree);
}

struct Shares {
  double cut = 0.0;            ///< bound of what facets steeper than ShapeNode::cut add to Moments::albedo
  double reflected_cut = 0.0;  ///< bound of what these facets add to Moments::r_i
  double grooves = 0.0;        ///< bound of the errors of r_i and deficit: merged bounces, rounding, omitted light
  double masking = 0.0;        ///< relative error of G
  double rounding = 0.0;       ///< relative rounding error
  double least = 0.0;          ///< least error bound of a sum, relative to the sum
  double pair = 1.0;           ///< error bound divided by the difference of two rules
  // Two rules with few nodes may agree by chance, so the bound of a sum is at least a share of the tolerance.
  double rule_error() const { return least + rounding; }
  double masked_error() const { return rule_error() + masking; }
};

Shares error_shares(const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                    double unit_roundoff) {
  const kernel::ShapeNode& shape = data.shapes[entry.shape];
  const kernel::ThetaNode& theta = data.thetas[entry.theta];
  const kernel::IndexNode& index = data.indices[entry.index];
  Shares shares;
  shares.cut = cut_bound(data, theta, shape);
  shares.masking = masking_error(data, entry, unit_roundoff);
  // The sum of the sizes of all azimuthal orders, as a share of order 0: the quotient of the widths along and across.
  const double eccentric = eccentricity(data.slopes[entry.shape]);
  const double orders = (1.0 + eccentric) / (1.0 - eccentric);
  shares.rounding = orders * unit_roundoff * roundings(data, theta, shape, index);
  shares.least = orders * kLeastShareOfTolerance * data.tolerance;
  shares.pair = pair_factor(data, index);
  if (data.scattering == Scattering::kMultiple) {
    shares.grooves =
        many_bounces_bound(data, theta, index, shape, std::abs(node.many), shares.least * std::abs(node.r_i)) +
        (kGrooveRoundings * unit_roundoff + data.rule.dimmest) * theta.c;
  }
  const bool is_negligible = shares.cut <= data.rule.dimmest * theta.c;
  shares.reflected_cut = is_negligible ? shares.cut : shares.cut * steep_reflectance(data, index, theta, shape);
  return shares;
}

void set_errors(Moments& moments, const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                const Shares& shares) {
  const double r_i_scale = std::abs(node.r_i);  // r_i can be negative if a rule does not converge
  const double deficit_scale = node.deficit + 2.0 * node.behind;
  moments.r_i_error = shares.pair * node.reflected_difference + shares.masked_error() * r_i_scale +
                      shares.reflected_cut + shares.grooves;
  moments.r_q_error = moments.r_i_error;
  const double largest_difference =
      std::max({node.reflected_difference, node.albedo_difference, node.deficit_difference});
  moments.albedo_error = shares.pair * largest_difference + shares.masked_error() * std::abs(node.albedo) + shares.cut;
  // With total reflection, the deficit may be far smaller than r_i. So the deficit error is relative to the albedo.
  const bool is_critical = data.indices[entry.index].critical_cos > 0.0;
  const double deficit_terms = std::max(std::abs(deficit_scale), is_critical ? std::abs(node.albedo) : 0.0);
  const bool is_multiple = data.scattering == Scattering::kMultiple;
  moments.deficit_error = shares.pair * node.deficit_difference + shares.rule_error() * deficit_terms +
                          shares.masking * std::abs(node.albedo) +
                          (is_multiple ? shares.reflected_cut + shares.grooves : shares.cut);
}

void add_curve_errors(Moments& moments, const kernel::MomentsNode& node, double emitted, const CurveError& error,
                      double unit_roundoff) {
  const double facet_error = 1.5 * (error.absolute + kCurveRoundings * unit_roundoff * error.per_roundoff);
  for (double* const bound : {&moments.r_i_error, &moments.r_q_error, &moments.deficit_error})
    *bound += facet_error * std::abs(node.albedo);
  for (double* const bound : {&moments.direct_i_error, &moments.direct_q_error}) *bound += facet_error * emitted;
  for (ColumnMoments& column : moments.columns) column.error += facet_error * std::abs(node.albedo);
}

/// `sums` has the four numbers of column k that add_columns() gives.
ColumnMoments column_moments(std::span<const double> sums, std::size_t k, const kernel::MomentsNode& node,
                             const KernelData& data, const kernel::ThetaNode& theta, const Shares& shares,
                             double unit_roundoff) {
  const double sky_bound = data.sky.count > 0 ? sky_error(data, data.response ? 0 : k, unit_roundoff) : 0.0;
  if (!data.response) {
    const double error = shares.pair * sums[2] + (sky_bound + shares.masked_error()) * std::abs(node.r_i);
    return {sums[0], sums[1], error + shares.reflected_cut + shares.grooves};
  }
  const double largest = data.response->of == Response::Of::kDirect ? theta.c : std::abs(node.albedo);
  return {.i = sums[0],
          .q = sums[1],
          .error = (shares.rounding + response_rounding(k, unit_roundoff) + sky_bound) * largest + shares.cut,
          .i_apart = shares.pair * sums[2],
          .q_apart = shares.pair * sums[3],
          .relative_error = shares.least + shares.masking};
}

}  // namespace

bool table_resolves(const kernel::ShapeNode& shape, double cos_theta, double sin_theta) {
  return shape.m >= shape.table_scale || cos_theta >= shape.table_scale * sin_theta;
}

void take_complement(Moments& moments, double cosine) {
  if (moments.deficit_error > moments.r_i_error) {
    moments.deficit = cosine - moments.r_i;
    moments.deficit_error = moments.r_i_error + kCosineRounding * cosine;
  } else {
    moments.r_i = cosine - moments.deficit;
    moments.r_i_error = moments.deficit_error;
  }
}

double float_roundoff(const Arithmetic& arithmetic) {
  constexpr double kCorrect = OperationErrors{}.largest;
  return kFloatRoundoff * (1.0 + kDivisionGrowth * std::max(arithmetic.division.largest - kCorrect, 0.0) +
                           kRootGrowth * std::max(arithmetic.root.largest - kCorrect, 0.0));
}

Moments moments_from_kernel(const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                            double unit_roundoff, std::span<const double> columns) {
  const kernel::ThetaNode& theta = data.thetas[entry.theta];
  const Shares shares = error_shares(node, data, entry, unit_roundoff);
  Moments moments;
  moments.r_i = node.r_i;
  moments.r_q = node.r_q;
  moments.albedo = node.albedo;
  moments.deficit = node.deficit;
  moments.evaluations = node.evaluations;
  set_errors(moments, node, data, entry, shares);
  const bool is_multiple = data.scattering == Scattering::kMultiple;
  if (is_multiple) {
    moments.albedo = theta.c;
    moments.albedo_error = kCosineRounding * theta.c;
  }
  // Facets that no masking hides yet may emit more than a black surface.
  const double emitted = data.has_only_direct ? std::max(theta.c, node.direct_i) : theta.c;
  if (data.has_direct) {
    moments.direct_i = node.direct_i;
    moments.direct_q = node.direct_q;
    moments.direct_i_error = shares.pair * node.direct_difference + shares.masked_error() * emitted + shares.cut;
    moments.direct_q_error = moments.direct_i_error;
  }
  for (std::size_t k = 0; k < data.column_count(); ++k) {
    const auto sums = columns.subspan(DOLP_COLUMN_PARTS * k, DOLP_COLUMN_PARTS);
    moments.columns.push_back(column_moments(sums, k, node, data, theta, shares, unit_roundoff));
  }
  if (data.has_curves) add_curve_errors(moments, node, emitted, data.curve_errors[entry.index], unit_roundoff);
  // In grooves an inaccurate r_i may exceed cos(theta). Then it must not replace the deficit, which would be negative.
  if (!is_multiple || moments.r_i < theta.c || moments.deficit_error <= moments.r_i_error)
    take_complement(moments, theta.c);
  return moments;
}

}  // namespace dolp
