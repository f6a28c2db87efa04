#include "verify/table_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <dolp/number_range.hpp>
#include <dolp/status.hpp>
#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "plan/effects.hpp"
#include "radiometry/diffuse.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/response_run.hpp"
#include "run/scene_run.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

// The tolerance of the reference is a hundredth of the table's tolerance, but not below this value.
constexpr double kReferenceTolerance = 1e-11;

constexpr double kRightAngle_deg = 90.0;

/// Ways in which the error bound of a quantity follows from the columns error_estimate and rho_error_estimate.
enum class Bound { kDolp, kAngle, kReflectance, kPolarisedRadiation, kRadiation, kEmissivity, kAlbedo };

struct Compared {
  Quantity quantity;
  Bound bound;
};
constexpr std::array<Compared, 15> kCompared{{
    {Quantity::kDolp, Bound::kDolp},
    {Quantity::kQOverI, Bound::kDolp},
    {Quantity::kAolp, Bound::kAngle},
    {Quantity::kDolpLow, Bound::kDolp},
    {Quantity::kDolpHigh, Bound::kDolp},
    {Quantity::kRhoI, Bound::kReflectance},
    {Quantity::kRhoQ, Bound::kReflectance},
    {Quantity::kRhoU, Bound::kReflectance},
    {Quantity::kStokesI, Bound::kRadiation},
    {Quantity::kStokesQ, Bound::kPolarisedRadiation},
    {Quantity::kStokesU, Bound::kPolarisedRadiation},
    {Quantity::kStokesV, Bound::kPolarisedRadiation},
    {Quantity::kAlbedo, Bound::kAlbedo},
    {Quantity::kEmissivityS, Bound::kEmissivity},
    {Quantity::kEmissivityP, Bound::kEmissivity},
}};

/// Relative rounding error of a radiance, an emissivity and an albedo at one wavelength.
constexpr double kRounding = 1e-12;

/// The same for an albedo from kernels in float: some roundings. At 90 degrees rho is known better, from its limit.
constexpr double kFloatRounding = 1e-6;

/// Terms of the error bounds. All but specular_share depend only on the variant (material, band, wavelength,
/// temperature) of an entry. They have the unit of I: radiances in bistatic mode, else exitances.
struct BoundTerms {
  double emitted = 0.0;    ///< emission of a black surface, at the sensor
  double radiation = 0.0;  ///< emission, surroundings and source, before the surface reflects them
  double dropped = 0.0;    ///< radiation of the effects that the table leaves out
  double rounding = kRounding;
  double albedo_rounding = kRounding;
  bool depends_on_rho = true;  ///< false if the run needed no rho
  double tolerance = 0.0;
  EmissionModel model = EmissionModel::kMoments;
  std::optional<DiffuseReflection> diffuse = {};  ///< nullopt if the surface has no diffuse part
  double specular_share = 1.0;                    ///< specular part of rho_I, relative to rho_I
};

BoundTerms bound_terms(const SceneModel& scene, const EffectPlan& plan) {
  const SpectralRule rule = spectral_rule(scene);
  SpectralSample total;
  for (const SpectralSample& sample : rule.samples) {
    total.emitted += std::abs(sample.emitted);
    total.surroundings += std::abs(sample.surroundings);
    total.irradiance += std::abs(sample.irradiance);
  }
  const std::array<std::pair<Part, double>, 4> parts{{{Part::kEmission, total.emitted},
                                                      {Part::kSurroundings, total.surroundings},
                                                      {Part::kSource, total.irradiance},
                                                      {Part::kPathRadiance, rule.path_exitance}}};
  const double unit = scene.geometry.mode == Mode::kBistatic ? 1.0 / std::numbers::pi : 1.0;
  BoundTerms terms;
  for (const auto& [part, exitance] : parts) {
    if (plan.dropped.contains(part)) terms.dropped += unit * exitance;
  }
  terms.emitted = unit * total.emitted * (scene.path ? scene.path->transmittance : 1.0);
  terms.radiation = unit * (total.emitted + total.surroundings + total.irradiance);
  terms.depends_on_rho = plan.gives_rho;
  terms.rounding += rule.relative_error;
  terms.tolerance = scene.accuracy.tolerance;
  if (scene.emission) terms.model = scene.emission->model;
  Surface surface = scene.surface;
  if (rule.diffuse) surface.diffuse = rule.diffuse->mean;
  if (surface.diffuse > 0.0) terms.diffuse.emplace(surface, surface.optics_at(scene.spectrum.min_um));
  return terms;
}

/// Error bounds that the table states, or those of the reference.
struct Estimates {
  double dolp = kInfinity;
  double rho = kInfinity;  ///< relative to rho_I
};

double absolute(double relative, double value) { return std::isinf(relative) ? relative : relative * std::abs(value); }

/// The error bound of I. The bound of DOLP limits it, because a relative error e of I changes DOLP by e * DOLP. The
/// bound of rho also limits it: an error d of rho_I changes I by at most d * terms.radiation. The errors of a sky, a
/// beam and direct emission are in this second limit by the bound of DOLP, which contains their error of Q and I.
double radiation_bound(const Estimates& estimates, const PointResult& reference, const BoundTerms& terms) {
  const double dolp_bound = absolute(estimates.dolp, reference[Quantity::kStokesI]);
  const double rho_bound = terms.depends_on_rho ? absolute(estimates.rho, reference[Quantity::kRhoI]) : 0.0;
  const double dropped = terms.dropped * std::max(1.0, std::abs(reference[Quantity::kRhoI]));
  const double by_rho = dolp_bound + dropped + (rho_bound + terms.rounding) * terms.radiation;
  const double by_dolp = dolp_bound / std::abs(reference[Quantity::kDolp]);
  return by_rho < by_dolp || reference[Quantity::kDolp] == 0.0 ? by_rho : by_dolp;
}

double error_bound(Bound bound, const Estimates& estimates, const PointResult& reference, const BoundTerms& terms) {
  const double rho_bound = absolute(estimates.rho, reference[Quantity::kRhoI]);
  const double dolp_bound = absolute(estimates.dolp, reference[Quantity::kStokesI]);
  switch (bound) {
    case Bound::kDolp:
      return estimates.dolp;
    case Bound::kAngle: {  // an error d of (Q, U) turns it by at most asin(d / p), and by any angle if d >= p
      const double share = dolp_bound / std::hypot(reference[Quantity::kStokesQ], reference[Quantity::kStokesU]);
      const double angle_deg = share < 1.0 ? kRightAngle_deg / std::numbers::pi * std::asin(share) : kRightAngle_deg;
      return angle_deg + terms.rounding;
    }
    case Bound::kReflectance:
      return rho_bound;
    case Bound::kPolarisedRadiation:
      return dolp_bound;
    case Bound::kRadiation:
      return radiation_bound(estimates, reference, terms);
    case Bound::kEmissivity:
      return 2.0 * (terms.model == EmissionModel::kMoments ? rho_bound : dolp_bound / terms.emitted) + terms.rounding;
    case Bound::kAlbedo:
      return absolute(estimates.rho / terms.specular_share + terms.albedo_rounding, reference[Quantity::kAlbedo]);
  }
  return kInfinity;
}

/// Tells what is wrong with a value. `allowed` is the largest error that the tolerance allows, or infinity.
std::string complaint_about(const CheckedValue& value, double allowed) {
  if (std::isnan(value.stored) && std::isnan(value.reference)) return {};
  if (std::isnan(value.stored)) return "is NaN in the table";
  if (std::isnan(value.reference)) return "is a number in the table, but outside the model's domain";
  if (std::isnan(value.stated)) return "has no error estimate in the table";
  if (value.error() > value.stated + value.reference_error) return "errs by more than the table states";
  if (value.error() > allowed + value.reference_error) return "misses the tolerance without the status that says so";
  return {};
}

double estimate_at(const std::vector<double>& estimates, std::size_t i) {
  return estimates.empty() ? kInfinity : estimates[i];
}

double allowed_error(Bound bound, std::uint32_t status, double tolerance, const PointResult& reference) {
  const bool is_rho = bound == Bound::kReflectance && (status & kRhoToleranceNotMet) == 0;
  if (is_rho) return tolerance * std::abs(reference[Quantity::kRhoI]);
  const bool is_dolp = bound == Bound::kDolp && promises_dolp(status) && (status & kToleranceNotMet) == 0;
  return is_dolp ? tolerance : kInfinity;
}

void add(TableCheck& check, QuantityCheck& quantity_check, const CheckedValue& value) {
  ++quantity_check.compared;
  if (std::isinf(value.stated)) ++quantity_check.unstated;
  if (value.is_undecided()) ++quantity_check.undecided;
  if (quantity_check.compared == 1 || value.ratio() > quantity_check.worst.ratio()) quantity_check.worst = value;
  if (!value.complaint.empty()) check.failures.push_back(value);
}

/// The albedo belongs to the specular part, and the error bound of rho is relative to rho_I with its diffuse part.
double specular_share(const BoundTerms& terms, const PointResult& reference, double zenith_deg) {
  if (!terms.diffuse) return 1.0;
  return 1.0 - terms.diffuse->rho(cos_sin_deg(zenith_deg).cos).i / reference[Quantity::kRhoI];
}

CheckedValue compare(const TableSample& sample, const Compared& compared, std::size_t i, const PointResult& reference,
                     const BoundTerms& terms) {
  const TableValues& table = sample.table;
  CheckedValue value{describe(compared.quantity).name, entry_axis_values(sample.positions[i], table)};
  value.stored = table[compared.quantity][i];
  value.reference = reference[compared.quantity];
  if (compared.bound == Bound::kAngle) {
    // Angles that differ by 180 degrees are equal. Where Q = U = 0 on one side only, the comparison of Q and U decides.
    value.stored = value.reference + std::remainder(value.stored - value.reference, 2.0 * kRightAngle_deg);
    if (std::isnan(value.stored)) value.reference = value.stored;
  }
  const Estimates stated{estimate_at(table[Quantity::kErrorEstimate], i),
                         estimate_at(table[Quantity::kRhoErrorEstimate], i)};
  const Estimates reference_estimates{reference[Quantity::kErrorEstimate], reference[Quantity::kRhoErrorEstimate]};
  BoundTerms keeps_all = terms;
  keeps_all.dropped = 0.0;
  value.stated = error_bound(compared.bound, stated, reference, terms);
  value.reference_error = error_bound(compared.bound, reference_estimates, reference, keeps_all);
  // If neither the table nor the reference has an error bound, for example because I overflows, any error is allowed.
  if (std::isnan(value.stated) && !std::isfinite(value.reference_error))
    value.stated = value.reference_error = kInfinity;
  const std::uint32_t status = table.status.empty() ? kAnyToleranceNotMet : table.status[i];
  value.complaint = complaint_about(value, allowed_error(compared.bound, status, terms.tolerance, reference));
  return value;
}

void check_axes(const TableValues& table, const SceneValues& scene, const std::string& name) {
  for (const Axis axis : kAllAxes) {
    const AxisDescription& known = describe(axis);
    const bool has_finite_mean_slope = axis == Axis::kQ && scene.surface.needs_mean_slope();
    const NumberRange& range = has_finite_mean_slope ? kSmithCauchyQRange : known.range;
    for (const double value : table.axes[axis]) {
      if (range.contains(value)) continue;
      throw InputError(fmt::format("{}: axis {}: {} is out of range; must be a number in {}", name, known.name, value,
                                   range.text()));
    }
  }
}

}  // namespace

double CheckedValue::error() const { return std::abs(stored - reference); }

double CheckedValue::ratio() const {
  if (std::isnan(error())) return complaint.empty() ? 0.0 : kInfinity;
  if (error() == 0.0) return 0.0;
  return error() / (stated + reference_error);
}

std::vector<AxisValue> entry_axis_values(std::size_t entry, const TableHead& table) {
  std::vector<AxisValue> position;
  const PerAxis at = positions_on_axes(entry, table.counts());
  for (const Axis axis : kAllAxes) {
    if (table.axes[axis].empty()) continue;
    const double value = table.axes[axis][at[axis]];
    position.push_back({axis, value, describe(axis).has_labels ? table.label(axis, value) : ""});
  }
  return position;
}

TableCheck check_table(const TableSample& sample, const SceneValues& scene, const std::string& name,
                       const Progress& progress) {
  const TableValues& table = sample.table;
  const bool has_dolp = table.has(Quantity::kDolp) && table.has(Quantity::kErrorEstimate);
  const bool has_rho =
      table.has(Quantity::kRhoErrorEstimate) && (table.has(Quantity::kRhoI) || table.has(Quantity::kRhoQ));
  if (!has_dolp && !has_rho) {
    throw InputError(
        fmt::format("{}: has nothing to compare: neither dolp with error_estimate nor rho_i or rho_q with "
                    "rho_error_estimate",
                    name));
  }
  check_axes(table, scene, name);
  const SceneEntries grid = SceneEntries::grid(table.axes, scene.surface.material.constant, scene.cross_slopes());
  ReferenceEvaluator reference({.relative_tolerance = kReferenceTolerance});
  const SceneEntries chosen = grid.chosen(sample.positions);
  const std::vector<PointResult> results = scene.spectrum.is_band()
                                               ? integrate_band(scene, chosen, reference, progress)
                                               : evaluate_scene(scene, chosen, reference, progress);

  const EffectPlan plan = plan_effects(scene, grid, false);
  const std::string* precision = find_attribute<std::string>(table, "precision");
  const bool is_double = precision && *precision == "double";
  std::vector<BoundTerms> terms;
  for (const SceneVariant& variant : grid.variants()) {
    BoundTerms& own_terms = terms.emplace_back(bound_terms(with_variant(scene, variant), plan));
    own_terms.albedo_rounding = is_double ? own_terms.rounding : kFloatRounding;
  }
  TableCheck check;
  check.entries = table.size();
  check.checked = sample.positions.size();
  check.tolerance = scene.accuracy.tolerance;
  for (const std::uint32_t status : table.status) check.missed += (status & kAnyToleranceNotMet) != 0 ? 1 : 0;
  for (const Compared& compared : kCompared) {
    if (!table.has(compared.quantity)) continue;
    QuantityCheck& quantity_check = check.quantities.emplace_back();
    quantity_check.name = describe(compared.quantity).name;
    for (std::size_t i = 0; i < results.size(); ++i) {
      BoundTerms& entry_terms = terms[grid[sample.positions[i]].variant];
      entry_terms.specular_share = specular_share(entry_terms, results[i], moment_zenith_deg(scene, chosen[i]));
      add(check, quantity_check, compare(sample, compared, i, results[i], entry_terms));
    }
  }
  return check;
}

TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress) {
  const TableValues& table = sample.table;
  const std::vector<double>& stated = table.responses[ResponseVariable::kResponseError];
  if (stated.empty()) throw InputError(name + ": has no response_error to check");
  MomentsRequest request = response_request(scene.surface);
  const SceneEntries grid = SceneEntries::grid(table.axes, kUnusedIndex);
  for (const std::size_t position : sample.positions) {
    const SceneEntry entry = grid[position];
    request.append({entry.theta_deg, entry.shape, kUnusedIndex});
  }
  ReferenceEvaluator reference;
  const EntryResponses right = compute_responses(request, scene.accuracy, reference, progress);
  const std::vector<double>& reference_error = right.responses[ResponseVariable::kResponseError];
  TableCheck check;
  check.entries = table.size();
  check.checked = request.size();
  check.tolerance = scene.accuracy.tolerance;
  for (std::size_t i = 0; i < stated.size(); ++i) check.missed += stated[i] > check.tolerance * right.albedo[i] ? 1 : 0;
  for (const ResponseVariable variable : kAllResponseVariables) {
    const ResponseDescription& described = describe(variable);
    if (!described.has_beta || table.responses[variable].empty()) continue;
    if (table.responses[variable].size() != right.responses[variable].size())
      throw InputError(fmt::format("{}: {} is not at the local angles of this program", name, described.name));
    const bool is_of_q = variable == ResponseVariable::kResponseQ || variable == ResponseVariable::kEmissionQ;
    QuantityCheck& variable_check = check.quantities.emplace_back();
    variable_check.name = described.name;
    for (std::size_t i = 0; i < request.size(); ++i) {
      if (std::isnan(stated[i]) && std::isnan(reference_error[i])) continue;  // no weights: rho is undefined there
      const auto entry_weights = [&](const std::vector<double>& weights) {
        return std::span(weights).subspan(i * table.beta_deg.size(), table.beta_deg.size());
      };
      CheckedValue value{described.name, entry_axis_values(sample.positions[i], table)};
      value.stored = response_distance(entry_weights(table.responses[variable]),
                                       entry_weights(right.responses[variable]), is_of_q);
      value.stated = stated[i];
      value.reference_error = reference_error[i];
      if (!(value.stored <= stated[i] + reference_error[i])) value.complaint = "is too far from the reference";
      add(check, variable_check, value);
    }
  }
  return check;
}

}  // namespace dolp
