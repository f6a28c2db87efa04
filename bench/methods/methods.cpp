// The list of the methods that the study `accuracy` compares.
#include "methods/method.hpp"
#include "model/choices.hpp"

namespace dolp::bench {
namespace {

void add_rules(std::vector<Method>& list) {
  list.push_back({.name = "midpoint",
                  .label = "midpoint rule",
                  .what = "midpoint product rule in (theta_r, delta_phi), plain formulas, C++ double",
                  .cores = "1",
                  .setting_name = "nodes per axis",
                  .settings = {8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096},
                  .quick_settings = {32, 128, 512},
                  .make = [](const SolverOptions&) { return make_midpoint_rule(); }});
  list.push_back(
      {.name = "gauss",
       .label = "Gauss-Legendre rule",
       .what = "Gauss-Legendre product rule in (theta_r, delta_phi), plain formulas, C++ double",
       .cores = "1",
       .setting_name = "nodes per axis",
       .settings = {4, 8, 12, 16, 20, 32, 64, 96, 128, 256, 512, 1024},  // GSL stores the rules of these sizes
       .quick_settings = {16, 64, 256},
       .make = [](const SolverOptions&) { return make_gauss_rule(); }});
  list.push_back({.name = "monte-carlo",
                  .label = "Monte Carlo",
                  .what = "half vectors sampled from D cos(alpha), as a renderer does, C++ double",
                  .cores = "1",
                  .setting_name = "samples",
                  .settings = {1e2, 1e3, 1e4, 1e5, 1e6},
                  .quick_settings = {1e3, 1e5},
                  .is_random = true,
                  .make = [](const SolverOptions&) { return make_monte_carlo(); }});
}

void add_device_rules(std::vector<Method>& list) {
  list.push_back({.name = "vulkan-midpoint",
                  .label = "midpoint rule, Vulkan",
                  .what = "the midpoint rule on the Vulkan device, with dolp's Fresnel and masking tables, float",
                  .cores = "all",
                  .setting_name = "nodes per axis",
                  .settings = {8, 16, 32, 64, 128, 256, 512, 1024},
                  .quick_settings = {32, 128},
                  .is_batched = true,
                  .make = make_vulkan_midpoint});
  list.push_back({.name = "vulkan-gauss",
                  .label = "Gauss-Legendre rule, Vulkan",
                  .what = "the Gauss-Legendre rule on the Vulkan device, likewise",
                  .cores = "all",
                  .setting_name = "nodes per axis",
                  .settings = {4, 8, 12, 16, 20, 32, 64, 96, 128, 256, 512, 1024},
                  .quick_settings = {16, 64},
                  .is_batched = true,
                  .make = make_vulkan_gauss});
}

void add_adaptive(std::vector<Method>& list) {
  list.push_back(
      {.name = "hcubature",
       .label = "hcubature",
       .what = "libcubature, h-adaptive, in (theta_r, delta_phi), plain formulas, masking from tables, C++ double",
       .cores = "1",
       .setting_name = "tolerance",
       .settings = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9},
       .quick_settings = {1e-3, 1e-5, 1e-7},
       .make = [](const SolverOptions&) { return make_hcubature(); }});
  list.push_back({.name = "pcubature",
                  .label = "pcubature",
                  .what = "libcubature, p-adaptive (Clenshaw-Curtis), likewise",
                  .cores = "1",
                  .setting_name = "tolerance",
                  .settings = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9},
                  .quick_settings = {1e-3, 1e-5, 1e-7},
                  .make = [](const SolverOptions&) { return make_pcubature(); }});
  list.push_back({.name = "dblquad",
                  .label = "SciPy dblquad",
                  .what = "scipy.integrate.dblquad in (theta_r, delta_phi), plain formulas, Python",
                  .cores = "1",
                  .setting_name = "tolerance",
                  .settings = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
                  .quick_settings = {1e-2, 1e-4},
                  .make = [](const SolverOptions& options) { return make_dblquad(options); }});
}

Method evaluator(const std::string& name, Precision precision,
                 std::function<std::unique_ptr<Solver>(const SolverOptions&)> make) {
  const bool in_double = precision == Precision::kDouble;
  const std::string suffix = to_name(precision);
  const bool on_device = name == "vulkan";
  return {.name = name + "-" + suffix,
          .label = (on_device ? "dolp Vulkan " : "dolp CPU kernel ") + suffix,
          .what = on_device ? "the kernel of dolp on the Vulkan device, " + suffix
                            : "the same source compiled as C++, " + suffix,
          .cores = "all",
          .setting_name = "tolerance",
          .settings = in_double ? std::vector<double>{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}
                                : std::vector<double>{1e-2, 1e-3, 1e-4, 1e-5, 1e-6},
          .quick_settings = in_double ? std::vector<double>{1e-3, 1e-6, 1e-9} : std::vector<double>{1e-3, 1e-5},
          .is_batched = true,
          .make = std::move(make)};
}

std::vector<Method> all() {
  std::vector<Method> list;
  add_rules(list);
  add_device_rules(list);
  add_adaptive(list);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    list.push_back(evaluator("vulkan", precision,
                             [precision](const SolverOptions& options) { return make_vulkan(options, precision); }));
  }
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    list.push_back(evaluator("cpu", precision, [precision](const SolverOptions&) { return make_cpu(precision); }));
  }
  return list;
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> list = all();
  return list;
}

}  // namespace dolp::bench
