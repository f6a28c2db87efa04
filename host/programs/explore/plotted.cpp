#include "explore/plotted.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace dolp::explore {
namespace {

constexpr std::array kAllPlotted = {
    PlottedDescription{Plotted::kDolp, "DOLP", "√(Q² + U²)/I, in percent", true, false},
    PlottedDescription{Plotted::kSignedDolp, "Q/I", "positive: s polarised, negative: p; in percent", true, false},
    PlottedDescription{Plotted::kRhoS, "ρ_s", "ρ_I + ρ_Q, eq. (16)", false, true},
    PlottedDescription{Plotted::kRhoP, "ρ_p", "ρ_I − ρ_Q, eq. (16)", false, true},
    PlottedDescription{Plotted::kEmissivityS, "ε_s", "1 − ρ_s (Kirchhoff)", false, true},
    PlottedDescription{Plotted::kEmissivityP, "ε_p", "1 − ρ_p (Kirchhoff)", false, true},
    PlottedDescription{Plotted::kAlbedo, "albedo", "A(θ), ρ of perfectly reflecting facets", false, true},
};

}  // namespace

std::span<const PlottedDescription> all_plotted() { return kAllPlotted; }

const PlottedDescription& described(Plotted quantity) {
  for (const PlottedDescription& known : kAllPlotted) {
    if (known.quantity == quantity) return known;
  }
  throw std::logic_error("no such quantity");
}

double value_of(Plotted quantity, const Point& r) {
  switch (quantity) {
    case Plotted::kDolp:
      return r.dolp;
    case Plotted::kSignedDolp:
      return r.stokes_q / r.stokes_i;
    case Plotted::kRhoS:
      return r.rho_i + r.rho_q;
    case Plotted::kRhoP:
      return r.rho_i - r.rho_q;
    case Plotted::kEmissivityS:
      return 1.0 - (r.rho_i + r.rho_q);
    case Plotted::kEmissivityP:
      return 1.0 - (r.rho_i - r.rho_q);
    case Plotted::kAlbedo:
      return r.albedo;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double error_of(Plotted quantity, const Point& r) {
  if (quantity == Plotted::kDolp || quantity == Plotted::kSignedDolp) return r.error_estimate;
  if (quantity == Plotted::kAlbedo) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * r.rho_error_estimate * std::abs(r.rho_i);  // of the sum of two moments
}

std::string status_text(std::uint32_t status) {
  std::string text;
  const auto add = [&](std::uint32_t bit, const char* meaning) {
    if (status & bit) text += (text.empty() ? "" : ", ") + std::string(meaning);
  };
  add(kReflectanceOutsideZeroToOne, "ρ outside [0, 1]");
  add(kToleranceNotMet, "tolerance missed");
  add(kOutsideModelDomain, "outside the model's domain");
  add(kIntensityNotPositive, "I ≤ 0");
  return text.empty() ? "good" : text;
}

}  // namespace dolp::explore
