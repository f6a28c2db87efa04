// Response tables: the contribution of facets at each local angle of incidence to the reflectance of a rough surface,
// for any material. Only this file names and orders their variables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dolp/enum_array.hpp>

namespace dolp {

/// A variable of a response table. With the reflectances R_s and R_p of a facet at the local angle of incidence beta, R
/// = (R_s + R_p) / 2 and D = (R_s - R_p) / 2, the sums over beta are moments, for k_s = 1 and without a diffuse part.
///
/// Accuracy: let a_m and b_m be the coefficients of the Chebyshev polynomials T_m(x), x = 2 asinh(cos(beta) / c0) /
///   asinh(1 / c0) - 1, m < beta.size(), through R (of emission 1 - R) and D / sin^2(beta) at the angles beta. Errors
///   are at most response_error times the largest of 2^m |a_m| and 2^m |b_m|, for any values R and D. That is 0.7
///   to 1.3 for bare materials, more where total reflection begins. A curve also adds its largest distance from the sum
///   of polynomials, of b_m times sin^2(beta), times the albedo (of emission times 1).
enum class ResponseVariable : std::uint8_t { kResponseI, kResponseQ, kEmissionI, kEmissionQ, kResponseError };
inline constexpr std::size_t kResponseVariableCount = static_cast<std::size_t>(ResponseVariable::kResponseError) + 1;

template <class Value>
using ResponseArray = EnumArray<ResponseVariable, Value, kResponseVariableCount>;

inline constexpr auto kAllResponseVariables = enumerators<ResponseVariable, kResponseVariableCount>();

struct ResponseDescription {
  const char* name;
  const char* long_name;
  bool has_beta;  ///< false: it has one value per entry
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
}};

constexpr const ResponseDescription& description_of(ResponseVariable variable) {
  return kResponseVariables[static_cast<std::size_t>(variable)];
}

/// The coordinate beta in files.
struct BetaDescription {
  const char* name;
  const char* long_name;
  const char* units;
};
inline constexpr BetaDescription kBeta = {"beta", "local angle of incidence", "degree"};

}  // namespace dolp
