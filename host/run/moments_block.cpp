#include "run/moments_block.hpp"

#include <map>
#include <tuple>
#include <utility>

#include "model/grazing.hpp"
#include "run/closed_forms.hpp"
#include "run/distinct.hpp"

namespace dolp {
namespace {

/// What distinguishes two slope distributions: the gaussian has no q.
SlopeShape normalised(const Scene& scene, const SlopeShape& shape) {
  return scene.surface.distribution == Distribution::kGaussian ? SlopeShape{.sigma = shape.sigma} : shape;
}

bool is_same(const MomentsEntry& a, const MomentsEntry& b) {
  return a.theta == b.theta && a.shape == b.shape && a.index == b.index;
}

/// Fills a block entry by entry.
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
    // What misses the tolerance between nodes is integrated by itself: its neighbours are the hard ones too.
    request.may_interpolate = scene.accuracy.may_interpolate && attempt.tolerance >= scene.accuracy.tolerance;
    request.entries.reserve(count * samples.size());
    block_.first_moments.reserve(count);
    for (const OpticalConstants& sample : samples) sample_positions_.push_back(position(sample));
  }

  void add(const SceneEntry& entry) {
    if (needs_evaluator(scene_, entry)) {
      const double theta_deg = zenith_before_limit_deg(scene_.surface.masking, entry.theta_deg);
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

  MomentsBlock take() { return std::move(block_); }

 private:
  std::uint32_t position(const OpticalConstants& index) { return indices_.position({index.n, index.k}, index); }

  void append(MomentsEntry wanted, std::span<const std::uint32_t> indices) {
    std::vector<MomentsEntry>& entries = block_.request.entries;
    wanted.index = indices.front();
    if (last_count_ == indices.size() && is_same(entries[last_first_], wanted)) return;
    last_count_ = indices.size();
    last_first_ = static_cast<std::uint32_t>(entries.size());
    if (scene_.geometry.mode == Mode::kBistatic) {
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
  MomentsBlock block_;
  Distinct<double> thetas_{block_.request.theta_deg};
  Distinct<SlopeShape> shapes_{block_.request.shapes};
  Distinct<OpticalConstants> indices_{block_.request.indices};
  std::vector<std::uint32_t> sample_positions_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>, std::uint32_t> firsts_;
  std::uint32_t last_first_ = 0;
  std::size_t last_count_ = 0;
};

}  // namespace

SceneEntry seen_entry(const Scene& scene, const SceneEntry& entry) {
  SceneEntry seen = entry;
  if (scene.geometry.mode == Mode::kBistatic) seen.theta_deg = scene.geometry.view_zenith_deg;
  return seen;
}

MomentsBlock moments_block(const Scene& scene, const std::vector<OpticalConstants>& samples,
                           std::span<const SceneEntry> entries, const Attempt& attempt) {
  BlockBuilder builder(scene, samples, entries.size(), attempt);
  for (const SceneEntry& entry : entries) builder.add(seen_entry(scene, entry));
  return builder.take();
}

}  // namespace dolp
