#include "reference_values/reference_cases.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace dolp::reference {
namespace {

// Smallest q of random cases with smith masking. With the Cauchy distribution their moments exist only for q > 1.5.
constexpr double kSmallestSmithQ = 1.53;
// Distance of the cases "beside-..." from a special zenith, see hard_cases(). It is far above rounding.
constexpr double kBeside_deg = 1e-7;

constexpr OpticalConstants kMetal{27.0, 90.0};
constexpr OpticalConstants kGoodConductor{1000.0, 1000.0};
constexpr OpticalConstants kAlmostTotal{0.5, 1e-3};

// Random numbers. The distributions of the standard library are not used, because they differ between libraries.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

 private:
  std::mt19937_64 engine_;
};

/// A range from which random points are drawn.
struct Domain {
  const char* name;
  double sigma_min, sigma_max, q_min, q_max, theta_max_deg;
};
constexpr Domain kDomainA{"random-a", 0.01, 1.2, 1.06, 13.0, 89.5};
constexpr Domain kDomainB{"random-b", 0.001, 5.0, 1.01, 45.0, 89.9};

OpticalConstants random_index(Draw& draw) {
  const double kind = draw.uniform(0.0, 3.0);
  if (kind < 1.0) return {draw.uniform(1.3, 4.0), 0.0};
  if (kind < 2.0) return {draw.uniform(1.3, 4.0), draw.log_uniform(1e-3, 1.0)};
  return {draw.log_uniform(0.2, 27.0), draw.log_uniform(1.0, 90.0)};
}

Case random_case(const Domain& domain, const Group& group, Draw& draw) {
  const bool is_grazing = draw.uniform(0.0, 1.0) < 0.2;
  Case result{domain.name};
  result.theta_deg = draw.uniform(is_grazing ? 85.0 : 0.0, domain.theta_max_deg);
  result.shape.sigma = draw.log_uniform(domain.sigma_min, domain.sigma_max);
  const bool is_smith = group.masking == Masking::kSmith;
  const double q_min = is_smith ? kSmallestSmithQ : domain.q_min;
  const double q = 1.0 + draw.log_uniform(q_min - 1.0, domain.q_max - 1.0);
  if (group.distribution == Distribution::kCauchy) result.shape.q = q;
  result.index = random_index(draw);
  return result;
}

double brewster_deg(double n) { return std::atan(n) * 180.0 / std::numbers::pi; }

std::vector<Case> directions() {
  return {{.name = "normal", .theta_deg = 0.0},
          {.name = "normal-smooth", .theta_deg = 0.0, .shape = {1e-3, 2.0}},
          {.name = "normal-rough", .theta_deg = 0.0, .shape = {5.0, 2.0}},
          {.name = "normal-albedo", .theta_deg = 0.0, .shape = {1.0 / std::numbers::sqrt2, 2.0}, .index = kMetal},
          {.name = "almost-normal", .theta_deg = 1e-6},
          {.name = "almost-normal-smooth", .theta_deg = 1e-6, .shape = {1e-4, 2.0}},
          {.name = "almost-normal-metal", .theta_deg = 1e-6, .index = kMetal},
          {.name = "split-lines-90/7", .theta_deg = 12.857142857},
          {.name = "split-lines-18", .theta_deg = 18.0},
          {.name = "split-lines-30", .theta_deg = 30.0},
          {.name = "split-lines-30-smooth", .theta_deg = 30.0, .shape = {1e-3, 2.0}},
          {.name = "split-lines-30-rough", .theta_deg = 30.0, .shape = {5.0, 2.0}},
          {.name = "beside-30", .theta_deg = 30.0 + kBeside_deg},
          {.name = "split-lines-45", .theta_deg = 45.0},
          {.name = "beside-45", .theta_deg = 45.0 - kBeside_deg},
          {.name = "brewster", .theta_deg = brewster_deg(1.508)},
          {.name = "brewster-smooth", .theta_deg = brewster_deg(1.508), .shape = {1e-2, 2.0}},
          {.name = "brewster-mirror", .theta_deg = brewster_deg(1.508), .shape = {0.0, 2.0}},
          {.name = "almost-grazing", .theta_deg = 89.99},
          {.name = "almost-grazing-smooth", .theta_deg = 89.99, .shape = {1e-3, 2.0}},
          {.name = "almost-grazing-rough", .theta_deg = 89.99, .shape = {5.0, 2.0}},
          {.name = "almost-grazing-metal", .theta_deg = 89.99, .index = kMetal},
          {.name = "almost-grazing-89.999", .theta_deg = 89.999},
          {.name = "grazing-limit", .theta_deg = 90.0 - 1e-9},
          {.name = "grazing-limit-metal", .theta_deg = 90.0 - 1e-9, .index = kMetal},
          {.name = "grazing", .theta_deg = 90.0},
          {.name = "grazing-smooth", .theta_deg = 90.0, .shape = {1e-2, 2.0}},
          {.name = "grazing-metal", .theta_deg = 90.0, .index = kMetal}};
}

std::vector<Case> roughnesses() {
  return {{.name = "ordinary"},
          {.name = "mirror", .shape = {0.0, 2.0}},
          {.name = "mirror-normal", .theta_deg = 0.0, .shape = {0.0, 2.0}},
          {.name = "mirror-grazing", .theta_deg = 89.99, .shape = {0.0, 2.0}},
          {.name = "mirror-metal", .shape = {0.0, 2.0}, .index = kMetal},
          {.name = "mirror-total-reflection", .shape = {0.0, 2.0}, .index = {0.5, 0.0}},
          {.name = "sigma-1e-4", .shape = {1e-4, 2.0}},
          {.name = "sigma-1e-4-metal", .shape = {1e-4, 2.0}, .index = kMetal},
          {.name = "sigma-1e-3", .shape = {1e-3, 2.0}},
          {.name = "sigma-1e-2", .shape = {1e-2, 2.0}},
          {.name = "sigma-1e-2-grazing", .theta_deg = 89.0, .shape = {1e-2, 2.0}},
          {.name = "sigma-5", .shape = {5.0, 2.0}},
          {.name = "sigma-5-metal", .shape = {5.0, 2.0}, .index = kMetal},
          {.name = "sigma-5-grazing", .theta_deg = 89.0, .shape = {5.0, 2.0}},
          {.name = "sigma-10", .shape = {10.0, 2.0}}};
}

std::vector<Case> indices() {
  return {{.name = "vacuum", .index = {1.0, 0.0}},
          {.name = "vacuum-grazing", .theta_deg = 89.0, .index = {1.0, 0.0}},
          {.name = "almost-vacuum", .index = {1.0001, 0.0}},
          {.name = "total-reflection", .index = {0.5, 0.0}},
          {.name = "total-reflection-normal", .theta_deg = 0.0, .index = {0.5, 0.0}},
          {.name = "total-reflection-critical", .theta_deg = 30.0, .shape = {0.05, 2.0}, .index = {0.5, 0.0}},
          {.name = "total-reflection-smooth", .theta_deg = 30.0, .shape = {1e-3, 2.0}, .index = {0.5, 0.0}},
          {.name = "total-reflection-rough", .shape = {5.0, 2.0}, .index = {0.9, 0.0}},
          {.name = "almost-total-reflection", .index = kAlmostTotal},
          {.name = "almost-total-reflection-89.999", .theta_deg = 89.999, .index = kAlmostTotal},
          {.name = "index-0.9", .theta_deg = 80.0, .index = {0.9, 1e-3}},
          {.name = "index-0.2-3", .index = {0.2, 3.0}},
          {.name = "index-0.2-3-normal", .theta_deg = 0.0, .index = {0.2, 3.0}},
          {.name = "index-0.2-3-grazing", .theta_deg = 89.0, .index = {0.2, 3.0}},
          {.name = "index-4-grazing", .theta_deg = 89.0, .index = {4.0, 0.0}},
          {.name = "index-27-90", .index = kMetal},
          {.name = "index-27-90-normal", .theta_deg = 0.0, .index = kMetal},
          {.name = "index-27-90-smooth", .shape = {0.05, 3.0}, .index = kMetal},
          {.name = "index-27-90-grazing", .theta_deg = 89.0, .index = kMetal},
          {.name = "index-1000-1000", .index = kGoodConductor},
          {.name = "index-1000-1000-normal", .theta_deg = 0.0, .index = kGoodConductor},
          {.name = "index-1000-1000-grazing", .theta_deg = 89.9, .index = kGoodConductor}};
}

std::vector<Case> exponents() {
  return {{.name = "q-1.001", .shape = {0.3, 1.001}},
          {.name = "q-1.001-normal", .theta_deg = 0.0, .shape = {0.3, 1.001}},
          {.name = "q-1.001-smooth", .shape = {0.01, 1.001}},
          {.name = "q-1.001-rough", .shape = {5.0, 1.001}},
          {.name = "q-1.001-grazing", .theta_deg = 89.0, .shape = {0.3, 1.001}},
          {.name = "q-1.07-grazing", .theta_deg = 89.0, .shape = {0.3, 1.07}},
          {.name = "q-1.5-below", .shape = {0.3, 1.5 - 1e-9}},
          {.name = "q-1.5", .shape = {0.3, 1.5}},
          {.name = "q-1.5-grazing", .theta_deg = 89.99, .shape = {0.3, 1.5}},
          {.name = "q-1.5-above", .shape = {0.3, 1.5 + 1e-9}},
          {.name = "q-1.501", .shape = {0.3, 1.501}},
          {.name = "q-1.6-at-90", .theta_deg = 90.0, .shape = {0.3, 1.6}},
          {.name = "q-50", .shape = {0.3, 50.0}},
          {.name = "q-50-rough", .shape = {5.0, 50.0}},
          {.name = "q-50-grazing", .theta_deg = 89.0, .shape = {0.3, 50.0}},
          {.name = "q-1000", .shape = {0.3, 1000.0}},
          {.name = "q-1000-normal", .theta_deg = 0.0, .shape = {0.3, 1000.0}},
          {.name = "q-1000-smooth", .shape = {1e-3, 1000.0}},
          {.name = "q-1000-rough", .shape = {5.0, 1000.0}},
          {.name = "q-1000-grazing", .theta_deg = 89.0, .shape = {0.3, 1000.0}},
          {.name = "q-10000", .shape = {0.3, 10000.0}}};
}

}  // namespace

std::vector<Case> hard_cases(const Group& group) {
  const bool is_cauchy = group.distribution == Distribution::kCauchy;
  const bool is_smith = group.masking == Masking::kSmith;
  std::vector<Case> cases;
  const auto append = [&](const std::vector<Case>& more) { cases.insert(cases.end(), more.begin(), more.end()); };
  append(directions());
  append(roughnesses());
  append(indices());
  if (is_cauchy) append(exponents());
  std::erase_if(cases, [&](const Case& c) {
    const bool lacks_mean_slope = is_cauchy && is_smith && c.shape.q <= 1.5;
    const bool vanishes = c.theta_deg == 90.0 && (is_smith || group.masking == Masking::kVCavity);
    return lacks_mean_slope || vanishes;
  });
  return cases;
}

std::vector<Case> random_cases(const Group& group, std::uint64_t seed, std::size_t count_a, std::size_t count_b) {
  Draw draw(seed);
  std::vector<Case> cases;
  for (std::size_t i = 0; i < count_a; ++i) cases.push_back(random_case(kDomainA, group, draw));
  for (std::size_t i = 0; i < count_b; ++i) cases.push_back(random_case(kDomainB, group, draw));
  return cases;
}

}  // namespace dolp::reference
