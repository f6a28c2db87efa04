#include "run/part_requests.hpp"

#include <algorithm>
#include <limits>

namespace dolp {
namespace {

BeamAngles angles_of(const Scene& scene, double theta_deg) {
  const Geometry& geometry = scene.geometry;
  return {theta_deg, zenith_before_limit_deg(scene.surface.masking, geometry.view_zenith_deg),
          geometry.relative_azimuth_deg};
}

/// What distinguishes two slope distributions: the gaussian has no q.
SlopeShape normalised(const Scene& scene, const SlopeShape& shape) {
  return scene.surface.distribution == Distribution::kGaussian ? SlopeShape{.sigma = shape.sigma} : shape;
}

Treatment treatment(const Scene& scene, const SceneEntry& entry) {
  return treatment_of(scene.surface.distribution, scene.surface.masking, seen_deg(scene, entry.theta_deg), entry.shape);
}

/// A position on each axis of a grid.
struct GridPlace {
  std::size_t theta, sigma, q;
};

GridPlace place_in(const SceneEntries& grid, std::size_t position) {
  const std::size_t of_sigma = position / grid.q().size();
  return {of_sigma / grid.sigma().size(), of_sigma % grid.sigma().size(), position % grid.q().size()};
}

/// Values that are used go to `axis`, in their order.
std::vector<std::uint32_t> numbered(const std::vector<double>& values, const std::vector<char>& is_used,
                                    std::vector<double>& axis) {
  std::vector<std::uint32_t> positions(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    positions[i] = static_cast<std::uint32_t>(axis.size());
    if (is_used[i] != 0) axis.push_back(values[i]);
  }
  return positions;
}

}  // namespace

double seen_deg(const Scene& scene, double theta_deg) {
  return scene.geometry.mode == Mode::kBistatic ? scene.geometry.view_zenith_deg : theta_deg;
}

bool wants_moments(const Scene& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.needs_moments && treatment(scene, entry) == Treatment::kIntegrated;
}

bool wants_beam(const Scene& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.needs_beams && !is_mirror(entry.shape) && has_facet(angles_of(scene, entry.theta_deg));
}

Scattered beam_without_evaluator(const Scene& scene, double theta_deg) {
  const BeamAngles angles = angles_of(scene, theta_deg);
  const bool is_undefined = !has_facet(angles) || is_specular(angles);
  const double glare = is_undefined ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  return {.i = glare, .q = glare};
}

PartRequests::PartRequests(const Scene& scene, const std::vector<OpticalConstants>& samples, const EffectPlan& plan,
                           const Selection& selection, const RefinementLevel& level)
    : scene_(scene), samples_(samples), plan_(plan), chosen_(selection.chosen) {
  moments_.distribution = beams_.distribution = scene.surface.distribution;
  moments_.masking = beams_.masking = scene.surface.masking;
  moments_.scattering = beams_.scattering = plan.kept.further_bounces ? scene.surface.scattering : Scattering::kSingle;
  moments_.wants_direct = plan.needs_direct;
  moments_.precision = beams_.precision = level.precision;
  moments_.tolerance = level.tolerance;
  moments_.has_extra_splits = level.is_check;
  moments_.row_width = level.row_width;
  moments_.may_interpolate = level.may_interpolate;
  if (plan.needs_moments && selection.part.is_grid()) ask_grid(selection);
  if (plan.needs_moments && !selection.part.is_grid()) ask_points(selection);
  if (plan.needs_beams) ask_beams(selection);
}

void PartRequests::ask_grid(const Selection& selection) {
  const SceneEntries& grid = selection.part;
  std::vector<char> theta(grid.theta_deg().size(), 0), sigma(grid.sigma().size(), 0), q(grid.q().size(), 0);
  for (std::size_t i = 0; i < selection.size(); ++i) {
    if (!wants_moments(scene_, selection[i], plan_)) continue;
    const GridPlace place = place_in(grid, selection.position(i));
    theta[place.theta] = sigma[place.sigma] = q[place.q] = 1;
  }
  if (std::ranges::find(theta, 1) == theta.end()) return;
  moments_.layout = MomentsRequest::Layout::kGrid;
  moments_.indices = samples_;
  sigma_at_ = numbered(grid.sigma(), sigma, moments_.sigma);
  if (scene_.surface.distribution == Distribution::kGaussian) {
    moments_.q = {SlopeShape{}.q};
    q_at_.assign(q.size(), 0);
  } else {
    q_at_ = numbered(grid.q(), q, moments_.q);
  }
  if (scene_.geometry.mode == Mode::kBistatic) {
    moments_.theta_deg = {scene_.geometry.view_zenith_deg};
    theta_at_.assign(theta.size(), 0);
  } else {
    theta_at_ = numbered(grid.theta_deg(), theta, moments_.theta_deg);
  }
  for (double& theta_deg : moments_.theta_deg) {
    theta_deg = zenith_before_limit_deg(scene_.surface.masking, theta_deg);
  }
  if (!selection.chosen.empty()) mask(selection);
}

void PartRequests::mask(const Selection& selection) {
  moments_.wanted.assign(moments_.size(), 0);
  for (std::size_t i = 0; i < selection.size(); ++i) {
    if (!wants_moments(scene_, selection[i], plan_)) continue;
    const Place place = moments_of(i);
    for (std::size_t j = 0; j < samples_.size(); ++j) moments_.wanted[place.first + j * place.stride] = 1;
  }
  if (moments_.wanted_count() == moments_.size()) moments_.wanted.clear();
}

PartRequests::Place PartRequests::moments_of(std::size_t member) const {
  if (!places_.empty()) return places_[member];
  const std::size_t position = chosen_.empty() ? member : chosen_[member];
  const std::size_t of_sigma = position / q_at_.size();
  const std::size_t shapes = moments_.sigma.size() * moments_.q.size();
  const std::size_t shape = sigma_at_[of_sigma % sigma_at_.size()] * moments_.q.size() + q_at_[position % q_at_.size()];
  return {theta_at_[of_sigma / sigma_at_.size()] * samples_.size() * shapes + shape, shapes};
}

void PartRequests::ask_points(const Selection& selection) {
  moments_.layout = MomentsRequest::Layout::kList;
  places_.reserve(selection.size());
  std::vector<MomentsPoint> last;  // those of the entry before, which begin at `place`
  std::vector<MomentsPoint> own;
  Place place;
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const SceneEntry entry = selection[i];
    if (wants_moments(scene_, entry, plan_)) {
      const double used_deg = zenith_before_limit_deg(scene_.surface.masking, seen_deg(scene_, entry.theta_deg));
      const SlopeShape shape = normalised(scene_, entry.shape);
      own.clear();
      if (entry.index) own.push_back({used_deg, shape, *entry.index});
      for (std::size_t j = 0; !entry.index && j < samples_.size(); ++j) own.push_back({used_deg, shape, samples_[j]});
      if (own != last) {
        place = {moments_.size(), entry.index ? std::size_t{0} : std::size_t{1}};
        for (const MomentsPoint& point : own) moments_.append(point);
        last.swap(own);
      }
    }
    places_.push_back(place);
  }
}

void PartRequests::ask_beams(const Selection& selection) {
  const bool is_grid = selection.part.is_grid();
  const auto q_count = static_cast<std::uint32_t>(selection.part.q().size());
  if (is_grid) {
    for (const double theta_deg : selection.part.theta_deg()) beams_.angles.push_back(angles_of(scene_, theta_deg));
    for (const double sigma : selection.part.sigma()) {
      for (const double q : selection.part.q()) beams_.shapes.push_back({sigma, q});
    }
  }
  beams_.indices = samples_;
  first_beam_.reserve(selection.size());
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const SceneEntry entry = selection[i];
    first_beam_.push_back(beams_.entries.size());
    if (!wants_beam(scene_, entry, plan_)) continue;
    ScatteringEntry wanted;
    if (is_grid) {
      const GridPlace place = place_in(selection.part, selection.position(i));
      wanted.angles = static_cast<std::uint32_t>(place.theta);
      wanted.shape = static_cast<std::uint32_t>(place.sigma) * q_count + static_cast<std::uint32_t>(place.q);
    } else {
      wanted.angles = wanted.shape = static_cast<std::uint32_t>(beams_.angles.size());
      beams_.angles.push_back(angles_of(scene_, entry.theta_deg));
      beams_.shapes.push_back(entry.shape);
    }
    if (entry.index) beams_.indices.push_back(*entry.index);
    const auto own = static_cast<std::uint32_t>(beams_.indices.size() - 1);
    for (std::uint32_t j = 0; j < samples_.size(); ++j) {
      wanted.index = entry.index ? own : j;
      beams_.entries.push_back(wanted);
    }
  }
}

}  // namespace dolp
