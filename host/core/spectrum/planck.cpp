#include "spectrum/planck.hpp"

#include <cmath>

namespace dolp {
namespace {

constexpr double kPlanck_Js = 6.62607015e-34;
constexpr double kLightSpeed_m_per_s = 299792458.0;
constexpr double kBoltzmann_J_per_K = 1.380649e-23;
// 1e6 converts m K to um K. 1e24 = 1e30 * 1e-6: 1e30 for lambda^-5 with lambda in um, 1e-6 for a radiance per um.
constexpr double kSecondRadiationConstant_umK = kPlanck_Js * kLightSpeed_m_per_s / kBoltzmann_J_per_K * 1e6;
constexpr double kFirstRadianceConstant = 2.0 * kPlanck_Js * kLightSpeed_m_per_s * kLightSpeed_m_per_s * 1e24;

}  // namespace

double planck_radiance(double wavelength_um, double temperature_K) {
  if (temperature_K == 0.0) return 0.0;
  const double exponent = kSecondRadiationConstant_umK / (wavelength_um * temperature_K);
  const double squared = wavelength_um * wavelength_um;
  return kFirstRadianceConstant / (squared * squared * wavelength_um) / std::expm1(exponent);
}

}  // namespace dolp
