#include "plan/doubt_model.hpp"

#include <algorithm>
#include <cmath>

#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

constexpr std::array kKnots = {3.5, 5.5, 8.5, 12.5};

using Coefficients = std::array<std::array<double, kDoubtKnots>, kDoubtFeatures>;

// By masking, distribution (cauchy, gaussian) and what is doubted (r_i and r_q, deficit).
constexpr Coefficients kCoefficients[4][2][2] = {
#include "plan/doubt_coefficients.inc"
};

constexpr std::array<std::string_view, kDoubtFeatures> kNames = {
    // of the doubt
    "one", "doubt", "doubt above a tenth", "doubt above 1",
    // of the direction
    "grazing", "cos below 0.2", "cos below 0.04", "sin below 0.5", "sin below 0.1", "coincidence", "cos below 0.001",
    "next to the horizon",
    // of the shape
    "m", "m above 0.03", "m above 0.1", "m above 0.3", "m above 1", "outside: m small by", "outside: m large by",
    "outside: shape", "q", "q - 1 above 0.3", "q - 1 above 1", "q - 1 above 3", "heavy tail, smooth",
    "heavy tail, rough", "light tail by m", "outside: q small by", "outside: q large by",
    // of the index
    "contrast", "contrast above 4", "contrast above 30", "contrast above 300", "outside: contrast small by", "critical",
    "critical by n", "nearly critical", "nearly critical by n", "outside: silvery", "outside: silvery by n",
    // of pairs
    "pole", "pole near", "rough, grazing", "smooth, grazing", "steep", "steep above 10", "rough, pole",
    "outside: rough, grazing", "outside: smooth, grazing", "outside: smooth, next to the horizon",
    "outside: shape, next to the horizon", "critical by m", "critical by cos", "nearly critical by m",
    "nearly critical by cos", "line", "line, smooth", "line by q", "cusp above 0.01", "cusp above 1", "cusp above 100",
    "split cusp above 1", "split cusp above 1000", "cusp", "cusp, grazing", "cusp, rough", "cusp, rough, grazing"};

// Where features end, as log10: of m, cos(theta), q - 1 and |N^2 - 1|. What lies outside, and
// what is next to the horizon, has features of its own, so that it does not weigh on the rest.
constexpr double kSmallestM = -1.85;
constexpr double kLargestM = 0.25;
constexpr double kGrazing = 3.0;
constexpr double kSmallestCos = 1e-5;
constexpr double kSmallestSin = 3e-3;
constexpr double kSmallestQ = -1.22;
constexpr double kSmallestSmithQ = -0.28;
constexpr double kSmallestMean = -1.3;  // of 2q - 3
constexpr double kLargestQ = 1.09;
constexpr double kSmallestContrast = -0.8;
constexpr double kLargestContrast = 4.0;
constexpr double kSmallestPole = 0.01;  // of cos(theta) + pole_cos
constexpr double kSmallestMetalN = 0.2;

// What the calibration has drawn; the features of anything beyond are those of its end.
constexpr std::array kCalibratedM = {1.4e-4, 14.2};
constexpr std::array kCalibratedQ = {1e-3, 1e4};     // q - 1
constexpr std::array kCalibratedMean = {1e-3, 1e4};  // 2q - 3
constexpr std::array kCalibratedContrast = {2e-5, 1e12};
constexpr std::array kCalibratedSquare = {1e-4, 1e12};  // |N^2|
constexpr std::array kCalibratedMetalN = {1e-3, 1e6};

constexpr double kNearContrast = 2.4;  // |N^2 - 1| up to which Re N^2 < 1 reflects nearly all beyond an angle
constexpr double kCoincidence = 1.05;  // of neighbouring breakpoints: their singularities act together
constexpr double kLeastDoubt = -3.0;   // log10 of the doubt over 10^-digits
constexpr double kMostDoubt = 2.0;
constexpr double kNoCusp = -100.0;
constexpr double kWeakestCusp = -16.0;
constexpr double kLeastFactor = -3.0;  // log10
constexpr double kMostFactor = 12.0;

double above(double value, double start) { return std::max(0.0, value - start); }
double below(double value, double start) { return std::max(0.0, start - value); }
double log10_in(double value, const std::array<double, 2>& range) {
  return std::log10(std::clamp(value, range[0], range[1]));
}
double flag(bool condition) { return condition ? 1.0 : 0.0; }

bool has_coincidence(const kernel::ThetaNode& theta) {
  for (std::size_t i = 1; i < static_cast<std::size_t>(theta.piece_count); ++i) {
    if (theta.end[i + 1] < kCoincidence * theta.end[i]) return true;
  }
  return false;
}

std::array<double, kDoubtFeatures> coefficients_at(const Coefficients& coefficients, double digits) {
  const double at = std::clamp(digits, kKnots.front(), kKnots.back());
  std::size_t i = 0;
  while (i + 2 < kKnots.size() && at > kKnots[i + 1]) ++i;
  const double share = (at - kKnots[i]) / (kKnots[i + 1] - kKnots[i]);
  std::array<double, kDoubtFeatures> result{};
  for (std::size_t f = 0; f < kDoubtFeatures; ++f) {
    result[f] = (1.0 - share) * coefficients[f][i] + share * coefficients[f][i + 1];
  }
  return result;
}

template <std::size_t N>
double score(const std::array<double, kDoubtFeatures>& coefficients, std::size_t first,
             const std::array<double, N>& features) {
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) sum += coefficients[first + i] * features[i];
  return sum;
}

}  // namespace

std::span<const std::string_view, kDoubtFeatures> doubt_feature_names() { return kNames; }

std::span<const double, kDoubtKnots> doubt_knots() { return kKnots; }

DoubtModel::DoubtModel(Distribution distribution, Masking masking, double digits,
                       const std::vector<kernel::ThetaNode>& thetas, const std::vector<kernel::ShapeNode>& shapes,
                       const std::vector<kernel::IndexNode>& indices)
    : is_cauchy_(distribution == Distribution::kCauchy),
      is_smith_cauchy_(is_cauchy_ && masking == Masking::kSmith),
      digits_(digits) {
  const auto& model = kCoefficients[static_cast<std::size_t>(masking)][is_cauchy_ ? 0 : 1];
  for (std::size_t i = 0; i < 2; ++i) coefficients_[i] = coefficients_at(model[i], digits);
  for (const kernel::ThetaNode& node : thetas) thetas_.push_back(theta_of(node));
  for (const kernel::ShapeNode& node : shapes) shapes_.push_back(shape_of(node));
  for (const kernel::IndexNode& node : indices) indices_.push_back(index_of(node));
  for (std::size_t i = 0; i < 2; ++i) {
    for (Theta& theta : thetas_) theta.score[i] = score(coefficients_[i], kOwn, theta.features);
    for (Shape& shape : shapes_) shape.score[i] = score(coefficients_[i], kOwn + kTheta, shape.features);
    for (Index& index : indices_) index.score[i] = score(coefficients_[i], kOwn + kTheta + kShape, index.features);
  }
}

DoubtModel::Theta DoubtModel::theta_of(const kernel::ThetaNode& node) {
  Theta theta;
  theta.cos = node.c;
  theta.has_line = node.has_line;
  theta.log_cos = -std::log10(std::max(node.c, kSmallestCos));
  const double grazing = std::min(theta.log_cos, kGrazing);
  const double normal = -std::log10(std::max(node.s, kSmallestSin));
  theta.features = {grazing,
                    above(grazing, 0.7),
                    above(grazing, 1.4),
                    above(normal, 0.3),
                    above(normal, 1.0),
                    flag(has_coincidence(node)),
                    above(theta.log_cos, kGrazing),
                    flag(theta.log_cos > kGrazing)};
  return theta;
}

DoubtModel::Shape DoubtModel::shape_of(const kernel::ShapeNode& node) const {
  const double smallest_q = is_smith_cauchy_ ? kSmallestSmithQ : kSmallestQ;
  // Smith's mean slope diverges at q = 3/2.
  const double log_mean = is_smith_cauchy_ ? log10_in(node.two_q_minus_3, kCalibratedMean) : 0.0;
  Shape shape;
  shape.log_m = log10_in(node.m, kCalibratedM);
  shape.cusp_digits = node.cusp_digits;
  const double m = std::clamp(shape.log_m, kSmallestM, kLargestM);
  const double log_q = is_cauchy_ ? log10_in(node.q_minus_1, kCalibratedQ) : 0.0;
  const double q = std::clamp(log_q, smallest_q, kLargestQ);
  shape.log_q = q;
  shape.is_outside =
      flag(shape.log_m < kSmallestM || shape.log_m > kLargestM || log_q < smallest_q || log_q > kLargestQ);
  shape.features = {m,
                    above(m, -1.5),
                    above(m, -1.0),
                    above(m, -0.5),
                    above(m, 0.0),
                    below(shape.log_m, kSmallestM),
                    above(shape.log_m, kLargestM),
                    shape.is_outside,
                    q,
                    above(q, -0.5),
                    above(q, 0.0),
                    above(q, 0.5),
                    below(q, 0.0) * below(m, -1.0),
                    below(q, 0.0) * above(m, -0.5),
                    above(q, 0.0) * m,
                    is_smith_cauchy_ ? below(log_mean, kSmallestMean) : below(log_q, kSmallestQ),
                    above(log_q, kLargestQ)};
  return shape;
}

DoubtModel::Index DoubtModel::index_of(const kernel::IndexNode& node) {
  const double contrast = std::hypot(node.n2m1_re, node.n2m1_im);
  const double log_contrast = log10_in(contrast, kCalibratedContrast);
  const double clamped = std::clamp(log_contrast, kSmallestContrast, kLargestContrast);
  const double n2_size = std::hypot(1.0 + node.n2m1_re, node.n2m1_im);
  const double log_n2 = log10_in(n2_size, kCalibratedSquare);
  // Metals that hardly absorb: Re N^2 < 0, n = Im N^2 / (2 k) next to nothing.
  const double k = std::sqrt(0.5 * (n2_size - 1.0 - node.n2m1_re));
  const double n_of_metal = node.n2m1_re < -1.0 ? 0.5 * node.n2m1_im / k : kSmallestMetalN;
  const double silvery = below(log10_in(n_of_metal, kCalibratedMetalN), std::log10(kSmallestMetalN));
  Index index;
  index.pole_cos = node.pole_cos;
  index.is_critical = flag(node.critical_cos > 0.0);
  index.is_nearly_critical = flag(node.critical_cos <= 0.0 && node.n2m1_re < 0.0 && contrast < kNearContrast);
  index.features = {clamped,
                    above(clamped, 0.6),
                    above(clamped, 1.5),
                    above(clamped, 2.5),
                    below(log_contrast, kSmallestContrast),
                    index.is_critical,
                    index.is_critical * log_n2,
                    index.is_nearly_critical,
                    index.is_nearly_critical * log_n2,
                    flag(silvery > 0.0),
                    silvery};
  return index;
}

std::array<double, DoubtModel::kOwn> DoubtModel::own_features(double relative_doubt) const {
  const double doubt = std::clamp(std::log10(relative_doubt) + digits_, kLeastDoubt, kMostDoubt);
  return {1.0, doubt, above(doubt, -1.0), above(doubt, 0.0)};
}

std::array<double, DoubtModel::kPair> DoubtModel::pair_features(const Theta& theta, const Shape& shape,
                                                                const Index& index) const {
  const double m = std::clamp(shape.log_m, kSmallestM, kLargestM);
  const double grazing = std::min(theta.log_cos, kGrazing);
  const double pole = -std::log10(std::max(theta.cos + index.pole_cos, kSmallestPole));
  const bool has_cusp = is_smith_cauchy_ && shape.cusp_digits > kNoCusp;
  const double split = flag(has_cusp) * theta.has_line;
  const double cusp = flag(has_cusp) * (1.0 - theta.has_line);
  const double size = std::clamp(shape.cusp_digits, kWeakestCusp, 0.0) + digits_;
  const double rough = above(m, -0.3);
  const double steep = m + grazing;  // log10 of m / cos(theta)
  const double oblique = above(grazing, 0.7);
  return {above(pole, 0.3),
          above(pole, 1.2),
          above(m, -0.5) * above(grazing, 1.0),
          below(m, -0.8) * grazing,
          above(steep, 0.0),
          above(steep, 1.0),
          above(m, -1.0) * above(pole, 1.0),
          above(shape.log_m, kLargestM) * grazing,
          below(shape.log_m, kSmallestM) * grazing,
          below(shape.log_m, kSmallestM) * above(theta.log_cos, kGrazing),
          shape.is_outside * flag(theta.log_cos > kGrazing),
          index.is_critical * shape.log_m,
          index.is_critical * theta.log_cos,
          index.is_nearly_critical * shape.log_m,
          index.is_nearly_critical * theta.log_cos,
          theta.has_line,
          theta.has_line * below(m, -1.0),
          theta.has_line * shape.log_q,
          cusp * above(size, -2.0),
          cusp * above(size, 0.0),
          cusp * above(size, 2.0),
          split * above(size, 0.0),
          split * above(size, 3.0),
          cusp,
          cusp * oblique,
          cusp * rough,
          cusp * rough * oblique};
}

double DoubtModel::factor(Doubted doubted, const MomentsEntry& entry, double relative_doubt) const {
  const auto i = static_cast<std::size_t>(doubted);
  const Theta& theta = thetas_[entry.theta];
  const Shape& shape = shapes_[entry.shape];
  const Index& index = indices_[entry.index];
  const double decades = score(coefficients_[i], 0, own_features(relative_doubt)) + theta.score[i] + shape.score[i] +
                         index.score[i] +
                         score(coefficients_[i], kDoubtFeatures - kPair, pair_features(theta, shape, index));
  return std::pow(10.0, std::clamp(decades, kLeastFactor, kMostFactor));
}

DoubtFeatures DoubtModel::features(const MomentsEntry& entry, double relative_doubt) const {
  const Theta& theta = thetas_[entry.theta];
  const Shape& shape = shapes_[entry.shape];
  const Index& index = indices_[entry.index];
  DoubtFeatures features{};
  auto next = features.begin();
  const auto append = [&](const auto& part) { next = std::copy(part.begin(), part.end(), next); };
  append(own_features(relative_doubt));
  append(theta.features);
  append(shape.features);
  append(index.features);
  append(pair_features(theta, shape, index));
  return features;
}

}  // namespace dolp
