// Response tables: the contribution of facets at each local angle of incidence to the reflectance of a rough surface,
// for any material. Only this file names and orders their variables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dolp/enum_array.hpp>

namespace dolp {

/// A variable of a response table. The table has weights at local angles of incidence beta. Let R = (R_s + R_p) / 2 and
/// D = (R_s - R_p) / 2 be reflectances of a facet at beta. Sums over beta of weights times R or D are the moments for
/// k_s = 1 without a diffuse part.
/// Accuracy: let x = 2 asinh(cos(beta) / c0) / asinh(1 / c0) - 1, where c0 is an attribute of the table. Interpolate R
/// (for emission 1 - R) at the angles beta by a sum of Chebyshev polynomials T_m(x), m < beta.size(), with the
/// coefficients a_m. Interpolate D / sin^2(beta) in the same way, with the coefficients b_m. The error of a sum is at
/// most response_error times the largest of all 2^m |a_m| and 2^m |b_m|, whatever R and D are. This largest value is
/// 0.7 to 1.3 for bare materials, and more if total reflection begins at some beta. Between the angles beta, R differs
/// from its polynomial, and D from its polynomial times sin^2(beta). The largest of these differences, times the albedo
/// (for emission times 1), adds to the error.
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

/// The coordinate beta of table files.
struct BetaDescription {
  const char* name;
  const char* long_name;
  const char* units;
};
inline constexpr BetaDescription kBeta = {"beta", "local angle of incidence", "degree"};

}  // namespace dolp
