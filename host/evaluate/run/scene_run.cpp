#include "evaluate/run/scene_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "error.hpp"
#include "evaluate/radiometry/smooth_surface.hpp"
#include "evaluate/run/attempts.hpp"
#include "evaluate/run/grazing_limit.hpp"
#include "evaluate/scattering.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"

namespace dolp {
namespace {

constexpr double kMostEntries = 1U << 24U;         // of a table: about 5 GB of memory
constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths

// Below this roughness the slopes' density overflows a float; the surface is a mirror but for the share of the facets
// that are steeper than kMirrorSlope all the same, which the error estimate then carries.
constexpr double kSmallestSigma = 1e-28;
constexpr double kMirrorSlope = 1e-6;

// Stands for 90 degrees where rho of a rough surface has a limit there, which it approaches like the cosine.
constexpr double kNearGrazingDeg = 90.0 - 1e-12;

// Stands for the cosine of 90 degrees in the closed form of a mirror: small beside the inverse square of any index.
constexpr double kNearGrazingCosine = 1e-100;

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

bool has_grazing_limit(const Scene& scene) {
  return scene.surface.masking == Masking::kVCavity || scene.surface.masking == Masking::kSmith;
}

/// Where the evaluator computes an entry: at its own direction, and just before 90 degrees for a limit there.
double moments_theta_deg(const Scene& scene, const SceneEntry& entry) {
  return has_grazing_limit(scene) && entry.theta_deg == 90.0 ? kNearGrazingDeg : entry.theta_deg;
}

/// The cosine that the closed form of an entry is for.
double closed_form_cosine(const SceneEntry& entry) {
  const bool has_limit = is_mirror(entry.shape) && entry.theta_deg == 90.0;
  return has_limit ? kNearGrazingCosine : cos_sin_deg(entry.theta_deg).cos;
}

using Pair = std::pair<double, double>;

/// Positions of values in a list of distinct ones, each named by two numbers.
template <class Value>
class Distinct {
 public:
  explicit Distinct(std::vector<Value>& values) : values_(values) {}

  std::uint32_t position(const Pair& key, const Value& value) {
    if (is_empty_ || key != last_key_) {
      const auto [found, is_new] = positions_.try_emplace(key, static_cast<std::uint32_t>(values_.size()));
      if (is_new) values_.push_back(value);
      last_key_ = key;
      last_position_ = found->second;
      is_empty_ = false;
    }
    return last_position_;
  }

 private:
  struct Hash {
    std::size_t operator()(const Pair& key) const {
      constexpr std::size_t kOddMultiplier = 0x9e3779b97f4a7c15U;  // of Fibonacci hashing
      return std::hash<double>{}(key.first) * kOddMultiplier + std::hash<double>{}(key.second);
    }
  };
  std::unordered_map<Pair, std::uint32_t, Hash> positions_;
  std::vector<Value>& values_;
  // The axes of a grid repeat the same value many times over.
  Pair last_key_;
  std::uint32_t last_position_ = 0;
  bool is_empty_ = true;
};

/// What the evaluator is asked for, and where the moments of each entry are in its answer.
struct Block {
  MomentsRequest request;
  std::vector<std::uint32_t> first_moments;  ///< meaningless for entries with closed forms
};

/// What distinguishes two slope distributions: the gaussian has no q.
SlopeShape normalised(const Scene& scene, const SlopeShape& shape) {
  return scene.surface.distribution == Distribution::kGaussian ? SlopeShape{.sigma = shape.sigma} : shape;
}

bool is_same(const MomentsEntry& a, const MomentsEntry& b) {
  return a.theta == b.theta && a.shape == b.shape && a.index == b.index;
}

bool is_bistatic(const Scene& scene) { return scene.geometry.mode == Mode::kBistatic; }

/// Fills a block entry by entry. An entry that repeats the one before it, as those do that differ in the q of a
/// gaussian alone, shares its moments; in bistatic mode all entries of one surface do, whatever the source's direction.
class BlockBuilder {
 public:
  BlockBuilder(const Scene& scene, const std::vector<OpticalConstants>& samples, std::size_t count,
               const Attempt& attempt)
      : scene_(scene) {
    MomentsRequest& request = block_.request;
    request.distribution = scene.surface.distribution;
    request.masking = scene.surface.masking;
    request.tolerance = attempt.tolerance;
    request.precision = attempt.precision;
    request.entries.reserve(count * samples.size());
    block_.first_moments.reserve(count);
    for (const OpticalConstants& sample : samples) sample_positions_.push_back(position(sample));
  }

  void add(const SceneEntry& entry) {
    if (needs_evaluator(scene_, entry)) {
      const double theta_deg = moments_theta_deg(scene_, entry);
      const SlopeShape shape = normalised(scene_, entry.shape);
      MomentsEntry wanted;
      wanted.theta = thetas_.position({theta_deg, 0.0}, theta_deg);
      wanted.shape = shapes_.position({shape.sigma, shape.q}, shape);
      if (entry.index) {
        const std::uint32_t own = position(*entry.index);
        append(wanted, {&own, 1});
      } else {
        append(wanted, sample_positions_);
      }
    }
    block_.first_moments.push_back(last_first_);
  }

  Block take() { return std::move(block_); }

 private:
  std::uint32_t position(const OpticalConstants& index) { return indices_.position({index.n, index.k}, index); }

  void append(MomentsEntry wanted, std::span<const std::uint32_t> indices) {
    std::vector<MomentsEntry>& entries = block_.request.entries;
    wanted.index = indices.front();
    if (last_count_ == indices.size() && is_same(entries[last_first_], wanted)) return;
    last_count_ = indices.size();
    last_first_ = static_cast<std::uint32_t>(entries.size());
    if (is_bistatic(scene_)) {
      const auto key = std::make_tuple(wanted.theta, wanted.shape, wanted.index, last_count_);
      const auto [found, is_new] = firsts_.try_emplace(key, last_first_);
      last_first_ = found->second;
      if (!is_new) return;
    }
    for (const std::uint32_t index : indices) {
      wanted.index = index;
      entries.push_back(wanted);
    }
  }

  const Scene& scene_;
  Block block_;
  Distinct<double> thetas_{block_.request.theta_deg};
  Distinct<SlopeShape> shapes_{block_.request.shapes};
  Distinct<OpticalConstants> indices_{block_.request.indices};
  std::vector<std::uint32_t> sample_positions_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>, std::uint32_t> firsts_;
  std::uint32_t last_first_ = 0;
  std::size_t last_count_ = 0;
};

/// The view of the bistatic mode, just before 90 degrees for a limit there.
double view_zenith_deg(const Scene& scene) {
  const double zenith_deg = scene.geometry.view_zenith_deg;
  return has_grazing_limit(scene) && zenith_deg == 90.0 ? kNearGrazingDeg : zenith_deg;
}

/// The first column of a pBRDF.
Scattered scattered(const ScatteringMatrix& f) { return {f.m[0], f.m[4], f.m[8], f.m[12], f.error}; }

/// What the source sends toward the view for each entry and sample, by the evaluator of the moments; nothing for a mirror
/// but toward its specular direction, where the radiance is not defined, as it is not between beams at 90 degrees both.
std::vector<Scattered> entry_beams(const Scene& scene, std::span<const SceneEntry> entries,
                                   const std::vector<OpticalConstants>& samples, MomentsEvaluator& evaluator,
                                   Precision precision) {
  if (evaluator.scattering() == nullptr) throw std::logic_error("the bistatic mode needs an evaluator of pBRDFs");
  const Geometry& geometry = scene.geometry;
  const auto angles_of = [&](const SceneEntry& entry) {
    return BeamAngles{entry.theta_deg, view_zenith_deg(scene), geometry.relative_azimuth_deg};
  };
  const auto is_evaluated = [&](const SceneEntry& entry) {
    return !is_mirror(entry.shape) && has_facet(angles_of(entry));
  };
  ScatteringRequest request;
  request.distribution = scene.surface.distribution;
  request.masking = scene.surface.masking;
  request.precision = precision;
  Distinct<BeamAngles> angles(request.angles);
  Distinct<SlopeShape> shapes(request.shapes);
  Distinct<OpticalConstants> indices(request.indices);
  for (const SceneEntry& entry : entries) {
    if (!is_evaluated(entry)) continue;
    ScatteringEntry wanted;
    wanted.angles = angles.position({entry.theta_deg, 0.0}, angles_of(entry));
    wanted.shape = shapes.position({entry.shape.sigma, entry.shape.q}, entry.shape);
    for (const OpticalConstants& sample : samples) {
      const OpticalConstants index = entry.index.value_or(sample);
      wanted.index = indices.position({index.n, index.k}, index);
      request.entries.push_back(wanted);
    }
  }
  const std::vector<ScatteringMatrix> rough = evaluator.scattering()->scatter(request, {});
  std::vector<Scattered> beams;
  auto next = rough.begin();
  for (const SceneEntry& entry : entries) {
    for (std::size_t j = 0; j < samples.size(); ++j) {
      const bool is_undefined = !has_facet(angles_of(entry)) || is_specular(angles_of(entry));
      const double glare = is_undefined ? std::numeric_limits<double>::quiet_NaN() : 0.0;
      beams.push_back(is_evaluated(entry) ? scattered(*next++) : Scattered{.i = glare, .q = glare});
    }
  }
  return beams;
}

Moments mirror_with_bound(const Scene& scene, const SceneEntry& entry, const OpticalConstants& index) {
  const double cosine = closed_form_cosine(entry);
  const double steep = steep_share(scene, entry.shape) * cosine;
  Moments moments = mirror_moments(index, cosine);
  for (double* error : {&moments.r_i_error, &moments.r_q_error, &moments.albedo_error, &moments.deficit_error}) {
    *error += steep;
  }
  return moments;
}

/// Moments of an entry that has closed forms, for each index.
std::vector<Moments> closed_forms(const Scene& scene, const SceneEntry& entry,
                                  const std::vector<OpticalConstants>& indices) {
  std::vector<Moments> moments;
  for (const OpticalConstants& index : indices) {
    moments.push_back(is_mirror(entry.shape) ? mirror_with_bound(scene, entry, index)
                                             : grazing_limit_moments(index, entry.shape.q));
  }
  return moments;
}

/// Result of an entry; `beams` is empty in hemispherical mode.
PointResult entry_result(const Radiometry& radiometry, const SceneEntry& entry, const Direction& direction,
                         std::span<const Moments> moments, std::span<const OpticalConstants> indices,
                         std::span<const Scattered> beams) {
  if (beams.empty()) return radiometry.point(direction, moments, indices);
  return radiometry.bistatic_point(direction, cos_sin_deg(entry.theta_deg).cos, moments, indices, beams);
}

/// The entry as the moments see it: in bistatic mode they are those of the view direction.
SceneEntry seen_entry(const Scene& scene, const SceneEntry& entry) {
  SceneEntry seen = entry;
  if (is_bistatic(scene)) seen.theta_deg = scene.geometry.view_zenith_deg;
  return seen;
}

/// Results of the entries of a block.
std::vector<PointResult> block_results(const Scene& scene, const Radiometry& radiometry,
                                       std::span<const SceneEntry> entries, const Block& block,
                                       std::span<const Moments> moments, MomentsEvaluator& evaluator) {
  std::vector<PointResult> results;
  const std::vector<OpticalConstants> samples = radiometry.rule().indices();
  const std::size_t count = samples.size();
  const std::vector<Scattered> beams =
      is_bistatic(scene) ? entry_beams(scene, entries, samples, evaluator, block.request.precision)
                         : std::vector<Scattered>{};
  std::vector<double> cosines;
  for (const double theta_deg : block.request.theta_deg) cosines.push_back(cos_sin_deg(theta_deg).cos);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const SceneEntry seen = seen_entry(scene, entries[i]);
    const std::span<const Scattered> own_beams =
        beams.empty() ? std::span<const Scattered>{} : std::span(beams).subspan(i * count, count);
    std::vector<OpticalConstants> own_indices;
    if (seen.index) own_indices.assign(count, *seen.index);
    const std::vector<OpticalConstants>& indices = seen.index ? own_indices : samples;
    if (!needs_evaluator(scene, seen)) {
      const Direction direction{seen.theta_deg, closed_form_cosine(seen)};
      const std::vector<Moments> closed = closed_forms(scene, seen, indices);
      results.push_back(entry_result(radiometry, entries[i], direction, closed, indices, own_beams));
      continue;
    }
    const std::uint32_t first = block.first_moments[i];
    const Direction direction{seen.theta_deg, cosines[block.request.entries[first].theta]};
    std::vector<Moments> same;
    if (seen.index) same.assign(count, moments[first]);
    const std::span<const Moments> own = seen.index ? std::span<const Moments>(same) : moments.subspan(first, count);
    results.push_back(entry_result(radiometry, entries[i], direction, own, indices, own_beams));
  }
  return results;
}

/// What the attempts at the entries of a scene share.
struct SceneRun {
  const Scene& scene;
  Accuracy accuracy;  ///< the scene's, in the evaluator's precision where the scene leaves it open
  const Radiometry& radiometry;
  MomentsEvaluator& evaluator;
};

/// One attempt at all entries of a block.
std::vector<PointResult> attempt_block(const SceneRun& run, std::span<const SceneEntry> entries, const Attempt& attempt,
                                       const Progress& progress) {
  BlockBuilder builder(run.scene, run.radiometry.rule().indices(), entries.size(), attempt);
  for (const SceneEntry& entry : entries) builder.add(seen_entry(run.scene, entry));
  const Block block = builder.take();
  const std::vector<Moments> moments = run.evaluator.evaluate(block.request, progress);
  return block_results(run.scene, run.radiometry, entries, block, moments, run.evaluator);
}

bool is_better(const PointResult& a, const PointResult& b) {
  return (a.status & kStatusToleranceMissed) < (b.status & kStatusToleranceMissed) ||
         std::max(a.error_estimate, a.rho_error_estimate) < std::max(b.error_estimate, b.rho_error_estimate);
}

/// Tries the entries of a block again that miss the tolerance, those together that want the same attempt.
void retry(const SceneRun& run, std::span<const SceneEntry> entries, const Attempt& first,
           std::span<PointResult> results) {
  std::map<Attempt, std::vector<std::size_t>> waiting;
  const auto plan = [&](std::size_t i, const Attempt& last, const PointResult& result) {
    const auto next = next_attempt(last, result, run.accuracy, run.evaluator.has_double());
    if (next && needs_evaluator(run.scene, seen_entry(run.scene, entries[i]))) waiting[*next].push_back(i);
  };
  for (std::size_t i = 0; i < entries.size(); ++i) plan(i, first, results[i]);
  while (!waiting.empty()) {
    const auto [attempt, members] = *waiting.begin();
    waiting.erase(waiting.begin());
    std::vector<SceneEntry> again;
    for (const std::size_t i : members) again.push_back(entries[i]);
    const std::vector<PointResult> better = attempt_block(run, again, attempt, {});
    for (std::size_t j = 0; j < members.size(); ++j) {
      if (is_better(better[j], results[members[j]])) results[members[j]] = better[j];
      plan(members[j], attempt, better[j]);
    }
  }
}

/// Refuses points that lack what the scene does not say.
void check_columns(const Scene& scene, const Points& points) {
  if (!points.theta_deg && scene.grid.theta_deg.size() != 1) {
    throw InputError(
        fmt::format("{}:1: column \"theta_deg\" is missing, a number in {}; only a scene with a single grid.theta_deg "
                    "does without",
                    points.name, kZenithDegRange.text()));
  }
  if (points.n.has_value() != points.k.has_value() && !scene.surface.material.is_constant()) {
    const char* given = points.n ? "n" : "k";
    const char* missing = points.n ? "k" : "n";
    throw InputError(
        fmt::format("{}:1: column \"{}\" needs column \"{}\" beside it, because the scene's material \"{}\" "
                    "depends on the wavelength",
                    points.name, given, missing, scene.surface.material.name));
  }
}

double value_or(const std::optional<std::vector<double>>& column, std::size_t row, double fallback) {
  return column ? (*column)[row] : fallback;
}

}  // namespace

void check_smith(const Scene& scene, const Points& points) {
  const Surface& surface = scene.surface;
  if (surface.masking != Masking::kSmith || surface.distribution != Distribution::kCauchy || !points.q) return;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const double q = (*points.q)[row];
    if (kSmithCauchyQRange.contains(q)) continue;
    throw InputError(
        fmt::format("{}:{}: q = {}: out of range, a number in {} with masking = \"smith\" and distribution = "
                    "\"cauchy\"",
                    points.name, points.line(row), format_number(q), kSmithCauchyQRange.text()));
  }
}

std::vector<SceneEntry> grid_entries(const Scene& scene) {
  const Grid& grid = scene.grid;
  const double count = static_cast<double>(grid.theta_deg.size()) * static_cast<double>(grid.sigma.size()) *
                       static_cast<double>(grid.q.size());
  if (count > kMostEntries) {
    throw InputError(fmt::format("{}: grid: {} x {} x {} entries; at most {:.0f} in one table", scene.path_name,
                                 grid.theta_deg.size(), grid.sigma.size(), grid.q.size(), kMostEntries));
  }
  std::vector<SceneEntry> entries;
  entries.reserve(static_cast<std::size_t>(count));
  for (const double theta_deg : scene.grid.theta_deg) {
    for (const double sigma : scene.grid.sigma) {
      for (const double q : scene.grid.q) entries.push_back({theta_deg, {sigma, q}, {}});
    }
  }
  return entries;
}

std::vector<SceneEntry> point_entries(const Scene& scene, const Points& points) {
  check_columns(scene, points);
  check_smith(scene, points);
  const bool own_index = points.n || points.k;
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
  SceneRun run{scene, scene.accuracy, radiometry, evaluator};
  if (run.accuracy.precision == Precision::kAuto) run.accuracy.precision = evaluator.precision();
  const Attempt first_try = first_attempt(run.accuracy, evaluator.has_double());
  const std::size_t block_size = std::max<std::size_t>(1, kMomentsAtOnce / radiometry.rule().indices().size());
  std::vector<PointResult> results;
  results.reserve(entries.size());
  for (std::size_t first = 0; first < entries.size(); first += block_size) {
    const std::size_t count = std::min(block_size, entries.size() - first);
    const std::span<const SceneEntry> of_block(entries.data() + first, count);
    const Progress block_progress = [&](std::size_t done, std::size_t total) {
      return !progress || progress(first + count * done / total, entries.size());
    };
    std::vector<PointResult> of_results = attempt_block(run, of_block, first_try, block_progress);
    retry(run, of_block, first_try, of_results);
    results.insert(results.end(), of_results.begin(), of_results.end());
  }
  return results;
}

}  // namespace dolp
