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

/// The tightest tolerance of a rule in float. Below it rounding errors dominate.
inline constexpr double kLeastFloatTolerance = 2e-6;

struct MomentsPoint {
  double theta_deg = 0.0;
  SlopeShape shape;
  FacetOptics index;
  friend bool operator==(const MomentsPoint&, const MomentsPoint&) = default;
};

/// Asks for responses to the local angle of incidence (response_basis.hpp) instead of moments with functions of a sky.
struct Response {
  enum class Of : std::uint8_t {
    kReflected,  ///< responses of the reflected light
    kSky,        ///< responses of the reflected light times the only function of the request's sky
    kDirect      ///< responses of the direct emission
  };
  std::size_t count = 0;
  double c0 = 1.0;
  double bend = 1.0;  ///< distance of a singularity that the rules must resolve (ResponseBasis::bend)
  Of of = Of::kReflected;
};

/// A grid has all combinations of optics, theta, sigma and q; q varies fastest. A list has one value per entry in each
/// of these four vectors. An entry is identified by its position in this order.
struct MomentsRequest {
  enum class Layout { kGrid, kList };

  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple only with v-cavity
  bool wants_direct = false;                    ///< asks for direct_i and direct_q too; only with v-cavity or smith
  double tolerance = 1e-4;                      ///< tolerance of the rule, relative to r_i
  Precision precision = Precision::kAuto;       ///< kAuto means float
  bool may_interpolate = true;                  ///< allows interpolation between slope distributions, to `tolerance`
  bool has_extra_splits = false;                ///< adds split lines, so that the result can check a rule without them
  std::shared_ptr<const ResponseBasis> basis;   ///< basis from which all optics are combined; null: each is integrated
  std::shared_ptr<const SkyBasis> sky;  ///< Moments::columns has a column per function of this sky; null: no columns
  std::optional<Response> response;     ///< asks for responses, which Moments::columns then has instead
  Layout layout = Layout::kGrid;
  std::vector<double> theta_deg;
  std::vector<FacetOptics> optics;  ///< bare facets, or facets with films
  std::vector<double> sigma;
  std::vector<double> q;
  std::vector<char> wanted;  ///< one flag per entry of a grid; empty: all. Moments of unwanted entries are undefined

  std::size_t size() const;
  bool is_wanted(std::size_t entry) const { return wanted.empty() || wanted[entry] != 0; }
  std::size_t wanted_count() const;
  /// `share` times the tolerance, but in float at least the smaller of kLeastFloatTolerance and the tolerance.
  double finer_tolerance(double share) const;
  std::size_t shapes() const { return sigma.size() * q.size(); }
  MomentsPoint operator[](std::size_t entry) const;
  /// The same request for only some directions of a grid, given by their positions in `theta_deg`.
  MomentsRequest of_directions(std::span<const std::size_t> directions) const;
  void append(const MomentsPoint& point);  ///< also makes the request a list
};

/// Moments of one entry whose integrands contain a function g of the facet, |g| <= 1. For a sky, g depends on the
/// zenith of the reflected ray and multiplies the integrands of r_i and r_q. For a response, g depends on the local
/// angle of incidence and replaces (R_s + R_p) / 2 in r_i and (R_s - R_p) / (2 sin^2) in r_q.
struct ColumnMoments {
  double i = 0.0;
  double q = 0.0;
  double error = 0.0;  ///< bound of the absolute errors of i and q; for a response the next three add to it
  // Only for a response. i_apart and q_apart are signed differences between two rules. The magnitude of their weighted
  // sum bounds the error of a weighted sum of responses. relative_error is relative to that sum.
  double i_apart = 0.0;
  double q_apart = 0.0;
  double relative_error = 0.0;
};

/// The moments of one entry for k_s = 1. All have the factor cos(theta), which keeps them finite at theta = 90 degrees:
/// r = rho cos(theta). For s and p polarisation, rho_s = rho_I + rho_Q and rho_p = rho_I - rho_Q.
struct Moments {
  double r_i = 0.0;      ///< rho_I cos(theta)
  double r_q = 0.0;      ///< rho_Q cos(theta), with its sign
  double albedo = 0.0;   ///< A cos(theta): the integral of r_i for R = 1
  double deficit = 0.0;  ///< cos(theta) - r_i, computed without cancellation where rho_I is near 1
  /// Emission of the facets straight to the viewer: eps_I cos(theta). NaN if the request does not want direct emission.
  double direct_i = std::numeric_limits<double>::quiet_NaN();
  double direct_q = std::numeric_limits<double>::quiet_NaN();  ///< eps_Q cos(theta); eps_s = eps_I + eps_Q
  // Bounds of the absolute errors of these six numbers. They include quadrature, masking tables and rounding.
  double r_i_error = 0.0;
  double r_q_error = 0.0;
  double albedo_error = 0.0;
  double deficit_error = 0.0;
  double direct_i_error = 0.0;
  double direct_q_error = 0.0;
  double evaluations = 0.0;                 ///< integrand evaluations spent on this entry
  std::vector<ColumnMoments> columns = {};  ///< one column for each function of the request's sky, or for each response
};

struct MomentMember {
  double Moments::*value;
  double Moments::*error;
};
inline constexpr std::array<MomentMember, 6> kMomentMembers = {{{&Moments::r_i, &Moments::r_i_error},
                                                                {&Moments::r_q, &Moments::r_q_error},
                                                                {&Moments::albedo, &Moments::albedo_error},
                                                                {&Moments::deficit, &Moments::deficit_error},
                                                                {&Moments::direct_i, &Moments::direct_i_error},
                                                                {&Moments::direct_q, &Moments::direct_q_error}}};
inline constexpr std::size_t kDirectMembers = 2;  ///< the last members are direct_i and direct_q

}  // namespace dolp
