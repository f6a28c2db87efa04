// Integrals over the slope t and the azimuth phi of the facets, split where the integrand bends sharply. The variable
// chi = 90 degrees - phi replaces phi. Each integrand covers two facets: A at phi, B at phi + 180 degrees, and with the
// weights of Slopes::mirror_weights() their mirror images at -phi. So chi runs only from 0 to pi/2.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "reference/adaptive.hpp"
#include "reference/fresnel.hpp"
#include "reference/moments.hpp"
#include "reference/slopes.hpp"
#include "reference/vectors.hpp"

namespace dolp::reference {

struct SlopePoint {
  double t;
  double sin_chi;  ///< cos(phi)
  double cos_chi;  ///< sin(phi)
};

inline SlopePoint slope_point(double t, double chi_rad) { return {t, std::sin(chi_rad), std::cos(chi_rad)}; }

using Electric = Vector<std::complex<double>>;

/// Unit vector toward the viewer in the axes of a groove: u across the groove (azimuth phi), v along the groove, z up.
inline Vector<double> toward_view(const SlopePoint& point, const Zenith& view) {
  return {view.sin * point.sin_chi, -view.sin * point.cos_chi, view.cos};
}

/// Electric vectors of two waves of amplitude 1 along k: s = k x z / |k x z| and p = k x s. At theta = 0, s is a limit.
struct UnitLight {
  Electric from_s;
  Electric from_p;
};

inline UnitLight unit_light(const SlopePoint& point, const Vector<double>& k) {
  const Vector<double> s{point.cos_chi, point.sin_chi, 0.0};
  return {s.cast<std::complex<double>>(), k.cross(s).cast<std::complex<double>>()};
}

/// Reflects the electric vector `e` at a facet, in place. Returns the intensity that the facet absorbs.
inline double reflect(const Bounce<double>& b, const FresnelCoefficients& r, Electric& e) {
  const Amplitudes<std::complex<double>> incident = components(b, e);
  e = reflected(b, incident, {r.r_s, r.r_p});
  return std::norm(incident.s) * r.absorbed_s + std::norm(incident.p) * r.absorbed_p;
}

/// The angles beta at which total reflection begins and at which R_p has its (pseudo-)Brewster minimum.
class SpecialAngles {
 public:
  explicit SpecialAngles(const FacetOptics& constants)
      : brewster_(1.0 / std::hypot(1.0, constants.index.n, constants.index.k)),
        critical_(constants.index.n < 1.0 ? std::sqrt(1.0 - constants.index.n * constants.index.n) : 0.0) {}

  /// A number that tells on which side of each special angle beta lies.
  std::uint64_t side(double cos_beta) const {
    return (cos_beta < brewster_ ? 1U : 0U) + (cos_beta < critical_ ? 2U : 0U);
  }

 private:
  double brewster_;
  double critical_;
};

/// Maps a slope to a number. Slopes on different sides of a bend of the integrand have different numbers.
using Regime = std::function<std::uint64_t(const SlopePoint&)>;

/// A RegimeScan computes the regime at a dozen equal steps of chi. ScanSteps adds further values of chi.
struct ScanSteps {
  /// Let psi be the zenith of the view, projected onto the plane across the groove, and gamma the half-angle of the
  /// groove. If per_gamma is not 0, values of chi are added at equal steps of psi, of about gamma / per_gamma.
  double per_gamma = 0.0;
  int halvings = 0;        ///< number of values toward chi = 0, each half as large as the previous one
  double ridge_rad = 0.0;  ///< Slopes::ridge_rad()
};

/// Finds the bends of the integrand for one view. Computes the regime at many slopes, then bisects where it changes.
class RegimeScan {
 public:
  RegimeScan(const Zenith& view, double theta_rad, const ScanSteps& steps, Regime regime)
      : view_(view), theta_rad_(theta_rad), steps_(steps), regime_(std::move(regime)) {}
  /// Break points of the integral over chi: bends, unless there are too many, and the ridge of an elliptic density. For
  /// grazing views also some small chi.
  std::vector<double> chi_breaks(double t) const;
  /// Break points of the integral over t, up to `end`: bends at chi = 0 or pi/2. For grazing views also some small t.
  std::vector<double> t_breaks(double width, double end) const;

 private:
  Zenith view_;
  double theta_rad_;
  ScanSteps steps_;
  Regime regime_;
};

template <std::size_t N>
struct SlopeTask {
  std::function<Values<N>(const SlopePoint&)> integrand;
  std::function<Values<N>(const Values<N>&)> scales;  ///< computes the scale of each integral, see Goal::relative
  double steepest;                                    ///< upper end of the integral over t
  double bends_end;                                   ///< the integral over t is split at bends up to this t
  /// If density_at(v) < thin_weight, the integral over chi may have an error thin_weight / density_at(v) times larger.
  double thin_weight = 0.0;
  std::function<double()> work = [] { return 0.0; };  ///< work done so far, in any unit
  double most_work = 1.0;                             ///< after this much work no integral is refined
};

/// Integrals of N functions f_k: int_0^steepest 2 pi P t dt (2/pi) int_0^{pi/2} f_k dchi, with the slope density P. In
/// component N + k of the result, the error of the integral over chi replaces this integral. `expected`: rough results.
template <std::size_t N>
Integral<2 * N> integrate_all_slopes(const SlopeTask<N>& task, const Slopes& slopes, const RegimeScan& scan,
                                     const Refinement& refinement, const Values<N>& expected) {
  constexpr double kInnerShare = 0.02;
  constexpr double kInnerFloor = 4e-15;  // a Kronrod panel has a rounding error of 1e-15 of its magnitude
  const auto is_tired = [&] { return task.work() > task.most_work; };
  Values<N> boundless;
  boundless.fill(std::numeric_limits<double>::infinity());

  const auto row = [&](double v) {
    const double t = slopes.at(v);
    const double weight = slopes.density_at(v);
    const double relaxed = std::max(1.0, task.thin_weight / std::max(weight, 1e-300));
    const auto inner_scales = [&](const Values<N>& value) {
      if (is_tired()) return boundless;
      Values<N> larger;
      for (std::size_t k = 0; k < N; ++k) larger[k] = relaxed * std::max(std::abs(value[k]), expected[k]);
      return task.scales(larger);
    };
    Breaks breaks(0.0, 0.5 * std::numbers::pi);
    for (const double chi : scan.chi_breaks(t)) breaks.add(chi);
    const Goal goal{.relative = std::max(kInnerFloor, kInnerShare * refinement.relative_tolerance),
                    .max_panels = 200,
                    .subdivisions = refinement.subdivisions};
    const auto in_chi = [&](double chi) { return task.integrand(slope_point(t, chi)); };
    const Integral<N> inner = integrate<N>(in_chi, breaks, goal, inner_scales);
    Values<2 * N> both;
    for (std::size_t k = 0; k < N; ++k) {
      both[k] = weight * 2.0 * std::numbers::inv_pi * inner.value[k];
      both[N + k] = weight * 2.0 * std::numbers::inv_pi * inner.error[k];
    }
    return both;
  };
  const auto scales = [&](const Values<2 * N>& value) {
    Values<2 * N> all;
    all.fill(std::numeric_limits<double>::infinity());
    if (is_tired()) return all;
    Values<N> first;
    std::copy_n(value.begin(), N, first.begin());
    first = task.scales(first);
    std::copy(first.begin(), first.end(), all.begin());
    return all;
  };
  Breaks breaks(0.0, slopes.slope_coordinate(task.steepest));
  for (const double v : {1.5, 4.0, 8.0, 16.0, 24.0, 32.0, 40.0, 48.0}) breaks.add(v);
  for (const double t : scan.t_breaks(slopes.width(), task.bends_end)) breaks.add(slopes.slope_coordinate(t));
  const Goal goal{.relative = refinement.relative_tolerance, .subdivisions = refinement.subdivisions};
  return integrate<2 * N>(row, breaks, goal, scales);
}

}  // namespace dolp::reference
