#include "evaluate/run/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "error.hpp"
#include "evaluate/radiometry/smooth_surface.hpp"
#include "evaluate/run/grazing_limit.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths

// Below this roughness the slopes' density overflows a float; the surface is a mirror but for the share of the facets
// that are steeper than kMirrorSlope all the same, which the error estimate then carries.
constexpr double kSmallestSigma = 1e-28;
constexpr double kMirrorSlope = 1e-6;

// Stands for 90 degrees where rho has a limit there.
constexpr double kNearGrazingDeg = 90.0 - 1e-9;

bool is_mirror(const SlopeShape& shape) { return shape.sigma < kSmallestSigma; }

double steep_share(const Scene& scene, const SlopeShape& shape) {
  if (shape.sigma == 0.0) return 0.0;
  const double u = kMirrorSlope / (std::sqrt(2.0) * shape.sigma);
  if (scene.surface.distribution == Distribution::kGaussian) return std::exp(-u * u);
  return std::exp((1.0 - shape.q) * std::log1p(u * u)) + kMirrorSlope;
}

/// At 90 degrees the moments of a heavy tail diverge, and only their quotients have a limit.
bool is_divergent(const Scene& scene, const SceneEntry& entry) {
  const Masking masking = scene.surface.masking;
  return entry.theta_deg == 90.0 && (masking == Masking::kNone || masking == Masking::kIntegral) &&
         scene.surface.distribution == Distribution::kCauchy && entry.shape.q <= 1.5;
}

/// Whether the evaluator has to compute an entry; the others have closed forms.
bool needs_evaluator(const Scene& scene, const SceneEntry& entry) {
  return !is_mirror(entry.shape) && !is_divergent(scene, entry);
}

/// Where the moments of an entry are evaluated: at its own direction, and just before 90 degrees for a limit there.
double moments_theta_deg(const Scene& scene, const SceneEntry& entry) {
  const Masking masking = scene.surface.masking;
  const bool has_limit = masking == Masking::kVCavity || masking == Masking::kSmith || is_mirror(entry.shape);
  return has_limit && entry.theta_deg == 90.0 ? kNearGrazingDeg : entry.theta_deg;
}

/// Positions of values in a list of distinct ones.
template <class Key, class Value>
class Distinct {
 public:
  explicit Distinct(std::vector<Value>& values) : values_(values) {}

  std::uint32_t position(const Key& key, const Value& value) {
    const auto [found, is_new] = positions_.try_emplace(key, static_cast<std::uint32_t>(values_.size()));
    if (is_new) values_.push_back(value);
    return found->second;
  }

 private:
  std::map<Key, std::uint32_t> positions_;
  std::vector<Value>& values_;
};

using Pair = std::pair<double, double>;

/// The request for entries [first, last): for each rough one the samples of the spectral rule, in order.
MomentsRequest make_request(const Scene& scene, const std::vector<SceneEntry>& entries,
                            const std::vector<OpticalConstants>& samples, std::size_t first, std::size_t last) {
  MomentsRequest request;
  request.distribution = scene.surface.distribution;
  request.masking = scene.surface.masking;
  request.tolerance = scene.accuracy.tolerance;
  Distinct<double, double> thetas(request.theta_deg);
  Distinct<Pair, SlopeShape> shapes(request.shapes);
  Distinct<Pair, OpticalConstants> indices(request.indices);
  request.entries.reserve((last - first) * samples.size());
  for (std::size_t i = first; i < last; ++i) {
    const SceneEntry& entry = entries[i];
    if (!needs_evaluator(scene, entry)) continue;
    MomentsEntry wanted;
    const double theta_deg = moments_theta_deg(scene, entry);
    wanted.theta = thetas.position(theta_deg, theta_deg);
    wanted.shape = shapes.position({entry.shape.sigma, entry.shape.q}, entry.shape);
    for (const OpticalConstants& sample : samples) {
      const OpticalConstants index = entry.index.value_or(sample);
      wanted.index = indices.position({index.n, index.k}, index);
      request.entries.push_back(wanted);
    }
  }
  return request;
}

Moments mirror_with_bound(const Scene& scene, const SceneEntry& entry, const OpticalConstants& index) {
  const double cosine = cos_sin_deg(moments_theta_deg(scene, entry)).cos;
  const double steep = steep_share(scene, entry.shape) * cosine;
  Moments moments = mirror_moments(index, cosine);
  for (double* error : {&moments.r_i_error, &moments.r_q_error, &moments.albedo_error, &moments.deficit_error}) {
    *error += steep;
  }
  return moments;
}

/// Moments of an entry that has closed forms, for each sample.
std::vector<Moments> closed_forms(const Scene& scene, const SceneEntry& entry,
                                  const std::vector<OpticalConstants>& samples) {
  std::vector<Moments> moments;
  for (const OpticalConstants& sample : samples) {
    const OpticalConstants index = entry.index.value_or(sample);
    moments.push_back(is_mirror(entry.shape) ? mirror_with_bound(scene, entry, index)
                                             : grazing_limit_moments(index, entry.shape.q));
  }
  return moments;
}

PointResult radiometry_of(const Scene& scene, const Radiometry& radiometry, const SceneEntry& entry,
                          std::span<const Moments> moments) {
  const Direction direction{entry.theta_deg, cos_sin_deg(moments_theta_deg(scene, entry)).cos};
  if (!entry.index) return radiometry.point(direction, moments);
  return radiometry.point(direction, moments, std::vector<OpticalConstants>(moments.size(), *entry.index));
}

double value_or(const std::optional<std::vector<double>>& column, std::size_t row, double fallback) {
  return column ? (*column)[row] : fallback;
}

}  // namespace

std::vector<SceneEntry> grid_entries(const Scene& scene) {
  std::vector<SceneEntry> entries;
  entries.reserve(scene.grid.theta_deg.size() * scene.grid.sigma.size() * scene.grid.q.size());
  for (const double theta_deg : scene.grid.theta_deg) {
    for (const double sigma : scene.grid.sigma) {
      for (const double q : scene.grid.q) entries.push_back({theta_deg, {sigma, q}, {}});
    }
  }
  return entries;
}

std::vector<SceneEntry> point_entries(const Scene& scene, const Points& points) {
  if (!points.theta_deg && scene.grid.theta_deg.size() != 1) {
    throw InputError("points: the column theta_deg is missing and the scene's grid.theta_deg is not a single value");
  }
  const bool own_index = points.n || points.k;
  if (own_index && !(points.n && points.k) && !scene.surface.material.is_constant()) {
    throw InputError("points: the columns n and k go together when the scene's material depends on the wavelength");
  }
  std::vector<SceneEntry> entries;
  entries.reserve(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    SceneEntry entry;
    entry.theta_deg = value_or(points.theta_deg, row, scene.grid.theta_deg.front());
    entry.shape = {value_or(points.sigma, row, scene.surface.sigma), value_or(points.q, row, scene.surface.q)};
    const OpticalConstants& index = scene.surface.material.constant;
    if (own_index) entry.index = OpticalConstants{value_or(points.n, row, index.n), value_or(points.k, row, index.k)};
    entries.push_back(entry);
  }
  return entries;
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        MomentsEvaluator& evaluator, const Progress& progress) {
  const Radiometry radiometry(scene);
  const std::vector<OpticalConstants> samples = radiometry.rule().indices();
  const std::size_t block = std::max<std::size_t>(1, kMomentsAtOnce / samples.size());
  std::vector<PointResult> results;
  results.reserve(entries.size());
  for (std::size_t first = 0; first < entries.size(); first += block) {
    const std::size_t last = std::min(first + block, entries.size());
    const MomentsRequest request = make_request(scene, entries, samples, first, last);
    const Progress of_block = [&](std::size_t done, std::size_t) {
      return !progress || progress(first + done / samples.size(), entries.size());
    };
    const std::vector<Moments> moments = evaluator.evaluate(request, of_block);
    std::size_t used = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (!needs_evaluator(scene, entries[i])) {
        results.push_back(radiometry_of(scene, radiometry, entries[i], closed_forms(scene, entries[i], samples)));
        continue;
      }
      const std::span of_entry(moments.data() + used, samples.size());
      results.push_back(radiometry_of(scene, radiometry, entries[i], of_entry));
      used += samples.size();
    }
  }
  return results;
}

}  // namespace dolp
