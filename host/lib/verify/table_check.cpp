#include "verify/table_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <random>
#include <set>

#include "base/numbers.hpp"
#include "model/point_result.hpp"
#include "model/status.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/scene_run.hpp"
#include "scene/number_range.hpp"

namespace dolp {
namespace {

// The reference is a hundred times better than the table if it can, and this good at least.
constexpr double kReferenceTolerance = 1e-11;

/// How the bound of a quantity follows from the two estimates.
enum class Bound { kDolp, kReflectance, kPolarisedRadiation, kRadiation };

struct Quantity {
  const char* name;
  std::vector<double> Table::*stored;
  double PointResult::*recomputed;
  Bound bound;
};
constexpr std::array<Quantity, 7> kQuantities{{
    {"dolp", &Table::dolp, &PointResult::dolp, Bound::kDolp},
    {"rho_i", &Table::rho_i, &PointResult::rho_i, Bound::kReflectance},
    {"rho_q", &Table::rho_q, &PointResult::rho_q, Bound::kReflectance},
    {"stokes_i", &Table::stokes_i, &PointResult::stokes_i, Bound::kRadiation},
    {"stokes_q", &Table::stokes_q, &PointResult::stokes_q, Bound::kPolarisedRadiation},
    {"stokes_u", &Table::stokes_u, &PointResult::stokes_u, Bound::kPolarisedRadiation},
    {"stokes_v", &Table::stokes_v, &PointResult::stokes_v, Bound::kPolarisedRadiation},
}};

/// The bound in the quantity's own units, from the estimates of one side and the magnitudes of the reference.
double bound_of(Bound bound, double dolp_estimate, double rho_estimate, const PointResult& reference) {
  const double radiation = dolp_estimate * std::abs(reference.stokes_i);
  switch (bound) {
    case Bound::kDolp:
      return dolp_estimate;
    case Bound::kReflectance:
      return rho_estimate * std::abs(reference.rho_i);
    case Bound::kPolarisedRadiation:
      return radiation;
    case Bound::kRadiation:
      return reference.dolp != 0.0 ? radiation / std::abs(reference.dolp) : kInfinity;
  }
  return kInfinity;
}

bool is_reflectance(Bound bound) { return bound == Bound::kReflectance; }

/// What is wrong with a value, or nothing. `allowed` is what the tolerance allows; infinite when nothing is promised.
std::string complaint_about(const CheckedValue& value, double allowed) {
  if (std::isnan(value.stored) && std::isnan(value.reference)) return {};
  if (std::isnan(value.stored)) return "is NaN in the table";
  if (std::isnan(value.reference)) return "is a number in the table, but outside the model's domain";
  if (std::isnan(value.stated)) return "has no error estimate in the table";
  if (value.error() > value.stated + value.reference_error) return "errs by more than the table states";
  if (value.error() > allowed + value.reference_error) return "misses the tolerance without status 2";
  return {};
}

/// The estimates of an entry; a table without them states nothing.
double estimate_at(const std::vector<double>& estimates, std::size_t i) {
  if (estimates.empty()) return kInfinity;
  return estimates[i];
}

double allowed_error(const Quantity& quantity, std::uint32_t status, double tolerance, const PointResult& reference) {
  const bool is_promised = (status & kStatusToleranceMissed) == 0;
  if (is_promised && is_reflectance(quantity.bound)) return tolerance * std::abs(reference.rho_i);
  const bool is_dolp = quantity.bound == Bound::kDolp && promises_dolp(status);
  if (is_promised && is_dolp) return tolerance;
  return kInfinity;
}

void add(QuantityCheck& check, const CheckedValue& value) {
  ++check.compared;
  if (std::isinf(value.stated)) ++check.unstated;
  if (check.compared == 1 || value.ratio() > check.worst.ratio()) check.worst = value;
}

CheckedValue compare(const Table& table, const Quantity& quantity, std::size_t i, const SceneEntry& entry,
                     const PointResult& reference, double tolerance) {
  CheckedValue value;
  value.quantity = quantity.name;
  value.theta_deg = entry.theta_deg;
  value.sigma = entry.shape.sigma;
  value.q = entry.shape.q;
  if (!table.wavelength_um.empty()) value.wavelength_um = table.wavelength_um[entry.wavelength];
  if (!table.n.empty()) value.n = entry.index->n;
  if (!table.k.empty()) value.k = entry.index->k;
  value.stored = (table.*quantity.stored)[i];
  value.reference = reference.*quantity.recomputed;
  const double dolp_estimate = estimate_at(table.error_estimate, i);
  const double rho_estimate = estimate_at(table.rho_error_estimate, i);
  value.stated = bound_of(quantity.bound, dolp_estimate, rho_estimate, reference);
  value.reference_error = bound_of(quantity.bound, reference.error_estimate, reference.rho_error_estimate, reference);
  const std::uint32_t status = table.status.empty() ? kStatusToleranceMissed : table.status[i];
  value.complaint = complaint_about(value, allowed_error(quantity, status, tolerance, reference));
  return value;
}

void check_axis(const std::vector<double>& values, const NumberRange& range, const char* axis,
                const std::string& name) {
  for (const double value : values) {
    if (range.contains(value)) continue;
    throw InputError(fmt::format("{}: axis {}: {} is out of range, a number in {}", name, axis, value, range.text()));
  }
}

void check_axes(const Table& table, const Scene& scene, const std::string& name) {
  check_axis(table.wavelength_um, kWavelengthUmRange, "wavelength", name);
  check_axis(table.n, kNRange, "n", name);
  check_axis(table.k, kKRange, "k", name);
  check_axis(table.theta_deg, kZenithDegRange, "theta", name);
  check_axis(table.sigma, kSigmaRange, "sigma", name);
  check_axis(table.q, scene.surface.needs_mean_slope() ? kSmithCauchyQRange : kQRange, "q", name);
}

bool has_dolp(const Table& table) { return !table.dolp.empty() && !table.error_estimate.empty(); }

bool has_rho(const Table& table) {
  return !table.rho_error_estimate.empty() && (!table.rho_i.empty() || !table.rho_q.empty());
}

}  // namespace

double CheckedValue::error() const { return std::abs(stored - reference); }

double CheckedValue::ratio() const {
  if (std::isnan(error())) return complaint.empty() ? 0.0 : kInfinity;
  if (error() == 0.0) return 0.0;
  return error() / (stated + reference_error);
}

std::vector<std::size_t> sample_positions(std::size_t entries, const TableCheckOptions& options) {
  std::set<std::size_t> chosen;
  if (options.samples >= entries) {
    for (std::size_t i = 0; i < entries; ++i) chosen.insert(i);
    return {chosen.begin(), chosen.end()};
  }
  // Floyd's sampling: R. Floyd, J. Bentley, Programming Pearls, Comm. ACM 30, 1987. The standard library's own may
  // differ between libraries. The remainder of 2^64 by at most 2^24 entries is even to 1e-12.
  std::mt19937_64 engine(options.seed);
  for (std::size_t last = entries - options.samples; last < entries; ++last) {
    const std::size_t candidate = engine() % (last + 1);
    chosen.insert(chosen.contains(candidate) ? last : candidate);
  }
  return {chosen.begin(), chosen.end()};
}

TableCheck check_table(const TableSample& sample, const Scene& scene, const std::string& name,
                       const Progress& progress) {
  const Table& table = sample.table;
  if (!has_dolp(table) && !has_rho(table)) {
    throw InputError(
        fmt::format("{}: has nothing to compare: neither dolp with error_estimate nor rho_i or rho_q with "
                    "rho_error_estimate",
                    name));
  }
  check_axes(table, scene, name);
  std::vector<SceneEntry> entries;
  Grid axes;
  for (std::size_t i = 0; i < kTableAxes.size(); ++i) axes.*kGridAxes[i] = table.*kTableAxes[i];
  const SceneEntries grid = SceneEntries::of_grid(axes, scene.surface.material.constant);
  for (const std::size_t position : sample.positions) entries.push_back(grid[position]);
  ReferenceEvaluator reference({.relative_tolerance = kReferenceTolerance});
  const std::vector<PointResult> results = evaluate_scene(scene, {entries, table.wavelength_um}, reference, progress);

  TableCheck check;
  check.entries = table.size();
  check.checked = entries.size();
  check.tolerance = scene.accuracy.tolerance;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint32_t status = table.status.empty() ? 0 : table.status[i];
    check.missed += (status & kStatusToleranceMissed) != 0 ? 1 : 0;
  }
  for (const Quantity& quantity : kQuantities) {
    if ((table.*quantity.stored).empty()) continue;
    QuantityCheck& of_quantity = check.quantities.emplace_back();
    of_quantity.name = quantity.name;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const CheckedValue value = compare(table, quantity, i, entries[i], results[i], check.tolerance);
      add(of_quantity, value);
      if (!value.complaint.empty()) check.failures.push_back(value);
    }
  }
  return check;
}

}  // namespace dolp
