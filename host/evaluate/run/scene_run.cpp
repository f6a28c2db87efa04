#include "evaluate/run/scene_run.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "error.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths

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

/// The request for entries [first, last): for each of them the samples of the spectral rule, in order.
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
    MomentsEntry wanted;
    wanted.theta = thetas.position(entry.theta_deg, entry.theta_deg);
    wanted.shape = shapes.position({entry.shape.sigma, entry.shape.q}, entry.shape);
    for (const OpticalConstants& sample : samples) {
      const OpticalConstants index = entry.index.value_or(sample);
      wanted.index = indices.position({index.n, index.k}, index);
      request.entries.push_back(wanted);
    }
  }
  return request;
}

PointResult radiometry_of(const Radiometry& radiometry, const SceneEntry& entry, std::span<const Moments> moments) {
  const Direction direction{entry.theta_deg, cos_sin_deg(entry.theta_deg).cos};
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
    for (std::size_t i = first; i < last; ++i) {
      const std::span of_entry(moments.data() + (i - first) * samples.size(), samples.size());
      results.push_back(radiometry_of(radiometry, entries[i], of_entry));
    }
  }
  return results;
}

}  // namespace dolp
