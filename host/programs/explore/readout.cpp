#include "explore/readout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dolp::explore {
namespace {

// Albedos outside these limits are mentioned.
constexpr double kAlbedoMin = 0.95;
constexpr double kAlbedoMax = 1.05;
constexpr double kPercent = 100.0;

/// A bound in points of DOLP.
std::string points_text(double bound) { return std::isfinite(bound) ? fmt::format("{:.2g}", kPercent * bound) : "∞"; }

const char* polarisation(double q_over_i) { return q_over_i > 0.0 ? "s" : "p"; }

/// A radiating effect and what it adds to Q/I at the peak.
struct Part {
  std::string name;
  double q_over_i;
};

/// Stokes parameters add up, so the remainder that no other part explains belongs to the emission where it cannot be
/// removed alone.
std::vector<Part> radiating_parts(const Session& session) {
  const Peak& peak = session.peak();
  double rest = peak.answer()->q_over_i;
  std::vector<Part> parts;
  for (const WithoutEffect& away : peak.without()) {
    if (!away.radiates) continue;
    parts.push_back({away.effect, peak.contribution(away)});
    rest -= parts.back().q_over_i;
  }
  const auto has = [&](const char* key) { return session.scene().number(key).has_value(); };
  const bool has_emission = !parts.empty() && parts.front().name == "emission";
  if (has_emission) return parts;
  const char* name = has("emission.temperature_K") ? "emission" : has("source.scale") ? "source" : "surroundings";
  const bool is_known = std::ranges::any_of(parts, [&](const Part& part) { return part.name == name; });
  if (!is_known) parts.insert(parts.begin(), {name, rest});
  return parts;
}

}  // namespace

std::string peak_text(const Session& session) {
  const std::optional<PeakAnswer>& peak = session.peak().answer();
  if (!session.curve().is_finished() || !peak) return "Maximum: …";
  if (peak->dolp <= peak->error) return "Maximum: the DOLP is 0 everywhere, within its bound";
  const char* of = is_bistatic(session.scene()) ? " of the source" : "";
  std::string text =
      fmt::format("Maximum: DOLP {:.3f} % at θ = {:.2f}°{}, {} polarised. Numerical error ≤ {} points; ",
                  kPercent * peak->dolp, peak->theta_deg, of, polarisation(peak->q_over_i), points_text(peak->error));
  if (peak->rival_deg) {
    text += fmt::format("with it the maximum may as well be elsewhere, at {:g}° for instance.", *peak->rival_deg);
  } else if (peak->theta_low_deg == peak->theta_high_deg) {
    text += fmt::format("the maximum is there to {:g}°.", Peak::kStepDeg);
  } else {
    text +=
        fmt::format("the maximum is surely between {:.2f}° and {:.2f}°.", peak->theta_low_deg, peak->theta_high_deg);
  }
  if (peak->is_at_end) text += " Beyond it the model fails, or the range ends.";
  // The bound covers numerical error only; the albedo shows the error of the surface model itself.
  if (std::isfinite(peak->albedo) && peak->albedo < kAlbedoMin) {
    text += fmt::format(" The surface model loses energy there (albedo {:.2f}).", peak->albedo);
  }
  if (std::isfinite(peak->albedo) && peak->albedo > kAlbedoMax) {
    text += fmt::format(" The surface model gains energy there (albedo {:.2f}).", peak->albedo);
  }
  return text;
}

std::string cause_text(const Session& session) {
  const Peak& peak = session.peak();
  if (!session.curve().is_finished() || !peak.is_complete()) return "Cause: …";
  const double sum = peak.answer()->q_over_i;
  std::string with;
  std::string against;
  for (const Part& part : radiating_parts(session)) {
    std::string& side = part.q_over_i * sum >= 0.0 ? with : against;
    side += fmt::format("{}{} {:+.2f}", side.empty() ? "" : ", ", part.name, kPercent * part.q_over_i);
  }
  std::string text = fmt::format("Cause, in points of Q/I (+ is s, - is p): {}", with);
  if (!against.empty()) text += "; against it: " + against;
  return text + fmt::format("; sum {:+.2f}.", kPercent * sum);
}

std::string cursor_text(const Session& session) {
  const Point* const shown = session.at_cursor();
  if (!shown) return "Cursor: …";
  const Point& r = *shown;
  std::string text = fmt::format("Cursor{}: θ = {:.1f}°, σ = {:.4g}, q = {:.4g}: DOLP {:.3f} % ± {}, Q/I {:+.3f} %",
                                 stale_text(session.curve().is_stale()), r.theta_deg, r.sigma, r.q, kPercent * r.dolp,
                                 points_text(r.error_estimate), kPercent * r.stokes_q / r.stokes_i);
  if (has_bracket(r)) {
    text += fmt::format(", all bounces {:.3f} to {:.3f} %", kPercent * r.dolp_low, kPercent * r.dolp_high);
  }
  if (std::isfinite(r.rho_i)) {
    text += fmt::format(", ρ_s {:.4f}, ρ_p {:.4f}", r.rho_i + r.rho_q, r.rho_i - r.rho_q);
  }
  if (std::isfinite(r.albedo)) text += fmt::format(", albedo {:.3f}", r.albedo);
  return text + "; " + status_text(r.status);
}

std::string without_text(const Session& session, const std::string& effect) {
  const std::optional<PeakAnswer>& peak = session.peak().answer();
  if (!peak) return {};
  for (const WithoutEffect& away : session.peak().without()) {
    if (effect != away.effect || !away.is_known) continue;
    const double q_over_i = away.result.stokes_q / away.result.stokes_i;
    if (!is_good(away.result) || !std::isfinite(q_over_i)) return "the model fails";
    return fmt::format("{:+.2f} → {:+.2f} %", kPercent * (q_over_i - peak->q_over_i), kPercent * q_over_i);
  }
  return {};
}

std::vector<std::string> cost_lines(const Session& session) {
  const Curve& curve = session.curve();
  const CurveReport& cost = curve.report();
  if (!curve.is_finished()) return {"time …", "work …", "error …"};
  const double points = static_cast<double>(cost.points);
  constexpr double kMilliseconds = 1e3;
  constexpr double kMicroseconds = 1e6;
  return {fmt::format("time    {:.1f} ms for {} directions, {:.0f} µs each", kMilliseconds * cost.wall_s, cost.points,
                      kMicroseconds * cost.wall_s / points),
          fmt::format("work    {:.0f} integrand evaluations an entry", cost.evaluations / points),
          fmt::format("error   DOLP ≤ {:.2g}; tolerance {:.2g}", curve.worst_error(),
                      *curve.scene().number("accuracy.tolerance"))};
}

}  // namespace dolp::explore
