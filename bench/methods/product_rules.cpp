// Product rules over the directions (theta_r, delta_phi) of the running beam. The integrand is beam_integrand().
#include "methods/product_rules.hpp"

#include <gsl/gsl_integration.h>

#include <cmath>
#include <numbers>

#include "base/processor.hpp"
#include "methods/direct_brdf.hpp"
#include "methods/method.hpp"

namespace dolp::bench {
namespace {

using std::numbers::pi;

constexpr auto kSmithBy = DirectSurface::SmithBy::kClosedForm;  // computed only once per zenith, so its time is small

Answer product_rule(const DirectSurface& surface, const Rule& rule) {
  std::vector<double> cos_azimuths;
  for (const double node : rule.nodes) cos_azimuths.push_back(std::cos(pi * node));
  Answer answer;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta_r = 0.5 * pi * rule.nodes[i];
    const RunningBeam beam = surface.beam(std::cos(theta_r), std::sin(theta_r));
    Reflected row;
    for (std::size_t j = 0; j < cos_azimuths.size(); ++j) {
      const Reflected value = beam_integrand(surface, beam, cos_azimuths[j]);
      row.i += rule.weights[j] * value.i;
      row.q += rule.weights[j] * value.q;
    }
    answer.r_i += rule.weights[i] * row.i;
    answer.r_q += rule.weights[i] * row.q;
  }
  const double factor = 0.5 * pi * pi;  // lengths of the intervals: pi/2 for theta_r, pi for delta_phi
  answer.r_i *= factor;
  answer.r_q *= factor;
  return answer;
}

class ProductRule final : public Solver {
 public:
  explicit ProductRule(Rule (*rule)(std::size_t)) : rule_(rule) {}

  Solution solve(const MomentsRequest& request, double setting) override {
    const auto count = static_cast<std::size_t>(setting);
    const Rule rule = rule_(count);
    Solution solution;
    for (std::size_t i = 0; i < request.size(); ++i) {
      solution.answers.push_back(product_rule(DirectSurface(entry_of(request, i), kSmithBy), rule));
    }
    solution.evaluations = static_cast<double>(count * count * request.size());
    return solution;
  }
  std::string where() const override { return processor_name(); }

 private:
  Rule (*rule_)(std::size_t);
};

}  // namespace

Rule midpoint_rule(std::size_t count) {
  Rule rule;
  const double step = 1.0 / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) rule.nodes.push_back((static_cast<double>(i) + 0.5) * step);
  rule.weights.assign(count, step);
  return rule;
}

Rule gauss_rule(std::size_t count) {
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> table(
      gsl_integration_glfixed_table_alloc(count), gsl_integration_glfixed_table_free);
  Rule rule{std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    gsl_integration_glfixed_point(0.0, 1.0, i, &rule.nodes[i], &rule.weights[i], table.get());
  }
  return rule;
}

std::unique_ptr<Solver> make_midpoint_rule() { return std::make_unique<ProductRule>(midpoint_rule); }
std::unique_ptr<Solver> make_gauss_rule() { return std::make_unique<ProductRule>(gauss_rule); }

}  // namespace dolp::bench
