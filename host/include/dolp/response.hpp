// Response tables. Such a table has a weight for the facets at each local angle of incidence. The weights give the
// reflectance of a rough surface of any material. Only this file names and orders the variables of response tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dolp/enum_array.hpp>
#include <dolp/errors.hpp>

namespace dolp {

/// A variable of a response table. The table has weights at local angles of incidence beta. Let R_s and R_p be the
/// reflectances of a facet at beta, R = (R_s + R_p) / 2 and D = (R_s - R_p) / 2. For a surface with the specular weight
/// k_s = 1 and no diffuse part, rho_I = sum over beta of response_i * R, and rho_Q = sum over beta of response_q * D.
/// Emissivities of direct emission: sum over beta of emission_i * (1 - R) for I, and of -emission_q * D for Q. Errors
/// of rho: at most F * response_error + albedo * P; errors of the emissivities: at most F * response_error + P. F
/// depends on the material: 0.7 to 1.3 if it is bare, more with total reflection (host/programs/cli/README.md). Between
/// the angles beta, polynomials replace R and D. P is the largest difference between R or D and its polynomial.
/// The fingerprint of an entry is response_fingerprint(). It shows whether another program changed the entry.
enum class ResponseVariable : std::uint8_t {
  kResponseI,
  kResponseQ,
  kEmissionI,
  kEmissionQ,
  kResponseError,
  kFingerprint
};
inline constexpr std::size_t kResponseVariableCount = static_cast<std::size_t>(ResponseVariable::kFingerprint) + 1;

template <class Value>
using ResponseArray = EnumArray<ResponseVariable, Value, kResponseVariableCount>;

inline constexpr auto kAllResponseVariables = enumerators<ResponseVariable, kResponseVariableCount>();

struct ResponseDescription {
  const char* name;
  const char* long_name;
  bool has_beta;  ///< true: one value per entry and angle beta; false: one value per entry
};

inline constexpr const char* kResponseQualifier = "response_error";

inline constexpr std::array<ResponseDescription, kResponseVariableCount> kResponseVariables = {{
    {"response_i", "weights of rho_i = sum over beta of response_i (r_s + r_p) / 2, for k_s = 1", true},
    {"response_q", "weights of rho_q = sum over beta of response_q (r_s - r_p) / 2, for k_s = 1", true},
    {"emission_i", "weights of the direct emissivity (eps_s + eps_p) / 2 = sum of emission_i (1 - (r_s + r_p) / 2)",
     true},
    {"emission_q", "weights of the direct emissivity (eps_s - eps_p) / 2 = -sum of emission_q (r_s - r_p) / 2", true},
    {kResponseQualifier, "bound of the errors of these sums for curves whose coefficients fall as 2^-m, see comment",
     false},
    {"fingerprint", "hash of the entry's numbers, by which dolp.moments finds entries that were changed", false},
}};

constexpr const ResponseDescription& describe(ResponseVariable variable) {
  return kResponseVariables[static_cast<std::size_t>(variable)];
}

/// The fingerprint of an entry in a response table, a whole number below 2^53. It changes with every bit of `numbers`.
/// These are theta in degree, sigma, q, albedo, response_error, then all response_i, then all response_q of the entry.
DOLP_EXPORT double response_fingerprint(std::span<const double> numbers);

struct BetaDescription {
  const char* name;
  const char* long_name;
  const char* units;
};
inline constexpr BetaDescription kBeta = {"beta", "local angle of incidence", "degree"};

}  // namespace dolp
