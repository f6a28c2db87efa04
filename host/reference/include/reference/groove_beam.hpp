// Follows a beam in a symmetric V-groove from facet to facet. Light that leaves the groove is not followed further.
// Axes: u across the groove, v along it, z upward. The origin is the middle of the aperture. The facets have length 1
// and meet at the apex, u = 0 and z = -sin(alpha). The rim of A is at u = -cos(alpha), the rim of B at u = cos(alpha).
#pragma once

#include <algorithm>

#include "reference/vectors.hpp"

namespace dolp::reference {

template <class Real>
struct Groove {
  Real cos_alpha;
  Real sin_alpha;
};

enum class Facet { kA, kB };

/// A beam of parallel rays: all rays through the aperture that meet the facet `first` before the other facet. The beam
/// covers a part of the facet, of length flux / cos(beta). The end of this part that is nearer to the apex is the
/// edge of the beam; the edge is followed as a ray. Rays that miss the next facet leave the groove above its rim.
template <class Real>
class GrooveBeam {
 public:
  /// `omega`: unit vector toward the source, omega[2] > 0.
  GrooveBeam(const Groove<Real>& groove, const Vector<Real>& omega, Facet first)
      : groove_(groove), side_(first == Facet::kA ? Real(-1) : Real(1)), k_(-omega) {
    // The ray to the apex crosses the aperture at u = to_apex. Rays with a smaller u meet facet A first.
    const Real to_apex = groove.sin_alpha * omega[0] / omega[2];
    const Real inside = std::clamp<Real>(to_apex, -groove.cos_alpha, groove.cos_alpha);
    meets_apex_ = inside == to_apex;
    flux_ = (first == Facet::kA ? groove.cos_alpha + inside : groove.cos_alpha - inside) * omega[2];
    if (flux_ <= 0) return;
    edge_ = {inside, Real(0), Real(0)};
    if (land() <= 0) flux_ = 0;
  }

  /// Flux on the current facet, per unit of length along the groove; 0 when all light has left.
  const Real& flux() const { return flux_; }
  /// Direction toward the current facet or, when all light has left, away from the groove.
  const Vector<Real>& direction() const { return k_; }
  Vector<Real> normal() const { return {-side_ * groove_.sin_alpha, Real(0), groove_.cos_alpha}; }

  /// Reflects the beam into `k_out`, toward the other facet. Returns the flux that misses the other facet and leaves.
  Real reflect(const Vector<Real>& k_out) {
    const Real before = flux_;
    k_ = k_out;
    side_ = -side_;
    flux_ = std::min<Real>(flux_, land());
    return before - flux_;
  }

 private:
  // Follows the edge of the beam to the facet on `side_`. Returns the flux of a beam that covers it from rim to edge.
  Real land() {
    const Vector<Real> n = normal();
    const Real cos_beta = -k_.dot(n);
    if (cos_beta <= 0) return 0;
    const Vector<Real> rim{side_ * groove_.cos_alpha, Real(0), Real(0)};
    const Vector<Real> down{-side_ * groove_.cos_alpha, Real(0), -groove_.sin_alpha};
    Real depth = 1;  // distance along the facet from its rim to the edge of the beam
    if (!meets_apex_) {
      const Vector<Real> from_rim = edge_ - rim;
      const Vector<Real> hit = from_rim + Real(from_rim.dot(n) / cos_beta) * k_;
      depth = std::clamp<Real>(hit.dot(down), Real(0), Real(1));
    }
    edge_ = rim + depth * down;
    return depth * cos_beta;
  }

  Groove<Real> groove_;
  Real side_;  ///< -1 on facet A, 1 on facet B
  Vector<Real> k_;
  Vector<Real> edge_ = Vector<Real>::Zero();
  Real flux_;
  bool meets_apex_;
};

}  // namespace dolp::reference
