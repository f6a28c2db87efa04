// The hemispherical moments of the specular microfacet term (k_s = 1, no diffuse part).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/slopes.hpp"

namespace dolp {

class ResponseBasis;
class SkyBasis;

/// The tightest tolerance of a rule in float; rounding dominates tighter ones.
inline constexpr double kLeastFloatTolerance = 2e-6;

/// A point at which moments are computed.
struct MomentsPoint {
  double theta_deg = 0.0;
  SlopeShape shape;
  FacetOptics index;
  friend bool operator==(const MomentsPoint&, const MomentsPoint&) = default;
};

/// Responses to the local angle of incidence (response_basis.hpp). In a request they replace the functions of its sky.
struct Response {
  enum class Of : std::uint8_t {
    kReflected,  ///< the light reflected
    kSky,        ///< this light, weighted with the function of the sky, which has one
    kDirect      ///< the direct emission
  };
  std::size_t count = 0;
  double c0 = 1.0;
  double bend = 1.0;  ///< ResponseBasis::bend, which the rules take up
  Of of = Of::kReflected;
};

/// The entries whose moments are wanted: the grid optics x theta x sigma x q, q fastest, as in a table, or points, for
/// which the four lists have one value each. An entry is its position in that order.
struct MomentsRequest {
  enum class Layout { kGrid, kList };

  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple: with v-cavity
  bool wants_direct = false;                    ///< direct_i and direct_q too; with v-cavity or smith
  double tolerance = 1e-4;                      ///< tolerance of the rule, relative to r_i
  Precision precision = Precision::kAuto;       ///< kAuto: float
  bool may_interpolate = true;                  ///< between slope distributions, to the same tolerance
  bool has_extra_splits = false;                ///< a rule of another kind, to check others with
  std::shared_ptr<const ResponseBasis> basis;   ///< combines the moments of all optics; null: none
  std::shared_ptr<const SkyBasis> sky;          ///< its functions give Moments::columns; null: none
  std::optional<Response> response;             ///< the responses give Moments::columns
  Layout layout = Layout::kGrid;
  std::vector<double> theta_deg;
  std::vector<FacetOptics> optics;  ///< bare facets, or facets with films
  std::vector<double> sigma;
  std::vector<double> q;
  std::vector<char> wanted;  ///< flag of each entry of a grid; empty: all. The moments of other entries are undefined

  std::size_t size() const;
  bool is_wanted(std::size_t entry) const { return wanted.empty() || wanted[entry] != 0; }
  std::size_t wanted_count() const;
  /// A share of the tolerance, but no less than the precision allows.
  double finer_tolerance(double share) const;
  /// Slope distributions of one direction and index of a grid.
  std::size_t shapes() const { return sigma.size() * q.size(); }
  MomentsPoint operator[](std::size_t entry) const;
  /// The request for some directions of a grid, by their positions.
  MomentsRequest of_directions(std::span<const std::size_t> directions) const;
  /// Adds a point, which makes it a request for points.
  void append(const MomentsPoint& point);
};

/// The moments with a function g of each facet, |g| <= 1. For a sky, g depends on the zenith of the reflected ray and
/// multiplies r_i and r_q. For responses, g depends on the local angle of incidence and replaces (R_s + R_p) / 2 and
/// (R_s - R_p) / (2 sin^2).
struct ColumnMoments {
  double i = 0.0;
  double q = 0.0;
  double error = 0.0;  ///< bound of the absolute error of both; for a response, without the next three
  // For a response: bounds of the error that sums over responses share, with its sign, and relative to the sum.
  double i_apart = 0.0;
  double q_apart = 0.0;
  double relative_error = 0.0;
};

/// The moments of one entry, all multiplied by cos(theta), which keeps them finite at theta = 90 degrees.
/// r = rho cos(theta); rho_s = rho_I + rho_Q, rho_p = rho_I - rho_Q.
struct Moments {
  double r_i = 0.0;      ///< rho_I cos(theta)
  double r_q = 0.0;      ///< rho_Q cos(theta), signed
  double albedo = 0.0;   ///< A cos(theta): the same integral with R = 1
  double deficit = 0.0;  ///< cos(theta) - r_i, summed directly: no cancellation where rho_I is near 1
  /// Emission of the facets straight to the viewer: eps_I cos(theta) of the direct emission; NaN where not wanted.
  double direct_i = std::numeric_limits<double>::quiet_NaN();
  double direct_q = std::numeric_limits<double>::quiet_NaN();  ///< eps_Q cos(theta); eps_s, eps_p = eps_I +- eps_Q
  // Bounds of the absolute errors of the six, in the same units (quadrature, masking tables and rounding).
  double r_i_error = 0.0;
  double r_q_error = 0.0;
  double albedo_error = 0.0;
  double deficit_error = 0.0;
  double direct_i_error = 0.0;
  double direct_q_error = 0.0;
  double evaluations = 0.0;                 ///< integrand evaluations spent on this entry
  std::vector<ColumnMoments> columns = {};  ///< with each function of the request's sky or responses
};

/// A moment and the bound of its error.
struct MomentMember {
  double Moments::*value;
  double Moments::*error;
};
/// All members; the two of the direct emission come last.
inline constexpr std::array<MomentMember, 6> kMomentMembers = {{{&Moments::r_i, &Moments::r_i_error},
                                                                {&Moments::r_q, &Moments::r_q_error},
                                                                {&Moments::albedo, &Moments::albedo_error},
                                                                {&Moments::deficit, &Moments::deficit_error},
                                                                {&Moments::direct_i, &Moments::direct_i_error},
                                                                {&Moments::direct_q, &Moments::direct_q_error}}};
inline constexpr std::size_t kDirectMembers = 2;

}  // namespace dolp
