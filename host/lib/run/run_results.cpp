#include "run/run_results.hpp"

#include <algorithm>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

constexpr std::size_t kManyEntries = 16384;  // from this number, threads share the columns

/// All columns of numbers, in the order of the members.
template <class Results>
auto number_columns(Results& results) {
  std::vector<decltype(&results.model_change)> all = {&results.model_change, &results.model_change_dolp};
  for (auto& column : results.columns) all.push_back(&column);
  for (auto& derivative : results.derivatives) all.push_back(&derivative.values);
  return all;
}

}  // namespace

RunResults::RunResults(const Quantities& quantities, const std::vector<DerivativeColumn>& own_derivatives,
                       std::size_t entries) {
  derivatives = own_derivatives;
  std::vector<std::vector<double>*> own = {&model_change, &model_change_dolp};
  for (const Quantity quantity : quantities) own.push_back(&columns[quantity]);
  for (DerivativeColumn& derivative : derivatives) own.push_back(&derivative.values);
  // The first writes to new memory take most of the time here.
  parallel_for(own.size(), entries < kManyEntries ? own.size() : 1, [&](std::size_t i) { own[i]->resize(entries); });
  status.resize(entries);
}

PointResult RunResults::at(std::size_t position) const {
  PointResult result = ResultColumns::at(position);
  result.model_change = model_change[position];
  result.model_change_dolp = model_change_dolp[position];
  return result;
}

std::vector<PointResult> RunResults::list() const {
  std::vector<PointResult> results;
  results.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) results.push_back(at(i));
  return results;
}

void RunResults::set(std::size_t position, const PointResult& result) {
  for (const Quantity quantity : kAllQuantities) {
    if (has(quantity)) columns[quantity][position] = result[quantity];
  }
  status[position] = result.status;
  model_change[position] = result.model_change;
  model_change_dolp[position] = result.model_change_dolp;
}

void RunResults::copy(const RunResults& part, std::size_t in_part, std::size_t in_whole, std::size_t count) {
  const auto copy_column = [&](const auto& from, auto& to) {
    if (!to.empty()) std::copy_n(from.data() + in_part, count, to.data() + in_whole);
  };
  const auto from = number_columns(part);
  const auto to = number_columns(*this);
  for (std::size_t i = 0; i < to.size(); ++i) copy_column(*from[i], *to[i]);
  copy_column(part.status, status);
}

}  // namespace dolp
