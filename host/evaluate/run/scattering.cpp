#include "evaluate/run/scattering.hpp"

#include <cmath>

#include "evaluate/cpu/parallel.hpp"
#include "evaluate/cpu/text.hpp"
#include "plan/geometry.hpp"

namespace dolp {
namespace {

// Relative errors of f: of G from a table, which is at least 1/2 or as well known relatively, and of rounding.
constexpr double kTableError = 4e-6;
constexpr double kRoundingError = 1e-11;

}  // namespace

std::vector<Scattered> scattered_beams(const MomentsRequest& request, double view_zenith_deg,
                                       double relative_azimuth_deg) {
  const KernelData data = kernel_data(request);
  const auto text = make_kernel_text_double(data);
  if (data.needs_masking_table()) {
    parallel_for(
        data.shapes.size(), [&](std::size_t i) { text->build_masking_table(i); }, nullptr);
  }
  std::vector<kernel::GeometryNode> geometries;
  for (const double theta_deg : request.theta_deg) {
    geometries.push_back(geometry_node(theta_deg, view_zenith_deg, relative_azimuth_deg));
  }
  const double relative_error = data.needs_masking_table() ? kTableError : kRoundingError;
  std::vector<Scattered> beams(request.entries.size());
  const auto one = [&](std::size_t i) {
    const MomentsEntry& entry = request.entries[i];
    const kernel::MuellerNode f = text->mueller(geometries[entry.theta], entry.shape, entry.index);
    beams[i] = {f.m[0], f.m[4], f.m[8], f.m[12], relative_error * std::abs(f.m[0])};
  };
  parallel_for(beams.size(), one, nullptr);
  return beams;
}

}  // namespace dolp
