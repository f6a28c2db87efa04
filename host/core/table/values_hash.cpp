#include "table/values_hash.hpp"

#include <fmt/format.h>

#include <bit>

#include "base/hash.hpp"
#include "model/scene_entry.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kPlaceFactor = 0x9e3779b97f4a7c15U;

template <class Value, class Bits>
std::uint64_t sum(std::span<const Value> values, std::size_t first_place, const Bits& bits) {
  std::uint64_t sum = 0;
  std::uint64_t factor = first_place * kPlaceFactor;
  for (const Value value : values) {
    sum += bits(value) * (factor | 1U);
    factor += kPlaceFactor;
  }
  return sum;
}

}  // namespace

std::uint64_t sum_of_values(std::span<const double> values, std::size_t first_place) {
  return sum(values, first_place, [](double value) { return std::bit_cast<std::uint64_t>(value); });
}

std::uint64_t sum_of_values(std::span<const std::uint32_t> values, std::size_t first_place) {
  return sum(values, first_place, [](std::uint32_t value) { return std::uint64_t{value} + 1U; });
}

ValueSums sums_of(const TableValues& part, const Quantities& quantities, const PerAxis& first, const PerAxis& whole) {
  ValueSums sums;
  const auto append = [&](const auto& values) {
    std::uint64_t& sum = sums.emplace_back(0);
    const std::size_t width = values.size() / part.size();
    for_each_run(first, part.counts(), whole, [&](const GridRun& run) {
      sum += sum_of_values(std::span(values).subspan(run.in_part * width, run.count * width), run.in_whole * width);
    });
  };
  for (const Quantity quantity : quantities) append(part[quantity]);
  for (const std::vector<double>& values : part.responses) {
    if (!values.empty()) append(values);
  }
  if (!part.status.empty()) append(part.status);
  return sums;
}

void add(ValueSums& sums, const ValueSums& of_part) {
  sums.resize(of_part.size(), 0);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += of_part[i];
}

std::string values_hash(const TableHead& head, const Quantities& quantities, const ValueSums& sums) {
  std::uint64_t hash = kHashStart;
  for (const Axis axis : kAllAxes) {
    const std::vector<double>& values = head.axes[axis];
    if (description_of(axis).has_labels) {  // positions differ between a table and its parts
      for (const double value : values) hash = hashed(hashed(hash, head.label(axis, value)), std::uint64_t{0});
    } else if (axis != Axis::kTemperature || !values.empty()) {  // files that could not have it keep their hash
      hash = hashed(hash, std::span(values));
    }
  }
  for (const std::vector<double>* values : {&head.wind_m_s, &head.beta_deg}) {
    if (!values->empty()) hash = hashed(hash, std::span(*values));
  }
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = head.*described.curve;
    for (const std::vector<double>* values : {&curve.wavelength_um, &curve.values, &curve.used})
      if (!values->empty()) hash = hashed(hash, std::span(*values));
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const char* const other = head.beta_deg.empty() ? "status" : "response";
    hash = hashed(hash, std::string_view(i < quantities.size() ? description_of(quantities[i]).name : other));
    hash = hashed(hash, sums[i]);
  }
  return fmt::format("placed64:{:016x}", hash);
}

}  // namespace dolp
