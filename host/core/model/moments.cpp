#include "model/moments.hpp"

#include <algorithm>

namespace dolp {

std::size_t MomentsRequest::size() const {
  if (layout == Layout::kList) return theta_deg.size();
  return theta_deg.size() * optics.size() * sigma.size() * q.size();
}

std::size_t MomentsRequest::wanted_count() const {
  if (wanted.empty()) return size();
  return wanted.size() - static_cast<std::size_t>(std::ranges::count(wanted, 0));
}

double MomentsRequest::finer_tolerance(double share) const {
  const double finer = share * tolerance;
  return precision == Precision::kDouble ? finer : std::max(finer, std::min(kLeastFloatTolerance, tolerance));
}

MomentsPoint MomentsRequest::operator[](std::size_t entry) const {
  if (layout == Layout::kList) return {theta_deg[entry], {sigma[entry], q[entry]}, optics[entry]};
  const std::size_t sigma_quotient = entry / q.size();
  const std::size_t theta_quotient = sigma_quotient / sigma.size();
  return {theta_deg[theta_quotient % theta_deg.size()],
          {sigma[sigma_quotient % sigma.size()], q[entry % q.size()]},
          optics[theta_quotient / theta_deg.size()]};
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
  layout = Layout::kList;
  theta_deg.push_back(point.theta_deg);
  sigma.push_back(point.shape.sigma);
  q.push_back(point.shape.q);
  optics.push_back(point.index);
}

}  // namespace dolp
