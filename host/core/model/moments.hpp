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

inline constexpr double kLeastFloatTolerance = 2e-6;  ///< least tolerance in float; below it, rounding errors dominate

struct MomentsPoint {
  double theta_deg = 0.0;
  SlopeShape shape;
  FacetOptics index;
  friend bool operator==(const MomentsPoint&, const MomentsPoint&) = default;
};

/// Requests responses. A response is a moment with a polynomial instead of a reflectance (see response_basis.hpp).
struct Response {
  enum class Of : std::uint8_t {
    kReflected,  ///< responses for r_i and r_q
    kSky,        ///< responses for r_i and r_q with a function of the sky, the only one in MomentsRequest::sky
    kDirect      ///< responses for direct_i and direct_q
  };
  std::size_t count = 0;
  double c0 = 1.0;
  double bend = 1.0;  ///< see ResponseBasis::bend
  Of of = Of::kReflected;
  friend bool operator==(const Response&, const Response&) = default;
};

/// Entries with the same direction and index. They are consecutive in a request.
struct Bundle {
  std::uint32_t direction = 0;  ///< position in MomentsRequest::theta_deg
  std::uint32_t index = 0;      ///< position in MomentsRequest::optics
  std::uint32_t first = 0;      ///< position in MomentsRequest::members
  std::uint32_t count = 0;      ///< number of entries
  std::size_t first_entry = 0;  ///< number of the first entry in the request
  friend bool operator==(const Bundle&, const Bundle&) = default;
  /// True if both bundles have the same direction and slope distributions.
  bool has_geometry(const Bundle& other) const {
    return direction == other.direction && first == other.first && count == other.count;
  }
};

/// The settings that all entries of a request share.
struct MomentsSettings {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple only with v-cavity
  bool wants_direct = false;                    ///< requests also direct_i and direct_q; only with v-cavity or smith
  double tolerance = 1e-4;                      ///< allowed error of a moment, as a share of r_i
  double scene_tolerance = 0.0;                 ///< limits the cost of tables if `tolerance` is far smaller
  Precision precision = Precision::kAuto;       ///< kAuto means float
  bool may_interpolate = true;  ///< allows interpolation between slope distributions, within `tolerance`
  /// The entries are scattered points. Then it depends on all of them whether responses save work, and whether the
  /// responses are interpolated between directions.
  bool is_scattered = false;
  bool has_lone_entries = false;               ///< most bundles have one entry, so there are no slope samples to share
  bool has_extra_splits = false;               ///< integrates with more panels than usual, to check another computation
  std::shared_ptr<const ResponseBasis> basis;  ///< if set, moments are sums of the responses of this basis
  std::shared_ptr<const SkyBasis> sky;  ///< if set, Moments::columns has one element for each function of this sky
  std::optional<Response> response;     ///< if set, Moments::columns has one element for each response

  /// `share` times the tolerance. In float it is at least kLeastFloatTolerance, but never more than `tolerance`.
  double finer_tolerance(double share) const;
  friend bool operator==(const MomentsSettings&, const MomentsSettings&) = default;
};

/// The entries are given by lists of values, and by bundles that point into these lists. A grid has a bundle for each
/// pair of a direction and an index, and all bundles share one range of members.
struct MomentsRequest : MomentsSettings {
  std::vector<double> theta_deg;
  std::vector<FacetOptics> optics;
  std::vector<SlopeShape> shapes;  ///< elliptic ones not with masking integral
  /// Positions in `shapes`. They begin with 0, 1, 2, ... for all shapes. In the range of a bundle they ascend.
  std::vector<std::uint32_t> members;
  std::vector<Bundle> bundles;

  std::size_t size() const { return bundles.empty() ? 0 : bundles.back().first_entry + bundles.back().count; }
  MomentsPoint operator[](std::size_t entry) const;
  std::size_t find_bundle(std::size_t entry) const;  ///< the position of an entry's bundle
  std::span<const std::uint32_t> bundle_shapes(const Bundle& bundle) const {
    return std::span(members).subspan(bundle.first, bundle.count);
  }
  bool has_elliptic_shapes() const;
  /// Elliptic slopes with smith masking: only the direct emission is computed. The other moments have the values of a
  /// surface that reflects nothing.
  bool has_only_direct() const { return masking == Masking::kSmith && has_elliptic_shapes(); }

  /// Replaces the entries by all combinations of optics, theta_deg and shapes; the last varies fastest.
  void set_grid();
  /// Replaces the slope distributions: each bundle gets all of `new_shapes`.
  void set_shapes(std::vector<SlopeShape> new_shapes);
  void add_bundle(std::uint32_t direction, std::uint32_t index, std::uint32_t first, std::uint32_t count);
  void append(const MomentsPoint& point);  ///< adds a lone entry
  MomentsRequest without_entries() const;  ///< only the settings
  /// This request for only some bundles, given by their positions, or for only some entries, given by ascending
  /// numbers.
  MomentsRequest select_bundles(std::span<const std::size_t> positions) const;
  MomentsRequest select_entries(std::span<const std::size_t> entries) const;
  friend bool operator==(const MomentsRequest&, const MomentsRequest&) = default;
};

/// All combinations of sigma and q; q varies fastest.
std::vector<SlopeShape> shape_product(std::span<const double> sigma, std::span<const double> q);

/// Moments of one entry with a function g in the integrands, |g| <= 1. There are two kinds of columns:
/// - Sky: g depends on the zenith of the reflected ray. It multiplies the integrands of r_i and r_q.
/// - Response: g depends on the local angle of incidence beta. It replaces (R_s + R_p) / 2 in r_i and
///   (R_s - R_p) / (2 sin^2(beta)) in r_q.
struct ColumnMoments {
  double i = 0.0;
  double q = 0.0;
  double error = 0.0;  ///< for a sky: bound of the absolute errors of i, q and u. For a response: see below
  // The next members are for responses. i_apart and q_apart are differences between two quadrature rules, times a
  // safety factor. Let response j have the weight w_j. The error of the weighted sum S = sum_j w_j i_j has the bound
  // |sum_j w_j i_apart_j| + relative_error |S| + sum_j |w_j| error_j. The same holds for q.
  double i_apart = 0.0;
  double q_apart = 0.0;
  double relative_error = 0.0;
  double u = 0.0;  ///< for a sky and an elliptic slope distribution
};

/// The moments of one entry if all reflection is specular (k_s = 1). A moment is a reflectance rho times cos(theta), so
/// it is finite at theta = 90 degrees. For s and p polarisation, rho_s = rho_I + rho_Q and rho_p = rho_I - rho_Q.
struct Moments {
  double r_i = 0.0;      ///< rho_I cos(theta)
  double r_q = 0.0;      ///< rho_Q cos(theta)
  double albedo = 0.0;   ///< A cos(theta), where A is rho_I of facets that reflect all light (R_s = R_p = 1)
  double deficit = 0.0;  ///< cos(theta) - r_i, computed without cancellation where rho_I is near 1
  /// eps_I cos(theta) of the light that facets emit straight to the viewer. NaN if the request does not ask for it.
  double direct_i = std::numeric_limits<double>::quiet_NaN();
  double direct_q = std::numeric_limits<double>::quiet_NaN();  ///< eps_Q cos(theta); eps_s = eps_I + eps_Q
  // Bounds of the absolute errors of these six moments, including errors of quadrature, masking tables and rounding.
  double r_i_error = 0.0;
  double r_q_error = 0.0;
  double albedo_error = 0.0;
  double deficit_error = 0.0;
  double direct_i_error = 0.0;
  double direct_q_error = 0.0;
  // Nonzero only with an elliptic slope distribution. The bounds of q hold for u as well.
  double r_u = 0.0;                         ///< rho_U cos(theta), in the frame of the viewer
  double direct_u = 0.0;                    ///< eps_U cos(theta)
  double evaluations = 0.0;                 ///< evaluations of the integrand for this entry
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
inline constexpr std::size_t kDirectMembers = 2;  ///< direct_i and direct_q are the last of kMomentMembers

}  // namespace dolp
