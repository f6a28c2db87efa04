#include "table/masking_kinks.hpp"

#include <algorithm>

#include "model/angles.hpp"

namespace dolp {

std::vector<double> masking_kinks(const SceneModel& scene) {
  const Masking masking = scene.surface.masking;
  const double view_deg = scene.geometry.view_zenith_deg;
  if (scene.geometry.mode != Mode::kBistatic || !scene.source) return {};
  if (masking == Masking::kIntegral) return {view_deg};
  if (masking != Masking::kVCavity) return {};
  const CosSin view = cos_sin_deg(view_deg);
  const double cos_azimuth = cos_sin_deg(scene.geometry.relative_azimuth_deg).cos;
  // (1 - G) cos^2(beta) before G is limited to 1, with 2 cos(alpha) cos(beta) = cos(theta) + cos(theta_view).
  const auto hidden = [&](double theta_deg) {
    const CosSin theta = cos_sin_deg(theta_deg);
    const double cos2_beta = 0.5 * (1.0 + theta.cos * view.cos + theta.sin * view.sin * cos_azimuth);
    return cos2_beta - std::min(theta.cos, view.cos) * (theta.cos + view.cos);
  };
  std::vector<double> kinks_deg;
  if (hidden(view_deg) > 0.0) kinks_deg.push_back(view_deg);
  for (int theta_deg = 0; theta_deg < 90; ++theta_deg) {
    const double below = hidden(theta_deg);
    const double above = hidden(theta_deg + 1);
    // A secant of a degree is right within some 0.01 degrees, which the size of a kink's error hardly depends on.
    if ((below > 0.0) != (above > 0.0)) kinks_deg.push_back(theta_deg + below / (below - above));
  }
  return kinks_deg;
}

}  // namespace dolp
