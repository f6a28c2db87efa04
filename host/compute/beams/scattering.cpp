#include "beams/scattering.hpp"

#include <algorithm>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/parallel_ranges.hpp"
#include "beams/beam_geometry.hpp"
#include "beams/in_plane_masking.hpp"
#include "model/films.hpp"
#include "model/slopes.hpp"
#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

using Complex = std::complex<double>;

// If |N^2 - sin^2(beta)| is below this share of |Re(N^2)| or sin^2(beta), exact_w_squared() avoids a loss of digits.
constexpr double kCritical = 1e-6;
constexpr double kSmallestSquare = 1e-300;
constexpr double kSmallestFacetCosine = 1e-12;

/// Mueller matrix of a facet in its own frame: m00 = (R_s + R_p) / 2, m01 = (R_s - R_p) / 2, cross = conj(r_s) r_p.
/// Measured reflectances have no phase, so their `cross` is 0. Conventions: r_p = -r_s at normal incidence.
struct FacetReflection {
  double m00 = 0.0;
  double m01 = 0.0;
  std::complex<double> cross;
};

constexpr std::size_t kGeometriesAtOnce = 256;
constexpr std::size_t kBeamsAtOnce = 64;  // those of one slope distribution share an InPlaneMasking

// Re(N^2 - sin^2(beta)) to all digits of a double, from the angles in degrees.
double exact_w_squared(const BeamAngles& angles, const OpticalConstants& index) {
  using Real = boost::multiprecision::cpp_bin_float_quad;
  const auto cosine = [](double angle_deg) { return boost::math::cos_pi(Real(angle_deg) / 180); };
  const auto sine = [](double angle_deg) { return boost::math::sin_pi(Real(angle_deg) / 180); };
  const Real cos_2beta = sine(angles.theta_i_deg) * sine(angles.theta_r_deg) * cosine(angles.delta_phi_deg) +
                         cosine(angles.theta_i_deg) * cosine(angles.theta_r_deg);
  const Real n = index.n;
  const Real k = index.k;
  return static_cast<double>((n - k) * (n + k) - (1 - cos_2beta) / 2);
}

double re_n_squared(const OpticalConstants& index) { return (index.n - index.k) * (index.n + index.k); }

Complex n_squared_minus_1(const OpticalConstants& index) {
  return {(index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k};
}

// Re(N^2 - sin^2(beta)) can be computed in two forms. The form with the smaller terms loses fewer digits.
double w_squared(const OpticalConstants& index, double c, double sin2) {
  return sin2 < 0.5 ? re_n_squared(index) - sin2 : n_squared_minus_1(index).real() + c * c;
}

// Computes R_s and R_p as shaders/physics/fresnel.glsl does. `w2` is Re(w^2). With c = cos(beta), the complex index N,
// w^2 = N^2 - sin^2(beta) and a of the code, conj(r_s) r_p = a (sin^2(beta) - c w) / (conj(c + w) (N^2 c + w)).
FacetReflection bare_reflection(const OpticalConstants& index, double c, double sin2, double w2) {
  const Complex n2m1 = n_squared_minus_1(index);
  const Complex w = std::sqrt(Complex(w2, n2m1.imag()));
  const Complex s_sum = c + w;
  const Complex p_sum = Complex(re_n_squared(index), n2m1.imag()) * c + w;
  const double a = std::norm(n2m1) / std::max(std::norm(s_sum), kSmallestSquare);  // avoids 0/0 for N = 1 at 90 degrees
  const double r_s = a / std::max(std::norm(s_sum), kSmallestSquare);
  const double p_norm = std::max(std::norm(p_sum), kSmallestSquare);
  const double m01 = 0.5 * (4.0 * c * w.real() * a / p_norm) * sin2;
  return {r_s - m01, m01, r_s * (sin2 - c * w) * s_sum * std::conj(p_sum) / p_norm};
}

/// `sin2`: 1 - cosine^2. It is separate because this difference may lose digits.
FacetReflection facet_reflection(const FacetOptics& optics, double cosine, double sin2) {
  if (optics.is_bare()) return bare_reflection(optics.index, cosine, sin2, w_squared(optics.index, cosine, sin2));
  const double c = std::max(cosine, kSmallestFacetCosine);
  const SmoothAbsorptance absorbed = smooth_absorptance(optics, c);
  const double m01 = 0.5 * absorbed.split * sin2;
  if (optics.measured) return {1.0 - absorbed.s - m01, m01, 0.0};
  const FilmReflection r = film_reflection(optics, c);
  return {r.r_s - m01, m01, r.cross};
}

FacetReflection beam_reflection(const BeamAngles& angles, const BeamGeometry& geometry, const FacetOptics& optics) {
  const double c = geometry.cos_beta, sin2 = geometry.sin2_beta;
  const OpticalConstants& index = optics.index;
  const double w2 = w_squared(index, c, sin2);
  const double scale = std::max(std::abs(re_n_squared(index)), sin2);
  const bool is_critical = std::hypot(w2, n_squared_minus_1(index).imag()) <= kCritical * scale;
  if (!optics.is_bare() || !is_critical) return facet_reflection(optics, c, sin2);
  return bare_reflection(index, c, sin2, exact_w_squared(angles, index));
}

/// The matrix of the facet (see FacetReflection) between turns by eta_i and -eta_r. A turn by eta maps (Q, U) to
/// (cos(2 eta) Q + sin(2 eta) U, -sin(2 eta) Q + cos(2 eta) U). U is 2 Re(E_s* E_p), and V is 2 Im(E_s* E_p).
/// Equation: shaders/physics/README.md, section 2, eqs. 4, 7 and 15. Eq. 4 as printed in the paper has the opposite
/// sign of eta.
std::array<double, 16> turned(const FacetReflection& facet, const BeamGeometry& g) {
  const double a = facet.m00, b = facet.m01, c = facet.cross.real(), s = facet.cross.imag();
  const auto [cos_i, sin_i] = g.twice_eta_i;
  const auto [cos_r, sin_r] = g.twice_eta_r;
  return {a,
          b * cos_i,
          b * sin_i,
          0.0,
          b * cos_r,
          a * cos_i * cos_r + c * sin_i * sin_r,
          a * sin_i * cos_r - c * cos_i * sin_r,
          s * sin_r,
          b * sin_r,
          a * cos_i * sin_r - c * sin_i * cos_r,
          a * sin_i * sin_r + c * cos_i * cos_r,
          -s * cos_r,
          0.0,
          -s * sin_i,
          s * cos_i,
          c};
}

void check_entries(const ScatteringRequest& request) {
  for (std::size_t i = 0; i < request.entries.size(); ++i) {
    const ScatteringEntry& entry = request.entries[i];
    if (entry.angles >= request.angles.size() || entry.shape >= request.shapes.size() ||
        entry.index >= request.optics.size()) {
      throw InputError("entry " + std::to_string(i) + " of the request is outside its lists of " +
                       std::to_string(request.angles.size()) + " pairs of beams, " +
                       std::to_string(request.shapes.size()) + " shapes and " + std::to_string(request.optics.size()) +
                       " indices");
    }
  }
}

bool needs_integrals(Masking masking) { return masking == Masking::kIntegral || masking == Masking::kSmith; }

/// The positions of the entries, with equal slope distributions side by side.
std::vector<std::size_t> order_by_shape(const ScatteringRequest& request) {
  std::vector<std::size_t> order(request.entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!needs_integrals(request.masking)) return order;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) {
    const SlopeShape& shape = request.shapes[request.entries[i].shape];
    return std::tuple(shape.sigma, shape.q);
  });
  return order;
}

std::vector<BeamGeometry> beam_geometries(const std::vector<BeamAngles>& angles) {
  std::vector<BeamGeometry> geometries(angles.size());
  parallel_ranges(angles.size(), kGeometriesAtOnce, [&](std::size_t first, std::size_t last) {
    std::optional<BeamZeniths> zeniths;
    for (std::size_t i = first; i < last; ++i) {
      const bool has_new_zeniths = i == first || angles[i].theta_i_deg != angles[i - 1].theta_i_deg ||
                                   angles[i].theta_r_deg != angles[i - 1].theta_r_deg;
      if (has_new_zeniths) zeniths.emplace(angles[i].theta_i_deg, angles[i].theta_r_deg);
      geometries[i] = beam_geometry(*zeniths, angles[i].delta_phi_deg);
    }
  });
  return geometries;
}

ScatteringMatrix beam_matrix(const ScatteringRequest& request, const ScatteringEntry& entry,
                             const BeamGeometry& geometry, double attenuation) {
  const SlopeShape& shape = request.shapes[entry.shape];
  const double azimuth = is_elliptic(shape) ? facet_azimuth(request.angles[entry.angles]) : 0.0;
  const double density = std::exp(log_density(request.distribution, shape, geometry.slope, azimuth));
  ScatteringMatrix matrix;
  matrix.m = turned(beam_reflection(request.angles[entry.angles], geometry, request.optics[entry.index]), geometry);
  for (double& element : matrix.m) element *= density * attenuation;
  matrix.error = kScatteringError * std::abs(matrix.m[0]);
  if (request.scattering == Scattering::kMultiple) add_further_bounces(matrix, request, entry);
  return matrix;
}

}  // namespace

std::vector<ScatteringMatrix> scattering_matrices(const ScatteringRequest& request, const Progress& progress) {
  check_entries(request);
  const std::vector<BeamGeometry> geometries = beam_geometries(request.angles);
  const std::vector<std::size_t> order = order_by_shape(request);
  std::vector<ScatteringMatrix> matrices(order.size());
  const auto compute_group = [&](std::size_t group) {
    std::optional<InPlaneMasking> masking;
    const SlopeShape* masking_shape = nullptr;
    const std::size_t last = std::min((group + 1) * kBeamsAtOnce, order.size());
    for (std::size_t i = group * kBeamsAtOnce; i < last; ++i) {
      const ScatteringEntry& entry = request.entries[order[i]];
      const BeamGeometry& geometry = geometries[entry.angles];
      double attenuation = 1.0;
      if (request.masking == Masking::kVCavity) attenuation = v_cavity_attenuation(geometry);
      if (needs_integrals(request.masking)) {
        const SlopeShape& shape = request.shapes[entry.shape];
        if (masking_shape == nullptr || shape != *masking_shape)
          masking.emplace(request.distribution, request.masking, shape);
        masking_shape = &shape;
        attenuation = masking->attenuation(geometry);
      }
      matrices[order[i]] = beam_matrix(request, entry, geometry, attenuation);
    }
  };
  const Progress beam_progress = [&](std::size_t done, std::size_t) {
    return !progress || progress(std::min(done * kBeamsAtOnce, order.size()), order.size());
  };
  parallel_for((order.size() + kBeamsAtOnce - 1) / kBeamsAtOnce, 4, compute_group, beam_progress);
  return matrices;
}

}  // namespace dolp
