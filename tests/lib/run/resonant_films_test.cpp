// Bands of surfaces with films that resonate. Near grazing incidence a film between a metal and the outer interface,
// which then reflects nearly everything, absorbs in narrow parts of a fringe.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <dolp/status.hpp>
#include <numbers>
#include <random>

#include "computed_scene.hpp"
#include "model/smooth_surface.hpp"
#include "spectrum/planck.hpp"

namespace dolp::resonant_films_test {
namespace {

using enum Quantity;

constexpr int kPanels = 600;           // of 20 nodes each, for the widest band below
constexpr double kTruthError = 1e-11;  // change of the sums below if kPanels is doubled, with a margin

/// Q/I of a mirror in a band, as a sum over many wavelengths.
double band_q_over_i(const SceneValues& scene, double theta_deg) {
  using Rule = boost::math::quadrature::gauss<double, 20>;
  const double cosine = std::cos(theta_deg * std::numbers::pi / 180.0);
  double i = 0.0, q = 0.0;
  const auto add = [&](double wavelength_um, double weight) {
    const SmoothAbsorptance absorbed = smooth_absorptance(scene.surface.optics_at(wavelength_um), cosine);
    const double mean = 0.5 * (absorbed.s + absorbed.p), half = 0.5 * (absorbed.s - absorbed.p);
    const double own = planck_radiance(wavelength_um, scene.emission->temperature_K);
    const double sky = scene.surroundings ? planck_radiance(wavelength_um, scene.surroundings->temperature_K) : 0.0;
    i += weight * (own * mean + sky * (1.0 - mean));
    q += weight * (own - sky) * half;
  };
  const double width_um = (scene.spectrum.max_um - scene.spectrum.min_um) / kPanels;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double middle_um = scene.spectrum.min_um + (panel + 0.5) * width_um;
    for (std::size_t j = 0; j < Rule::abscissa().size(); ++j) {
      add(middle_um - 0.5 * width_um * Rule::abscissa()[j], Rule::weights()[j]);
      add(middle_um + 0.5 * width_um * Rule::abscissa()[j], Rule::weights()[j]);
    }
  }
  return q / i;
}

struct Sample {
  const char* scene;
  double q_over_i;  ///< by band_q_over_i(), and confirmed outside this program
};
constexpr Sample kSamples[] = {
    {"surface = { n = 10.002, k = 18.082, sigma = 0, coating = [{ n = 3.3387, thickness_um = 3.9363 }, "
     "{ n = 3.1699, thickness_um = 2.3103 }, { n = 2.252, thickness_um = 3.6775 }] }\n"
     "spectrum = { band_um = [6.714, 7.008] }\nemission = { temperature_K = 300 }\n"
     "surroundings = { temperature_K = 220 }\naccuracy = { tolerance = 4.5e-3 }\ngrid = { theta_deg = [89.7687] }\n",
     -0.41074},
    {"surface = { material = \"iron\", sigma = 0, coating = [{ n = 3.8641, thickness_um = 1.1928 }, "
     "{ n = 1.8198, k = 0.00024, thickness_um = 0.1114 }, { n = 1.4528, thickness_um = 2.8404 }] }\n"
     "spectrum = { band_um = [4.0, 4.6] }\nemission = { temperature_K = 500 }\n"
     "accuracy = { tolerance = 1e-3 }\ngrid = { theta_deg = [88.1989] }\n",
     0.50051825},
};
constexpr double kPrinted = 6e-6;  // half a unit of the last printed digit of the first value, with a margin

TEST(ResonantFilms, KnownMirrors_AreWithinTheirBoundsAndTheTolerance) {
  for (const Sample& sample : kSamples) {
    for (const char* tolerance : {"1e-2", "1e-3", "1e-4", "1e-5"}) {
      const SceneValues scene = parse(sample.scene, {std::string("accuracy.tolerance=") + tolerance});
      const double right = band_q_over_i(scene, scene.grid[Axis::kTheta].front());
      EXPECT_NEAR(right, sample.q_over_i, kPrinted);
      const PointResult result = results_of(scene).front();
      EXPECT_NEAR(result[kQOverI], right, result[kErrorEstimate] + kTruthError) << tolerance;
      EXPECT_EQ(result.status & kToleranceNotMet, 0U) << tolerance;
    }
  }
}

TEST(ResonantFilms, RandomStacks_AreWithinTheirBoundsAndTheTolerance) {
  std::mt19937_64 engine(55);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  for (int trial = 0; trial < 20; ++trial) {
    std::string films;
    for (int count = 1 + trial % 3; count > 0; --count)
      films += fmt::format("{{n={},k={},thickness_um={}}}{}", between(1.2, 4.0),
                           trial % 2 == 0 ? 0.0 : std::pow(10.0, between(-5.0, -1.5)), between(0.05, 4.0),
                           count > 1 ? "," : "");
    const double from_um = between(3.0, 12.0);
    const SceneValues scene = parse(fmt::format(
        "surface={{n={},k={},sigma=0,coating=[{}]}}\nspectrum={{band_um=[{},{}]}}\n"
        "emission={{temperature_K={}}}\naccuracy={{tolerance={}}}\ngrid={{theta_deg=[10,50,{},{}]}}\n",
        between(0.5, 12.0), between(5.0, 60.0), films, from_um, from_um * between(1.03, 1.6), between(250.0, 500.0),
        std::pow(10.0, between(-4.5, -2.0)), between(80.0, 88.0), between(88.8, 89.9)));
    const std::vector<PointResult> results = results_of(scene);
    for (std::size_t i = 0; i < results.size(); ++i) {
      const double theta_deg = scene.grid[Axis::kTheta][i];
      EXPECT_NEAR(results[i][kQOverI], band_q_over_i(scene, theta_deg), results[i][kErrorEstimate] + kTruthError)
          << trial << ", " << theta_deg << " degrees";
      EXPECT_EQ(results[i].status & kToleranceNotMet, 0U) << trial << ", " << theta_deg << " degrees";
    }
  }
}

}  // namespace
}  // namespace dolp::resonant_films_test
