#include "model/moments.hpp"

#include <algorithm>

namespace dolp {

std::size_t MomentsRequest::size() const {
  if (layout == Layout::kList) return theta_deg.size();
  return theta_deg.size() * optics.size() * shapes();
}

std::size_t MomentsRequest::wanted_count() const {
  if (wanted.empty()) return size();
  return wanted.size() - static_cast<std::size_t>(std::ranges::count(wanted, 0));
}

double MomentsRequest::finer_tolerance(double share) const {
  const double finer = share * tolerance;
  return precision == Precision::kDouble ? finer : std::max(finer, std::min(kLeastFloatTolerance, tolerance));
}

SlopeShape MomentsRequest::shape(std::size_t number) const {
  const std::size_t azimuth = number % azimuth_deg.size();
  number /= azimuth_deg.size();
  const std::size_t cross = number % sigma_cross.size();
  number /= sigma_cross.size();
  return CrossSlopes{sigma_cross[cross], azimuth_deg[azimuth], wind_model}.shape(sigma[number / q.size()],
                                                                                 q[number % q.size()]);
}

bool MomentsRequest::has_elliptic_shapes() const {
  const bool has_cross = std::ranges::any_of(sigma_cross, [](double cross) { return cross > 0.0; });
  if (!has_cross && wind_model == WindModel::kIsotropic) return false;
  const std::size_t count = layout == Layout::kGrid ? shapes() : size();
  for (std::size_t i = 0; i < count; ++i) {
    if (is_elliptic(layout == Layout::kGrid ? shape(i) : (*this)[i].shape)) return true;
  }
  return false;
}

MomentsPoint MomentsRequest::operator[](std::size_t entry) const {
  if (layout == Layout::kList) {
    return {theta_deg[entry], {sigma[entry], q[entry], sigma_cross[entry], azimuth_deg[entry]}, optics[entry]};
  }
  const std::size_t pair = entry / shapes();
  return {theta_deg[pair % theta_deg.size()], shape(entry % shapes()), optics[pair / theta_deg.size()]};
}

MomentsRequest MomentsRequest::select_directions(std::span<const std::size_t> directions) const {
  MomentsRequest part = *this;
  part.theta_deg.clear();
  part.wanted.clear();
  for (const std::size_t i : directions) part.theta_deg.push_back(theta_deg[i]);
  for (std::size_t index = 0; !wanted.empty() && index < optics.size(); ++index) {
    for (const std::size_t i : directions) {
      const auto first = wanted.begin() + static_cast<std::ptrdiff_t>((index * theta_deg.size() + i) * shapes());
      part.wanted.insert(part.wanted.end(), first, first + static_cast<std::ptrdiff_t>(shapes()));
    }
  }
  return part;
}

void MomentsRequest::append(const MomentsPoint& point) {
  if (theta_deg.empty()) {
    sigma_cross.clear();
    azimuth_deg.clear();
  }
  layout = Layout::kList;
  theta_deg.push_back(point.theta_deg);
  sigma.push_back(point.shape.sigma);
  q.push_back(point.shape.q);
  sigma_cross.push_back(is_elliptic(point.shape) ? point.shape.sigma_cross : 0.0);
  azimuth_deg.push_back(point.shape.azimuth_deg);
  optics.push_back(point.index);
}

bool MomentsRequest::continues(std::size_t entry) const {
  const auto repeats = [&](const std::vector<double>& values) { return values[entry] == values[entry - 1]; };
  return entry > 0 && repeats(theta_deg) && repeats(sigma) && repeats(q) && repeats(sigma_cross) &&
         repeats(azimuth_deg);
}

}  // namespace dolp
