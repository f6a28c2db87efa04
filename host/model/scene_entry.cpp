#include "model/scene_entry.hpp"

#include <algorithm>

namespace dolp {
namespace {

/// A list cut into pieces of at most `most`.
template <class Value>
std::vector<std::vector<Value>> cut(const std::vector<Value>& list, std::size_t most) {
  std::vector<std::vector<Value>> pieces;
  for (std::size_t first = 0; first < list.size(); first += most) {
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
    pieces.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(std::min(most, list.size() - first)));
  }
  return pieces;
}

}  // namespace

SceneEntries SceneEntries::grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q) {
  SceneEntries entries;
  entries.is_grid_ = true;
  entries.theta_deg_ = std::move(theta_deg);
  entries.sigma_ = std::move(sigma);
  entries.q_ = std::move(q);
  return entries;
}

SceneEntry SceneEntries::operator[](std::size_t entry) const {
  if (!is_grid_) return points_[entry];
  const std::size_t of_sigma = entry / q_.size();
  return {theta_deg_[of_sigma / sigma_.size()], {sigma_[of_sigma % sigma_.size()], q_[entry % q_.size()]}, {}};
}

std::vector<SceneEntries> SceneEntries::parts(std::size_t most) const {
  if (empty()) return {};
  if (size() <= most) return {*this};
  std::vector<SceneEntries> parts;
  if (!is_grid_) {
    for (std::vector<SceneEntry>& points : cut(points_, most)) parts.emplace_back(std::move(points));
    return parts;
  }
  const std::size_t of_theta = sigma_.size() * q_.size();
  for (std::vector<double>& thetas : cut(theta_deg_, std::max<std::size_t>(1, most / of_theta))) {
    if (thetas.size() * of_theta <= most) {
      parts.push_back(grid(std::move(thetas), sigma_, q_));
      continue;
    }
    for (const std::vector<double>& sigmas : cut(sigma_, std::max<std::size_t>(1, most / q_.size()))) {
      for (std::vector<double>& qs : cut(q_, most)) parts.push_back(grid(thetas, sigmas, std::move(qs)));
    }
  }
  return parts;
}

}  // namespace dolp
