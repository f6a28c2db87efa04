// The quantities of results. Only this file names and orders them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dolp/enum_array.hpp>

namespace dolp {

/// A quantity of results, with one number per entry or point. Table files have the quantities in this order, and the
/// status after the last one.
/// Units: Stokes parameters are exitances, in W m-2 um-1 at one wavelength and W m-2 over a band; in bistatic mode they
/// are radiances, in W m-2 sr-1 um-1 and W m-2 sr-1. The angle of polarisation is in degrees. The other quantities
/// have unit 1.
/// Q = I_s - I_p; in hemispherical mode V = 0, and U = 0 unless slopes differ along and across. Over a band, the
/// reflectance rho is a weighted mean. The weight is the emission pi B(T) or, in a scene without emission, the incident
/// radiation. Without both, the weight is constant.
enum class Quantity : std::uint8_t {
  kDolp,    ///< sqrt(Q^2 + U^2) / I; negative if I is negative, NaN if I is 0
  kQOverI,  ///< Q / I, signed: positive if s-polarised radiation prevails
  kAolp,    ///< atan2(U, Q) / 2 in degrees, in [0, 180): 0 is the direction s, 90 is p; NaN if Q = U = 0
  kStokesI,
  kStokesQ,
  kStokesU,
  kStokesV,
  kRhoI,         ///< (rho_s + rho_p) / 2, including the specular weight k_s and the diffuse part
  kRhoQ,         ///< (rho_s - rho_p) / 2, including k_s and the diffuse part
  kRhoU,         ///< rho_U, including k_s; nonzero only if slopes differ along and across
  kAlbedo,       ///< A(theta): specular reflectance if all facets reflect perfectly, without the weight k_s
  kEmissivityS,  ///< emissivity by the emission model of the scene; over a band, its mean with the weight pi B(T)
  kEmissivityP,
  kDolpLow,  ///< kDolpLow and kDolpHigh bound the DOLP that all bounces of light would give
  kDolpHigh,
  kErrorEstimate,     ///< bound of the error of dolp, q_over_i, dolp_low and dolp_high; infinite if unknown
  kRhoErrorEstimate,  ///< bound of the errors of rho_i and rho_q, relative to rho_i; infinite if unknown
};
inline constexpr std::size_t kQuantityCount = static_cast<std::size_t>(Quantity::kRhoErrorEstimate) + 1;

template <class Value>
using QuantityArray = EnumArray<Quantity, Value, kQuantityCount>;

inline constexpr std::array<Quantity, kQuantityCount> kAllQuantities = enumerators<Quantity, kQuantityCount>();

/// Some of the quantities, in the order of the enumeration.
using Quantities = std::vector<Quantity>;

/// Needs of a quantity: rho or moments (integrals over the facets) from the run; emission, a bracket, or slopes that
/// differ along and across in the scene.
enum class QuantityNeeds : std::uint8_t { kNothing, kReflectance, kMoments, kEmission, kBracket, kCrossSlopes };

struct QuantityDescription {
  const char* name;
  const char* long_name;
  const char* units;      ///< null: the units of Stokes parameters, which depend on the scene
  const char* ancillary;  ///< names of the variables with the quantity's error bound and status; "" if none
  QuantityNeeds needs;
};

inline constexpr const char* kDolpQualifiers = "error_estimate status";
inline constexpr const char* kRhoQualifiers = "rho_error_estimate status";
inline constexpr const char* kStatusQualifier = "status";

inline constexpr std::array<QuantityDescription, kQuantityCount> kQuantities = {{
    {"dolp", "degree of linear polarisation", "1", kDolpQualifiers, QuantityNeeds::kNothing},
    {"q_over_i", "degree of linear polarisation Q / I, positive where s prevails", "1", kDolpQualifiers,
     QuantityNeeds::kNothing},
    {"aolp_deg", "angle of linear polarisation from the s direction", "degree", kStatusQualifier,
     QuantityNeeds::kNothing},
    {"stokes_i", "Stokes parameter I of the radiation that leaves the surface and reaches the sensor", nullptr,
     kStatusQualifier, QuantityNeeds::kNothing},
    {"stokes_q", "Stokes parameter Q = I_s - I_p", nullptr, kStatusQualifier, QuantityNeeds::kNothing},
    {"stokes_u", "Stokes parameter U", nullptr, kStatusQualifier, QuantityNeeds::kNothing},
    {"stokes_v", "Stokes parameter V", nullptr, kStatusQualifier, QuantityNeeds::kNothing},
    {"rho_i", "hemispherical-directional reflectance, mean of s and p", "1", kRhoQualifiers,
     QuantityNeeds::kReflectance},
    {"rho_q", "hemispherical-directional reflectance, half the difference of s and p", "1", kRhoQualifiers,
     QuantityNeeds::kReflectance},
    {"rho_u", "hemispherical-directional reflectance, Stokes parameter U", "1", kRhoQualifiers,
     QuantityNeeds::kCrossSlopes},
    {"albedo", "albedo of the surface model with perfectly reflecting facets", "1", kStatusQualifier,
     QuantityNeeds::kMoments},
    {"emissivity_s", "emissivity of s-polarised radiation that the emission uses", "1", kStatusQualifier,
     QuantityNeeds::kEmission},
    {"emissivity_p", "emissivity of p-polarised radiation that the emission uses", "1", kStatusQualifier,
     QuantityNeeds::kEmission},
    {"dolp_low", "least degree of linear polarisation with all bounces", "1", kDolpQualifiers, QuantityNeeds::kBracket},
    {"dolp_high", "largest degree of linear polarisation with all bounces", "1", kDolpQualifiers,
     QuantityNeeds::kBracket},
    {"error_estimate", "bound of the absolute errors of dolp and q_over_i", "1", "", QuantityNeeds::kNothing},
    {"rho_error_estimate", "bound of the errors of rho_i and rho_q relative to rho_i", "1", "",
     QuantityNeeds::kReflectance},
}};

static_assert(kQuantities.back().name != nullptr, "each quantity has a row");

constexpr const QuantityDescription& describe(Quantity quantity) {
  return kQuantities[static_cast<std::size_t>(quantity)];
}

inline std::string quantity_units(Quantity quantity, const std::string& stokes_units) {
  const char* const units = describe(quantity).units;
  return units ? units : stokes_units;
}

/// The quantities in the order of their columns in CSV files of results at points.
inline constexpr std::array<Quantity, kQuantityCount> kCsvOrder = {
    Quantity::kRhoI,          Quantity::kRhoQ,
    Quantity::kAlbedo,        Quantity::kStokesI,
    Quantity::kStokesQ,       Quantity::kStokesU,
    Quantity::kStokesV,       Quantity::kDolp,
    Quantity::kErrorEstimate, Quantity::kRhoErrorEstimate,
    Quantity::kEmissivityS,   Quantity::kEmissivityP,
    Quantity::kDolpLow,       Quantity::kDolpHigh,
    Quantity::kQOverI,        Quantity::kAolp,
    Quantity::kRhoU};
static_assert(std::ranges::is_permutation(kCsvOrder, kAllQuantities), "each quantity is in it once");

}  // namespace dolp
