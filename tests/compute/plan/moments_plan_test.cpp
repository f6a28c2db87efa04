// Entries of a grid share work (Sharing). The stated error of an entry must cover the difference from a separate
// computation. The environment variable DOLP_PROPERTY_DRAWS sets the number of grids per model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "evaluate/planned_moments.hpp"
#include "model/response_basis.hpp"
#include "plan/response_plan.hpp"
#include "properties_support.hpp"

namespace dolp::moments_plan_test {
namespace {

constexpr std::uint64_t kSeed = 20261123;
constexpr std::size_t kChecked = 30;  // entries checked per grid

/// How the entries of a grid share work. kSlopes: one sum over the azimuths at a slope is used for all slope
/// distributions. kRows: one kernel invocation computes several values of q. kShapes: moments are interpolated between
/// slope distributions. kIndices: the moments of many indices are weighted sums of the same few responses, see
/// model/response_basis.hpp. kPoints: the responses of many points are interpolated between zeniths and slope
/// distributions.
enum class Sharing { kSlopes, kRows, kShapes, kIndices, kPoints };
constexpr std::array kSharings = {Sharing::kSlopes, Sharing::kRows, Sharing::kShapes, Sharing::kIndices,
                                  Sharing::kPoints};

std::vector<double> in_ratios(double first, double last, std::size_t count, double origin = 0.0) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    values.push_back(origin + first * std::pow(last / first, share));
  }
  return values;
}

std::vector<FacetOptics> many_indices(Random& random) {
  const OpticalConstants least{random.log_uniform(0.2, 20.0), random.log_uniform(1e-3, 20.0)};
  std::vector<FacetOptics> indices;
  for (const double n : in_ratios(least.n, least.n * random.log_uniform(1.2, 3.0), 12)) {
    for (const double k : in_ratios(least.k, least.k * random.log_uniform(1.2, 3.0), 10)) indices.push_back({n, k});
  }
  return indices;
}

/// A random grid. Its largest sigma is up to 60 times its smallest sigma. The distance of q from the lower limit of q
/// varies by a factor of up to 30.
MomentsRequest random_grid(Random& random, const Model& model, Scattering scattering, Sharing sharing) {
  MomentsRequest request;
  request.distribution = model.distribution;
  request.masking = model.masking;
  request.scattering = scattering;
  const bool has_direct = model.masking == Masking::kVCavity || model.masking == Masking::kSmith;
  request.wants_direct = has_direct && scattering == Scattering::kSingle && random.chance(0.5);
  request.tolerance = random.log_uniform(1e-6, 1e-2);
  request.may_interpolate = sharing == Sharing::kShapes;
  // Not 90 degrees, because the moments with masking `none` or `integral` may be infinite there.
  request.theta_deg = {random.uniform(0.0, 89.9), random.chance(0.5) ? std::min(random.theta_deg(), 89.999) : 60.0};
  request.optics = {random.index()};
  if (sharing == Sharing::kSlopes) request.optics.push_back(random.index());
  if (sharing == Sharing::kIndices) {
    request.optics = many_indices(random);
    request.basis = ResponseBasis::of(request.optics, request.tolerance, response_passes(request.wants_direct, 0));
  }
  const bool is_dense = sharing == Sharing::kShapes;
  const double sigma = random.log_uniform(1e-3, 2.0);
  const std::vector<double> sigmas =
      in_ratios(sigma, std::min(10.0, sigma * random.log_uniform(1.2, 60.0)), is_dense ? 64 : 3);
  const double origin = model.masking == Masking::kSmith ? 1.5 : 1.0;
  const double q = random.log_uniform(0.02, 8.0);
  std::vector<double> qs = in_ratios(q, q * random.log_uniform(1.2, 30.0),
                                     is_dense                    ? 48
                                     : sharing == Sharing::kRows ? 12
                                                                 : 4,
                                     origin);
  if (model.distribution == Distribution::kGaussian) qs = {2.0};
  request.shapes = shape_product(sigmas, qs);
  request.set_grid();
  return request;
}

/// Many random points. Their largest sigma is up to 6 times their smallest, and q - 1 varies by a factor of up to 1.5.
MomentsRequest random_points(Random& random, const Model& model) {
  constexpr std::size_t kPoints = 9'000;
  MomentsRequest request = request_of(model, {}, random.log_uniform(3e-4, 1e-2));
  request.is_scattered = true;
  const bool has_direct = model.masking == Masking::kVCavity || model.masking == Masking::kSmith;
  request.wants_direct = has_direct && random.chance(0.5);
  const double sigma = random.log_uniform(1e-3, 2.0), sigma_ratio = random.log_uniform(1.2, 6.0);
  const double q = (model.masking == Masking::kSmith ? 1.5 : 1.0) + random.log_uniform(0.02, 8.0);
  const double q_ratio = random.chance(0.2) ? random.log_uniform(1.0, 1.5) : 1.0;
  const std::vector<FacetOptics> indices = many_indices(random);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const SlopeShape shape{std::min(10.0, sigma * random.log_uniform(1.0, sigma_ratio)),
                           1.0 + (q - 1.0) * random.log_uniform(1.0, q_ratio)};
    const auto index = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(indices.size())));
    request.append({std::min(random.theta_deg(), 89.999), shape, indices[index]});
  }
  request.basis = ResponseBasis::of(indices, request.tolerance, response_passes(request.wants_direct, 0));
  return request;
}

class Grids : public testing::TestWithParam<std::tuple<Kernel, Sharing>> {
 protected:
  /// Compares entries of the grid with separate computations in double, at a hundredth of the tolerance.
  void expect_like_alone(const MomentsRequest& request, const std::vector<Moments>& moments, Random& random) {
    MomentsRequest alone = request.without_entries();
    alone.basis = nullptr;
    alone.precision = Precision::kDouble;
    alone.tolerance = 1e-2 * request.tolerance;
    std::vector<std::size_t> positions;
    for (std::size_t i = 0; i < kChecked; ++i) {
      positions.push_back(static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(moments.size()))));
      alone.append(request[positions.back()]);
    }
    const std::vector<Moments> exact = exact_->evaluate(alone, {});
    for (std::size_t i = 0; i < kChecked; ++i) {
      expect_within_bounds(moments[positions[i]], exact[i],
                           text_of({alone[i].theta_deg, alone[i].shape, alone[i].index.index}));
    }
  }

  const decltype(make_evaluator(Kernel::kCpuDouble)) exact_ = make_evaluator(Kernel::kCpuDouble);
};

TEST_P(Grids, StatedErrors_HoldAgainstEveryEntryByItself) {
  const auto [kernel, sharing] = GetParam();
  const std::size_t grids = draws_wanted(1);
  const auto evaluator = make_evaluator(kernel);
  Work work;
  std::size_t entries = 0;
  for (const Scattering scattering : {Scattering::kSingle, Scattering::kMultiple}) {
    for (const Model& model : kModels) {
      const bool is_multiple = scattering == Scattering::kMultiple;
      // With multiple bounces the program computes the moments of each index separately, so indices share no work.
      const bool has_responses = sharing == Sharing::kIndices || sharing == Sharing::kPoints;
      if (is_multiple && (model.masking != Masking::kVCavity || has_responses)) continue;
      const auto model_seed = static_cast<std::uint64_t>(sharing == Sharing::kPoints ? &model - kModels.data() : 0);
      Random random(kSeed + 10 * static_cast<std::uint64_t>(kernel) + static_cast<std::uint64_t>(sharing) +
                    100 * model_seed);
      for (std::size_t grid = 0; grid < grids; ++grid) {
        SCOPED_TRACE(to_name(model) + " grid " + std::to_string(grid));
        MomentsRequest request = sharing == Sharing::kPoints ? random_points(random, model)
                                                             : random_grid(random, model, scattering, sharing);
        request.precision = is_double(kernel) ? Precision::kDouble : Precision::kFloat;
        const std::vector<Moments> moments = planned_moments(MomentsPlan(request), *evaluator, {}, work).all();
        entries += moments.size();
        expect_like_alone(request, moments, random);
      }
    }
  }
  // With responses the number is not known: `interpolated` also counts entries that are sums of responses, and only
  // some of the requests use responses.
  if (sharing == Sharing::kShapes) {
    EXPECT_GT(2 * work.interpolated, entries);
  } else if (sharing == Sharing::kPoints) {
    EXPECT_GT(5 * work.interpolated, entries);
  } else if (sharing != Sharing::kIndices) {
    EXPECT_EQ(work.interpolated, 0U);
  }
}

std::string case_name(const testing::TestParamInfo<std::tuple<Kernel, Sharing>>& test) {
  constexpr std::array kNames = {"Slopes", "Rows", "Shapes", "Indices", "Points"};
  return to_name(std::get<0>(test.param)) + kNames[static_cast<std::size_t>(std::get<1>(test.param))];
}

INSTANTIATE_TEST_SUITE_P(Kernels, Grids, testing::Combine(testing::ValuesIn(kKernels), testing::ValuesIn(kSharings)),
                         case_name);

TEST(MomentsRequest, SelectedEntries_AreThoseOfTheWhole) {
  MomentsRequest request;
  request.theta_deg = {10.0, 60.0};
  request.optics = {{1.5, 0.0}, {2.0, 1.0}};
  request.shapes = shape_product(std::array{0.1, 0.3}, std::array{2.0, 5.0});
  request.set_grid();
  ASSERT_EQ(request.size(), 16U);
  const std::vector<std::size_t> chosen = {1, 3, 4, 5, 6, 7, 15};
  const MomentsRequest part = request.select_entries(chosen);
  ASSERT_EQ(part.size(), chosen.size());
  EXPECT_EQ(part.bundles.size(), 3U);
  for (std::size_t i = 0; i < chosen.size(); ++i) EXPECT_EQ(part[i], request[chosen[i]]);
  EXPECT_EQ(part.bundles[1].first, request.bundles[1].first);  // a whole bundle shares the list of its shapes
  const MomentsRequest bundles = part.select_bundles(std::array<std::size_t, 2>{0, 2});
  ASSERT_EQ(bundles.size(), 3U);
  EXPECT_EQ(bundles[2], request[15]);
}

// A second pass computes only some entries of a grid, with the same nodes on the slope axis for all of them. These
// nodes must reach far enough for the entry with the heaviest tail (q = 1.2).
TEST(SecondPass, SomeShapesOfAGrid_HeaviestTailIsNotLost) {
  for (const Masking masking : {Masking::kNone, Masking::kVCavity}) {
    MomentsRequest request;
    request.masking = masking;
    request.theta_deg = {60.0};
    request.optics = {{1.5, 0.0}};
    request.shapes = shape_product(std::array{0.5, 0.55, 0.6}, std::array{1.2, 8.0});
    request.set_grid();
    request = request.select_entries(std::array<std::size_t, 3>{1, 2, 5});
    constexpr std::size_t kHeavy = 1;
    const auto evaluator = make_evaluator(Kernel::kCpuDouble);
    const Moments own = evaluator->evaluate(request, {})[kHeavy];
    const Point alone{60.0, {0.55, 1.2}, {1.5, 0.0}};
    const Model model{Distribution::kCauchy, masking};
    expect_within_bounds(own, evaluator->evaluate(request_of(model, {alone}, 1e-9), {}).front(), to_name(model));
    EXPECT_LE(own.r_i_error, request.tolerance * own.r_i) << to_name(model);
  }
}

}  // namespace
}  // namespace dolp::moments_plan_test
