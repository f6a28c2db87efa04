#include "table/table_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "base/error.hpp"
#include "model/status.hpp"

namespace dolp {
namespace {

constexpr std::size_t kWindow = kMostStencil;  // values of an axis
constexpr std::size_t kBlockWindow = 4;        // of wavelength, n and k
constexpr int kMostShift = 3;                  // of a window away from entries that are not known
constexpr std::size_t kLeastValues = 4;        // of an axis: how the changes of fewer fall says nothing
constexpr double kRemainder = 10.0;            // error over the change that one value makes, where changes fall fast
constexpr double kSlowestFall = 0.9;           // of the changes
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

const std::vector<double>& checked(const std::vector<double>& values, const char* axis, const std::string& name) {
  if (std::set(values.begin(), values.end()).size() != values.size()) {
    throw InputError(fmt::format("{}: {}: a value appears twice; nothing can be interpolated there", name, axis));
  }
  return values;
}

/// The axes of wavelength, n and k; one value of those that the table lacks.
std::vector<LookupAxis> block_axes(const Table& table, const std::string& name) {
  constexpr std::array<const char*, 3> kNames = {"wavelength", "n", "k"};
  std::vector<LookupAxis> axes;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const std::vector<double>& values = table.*kTableAxes[i];
    axes.emplace_back(values.empty() ? std::vector<double>{1.0} : checked(values, kNames[i], name),
                      LookupAxis::Scale::kLogarithm);
  }
  return axes;
}

PointResult unknown() {
  PointResult result;
  for (const TableVariable& variable : table_variables()) result.*variable.member = kNan;
  result.status = kStatusOutsideDomain;
  return result;
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
  std::size_t block = 0;
  Stencil theta;
  Stencil sigma;
  Stencil q;

  std::size_t size() const { return theta.count * sigma.count * q.count; }

  /// Calls visit(position, weight) for each entry.
  template <class Visit>
  void each(const TableLookup& lookup, const Visit& visit) const {
    for (std::size_t i = 0; i < theta.count; ++i) {
      for (std::size_t j = 0; j < sigma.count; ++j) {
        for (std::size_t k = 0; k < q.count; ++k) {
          visit(lookup.position(block, theta.first + i, sigma.first + j, q.first + k),
                theta.weights[i] * sigma.weights[j] * q.weights[k]);
        }
      }
    }
  }
};

/// How much fewer values of one axis, also aside, change what is interpolated: the stencils to compare with.
struct TableLookup::Spread {
  enum class Kind { kNone, kUnknown, kCompared };
  Kind kind = Kind::kNone;
  std::array<std::array<Stencil, 3>, 2> fewer;  // by one and by two values; in the middle and aside
  std::size_t first = 0;                        // of all their values and the window's
  std::size_t count = 0;

  Spread(const LookupAxis& axis, const LookupAxis::Place& place, const Stencil& own, int shift) {
    first = own.first;
    count = own.count;
    if (own.count == 1) return;
    if (own.count < kLeastValues) {
      kind = Kind::kUnknown;
      return;
    }
    kind = Kind::kCompared;
    std::size_t last = first + count;
    for (std::size_t less = 1; less <= fewer.size(); ++less) {
      for (const int aside : {0, 1, -1}) {
        Stencil& other = fewer[less - 1][static_cast<std::size_t>(aside + 1)];
        other = axis.stencil(place, own.count - less, shift + aside);
        first = std::min(first, other.first);
        last = std::max(last, other.first + other.count);
      }
    }
    count = last - first;
  }

  /// Error of `value` by `sums`, what the other axes leave of the table at the values from `first` on: what is missing
  /// if leaving out one value changes the result so much, and two so much, and more values went on like that.
  double remainder(double value, const double* sums) const {
    if (kind == Kind::kNone) return 0.0;
    if (kind == Kind::kUnknown) return std::numeric_limits<double>::infinity();
    std::array<double, 2> changes{};
    for (std::size_t less = 0; less < fewer.size(); ++less) {
      for (const Stencil& other : fewer[less]) {
        double sum = 0.0;
        for (std::size_t i = 0; i < other.count; ++i) sum += other.weights[i] * sums[other.first - first + i];
        changes[less] = std::max(changes[less], std::abs(value - sum));
      }
    }
    if (changes[0] == 0.0) return 0.0;
    return kRemainder * changes[0] / (1.0 - std::min(changes[0] / changes[1], kSlowestFall));
  }
};

TableLookup::TableLookup(const Table& table, double tolerance, const std::string& name)
    : table_(table),
      tolerance_(tolerance),
      block_axes_(block_axes(table, name)),
      theta_(checked(table.theta_deg, "theta", name), LookupAxis::Scale::kLinear),
      sigma_(checked(table.sigma, "sigma", name), LookupAxis::Scale::kLogarithm),
      q_(checked(table.q, "q", name), LookupAxis::Scale::kLogarithm, 1.0) {
  check_variables(table, name);
  for (const SmoothColumn& column : kColumns) {
    const std::vector<double>& values = table.*column.values;
    if (std::ranges::any_of(values, [](double value) { return value != 0.0; })) {
      columns_.push_back({&values, column.member});
    }
  }
  all_known_ = std::ranges::all_of(table.stokes_i, [](double value) { return std::isfinite(value); });
}

bool TableLookup::is_known(const Window& window) const {
  if (all_known_) return true;
  bool known = true;
  window.each(*this, [&](std::size_t position, double) { known = known && std::isfinite(table_.stokes_i[position]); });
  return known;
}

PointResult TableLookup::entry(const Window& window) const {
  const std::size_t at = position(window.block, window.theta.first, window.sigma.first, window.q.first);
  PointResult result;
  for (const TableVariable& variable : table_variables()) {
    const std::vector<double>& column = table_.*variable.values;
    result.*variable.member = column.empty() ? kNan : column[at];
  }
  result.status = table_.status[at];
  return result;
}

/// Where the entries are that a point asks for, the same in every column.
struct TableLookup::Gather {
  static constexpr std::size_t kMostWide = 2 * kMostStencil;
  /// A row along q: where it begins, and the places of its theta and sigma among those of the spreads.
  struct Row {
    std::size_t begin = 0;
    std::uint8_t theta = 0;
    std::uint8_t sigma = 0;
    double of_theta = 0.0;  ///< weight in the window, 0 outside
    double of_sigma = 0.0;
  };
  boost::container::static_vector<Row, kMostWide * kMostWide> rows;
  std::array<std::size_t, kMostWide> q{};  ///< position along a row
  std::size_t own_q = 0;                   ///< where the window's begin among them

  Gather(const TableLookup& lookup, const Window& window, const std::array<Spread, 3>& spreads) {
    const auto& [theta, sigma, along_q] = spreads;
    const auto weight = [](const Stencil& own, std::size_t place) {
      const std::size_t i = place - own.first;  // wraps below the stencil
      return i < own.count ? own.weights[i] : 0.0;
    };
    for (std::size_t i = 0; i < theta.count; ++i) {
      for (std::size_t j = 0; j < sigma.count; ++j) {
        Row row{.theta = static_cast<std::uint8_t>(i), .sigma = static_cast<std::uint8_t>(j)};
        row.of_theta = weight(window.theta, theta.first + i);
        row.of_sigma = weight(window.sigma, sigma.first + j);
        if (row.of_theta == 0.0 && row.of_sigma == 0.0) continue;
        row.begin = window.block + (lookup.theta_.position(theta.first + i) * lookup.sigma_.size() +
                                    lookup.sigma_.position(sigma.first + j)) *
                                       lookup.q_.size();
        rows.push_back(row);
      }
    }
    for (std::size_t k = 0; k < along_q.count; ++k) q[k] = lookup.q_.position(along_q.first + k);
    own_q = window.q.first - along_q.first;
  }
};

void TableLookup::read(const Column& column, const Window& window, const std::array<Spread, 3>& spreads,
                       const Gather& gather, PointResult& result, PointResult& change) const {
  // What the stencils of the other axes leave of the table, along each axis.
  std::array<std::array<double, Gather::kMostWide>, 3> sums{};
  const std::size_t* const own_q = gather.q.data() + gather.own_q;
  for (const Gather::Row& row : gather.rows) {
    const double* const values = column.values->data() + row.begin;
    double sum = 0.0;
    for (std::size_t k = 0; k < window.q.count; ++k) sum += window.q.weights[k] * values[own_q[k]];
    // Outside the window an entry may be unknown.
    if (row.of_sigma != 0.0) sums[0][row.theta] += row.of_sigma * sum;
    if (row.of_theta != 0.0) sums[1][row.sigma] += row.of_theta * sum;
    const double weight = row.of_theta * row.of_sigma;
    if (weight == 0.0) continue;
    for (std::size_t k = 0; k < spreads[2].count; ++k) sums[2][k] += weight * values[gather.q[k]];
  }
  double value = 0.0;
  for (std::size_t i = 0; i < window.theta.count; ++i) {
    value += window.theta.weights[i] * sums[0][window.theta.first - spreads[0].first + i];
  }
  result.*column.member = value;
  for (std::size_t axis = 0; axis < spreads.size(); ++axis) {
    change.*column.member += spreads[axis].remainder(value, sums[axis].data());
  }
}

PointResult TableLookup::in_block(std::size_t block, double theta_deg, double sigma, double q) const {
  const LookupAxis::Place theta_place = theta_.place(theta_deg);
  const LookupAxis::Place sigma_place = sigma_.place(sigma);
  const LookupAxis::Place q_place = q_.place(q);
  Window window{block, theta_.stencil(theta_place, kWindow), sigma_.stencil(sigma_place, kWindow),
                q_.stencil(q_place, kWindow)};
  if (window.size() == 1) return entry(window);
  int shift = 0;
  std::size_t count = kWindow;
  const int away = theta_deg > 45.0 ? -1 : 1;
  while (!is_known(window)) {
    // Away from the horizon, where they are, then closer together.
    if (++shift > kMostShift) {
      shift = 0;
      if (--count < 2) break;
    }
    window.theta = theta_.stencil(theta_place, count, away * shift);
  }
  if (count < 2) return unknown();
  PointResult result;
  const std::array<Spread, 3> spreads = {{{theta_, theta_place, window.theta, away * shift},
                                          {sigma_, sigma_place, window.sigma, 0},
                                          {q_, q_place, window.q, 0}}};
  PointResult change;
  for (const SmoothColumn& column : kColumns) {
    result.*column.member = (table_.*column.values).empty() ? kNan : 0.0;
  }
  const Gather gather(*this, window, spreads);
  for (const Column& column : columns_) read(column, window, spreads, gather, result, change);
  double error = 0.0;      // of DOLP, sum over the entries read
  double rho_error = 0.0;  // of rho, absolute
  window.each(*this, [&](std::size_t position, double weight) {
    error += std::abs(weight) * table_.error_estimate[position];
    if (table_.rho_error_estimate.empty()) return;
    rho_error += std::abs(weight * table_.rho_i[position]) * table_.rho_error_estimate[position];
  });
  const Window cell{block, theta_.stencil(theta_place, 2), sigma_.stencil(sigma_place, 2), q_.stencil(q_place, 2)};
  cell.each(*this, [&](std::size_t position, double) {
    result.status |= table_.status[position] & kStatusUnphysicalReflectance;
  });
  finish(result, change, error, rho_error);
  return result;
}

void TableLookup::finish(PointResult& result, const PointResult& change, double error, double rho_error) const {
  const double i = result.stokes_i;
  result.dolp = std::hypot(result.stokes_q, result.stokes_u) / i;
  const double dolp_change = std::hypot(change.stokes_q, change.stokes_u) / std::abs(i);
  // Where nothing is known of I either, an unpolarised result must not make it 0 * infinity.
  const double i_change = result.dolp == 0.0 ? 0.0 : std::abs(result.dolp) * change.stokes_i / std::abs(i);
  result.error_estimate = error + dolp_change + i_change;
  result.rho_error_estimate = table_.rho_error_estimate.empty()
                                  ? kNan
                                  : (rho_error + std::max(change.rho_i, change.rho_q)) / std::abs(result.rho_i);
  add_status(result);
}

void TableLookup::add_status(PointResult& result) const {
  if (result.stokes_i <= 0.0) result.status |= kStatusNonPositiveIntensity;
  const bool states_dolp = promises_dolp(result.status);
  if ((states_dolp && !(result.error_estimate <= tolerance_)) || result.rho_error_estimate > tolerance_) {
    result.status |= kStatusToleranceMissed;
  }
}

/// The blocks around a point, each with its result there.
struct TableLookup::Blocks {
  static constexpr std::size_t kAxes = 3;
  std::array<LookupAxis::Place, kAxes> places;
  std::array<Stencil, kAxes> own;
  std::vector<Spread> spreads;
  struct Block {
    std::array<std::size_t, kAxes> place{};  ///< among those of the spreads
    std::array<double, kAxes> weight{};      ///< in the window, 0 outside
    PointResult result;
    double in_window() const { return weight[0] * weight[1] * weight[2]; }
  };
  std::vector<Block> blocks;

  Blocks(const TableLookup& lookup, const Point& point) {
    for (std::size_t i = 0; i < kAxes; ++i) {
      const LookupAxis& axis = lookup.block_axes_[i];
      places[i] = axis.place(axis.size() == 1 ? axis.min() : point[i]);
      own[i] = axis.stencil(places[i], kBlockWindow);
      spreads.emplace_back(axis, places[i], own[i], 0);
    }
    PerAxis place{};
    add(lookup, point, 0, place);
  }

  void add(const TableLookup& lookup, const Point& point, std::size_t axis, PerAxis& place) {
    if (axis < kAxes) {
      for (place[axis] = 0; place[axis] < spreads[axis].count; ++place[axis]) add(lookup, point, axis + 1, place);
      return;
    }
    Block block;
    std::size_t number = 0;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const LookupAxis& of_blocks = lookup.block_axes_[i];
      block.place[i] = place[i];
      const std::size_t in_own = spreads[i].first + place[i] - own[i].first;  // wraps below the stencil
      block.weight[i] = in_own < own[i].count ? own[i].weights[in_own] : 0.0;
      outside += in_own < own[i].count ? 0 : 1;
      number = number * of_blocks.size() + of_blocks.position(spreads[i].first + place[i]);
    }
    if (outside > 1) return;
    const std::size_t size = lookup.theta_.size() * lookup.sigma_.size() * lookup.q_.size();
    block.result = lookup.in_block(number * size, point[3], point[4], point[5]);
    blocks.push_back(block);
  }

  /// The interpolated member, and what is added to its change.
  double value(double PointResult::*member, double& change) const {
    double value = 0.0;
    for (const Block& block : blocks) {
      if (block.in_window() != 0.0) value += block.in_window() * block.result.*member;
    }
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      std::vector<double> sums(spreads[axis].count, 0.0);
      for (const Block& block : blocks) {
        const double weight = block.weight[(axis + 1) % kAxes] * block.weight[(axis + 2) % kAxes];
        if (weight != 0.0) sums[block.place[axis]] += weight * block.result.*member;
      }
      change += spreads[axis].remainder(value, sums.data());
    }
    return value;
  }
};

PointResult TableLookup::at(const Point& point) const {
  const auto is_one = [](const LookupAxis& axis) { return axis.size() == 1; };
  if (std::ranges::all_of(block_axes_, is_one)) return in_block(0, point[3], point[4], point[5]);
  const Blocks blocks(*this, point);
  if (blocks.blocks.size() == 1) return blocks.blocks.front().result;
  PointResult result;
  PointResult change;
  for (const SmoothColumn& column : kColumns) {
    const bool is_there = !(table_.*column.values).empty();
    result.*column.member = is_there ? blocks.value(column.member, change.*column.member) : kNan;
  }
  double error = 0.0;
  double rho_error = 0.0;
  for (const Blocks::Block& block : blocks.blocks) {
    const double weight = std::abs(block.in_window());
    if (weight == 0.0) continue;
    if ((block.result.status & kStatusOutsideDomain) != 0) return unknown();
    error += weight * block.result.error_estimate;
    if (!table_.rho_error_estimate.empty())
      rho_error += weight * std::abs(block.result.rho_i) * block.result.rho_error_estimate;
    result.status |= block.result.status & kStatusUnphysicalReflectance;
  }
  finish(result, change, error, rho_error);
  return result;
}

const LookupAxis* TableLookup::axis(Axis axis) const {
  const auto number = static_cast<std::size_t>(axis);
  if (number < block_axes_.size()) return (table_.*kTableAxes[number]).empty() ? nullptr : &block_axes_[number];
  return axis == Axis::kTheta ? &theta_ : axis == Axis::kSigma ? &sigma_ : &q_;
}

}  // namespace dolp
