// make_groove_cases FILE.csv: writes moments that the reference computes for V-grooves with all bounces. Tests compare
// the kernels with these moments. Each line has one entry: a zenith angle, a roughness and a refractive index. Some
// entries are chosen because they are hard to compute, the others are random. The program takes minutes.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibrate/random_entries.hpp"
#include "model/choices.hpp"
#include "reference/reference_evaluator.hpp"

namespace {

using namespace dolp;

// Relative tolerance of the reference: a tenth of the smallest tolerance in the tests of grooves. The reference misses
// this tolerance for some steep surfaces and for some with q near 1. So the file contains the error of each moment.
constexpr double kTolerance = 1e-7;
// A random entry is left out if the reference gives its r_i with a relative error above this number.
constexpr double kLeastKnown = 1e-3;
constexpr std::uint64_t kSeed = 20261122;
// Numbers of random entries of Domain::kOrdinary and Domain::kCorners, for each slope distribution.
constexpr int kOrdinary = 12;
constexpr int kCorners = 18;

struct Case {
  MomentsPoint point;
  std::string name;
};

std::vector<Case> hard_cases(Distribution distribution) {
  constexpr OpticalConstants kPaint{1.5, 0.1};
  constexpr OpticalConstants kMetal{10.0, 60.0};
  constexpr OpticalConstants kLessThanOne{0.7, 0.0};
  std::vector<Case> cases{{{60.0, {10.0, 2.0}, kMetal}, "steep-metal"},
                          {{0.0, {10.0, 2.0}, {27.0, 90.0}}, "steep-normal"},
                          {{85.0, {10.0, 3.0}, {1.5, 0.0}}, "steep-dielectric"},
                          {{45.0, {3.0, 2.0}, {0.5, 0.0}}, "steep-total-reflection"},
                          {{0.0, {0.5, 2.0}, kMetal}, "normal-metal"},
                          {{1e-6, {0.3, 2.0}, kPaint}, "almost-normal"},
                          {{60.0, {0.3, 2.0}, kMetal}, "metal"},
                          {{80.0, {0.3, 2.0}, {0.2, 3.0}}, "metal-small-n"},
                          {{89.999, {0.3, 2.0}, kPaint}, "almost-grazing"},
                          {{89.999, {0.5, 2.0}, kMetal}, "almost-grazing-metal"},
                          {{90.0 - 1e-9, {0.3, 2.0}, kPaint}, "grazing-limit"},
                          {{90.0 - 1e-9, {0.5, 3.0}, kMetal}, "grazing-limit-metal"},
                          {{30.0, {0.3, 3.0}, kLessThanOne}, "total-reflection"},
                          {{80.0, {0.2, 3.0}, kLessThanOne}, "total-reflection-80"},
                          {{44.427, {0.3, 3.0}, kLessThanOne}, "critical-angle"},
                          {{60.0, {1e-4, 3.0}, kMetal}, "sigma-1e-4"}};
  if (distribution == Distribution::kGaussian) return cases;
  const std::vector<Case> heavy{{{60.0, {0.3, 1.001}, kPaint}, "q-1.001"},
                                {{30.0, {0.1, 1.001}, kMetal}, "q-1.001-metal"},
                                {{89.999, {0.3, 1.02}, kPaint}, "q-1.02-grazing"},
                                {{60.0, {10.0, 1.02}, kMetal}, "q-1.02-steep"},
                                {{60.0, {0.3, 1000.0}, kPaint}, "q-1000"}};
  cases.insert(cases.end(), heavy.begin(), heavy.end());
  return cases;
}

std::vector<Case> all_cases(Distribution distribution) {
  std::vector<Case> cases = hard_cases(distribution);
  Draws draw(kSeed);
  for (int i = 0; i < kOrdinary + kCorners; ++i) {
    const bool is_ordinary = i < kOrdinary;
    const Domain domain = is_ordinary ? Domain::kOrdinary : Domain::kCorners;
    cases.push_back(
        {random_entry(draw, domain, distribution, Masking::kVCavity), is_ordinary ? "ordinary" : "corners"});
  }
  return cases;
}

std::string lines_of(Distribution distribution) {
  const std::vector<Case> cases = all_cases(distribution);
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = Masking::kVCavity;
  request.scattering = Scattering::kMultiple;
  request.tolerance = 0.0;
  for (const Case& of : cases) request.append(of.point);
  const std::vector<Moments> moments =
      ReferenceEvaluator({.relative_tolerance = kTolerance}).evaluate(request, [](std::size_t done, std::size_t all) {
        std::fprintf(stderr, "\r%zu of %zu ", done, all);
        return true;
      });
  std::string text;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [theta_deg, shape, index] = cases[i].point;
    const Moments& m = moments[i];
    const bool is_random = cases[i].name == "ordinary" || cases[i].name == "corners";
    if (is_random && !(m.r_i_error <= kLeastKnown * m.r_i)) continue;
    text += fmt::format("{},v-cavity,{},{},{},{},{},{},{},{},{},{:.3g},{:.3g},{:.3g},{:.3g},{},adaptive quadrature\n",
                        to_name(distribution), theta_deg, shape.sigma, shape.q, index.n, index.k, m.r_i, m.r_q,
                        m.albedo, m.deficit, 1.01 * m.r_i_error, 1.01 * m.r_q_error, 1.01 * m.albedo_error,
                        1.01 * m.deficit_error, cases[i].name);
  }
  return text;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: make_groove_cases FILE.csv\n");
    return 2;
  }
  try {
    std::ofstream file(arguments[1]);
    file << "# make_groove_cases groove_cases.csv\n"
            "distribution,masking,theta_deg,sigma,q,n,k,r_i,r_q,albedo,deficit,r_i_error,r_q_error,albedo_error,"
            "deficit_error,case,origin\n"
         << lines_of(Distribution::kCauchy) << lines_of(Distribution::kGaussian);
    if (!file.flush()) throw std::runtime_error("cannot write the file");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_groove_cases: %s\n", error.what());
    return 4;
  }
  return 0;
}
