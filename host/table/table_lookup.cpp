#include "table/table_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.hpp"
#include "model/status.hpp"

namespace dolp {
namespace {

constexpr std::size_t kWindow = 6;       // values of an axis
constexpr int kMostShift = 3;            // of a window away from entries that are not known
constexpr std::size_t kLeastValues = 4;  // of an axis: how the changes of fewer fall says nothing
constexpr double kRemainder = 10.0;      // error over the change that one value makes, where changes fall fast
constexpr double kSlowestFall = 0.9;     // of the changes
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What is interpolated: the quantities of a table that are smooth.
struct SmoothColumn {
  std::vector<double> Table::*values;
  double PointResult::*member;
};
constexpr std::array<SmoothColumn, 11> kColumns = {{{&Table::stokes_i, &PointResult::stokes_i},
                                                    {&Table::stokes_q, &PointResult::stokes_q},
                                                    {&Table::stokes_u, &PointResult::stokes_u},
                                                    {&Table::stokes_v, &PointResult::stokes_v},
                                                    {&Table::rho_i, &PointResult::rho_i},
                                                    {&Table::rho_q, &PointResult::rho_q},
                                                    {&Table::albedo, &PointResult::albedo},
                                                    {&Table::emissivity_s, &PointResult::emissivity_s},
                                                    {&Table::emissivity_p, &PointResult::emissivity_p},
                                                    {&Table::dolp_low, &PointResult::dolp_low},
                                                    {&Table::dolp_high, &PointResult::dolp_high}}};
/// What every table has, besides the status.
constexpr std::array<double PointResult::*, 6> kNeeded = {&PointResult::dolp,     &PointResult::stokes_i,
                                                          &PointResult::stokes_q, &PointResult::stokes_u,
                                                          &PointResult::stokes_v, &PointResult::error_estimate};

enum Column : std::size_t { kI, kQ, kU, kV, kRhoI, kRhoQ };

const std::vector<double>& checked(const std::vector<double>& values, const char* axis, const std::string& name) {
  if (std::set(values.begin(), values.end()).size() != values.size()) {
    throw InputError(fmt::format("{}: {}: a value appears twice; nothing can be interpolated there", name, axis));
  }
  return values;
}

/// Refuses a table that lacks what every result needs.
void check_variables(const Table& table, const std::string& name) {
  const auto require = [&](bool is_there, std::string_view variable) {
    if (!is_there) throw InputError(fmt::format("{}: the variable {} is missing; lookup needs it", name, variable));
  };
  for (const TableVariable& variable : table_variables()) {
    const bool is_needed = std::ranges::find(kNeeded, variable.member) != kNeeded.end() ||
                           (variable.member == &PointResult::rho_i && !table.rho_error_estimate.empty());
    require(!is_needed || !(table.*variable.values).empty(), variable.name);
  }
  require(!table.status.empty(), "status");
}

}  // namespace

/// The entries that are read: a product of stencils.
struct TableLookup::Window {
  Stencil theta;
  Stencil sigma;
  Stencil q;

  std::size_t size() const { return theta.positions.size() * sigma.positions.size() * q.positions.size(); }

  /// Calls visit(position, weight) for each entry.
  template <class Visit>
  void each(const Table& table, const Visit& visit) const {
    for (std::size_t i = 0; i < theta.positions.size(); ++i) {
      for (std::size_t j = 0; j < sigma.positions.size(); ++j) {
        for (std::size_t k = 0; k < q.positions.size(); ++k) {
          visit(table.position(theta.positions[i], sigma.positions[j], q.positions[k]),
                theta.weights[i] * sigma.weights[j] * q.weights[k]);
        }
      }
    }
  }
};

struct TableLookup::Values {
  std::array<double, kColumns.size()> columns{};
  double error = 0.0;      // of DOLP, sum over the entries read
  double rho_error = 0.0;  // of rho, absolute

  void widen(const Values& a, const Values& b) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      columns[c] = std::max(columns[c], std::abs(a.columns[c] - b.columns[c]));
    }
  }
  /// Adds what is missing if leaving out one value changes the result by `last`, and two by `before`, and more values
  /// went on like that.
  void add_remainder(const Values& last, const Values& before) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (last.columns[c] == 0.0) continue;
      const double fall = std::min(last.columns[c] / before.columns[c], kSlowestFall);
      columns[c] += kRemainder * last.columns[c] / (1.0 - fall);
    }
  }
};

TableLookup::TableLookup(const Table& table, double tolerance, const std::string& name)
    : table_(table),
      tolerance_(tolerance),
      theta_(checked(table.theta_deg, "theta", name), LookupAxis::Scale::kLinear),
      sigma_(checked(table.sigma, "sigma", name), LookupAxis::Scale::kLogarithm),
      q_(checked(table.q, "q", name), LookupAxis::Scale::kLogarithm, 1.0) {
  check_variables(table, name);
}

bool TableLookup::is_known(const Window& window) const {
  bool known = true;
  window.each(table_, [&](std::size_t position, double) { known = known && std::isfinite(table_.stokes_i[position]); });
  return known;
}

PointResult TableLookup::entry(const Window& window) const {
  const std::size_t position =
      table_.position(window.theta.positions.front(), window.sigma.positions.front(), window.q.positions.front());
  PointResult result;
  for (const TableVariable& variable : table_variables()) {
    const std::vector<double>& column = table_.*variable.values;
    result.*variable.member = column.empty() ? kNan : column[position];
  }
  result.status = table_.status[position];
  return result;
}

TableLookup::Values TableLookup::read(const Window& window) const {
  Values values;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const std::vector<double>& column = table_.*kColumns[c].values;
    if (column.empty()) {
      values.columns[c] = kNan;
      continue;
    }
    window.each(table_, [&](std::size_t position, double weight) { values.columns[c] += weight * column[position]; });
  }
  window.each(table_, [&](std::size_t position, double weight) {
    values.error += std::abs(weight) * table_.error_estimate[position];
    if (table_.rho_error_estimate.empty()) return;
    values.rho_error += std::abs(weight * table_.rho_i[position]) * table_.rho_error_estimate[position];
  });
  return values;
}

PointResult TableLookup::at(double theta_deg, double sigma, double q) const {
  const auto window_of = [&](std::size_t count, int shift) {
    return Window{theta_.stencil(theta_deg, count, shift), sigma_.stencil(sigma, kWindow), q_.stencil(q, kWindow)};
  };
  Window window = window_of(kWindow, 0);
  if (window.size() == 1) return entry(window);
  int shift = 0;
  std::size_t count = kWindow;
  while (!is_known(window)) {
    // Away from the horizon, where they are, then closer together.
    if (++shift > kMostShift) {
      shift = 0;
      if (--count < 2) break;
    }
    window = window_of(count, theta_deg > 45.0 ? -shift : shift);
  }
  if (count < 2) {
    PointResult unknown;
    unknown.dolp = unknown.stokes_i = unknown.stokes_q = unknown.stokes_u = unknown.stokes_v = kNan;
    unknown.rho_i = unknown.rho_q = unknown.albedo = unknown.error_estimate = unknown.rho_error_estimate = kNan;
    unknown.status = kStatusOutsideDomain;
    return unknown;
  }
  const int side = theta_deg > 45.0 ? -shift : shift;
  const Values values = read(window);
  Values spread;
  // Of one axis, of which the window reads so many values: how much fewer values, also aside, change the result.
  const auto compare = [&](std::size_t values_read, const auto& with_stencil) {
    if (values_read == 1) return;
    if (values_read < kLeastValues) {
      spread.columns.fill(std::numeric_limits<double>::infinity());
      return;
    }
    std::array<Values, 2> changes;
    for (std::size_t fewer = 1; fewer <= changes.size(); ++fewer) {
      for (const int aside : {0, 1, -1}) {
        const Values other = read(with_stencil(values_read - fewer, aside));
        changes[fewer - 1].widen(values, other);
      }
    }
    spread.add_remainder(changes[0], changes[1]);
  };
  compare(window.theta.positions.size(), [&](std::size_t few, int aside) {
    return Window{theta_.stencil(theta_deg, few, side + aside), window.sigma, window.q};
  });
  compare(window.sigma.positions.size(), [&](std::size_t few, int aside) {
    return Window{window.theta, sigma_.stencil(sigma, few, aside), window.q};
  });
  compare(window.q.positions.size(), [&](std::size_t few, int aside) {
    return Window{window.theta, window.sigma, q_.stencil(q, few, aside)};
  });
  const Window cell{theta_.stencil(theta_deg, 2), sigma_.stencil(sigma, 2), q_.stencil(q, 2)};
  return result_of(cell, values, spread);
}

PointResult TableLookup::result_of(const Window& cell, const Values& values, const Values& spread) const {
  PointResult result;
  for (std::size_t c = 0; c < kColumns.size(); ++c) result.*kColumns[c].member = values.columns[c];
  const double i = result.stokes_i;
  const auto& wide = spread.columns;
  result.dolp = std::hypot(result.stokes_q, result.stokes_u) / i;
  const double dolp_spread = std::hypot(wide[kQ], wide[kU]) / std::abs(i);
  // Where nothing is known of I either, an unpolarised result must not make it 0 * infinity.
  const double i_spread = result.dolp == 0.0 ? 0.0 : std::abs(result.dolp) * wide[kI] / std::abs(i);
  result.error_estimate = values.error + dolp_spread + i_spread;
  result.rho_error_estimate = table_.rho_error_estimate.empty()
                                  ? kNan
                                  : (values.rho_error + std::max(wide[kRhoI], wide[kRhoQ])) / std::abs(result.rho_i);
  cell.each(table_, [&](std::size_t position, double) {
    result.status |= table_.status[position] & kStatusUnphysicalReflectance;
  });
  if (i <= 0.0) result.status |= kStatusNonPositiveIntensity;
  const bool states_dolp = promises_dolp(result.status);
  if ((states_dolp && !(result.error_estimate <= tolerance_)) || result.rho_error_estimate > tolerance_) {
    result.status |= kStatusToleranceMissed;
  }
  return result;
}

}  // namespace dolp
