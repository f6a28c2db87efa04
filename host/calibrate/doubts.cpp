#include "calibrate/doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "base/parallel_ranges.hpp"
#include "calibrate/calibration.hpp"
#include "evaluate/cpu/text.hpp"
#include "model/angles.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"

namespace dolp {
namespace {

constexpr std::array kDigits = {3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.5, 15.0};

// Stored cases: tolerances from 1e-2 to 1e-15 in the steps that attempts take.
constexpr double kStoredFirst = 2.0;
constexpr double kStoredStep = 0.5;
constexpr std::size_t kStoredSteps = 27;

constexpr double kManyDigits = 8.5;  // from here on half as many entries
constexpr double kFinerBy = 1e-4;
constexpr double kFinest = 1e-15;
constexpr double kDoubleRoundoff = 0x1p-53;
constexpr double kCoreShare = 0.6;
constexpr double kGrazingShare = 0.25;  // of the core
constexpr std::size_t kAtOnce = 1000;   // entries whose masking tables are in memory

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(engine_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  // Round values, at which breakpoints coincide and exponents are integers.
  double round(std::span<const double> values) {
    return values[std::min(static_cast<std::size_t>(uniform(0.0, static_cast<double>(values.size()))),
                           values.size() - 1)];
  }

 private:
  std::mt19937_64 engine_;
};

constexpr std::array kRoundSigmas = {0.05, 0.1, 0.2, 0.3, 0.445, 0.5, 0.905, 1.0};
constexpr std::array kRoundExponents = {1.6, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 8.0};

double theta_deg(Draw& draw, bool is_core) {
  if (draw.chance(0.03)) return draw.chance(0.5) ? 0.0 : 90.0;
  if (draw.chance(0.1)) return 5.0 * std::floor(draw.uniform(0.0, 18.0));
  if (is_core) return draw.chance(kGrazingShare) ? 90.0 - draw.log_uniform(1e-4, 10.0) : draw.uniform(0.0, 89.5);
  if (draw.chance(0.35)) return 90.0 - draw.log_uniform(1e-5, 10.0);
  return draw.chance(0.15) ? draw.log_uniform(1e-3, 10.0) : draw.uniform(0.0, 90.0);
}

SlopeShape shape(Draw& draw, bool is_core, bool is_smith_cauchy) {
  SlopeShape drawn;
  drawn.sigma = is_core ? draw.log_uniform(0.01, 1.2) : draw.log_uniform(draw.chance(0.3) ? 1e-4 : 3e-3, 10.0);
  if (draw.chance(0.1)) drawn.sigma = draw.round(kRoundSigmas);
  const double core_least = is_smith_cauchy ? 0.53 : 0.06;
  const double least = is_smith_cauchy ? 0.501 : 0.001;
  drawn.q = 1.0 + (is_core ? draw.log_uniform(core_least, 12.0)
                           : draw.log_uniform(draw.chance(0.3) ? least : core_least, draw.chance(0.2) ? 1e4 : 40.0));
  if (draw.chance(0.15)) drawn.q = draw.round(kRoundExponents);
  if (!is_core && is_smith_cauchy && draw.chance(0.2)) drawn.q = 1.5 + draw.log_uniform(5e-4, 0.1);
  return drawn;
}

OpticalConstants index(Draw& draw, bool is_core, double theta) {
  // The critical angle, or next to it.
  if (!is_core && draw.chance(0.08)) {
    const double beside = draw.chance(0.3) ? 0.0 : draw.log_uniform(1e-9, 1e-1);
    return {std::max(cos_sin_deg(theta).sin * (1.0 + (draw.chance(0.5) ? beside : -beside)), 1e-3), 0.0};
  }
  if (!is_core && draw.chance(0.3)) {
    const double kind = draw.uniform(0.0, 5.0);
    if (kind > 4.0) return {draw.log_uniform(1e-3, 0.2), draw.log_uniform(0.3, 30.0)};
    if (kind < 1.0) return {draw.log_uniform(0.01, 1.0), draw.chance(0.7) ? 0.0 : draw.log_uniform(1e-4, 0.3)};
    if (kind < 2.0) return {draw.uniform(0.1, 1.5), draw.log_uniform(1e-5, 2.0)};
    if (kind < 3.0) return {1.0 + draw.log_uniform(1e-5, 0.3), draw.chance(0.5) ? 0.0 : draw.log_uniform(1e-5, 0.3)};
    return {draw.log_uniform(0.1, 1e6), draw.log_uniform(1e-3, 1e6)};
  }
  const double kind = draw.uniform(0.0, 3.0);
  if (kind < 1.0) return {draw.uniform(1.3, 4.0), 0.0};
  if (kind < 2.0) return {draw.uniform(1.3, 4.0), draw.log_uniform(1e-3, 1.0)};
  return {draw.log_uniform(0.2, 27.0), draw.log_uniform(1.0, 90.0)};
}

double excess(double error, double other_bounds, double doubt) {
  if (!(doubt > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log10(std::max(error - other_bounds, 0.0) / doubt);
}

DoubtSample sample(const KernelData& data, const MomentsEntry& entry, const kernel::MomentsNode& node,
                   const Moments& truth) {
  kernel::MomentsNode silent = node;
  silent.doubt = 0.0;
  silent.deficit_doubt = 0.0;
  const double other_reflected = moments_from_kernel(silent, data, entry, kDoubleRoundoff).r_q_error;
  silent.doubt = std::numeric_limits<double>::infinity();  // so that the deficit's bound is its own
  const double other_deficit = moments_from_kernel(silent, data, entry, kDoubleRoundoff).deficit_error;
  const double error = std::max(std::abs(node.r_i - truth.r_i), std::abs(node.r_q - truth.r_q));
  DoubtSample result;
  result.digits = data.rule.digits;
  result.excess[0] = excess(error, other_reflected + truth.r_i_error, node.doubt);
  result.excess[1] =
      excess(std::abs(node.deficit - truth.deficit), other_deficit + truth.deficit_error, node.deficit_doubt);
  result.features[0] = data.doubts.features(entry, node.doubt / std::abs(node.r_i));
  result.features[1] = data.doubts.features(entry, node.deficit_doubt / node.deficit_scale);
  return result;
}

double tolerance_of(Masking masking, double digits) {
  return std::pow(10.0, rule_model(masking).margin_digits - digits);
}

// The kernel's text over a request, entry by entry.
class Kernel {
 public:
  explicit Kernel(const MomentsRequest& request) : data_(kernel_data(request)), text_(make_kernel_text_double(data_)) {}

  const KernelData& data() const { return data_; }

  kernel::MomentsNode moments(std::size_t i) {
    if (data_.needs_masking_table()) text_->build_masking_table(i);
    return text_->moments(data_.entries[i]);
  }

 private:
  KernelData data_;
  std::unique_ptr<KernelText> text_;
};

void add_entry(MomentsRequest& request, double theta, const SlopeShape& shape, const OpticalConstants& index) {
  const auto number = static_cast<std::uint32_t>(request.entries.size());
  request.theta_deg.push_back(theta);
  request.shapes.push_back(shape);
  request.indices.push_back(index);
  request.entries.push_back({number, number, number});
}

// `count` entries at one number of digits.
std::vector<DoubtSample> samples_at(MomentsRequest request, double digits, std::size_t count, Draw& draw) {
  const bool is_smith_cauchy = request.masking == Masking::kSmith && request.distribution == Distribution::kCauchy;
  request.tolerance = tolerance_of(request.masking, digits);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_core = draw.chance(kCoreShare);
    const double theta = theta_deg(draw, is_core);
    const SlopeShape slopes = shape(draw, is_core, is_smith_cauchy);
    add_entry(request, theta, slopes, index(draw, is_core, theta));
  }
  Kernel kernel(request);
  request.tolerance = std::max(kFinerBy * request.tolerance, kFinest);
  Kernel finer(request);
  std::vector<DoubtSample> samples(count);
  const auto one = [&](std::size_t i) {
    const kernel::MomentsNode better = finer.moments(i);
    const Moments truth{.r_i = better.r_i, .r_q = better.r_q, .deficit = better.deficit};
    samples[i] = sample(kernel.data(), kernel.data().entries[i], kernel.moments(i), truth);
  };
  parallel_for(count, one, nullptr);
  return samples;
}

}  // namespace

std::vector<DoubtSample> doubt_samples(Distribution distribution, Masking masking, std::size_t count,
                                       std::uint64_t seed) {
  Draw draw(seed * 8 + static_cast<std::uint64_t>(masking) * 2 + static_cast<std::uint64_t>(distribution));
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  std::vector<DoubtSample> samples;
  for (const double digits : kDigits) {
    const std::size_t wanted = digits < kManyDigits ? count : count / 2;
    for (std::size_t done = 0; done < wanted; done += kAtOnce) {
      const std::vector<DoubtSample> drawn = samples_at(request, digits, std::min(kAtOnce, wanted - done), draw);
      samples.insert(samples.end(), drawn.begin(), drawn.end());
    }
  }
  return samples;
}

std::vector<DoubtSample> doubt_samples(Distribution distribution, Masking masking,
                                       const std::vector<StoredCase>& cases) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  std::vector<const Moments*> truths;
  for (const StoredCase& stored : cases) {
    if (stored.distribution != distribution || stored.masking != masking || !is_calibration_case(stored)) continue;
    add_entry(request, stored.theta_deg, stored.shape, stored.index);
    truths.push_back(&stored.moments);
  }
  std::vector<DoubtSample> samples(truths.size() * kStoredSteps);
  for (std::size_t t = 0; t < kStoredSteps; ++t) {
    request.tolerance = std::pow(10.0, -kStoredFirst - kStoredStep * static_cast<double>(t));
    Kernel kernel(request);
    const auto one = [&](std::size_t i) {
      DoubtSample& here = samples[t * truths.size() + i];
      here = sample(kernel.data(), kernel.data().entries[i], kernel.moments(i), *truths[i]);
    };
    parallel_for(truths.size(), one, nullptr);
  }
  return samples;
}

}  // namespace dolp
