#include "evaluate/run/scattering.hpp"

#include <cmath>

#include "evaluate/cpu/parallel.hpp"
#include "evaluate/cpu/text.hpp"
#include "plan/geometry.hpp"

namespace dolp {
namespace {

// Relative errors of f: of G from a table, 4e-6 absolute at grazing where G is 1/2 at least, and of rounding.
constexpr double kTableError = 1e-5;
constexpr double kRoundingError = 1e-11;

double relative_error(const KernelData& data, const kernel::GeometryNode& geometry, const kernel::ShapeNode& shape) {
  if (!data.needs_masking_table()) return kRoundingError;
  const bool resolved =
      table_resolves(shape, geometry.c_i, geometry.s_i) && table_resolves(shape, geometry.c_r, geometry.s_r);
  return resolved ? kTableError : 1.0;
}

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
  std::vector<Scattered> beams(request.entries.size());
  const auto one = [&](std::size_t i) {
    const MomentsEntry& entry = request.entries[i];
    const kernel::MuellerNode f = text->mueller(geometries[entry.theta], entry.shape, entry.index);
    const double error = relative_error(data, geometries[entry.theta], data.shapes[entry.shape]);
    beams[i] = {f.m[0], f.m[4], f.m[8], f.m[12], error * std::abs(f.m[0])};
  };
  parallel_for(beams.size(), one, nullptr);
  return beams;
}

}  // namespace dolp
