#include "run/mueller_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <limits>
#include <numbers>
#include <span>

#include "model/angles.hpp"
#include "model/direction.hpp"
#include "radiometry/diffuse.hpp"
#include "run/scene_run.hpp"

namespace dolp {
namespace {

constexpr std::size_t kGeometriesAtOnce = 1U << 20U;  // number of geometries in a request, which limits its memory

bool is_grazing(const BeamAngles& angles) { return angles.theta_i_deg == 90.0 || angles.theta_r_deg == 90.0; }

bool is_undefined(const Surface& surface, const MuellerPoint& point) {
  const bool has_specular = surface.specular > 0.0;
  const bool has_limit = keeps_projected_area(surface.masking);
  const bool is_multiple = surface.scattering == Scattering::kMultiple;
  if (has_specular && (point.shape.sigma == 0.0 || is_multiple) && is_specular(point.angles)) return true;
  const bool specular_diverges = has_specular && point.shape.sigma > 0.0 && (!has_limit || !has_facet(point.angles));
  return is_grazing(point.angles) && (specular_diverges || diffuse_diverges(surface));
}

bool needs_evaluator(const Surface& surface, const MuellerPoint& point) {
  return surface.specular > 0.0 && point.shape.sigma > 0.0 && !is_undefined(surface, point);
}

BeamAngles used_angles(const Surface& surface, const BeamAngles& angles) {
  return {zenith_before_limit_deg(surface.masking, angles.theta_i_deg),
          zenith_before_limit_deg(surface.masking, angles.theta_r_deg), angles.delta_phi_deg};
}

ScatteringRequest request_for(const SceneValues& scene, std::span<const MuellerPoint> points) {
  ScatteringRequest request;
  request.distribution = scene.surface.distribution;
  request.masking = scene.surface.masking;
  request.scattering = scene.surface.scattering;
  request.accuracy = mueller_error(scene);
  for (const MuellerPoint& point : points) {
    if (!needs_evaluator(scene.surface, point)) continue;
    const auto position = static_cast<std::uint32_t>(request.entries.size());
    request.angles.push_back(used_angles(scene.surface, point.angles));
    request.shapes.push_back(point.shape);
    request.optics.push_back(point.index);
    request.entries.push_back({position, position, position});
  }
  return request;
}

void add_diffuse(MuellerMatrix& f, const Surface& surface, const MuellerPoint& point) {
  if (surface.diffuse == 0.0) return;
  const double cos_i = cos_sin_deg(point.angles.theta_i_deg).cos;
  const double cos_r = cos_sin_deg(point.angles.theta_r_deg).cos;
  const DiffuseReflection diffuse(surface, point.index);
  const DiffuseLight in = diffuse.transmitted(cos_i), out = diffuse.transmitted(cos_r);
  if (out.i == 0.0 || in.i == 0.0) return;  // at 90 degrees
  const double scale = surface.diffuse / std::numbers::pi * std::pow(cos_i * cos_r, surface.diffuse_exponent);
  f[0] += scale * out.i * in.i;
  f[1] += scale * out.i * in.q;
  f[4] += scale * out.q * in.i;
  f[5] += scale * out.q * in.q;
}

/// True if specular.error exceeds `accuracy`, because bounces that contribute were not computed.
bool is_inaccurate(const ScatteringMatrix& specular, double accuracy) {
  constexpr double kRounding = 1e-3;  // relative rounding error of specular.error, which is a sum
  return specular.error > (1.0 + kRounding) * accuracy * specular.m[0];
}

MuellerMatrix elements(const Surface& surface, const MuellerPoint& point, const ScatteringMatrix* specular,
                       double accuracy) {
  MuellerMatrix f{};
  if (is_undefined(surface, point) || (specular != nullptr && is_inaccurate(*specular, accuracy))) {
    f.fill(std::numeric_limits<double>::quiet_NaN());
    return f;
  }
  if (specular != nullptr) {
    const BeamAngles angles = used_angles(surface, point.angles);
    const double cosines = cos_sin_deg(angles.theta_i_deg).cos * cos_sin_deg(angles.theta_r_deg).cos;
    // Adding 0 turns -0 into +0.
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = surface.specular * specular->m[i] / cosines + 0.0;
  }
  add_diffuse(f, surface, point);
  return f;
}

}  // namespace

double mueller_error(const SceneValues& scene) {
  return scattering_accuracy(scene.surface.scattering, scene.accuracy.tolerance);
}

std::vector<MuellerPoint> mueller_points(const SceneValues& scene, const Points& points) {
  check_surface(scene, points);
  const Surface& surface = scene.surface;
  const bool has_own_index = points[Axis::kN] && points[Axis::kK];
  const bool needs_index = !surface.material.is_constant() && !has_own_index;
  if (scene.spectrum.is_band() && (needs_index || !surface.coating.empty() || surface.diffuse_table)) {
    const bool is_material = surface.coating.empty() && !surface.diffuse_table;
    throw InputError(fmt::format(
        "{}: {}: the Mueller matrix is that of one wavelength and {} depends on it; give spectrum.wavelength_um{}",
        scene.path_name, scene.spectrum.key(),
        is_material ? fmt::format("the material \"{}\"", surface.material.name)
                    : (surface.diffuse_table ? "surface.diffuse_file" : "a coating"),
        is_material ? ", or columns n and k" : ""));
  }
  if (surface.reflectance) {
    throw InputError(
        fmt::format("{}: surface.reflectance_file: the Mueller matrix needs phases, which reflectances lack; "
                    "give n and k, or a material and a coating",
                    scene.path_name));
  }
  if (surface.has_only_direct()) {
    throw InputError(
        fmt::format("{}: surface.masking = \"smith\": must be \"none\" or \"v-cavity\" for Mueller matrices of slopes "
                    "that differ along and across",
                    scene.path_name));
  }
  Surface coated = surface;
  FacetOptics optics = surface.optics_at(scene.spectrum.min_um);
  std::vector<MuellerPoint> result;
  result.reserve(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    if (!points.films.empty()) {
      set_films(coated, points.films_at(row));
      optics = coated.optics_at(scene.spectrum.min_um);
    }
    result.push_back(
        {{(*points[Axis::kTheta])[row], (*points[Axis::kViewZenith])[row], (*points[Axis::kRelativeAzimuth])[row]},
         shape_at(scene, points, row),
         optics});
    OpticalConstants& index = result.back().index.index;
    index = {value_or(points[Axis::kN], row, index.n), value_or(points[Axis::kK], row, index.k)};
  }
  return result;
}

std::vector<MuellerMatrix> evaluate_mueller(const SceneValues& scene, const std::vector<MuellerPoint>& points,
                                            ModelEvaluator& evaluator, const Progress& progress) {
  std::vector<MuellerMatrix> results;
  results.reserve(points.size());
  for (std::size_t first = 0; first < points.size(); first += kGeometriesAtOnce) {
    const auto block = std::span(points).subspan(first, std::min(kGeometriesAtOnce, points.size() - first));
    const Progress block_progress = [&](std::size_t done, std::size_t total) {
      return !progress || progress(first + block.size() * done / total, points.size());
    };
    const std::vector<ScatteringMatrix> specular = evaluator.scatter(request_for(scene, block), block_progress);
    auto next = specular.begin();
    for (const MuellerPoint& point : block) {
      const bool is_evaluated = needs_evaluator(scene.surface, point);
      results.push_back(elements(scene.surface, point, is_evaluated ? &*next++ : nullptr, mueller_error(scene)));
    }
  }
  return results;
}

}  // namespace dolp
