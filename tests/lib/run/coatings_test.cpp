// Tests of films and of measured reflectances, with and without scenes. Expected values come from closed forms and from
// the reference implementation (host/reference).
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <dolp/errors.hpp>
#include <dolp/status.hpp>
#include <numbers>

#include "agreement.hpp"
#include "beams/scattering.hpp"
#include "computed_scene.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "fixed_precision.hpp"
#include "model/films.hpp"
#include "model/smooth_surface.hpp"
#include "properties_support.hpp"
#include "reference/fresnel.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/scene_remarks.hpp"
#include "temporary_file.hpp"

namespace dolp::coatings_test {
namespace {

using enum Quantity;

constexpr std::uint64_t kSeed = 20261125;
constexpr double kClosedForm = 1e-12;

FacetOptics coated(const OpticalConstants& medium, std::vector<Film> films) {
  FacetOptics optics(medium);
  optics.films = std::move(films);
  return optics;
}

/// One to three films on a metal, a dielectric or an absorber. Most films absorb. Thickness: 0.01 to 1 wavelength.
FacetOptics random_coating(Random& random) {
  FacetOptics optics(random.chance(0.4) ? OpticalConstants{random.uniform(2.0, 30.0), random.uniform(10.0, 90.0)}
                                        : OpticalConstants{random.uniform(1.1, 3.5), random.log_uniform(1e-3, 0.5)});
  for (std::size_t i = random.count(1, 3); i > 0; --i) {
    const double k = random.chance(0.3) ? 0.0 : random.log_uniform(1e-3, 1.0);
    optics.films.push_back({{random.uniform(0.6, 3.0), k}, random.log_uniform(0.01, 1.0)});
  }
  return optics;
}

double distance(const FilmReflection& a, const FilmReflection& b) {
  return std::abs(a.r_s - b.r_s) + std::abs(a.r_p - b.r_p) + std::abs(a.cross - b.cross);
}

std::string text_of(const FacetOptics& optics) {
  std::string text = fmt::format("n {:.17g} k {:.17g}", optics.index.n, optics.index.k);
  for (const Film& film : optics.films)
    text += fmt::format(", film n {:.17g} k {:.17g} d/lambda {:.17g} +- {:.17g}", film.index.n, film.index.k,
                        film.thickness, film.spread);
  return text;
}

// ---- Smooth surfaces -----------------------------------------------------------------------------------------------

TEST(Films, WithoutThickness_AreTheBareMedium) {
  const OpticalConstants medium{1.8, 0.4};
  for (const double cosine : {1.0, 0.6, 0.05}) {
    const SmoothAbsorptance bare = smooth_absorptance(medium, cosine);
    const SmoothAbsorptance films = smooth_absorptance(coated(medium, {{{2.4, 0.1}, 0.0}, {{0.7, 0.2}, 0.0}}), cosine);
    EXPECT_NEAR(films.s, bare.s, kClosedForm);
    EXPECT_NEAR(films.p, bare.p, kClosedForm);
    EXPECT_NEAR(films.split, bare.split, 1e-9);
  }
}

TEST(Films, QuarterWaveOfTheRootOfTheIndex_DoesNotReflectAtNormalIncidence) {
  const double n = std::sqrt(2.25);
  const SmoothAbsorptance absorbed = smooth_absorptance(coated({2.25, 0.0}, {{{n, 0.0}, 0.25 / n}}), 1.0);
  EXPECT_NEAR(absorbed.s, 1.0, kClosedForm);
  EXPECT_NEAR(absorbed.p, 1.0, kClosedForm);
}

TEST(Films, OfOneIndex_AddTheirThicknesses) {
  const OpticalConstants film{1.6, 0.03};
  for (const double cosine : {0.9, 0.3}) {
    const FilmReflection two = film_reflection(coated({27.0, 90.0}, {{film, 0.3}, {film, 0.5}}), cosine);
    const FilmReflection one = film_reflection(coated({27.0, 90.0}, {{film, 0.8}}), cosine);
    EXPECT_LT(distance(two, one), kClosedForm);
  }
}

TEST(Films, Reflection_AgreesWithCharacteristicMatrices) {
  Random random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    const FacetOptics optics = random_coating(random);
    const double cosine = random.chance(0.2) ? random.log_uniform(1e-6, 1.0) : random.uniform(0.01, 1.0);
    const reference::FresnelCoefficients right = reference::fresnel(optics, cosine);
    const FilmReflection expected{std::norm(right.r_s), std::norm(right.r_p), std::conj(right.r_s) * right.r_p};
    EXPECT_LT(distance(film_reflection(optics, cosine), expected), 1e-11) << text_of(optics) << " at " << cosine;
    const SmoothAbsorptance absorbed = smooth_absorptance(optics, cosine);
    const double sin2 = (1.0 - cosine) * (1.0 + cosine);
    EXPECT_NEAR(absorbed.split * sin2, std::norm(right.r_s) - std::norm(right.r_p), 1e-11) << text_of(optics);
  }
}

// ---- Films of varying thickness ------------------------------------------------------------------------------------

/// The mean over single thicknesses, from the reference.
FilmReflection mean_of_stacks(const FacetOptics& optics, double cosine) {
  FilmReflection mean;
  for (const auto& [stack, weight] : reference::single_stacks(optics, cosine)) {
    const reference::FresnelCoefficients r = reference::fresnel(stack, cosine);
    mean.r_s += weight * std::norm(r.r_s);
    mean.r_p += weight * std::norm(r.r_p);
    mean.cross += weight * std::conj(r.r_s) * r.r_p;
  }
  return mean;
}

TEST(FilmSpread, OfZeroWidth_ChangesNothing) {
  Random random(kSeed);
  for (int i = 0; i < 50; ++i) {
    const FacetOptics optics = random_coating(random);
    FacetOptics spread = optics;
    spread.films.front().spread = 1e-7;  // of a wavelength; changes r by the square of the phase 1e-6
    EXPECT_LT(distance(film_reflection(spread, 0.6), film_reflection(optics, 0.6)), 1e-8) << text_of(optics);
  }
}

// Without interference a transparent film reflects R1 + (1 - R1)^2 R2 / (1 - R1 R2), with the reflectances R1 of its
// outer and R2 of its inner interface.
TEST(FilmSpread, OfManyWavelengths_AddsIntensities) {
  const OpticalConstants film{1.5, 0.0}, metal{27.0, 90.0};
  for (const double cosine : {1.0, 0.5, 0.1}) {
    const FilmReflection r = film_reflection(coated(metal, {{film, 50.0, 4.0}}), cosine);
    const SmoothAbsorptance outer = smooth_absorptance(film, cosine);
    const std::complex<double> q = std::sqrt(std::complex<double>(1.25 + cosine * cosine)), n2 = 2.25;
    const std::complex<double> m2 = std::complex(27.0, 90.0) * std::complex(27.0, 90.0);
    const std::complex<double> q_metal = std::sqrt(m2 - 1.0 + cosine * cosine);
    const double inner_s = std::norm((q - q_metal) / (q + q_metal));
    const double inner_p = std::norm((m2 * q - n2 * q_metal) / (m2 * q + n2 * q_metal));
    const auto sum = [](double first, double second) {
      return first + (1.0 - first) * (1.0 - first) * second / (1.0 - first * second);
    };
    EXPECT_NEAR(r.r_s, sum(1.0 - outer.s, inner_s), 1e-9) << cosine;
    EXPECT_NEAR(r.r_p, sum(1.0 - outer.p, inner_p), 1e-9) << cosine;
  }
}

TEST(FilmSpread, RandomStacks_AreMeansOverTheThickness) {
  constexpr double kMeanError = 2e-8;    // largest found: 4e-9
  constexpr double kErrorAtZero = 4e-6;  // if thicknesses below 0 are left out
  Random random(kSeed);
  for (int i = 0; i < 400; ++i) {
    FacetOptics optics = random_coating(random);
    Film& film = optics.films[random.count(0, optics.films.size() - 1)];
    film.thickness = random.log_uniform(0.05, 20.0);
    film.spread = film.thickness * random.log_uniform(1e-3, 1.0);
    if (is_too_wide(film)) film.spread = 0.2 * film.thickness;
    const double cosine =
        random.uniform(0.05, 1.0);  // nearer to grazing incidence the rule of the reference is too coarse
    const double most = film.thickness < 8.0 * film.spread ? kErrorAtZero : kMeanError;
    EXPECT_LT(distance(film_reflection(optics, cosine), mean_of_stacks(optics, cosine)), most)
        << text_of(optics) << " at " << cosine;
  }
}

TEST(FilmSpread, OfTwoFilms_IsTheMeanOverBoth) {
  for (const double cosine : {0.9, 0.3}) {
    const FacetOptics optics = coated({3.0, 1.0}, {{{1.5, 0.02}, 1.0, 0.05}, {{2.2, 0.0}, 0.5, 0.02}});
    EXPECT_LT(distance(film_reflection(optics, cosine), mean_of_stacks(optics, cosine)), 1e-8);
  }
}

// ---- Moments and beams ---------------------------------------------------------------------------------------------

/// Compares moments of random coatings with the reference. Coating i has model i of kModels, modulo their number.
void expect_within_bounds_of_reference(Precision precision, double tolerance, std::uint64_t seed, std::size_t draws) {
  Random random(seed);
  FixedPrecision evaluator(precision);
  ReferenceEvaluator reference;
  for (std::size_t i = 0; i < draws; ++i) {
    MomentsRequest request;
    request.distribution = kModels[i % kModels.size()].distribution;
    request.masking = kModels[i % kModels.size()].masking;
    request.wants_direct = request.masking == Masking::kSmith || request.masking == Masking::kVCavity;
    request.tolerance = tolerance;
    const MomentsPoint point{
        random.uniform(0.0, 88.0), {random.log_uniform(0.02, 1.0), random.uniform(1.8, 6.0)}, random_coating(random)};
    request.append(point);
    const Moments own = evaluator.evaluate(request, {}).front();
    const Moments right = reference.evaluate(request, {}).front();
    const std::string where = fmt::format("theta {:.17g} sigma {:.17g} q {:.17g} {}", point.theta_deg,
                                          point.shape.sigma, point.shape.q, text_of(point.index));
    expect_within_bounds(own, right, where);
    EXPECT_LT(own.r_i_error, 30.0 * tolerance * right.r_i + 1e-6) << where;
  }
}

TEST(Coatings, MomentsInFloat_AreWithinTheirBoundsOfTheReference) {
  expect_within_bounds_of_reference(Precision::kFloat, 1e-4, kSeed + 1, draws_wanted(32));
}

TEST(Coatings, MomentsInDouble_AreWithinTheirBoundsOfTheReference) {
  expect_within_bounds_of_reference(Precision::kDouble, 1e-6, kSeed + 2, draws_wanted(24));
}

// At 90 degrees facets that just turn away from the viewer have cos(beta) = 0, up to the rounding of a device.
TEST(Coatings, DirectEmissionAtTheHorizon_IsWithinItsBoundsOfDouble) {
  FacetOptics film(2.0, 0.0);
  film.films = {{{1.45, 0.0}, 0.0}};
  VulkanEvaluator device(VulkanOptions{});
  for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
    MomentsRequest request = request_of({Distribution::kCauchy, masking}, {}, 1e-4);
    request.wants_direct = true;
    request.has_lone_entries = true;
    request.theta_deg = {89.999999};
    request.optics = {film};
    for (double sigma = 0.01; sigma < 1.0; sigma *= 1.17) {
      for (double q = 1.6; q < 9.0; q += 0.673) request.shapes.push_back({sigma, q});
    }
    request.set_grid();
    const std::vector<Moments> moments = device.evaluate(request, {});
    request.precision = Precision::kDouble;
    const std::vector<Moments> exact = device.evaluate(request, {});
    for (std::size_t i = 0; i < moments.size(); ++i)
      expect_within_bounds(moments[i], exact[i], "sigma " + std::to_string(request.shapes[i].sigma));
  }
}

TEST(Coatings, MuellerMatrices_AgreeWithTheReference) {
  Random random(kSeed + 3);
  ScatteringRequest request;
  request.masking = Masking::kSmith;
  for (std::uint32_t i = 0; i < 100; ++i) {
    request.angles.push_back({random.uniform(0.0, 85.0), random.uniform(0.0, 85.0), random.uniform(-180.0, 180.0)});
    request.shapes.push_back({random.uniform(0.1, 0.6), random.uniform(1.8, 5.0)});
    request.optics.push_back(random_coating(random));
    request.entries.push_back({i, i, i});
  }
  const std::vector<ScatteringMatrix> own = scattering_matrices(request, {});
  const std::vector<ScatteringMatrix> right = ReferenceEvaluator().scatter(request, {});
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t j = 0; j < 16; ++j) {
      EXPECT_LE(std::abs(own[i].m[j] - right[i].m[j]), own[i].error + right[i].error)
          << "element " << j << " of " << text_of(request.optics[i]);
    }
  }
}

// ---- Scenes --------------------------------------------------------------------------------------------------------

const std::string kScene = R"toml(
[surface]
n = 27.0
k = 90.0
sigma = 0.2
q = 3.0
masking = "smith"
coating = [ { n = 0.7, k = 0.1, thickness_um = 1.0 } ]
[emission]
temperature_K = 300.0
[spectrum]
wavelength_um = 10.6
[grid]
theta_deg = [60]
)toml";

SceneValues scene_with(const std::vector<std::string>& overrides) { return parse(kScene, overrides); }
PointResult result_of(const std::vector<std::string>& overrides) { return results_of(scene_with(overrides)).front(); }

TEST(Coatings, OxideOnAluminium_PolarisesTheEmissionFarMore) {
  const auto q_over_i = [](const std::vector<std::string>& overrides) { return result_of(overrides)[kQOverI]; };
  EXPECT_NEAR(q_over_i({"surface.sigma=0", "surface.coating=none"}), -0.597, 1e-3);
  EXPECT_NEAR(q_over_i({"surface.sigma=0"}), -0.945, 1e-3);
}

TEST(Coatings, EmissionOfTheSmoothSurface_IsThatOfTheFilms) {
  const PointResult result = result_of({"emission.model=fresnel"});
  const SmoothAbsorptance right =
      smooth_absorptance(coated({27.0, 90.0}, {{{0.7, 0.1}, 1.0 / 10.6}}), std::cos(std::numbers::pi / 3.0));
  EXPECT_NEAR(result[kEmissivityS], right.s, 1e-9);
  EXPECT_NEAR(result[kEmissivityP], right.p, 1e-9);
}

TEST(Coatings, GridOfIndices_KeepsItsFilms) {
  const std::vector<std::string> n_axis = {"surface.n={}", "surface.k={}", "grid.n=[1.4, 2.0]", "grid.k=[0.05, 0.4]"};
  const SceneValues scene = scene_with(n_axis);
  const SceneEntries entries = grid_entries(scene);
  const std::vector<PointResult> results = results_of(scene, entries);
  ASSERT_EQ(results.size(), 4U);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const OpticalConstants index = *entries[i].index;
    expect_agreement(results[i],
                     result_of({fmt::format("surface.n={}", index.n), fmt::format("surface.k={}", index.k)}));
  }
}

// A mirror has a closed form at each wavelength. So a sum over many wavelengths can check the integral over the band.
TEST(Coatings, BandWithThickFilms_IsWithinItsBoundOfAFineSum) {
  for (const char* thickness : {"0.5", "5", "20", "5,thickness_spread_um=0.2", "50,thickness_spread_um=4"}) {
    const std::vector<std::string> film = {
        "surface.sigma=0",
        "surface.n=1.5",
        "surface.k=0.05",
        std::string("surface.coating=[{n=2.2,k=0.01,thickness_um=") + thickness + "}]",
        "spectrum.wavelength_um={}",
        "spectrum.band_um=[8,14]"};
    const PointResult band = result_of(film);
    std::vector<std::string> one = film;
    double i = 0.0, q = 0.0;
    constexpr int kSteps = 1500;
    for (int j = 0; j < kSteps; ++j) {
      one[4] = "spectrum.band_um={}";
      one[5] = fmt::format("spectrum.wavelength_um={:.17g}", 8.0 + 6.0 * (j + 0.5) / kSteps);
      const PointResult at = result_of(one);
      i += at[kStokesI];
      q += at[kStokesQ];
    }
    EXPECT_LE(std::abs(band[kQOverI] - q / i), band[kErrorEstimate] + 1e-6) << thickness;
    EXPECT_LT(band[kErrorEstimate], 1e-4) << thickness;
  }
}

TEST(Coatings, ScenesWithAllEffects_AgreeWithTheReference) {
  const std::vector<std::string> films = {"surface.material=\"BK7 borosilicate\"", "grid.theta_deg=[70]",
                                          "surface.coating=[{material=\"PMMA acrylic\",thickness_um=3}]"};
  const std::vector<std::vector<std::string>> cases = {
      {"spectrum.band_um=[10,10.5]", "surroundings.temperature_K=240"},
      {"surroundings.profile=clear-sky", "surface.masking=integral"},
      {"emission.model=direct", "emission.bracket=true", "surroundings.temperature_K=240"},
      {"geometry.mode=bistatic", "geometry.view_zenith_deg=40", "source.irradiance=20"},
      {"grid.wavelength_um=[9, 11]", "surface.diffuse=0.2", "surface.specular=0.8"},
      {"surface.coating.1.thickness_spread_um=0.5", "surroundings.temperature_K=240"},
      {"surface.coating.1.thickness_spread_um=0.5", "geometry.mode=bistatic", "geometry.view_zenith_deg=40",
       "source.irradiance=20"}};
  for (const std::vector<std::string>& more : cases) {
    const SceneValues scene = scene_with(joined(films, more));
    ReferenceEvaluator reference({.relative_tolerance = 1e-6});
    const std::vector<PointResult> own = results_of(scene);
    const std::vector<PointResult> right = evaluate_scene(scene, grid_entries(scene), reference, {});
    for (std::size_t i = 0; i < own.size(); ++i) {
      SCOPED_TRACE(more.front() + " entry " + std::to_string(i));
      expect_agreement(own[i], right[i]);
      EXPECT_LE(own[i][kErrorEstimate], 1e-4);
      EXPECT_EQ(own[i].status & kAnyToleranceNotMet, 0U);
    }
  }
}

TEST(Coatings, ColumnsOfPoints_AreTheNumbersOfTheirFilms) {
  const std::string csv =
      "theta_deg,surface.coating.1.thickness_um,surface.coating.1.n\n60,1,0.7\n60,0.5,0.7\n30,0.5,1.5\n60,1,0.7\n";
  const SceneValues scene = scene_with({"spectrum.wavelength_um=10"});
  const SceneEntries points = point_entries(scene, parse_points(csv, "p.csv", PointsKind::kDirections));
  EXPECT_EQ(points.variants().size(), 3U);
  const std::vector<PointResult> results = results_of(scene, points);
  expect_agreement(results[2], result_of({"spectrum.wavelength_um=10", "surface.coating.1.thickness_um=0.5",
                                          "surface.coating.1.n=1.5", "grid.theta_deg=30"}));
  EXPECT_EQ(results[0][kDolp], results[3][kDolp]);
  EXPECT_GT(std::abs(results[0][kDolp] - results[1][kDolp]), 1e-3);
  const std::string spread_csv = "theta_deg,surface.coating.1.thickness_spread_um\n60,0\n60,0.3\n";
  const std::vector<PointResult> spread =
      results_of(scene, point_entries(scene, parse_points(spread_csv, "p.csv", PointsKind::kDirections)));
  EXPECT_NEAR(spread[0][kDolp], results[0][kDolp], results[0][kErrorEstimate]);
  EXPECT_GT(std::abs(spread[1][kDolp] - spread[0][kDolp]), 1e-4);
  EXPECT_THROW(
      point_entries(scene, parse_points("theta_deg,surface.coating.2.n\n60,1.5\n", "p.csv", PointsKind::kDirections)),
      InputError);
}

TEST(Coatings, SceneWritten_ReadsTheSame) {
  const SceneValues scene =
      scene_with({"surface.coating.2.material=\"PMMA acrylic\"", "surface.coating.2.thickness_um=2"});
  ASSERT_EQ(scene.surface.coating.size(), 2U);
  const SceneValues again = parse_scene(scene_toml(scene, "."), "again.toml");
  ASSERT_EQ(again.surface.coating.size(), 2U);
  EXPECT_EQ(again.surface.coating[1].thickness_um, 2.0);
  EXPECT_EQ(again.names.coating[1].material, "PMMA acrylic");
  EXPECT_EQ(again.surface.optics_at(10.6), scene.surface.optics_at(10.6));
}

TEST(Coatings, Mistakes_AreToldWithTheKeyAndWhatIsAllowed) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"surface.coating=3"}, "surface.coating=3: must be a list of at most 16 tables"},
      {{"surface.coating=[{n=1.5}]"}, "surface.coating.1.thickness_um: missing"},
      {{"surface.coating=[{thickness_um=1}]"},
       "missing; must be a number in (0, 1e6], or give one of surface.coating.1.n"},
      {{"surface.coating.1.thickness_um=-1"}, "-1 is out of range; must be a number in [0, 1000]"},
      {{"surface.coating.3.n=1.5"}, "surface.coating has 1 layers, and the next is 2"},
      {{"surface.coating.1.colour=1"}, "unknown key"},
      {{"surface.coating.1.thickness_spread_um=-1"}, "-1 is out of range; must be a number in [0, 1000]"},
      {{"surface.coating=[{n=2,thickness_um=1,thickness_spread_um=1},{n=3,thickness_um=1,thickness_spread_um=1},"
        "{n=2,thickness_um=1,thickness_spread_um=1}]"},
       "at most 2 films of a coating can have a spread"},
      {{"surface.masking=v-cavity", "surface.scattering=multiple"}, "needs no surface.coating"},
      {{"surface.n={}", "surface.k={}", "surface.reflectance_file=r.csv"}, "cannot be combined with surface.coating"},
  };
  for (const auto& [overrides, message] : cases)
    EXPECT_TRUE(contains(error_of(kScene, overrides), message)) << error_of(kScene, overrides);
  const std::string too_wide =
      error_text([] { result_of({"surface.coating=[{n=2,thickness_um=200,thickness_spread_um=100}]"}); });
  EXPECT_TRUE(contains(too_wide, "surface.coating.1.thickness_spread_um = 100: must be at most 40, a fifth"))
      << too_wide;
}

// ---- Measured reflectances -----------------------------------------------------------------------------------------

/// A CSV file with the reflectances of a smooth medium at angles of incidence in steps of `step_deg`.
std::string measured_csv(const OpticalConstants& index, double step_deg) {
  std::string csv = "beta_deg,r_s,r_p\n";
  for (double beta_deg = 0.0; beta_deg < 90.0; beta_deg += step_deg) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, std::cos(beta_deg * std::numbers::pi / 180.0));
    csv += fmt::format("{},{:.12g},{:.12g}\n", beta_deg, 1.0 - absorbed.s, 1.0 - absorbed.p);
  }
  return csv + "90,1,1\n";
}

/// The scene with the measured reflectances of a file instead of n, k and films.
SceneValues measured_scene(const TemporaryFile& file, std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(),
                   {"surface.coating=none", "surface.n={}", "surface.k={}", "surface.reflectance_file=" + file.path()});
  return scene_with(overrides);
}

/// A smooth surface with an emission model.
std::vector<std::string> smooth(const char* model) {
  return {std::string("emission.model=") + model, "surface.sigma=0", "surface.masking=v-cavity"};
}

// Light that is all reflected leaves an emission of rounding errors, which the bounds of DOLP must say. The tunnel
// through an evanescent film absorbs 1e-13 of the light.
TEST(SmoothEmission, OfRoundingErrors_HasTheStatus) {
  for (const std::vector<std::string>& own : {
           std::vector<std::string>{"surface.n=0.5", "surface.k=0", "surface.coating=[{n=1.5,thickness_um=3}]"},
           {"surface.n=1.5", "surface.k=0.1", "surface.coating=[{n=0.5,thickness_um=40}]"},
       }) {
    for (const char* model : {"fresnel", "moments", "direct"}) {
      const PointResult result = result_of(joined(smooth(model), own));
      EXPECT_NE(result.status & (kToleranceNotMet | kOutsideModelDomain), 0U) << own[0] << " " << model;
    }
  }
}

// At 90 degrees a smooth surface reflects everything, and its emission, which has become 0, keeps the polarisation of
// its limit.
TEST(SmoothEmission, AtNinetyDegrees_IsTheLimit) {
  const TemporaryFile file("measured.csv", measured_csv({1.5, 0.1}, 1.0));
  for (const std::vector<std::string>& own : {
           std::vector<std::string>{"surface.coating=[{n=1.7,k=0.02,thickness_um=3}]"},
           {"surface.coating=[{n=1.7,k=0.02,thickness_um=3,thickness_spread_um=0.5}]"},
           {"surface.coating=[{n=1.7,thickness_um=0}]"},
           {"surface.coating=[{n=1.4,k=0.1,thickness_um=2},{n=1.7,thickness_um=5}]"},
           {"surface.coating=none", "surface.n={}", "surface.k={}", "surface.reflectance_file=" + file.path()},
       }) {
    for (const char* model : {"fresnel", "moments", "direct"}) {
      SceneValues scene = scene_with(joined(smooth(model), own));
      scene.grid[Axis::kTheta] = {89.99999, 90.0};
      const std::vector<PointResult> results = results_of(scene);
      EXPECT_EQ(results[1].status, 0U) << model;
      EXPECT_GT(results[1][kDolp], 0.01) << own[0] << " " << model;
      EXPECT_NEAR(results[1][kQOverI], results[0][kQOverI], 1e-5) << own[0] << " " << model;
      EXPECT_LE(results[1][kErrorEstimate], 1e-5) << model;
    }
  }
}

TEST(MeasuredReflectances, OfAMedium_GiveNearlyItsTable) {
  const TemporaryFile file("measured.csv", measured_csv({1.5, 0.1}, 0.5));
  for (const char* masking : {"smith", "integral"}) {
    const std::string of_masking = std::string("surface.masking=") + masking;
    const PointResult measured = results_of(measured_scene(file, {of_masking})).front();
    const PointResult medium = result_of({of_masking, "surface.coating=none", "surface.n=1.5", "surface.k=0.1"});
    EXPECT_NEAR(measured[kDolp], medium[kDolp], 1e-4) << masking;
    EXPECT_NEAR(measured[kRhoI], medium[kRhoI], 1e-4) << masking;
    EXPECT_LE(measured[kErrorEstimate], 1e-4) << masking;
  }
}

// Between two rows at 0 and 90 degrees the mean of R_s and R_p is a straight line, and their difference grows like
// sin^2(beta), but at most so far that both are in [0, 1]. At 60 degrees this limit acts: without it, R_s is 1.033 in
// the first case, and R_p is -0.038 in the second.
TEST(MeasuredReflectances, WideFirstInterval_StaysWithinZeroAndOneInEveryEvaluator) {
  struct Case {
    const char* rows;
    double rho_i, rho_q;  // of the smooth surface
  };
  for (const Case& own : {Case{"0,1,1\n90,1,0.2\n", 1.0 - 0.4 * 2.0 / 3.0, 0.4 * 2.0 / 3.0},
                          {"0,0,0\n90,0.9,0\n", 0.45 * 2.0 / 3.0, 0.45 * 2.0 / 3.0},
                          {"0,0,0\n90,0,0.9\n", 0.45 * 2.0 / 3.0, -0.45 * 2.0 / 3.0}}) {
    const TemporaryFile file("measured.csv", std::string("beta_deg,r_s,r_p\n") + own.rows);
    const auto scene_of = [&](const char* sigma) {
      return measured_scene(file, {"surface.masking=smith", "surface.q=3", std::string("surface.sigma=") + sigma,
                                   "grid.theta_deg=[60]", "accuracy.tolerance=1e-3"});
    };
    const PointResult mirror = results_of(scene_of("0")).front();
    EXPECT_NEAR(mirror[kRhoI], own.rho_i, 1e-14) << own.rows;
    EXPECT_NEAR(mirror[kRhoQ], own.rho_q, 1e-14) << own.rows;
    // Facets with slopes of a few sigma see other angles of incidence. R changes by at most 1.6 per radian.
    constexpr double kSpread = 0.01;
    const SceneValues rough = scene_of("1e-3");
    const PointResult kernels = results_of(rough).front();
    ReferenceEvaluator reference({.relative_tolerance = 1e-6});
    const PointResult right = evaluate_scene(rough, grid_entries(rough), reference, {}).front();
    EXPECT_NEAR(kernels[kRhoI], own.rho_i, kSpread) << own.rows;
    expect_agreement(kernels, right);
    const std::vector<std::string> remarks = remarks_on(rough);
    ASSERT_EQ(remarks.size(), 1U) << own.rows;
    EXPECT_TRUE(contains(remarks[0], "no row between 0 and 90 degrees")) << remarks[0];
  }
}

// Rows that change by up to half from angle to angle: straight lines between them have kinks, as in integrals over
// facets. The tables of the kernels follow the kinks, so that the results meet their tolerance.
TEST(MeasuredReflectances, JaggedRows_MeetTheToleranceAndTheReference) {
  const TemporaryFile file("jagged.csv",
                           "beta_deg,r_s,r_p\n0,0.3,0.3\n7,0.5,0.2\n9,0.4,0.3\n31,0.8,0.1\n33,0.4,0.4\n60,0.7,0.2\n"
                           "71,0.5,0.1\n90,0.9,0.7\n");
  for (const char* masking : {"smith", "v-cavity"}) {
    const SceneValues scene =
        measured_scene(file, {std::string("surface.masking=") + masking, "surface.q=3", "surface.sigma=0.05",
                              "grid.theta_deg=[0, 32, 70]", "accuracy.tolerance=1e-3"});
    const std::vector<PointResult> results = results_of(scene);
    ReferenceEvaluator reference({.relative_tolerance = 1e-5});
    const std::vector<PointResult> right = evaluate_scene(scene, grid_entries(scene), reference, {});
    for (std::size_t i = 0; i < results.size(); ++i) {
      SCOPED_TRACE(masking + std::to_string(i));
      EXPECT_EQ(results[i].status & kAnyToleranceNotMet, 0U);
      expect_agreement(results[i], right[i]);
    }
  }
}

// Rows of 5 degrees with jumps of up to a half; rows of 10 degrees of a dielectric; and a difference of R_s and R_p
// that grows like sin^2(beta) up to the second row, and then linearly. The zeniths are those of rows and close to the
// normal, where all facets of a slope meet a row.
TEST(MeasuredReflectances, CoarseRows_AreWithinTheirBoundsOfTheReference) {
  const std::array<const char*, 3> files = {
      {"0,0.3,0.3\n5,0.05,0.05\n10,0.05,0.05\n15,0.446,0.409\n20,0.105,0.077\n25,0.5,0.429\n30,0.94,0.122\n"
       "35,0.596,0.562\n40,0.95,0.95\n45,0.55,0.95\n50,0.208,0.95\n55,0.593,0.95\n60,0.95,0.95\n"
       "65,0.95,0.95\n70,0.95,0.565\n75,0.585,0.95\n80,0.103,0.95\n85,0.05,0.536\n90,1,1\n",
       "0,0.04,0.04\n10,0.041,0.039\n20,0.046,0.035\n30,0.056,0.028\n40,0.075,0.019\n50,0.11,0.006\n"
       "60,0.18,0.002\n70,0.31,0.04\n80,0.54,0.24\n85,0.73,0.5\n90,1,1\n",
       "0,0.5,0.5\n10,0.55,0.45\n20,0.6,0.4\n40,0.7,0.3\n90,0.95,0.05\n"}};
  for (const char* rows : files) {
    const TemporaryFile file("coarse.csv", std::string("beta_deg,r_s,r_p\n") + rows);
    for (const char* masking : {"none", "smith"}) {
      SceneValues scene = measured_scene(
          file, {std::string("surface.masking=") + masking, "surface.q=3", "grid.sigma=[9e-4, 0.01, 0.05, 1]",
                 "grid.theta_deg=[0, 0.03, 10, 20, 50, 80]", "accuracy.tolerance=1e-6"});
      ReferenceEvaluator reference({.relative_tolerance = 1e-8});
      const std::vector<PointResult> right = evaluate_scene(scene, grid_entries(scene), reference, {});
      for (const double tolerance : {1e-4, 1e-6}) {
        scene.accuracy.tolerance = tolerance;
        const std::vector<PointResult> results = results_of(scene);
        for (std::size_t i = 0; i < results.size(); ++i) {
          SCOPED_TRACE(fmt::format("{} {} {}", masking, tolerance, i));
          expect_agreement(results[i], right[i]);
        }
      }
    }
  }
}

// The parts of a table have the bits of the whole, so the kinks of a wavelength must not depend on other wavelengths.
TEST(MeasuredReflectances, EachWavelength_HasTheBitsThatItHasAlone) {
  std::string rows = "wavelength_um,beta_deg,r_s,r_p\n";
  for (const char* row : {"0,0.3,0.3", "10,0.31,0.29", "20,0.33,0.27", "40,0.4,0.2", "90,1,1"})
    rows += std::string("8,") + row + '\n';
  for (const char* row : {"0,0.3,0.3", "10,0.9,0.2", "20,0.3,0.6", "40,0.8,0.1", "90,1,1"})
    rows += std::string("11,") + row + '\n';
  const TemporaryFile file("wavelengths.csv", rows);
  for (const char* tolerance : {"1e-2", "1e-3"}) {
    const auto at = [&](const std::string& wavelengths) {
      return results_of(
          measured_scene(file, {"surface.masking=none", "grid.theta_deg=[40]", "grid.sigma=[0.01, 0.05, 0.1, 0.3]",
                                "spectrum.wavelength_um=8", "grid.wavelength_um=" + wavelengths,
                                std::string("accuracy.tolerance=") + tolerance}));
    };
    const std::vector<PointResult> both = at("[8, 11]"), first = at("[8]"), second = at("[11]");
    ASSERT_EQ(both.size(), first.size() + second.size());
    for (std::size_t i = 0; i < both.size(); ++i) {
      const PointResult& alone = i < first.size() ? first[i] : second[i - first.size()];
      for (const Quantity quantity : {kDolp, kRhoI, kErrorEstimate, kRhoErrorEstimate})
        EXPECT_EQ(both[i][quantity], alone[quantity]) << tolerance << ' ' << i << ' ' << describe(quantity).name;
    }
  }
}

TEST(MeasuredReflectances, BadFiles_AreRefusedWithTheirLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"beta_deg,r_s,r_p\n0,0.1,0.1\n80,0.5,0.2\n", ":3: beta_deg = 80: must be 90 in one row"},
      {"beta_deg,r_s,r_p\n10,0.1,0.1\n90,1,1\n", ":2: beta_deg = 10: must be 0 in one row"},
      {"beta_deg,r_s,r_p\n0,0.1,0.3\n90,1,1\n", ":2: r_s = 0.1 and r_p = 0.3 must agree"},
      {"beta_deg,r_s,r_p\n0,10,10\n90,100,100\n", ":2: r_s = 10: out of range"}};
  for (const auto& [csv, message] : cases) {
    const TemporaryFile file("measured.csv", csv);
    const std::string said = error_text([&] { measured_scene(file, {}); });
    EXPECT_TRUE(contains(said, message)) << said;
  }
}

}  // namespace
}  // namespace dolp::coatings_test
