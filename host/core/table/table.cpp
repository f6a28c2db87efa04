#include "table/table.hpp"

#include <fmt/format.h>

#include <bit>
#include <dolp/errors.hpp>

#include "base/hash.hpp"
#include "base/text.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kPositionFactor = 0x9e3779b97f4a7c15U;

std::uint64_t value_bits(double value) { return std::bit_cast<std::uint64_t>(value); }
std::uint64_t value_bits(std::uint32_t value) { return std::uint64_t{value} + 1U; }

template <class Value>
std::uint64_t sum_of_values(std::span<const Value> values, std::size_t first_position) {
  std::uint64_t sum = 0;
  std::uint64_t factor = first_position * kPositionFactor;
  for (const Value value : values) {
    sum += value_bits(value) * (factor | 1U);
    factor += kPositionFactor;
  }
  return sum;
}

std::vector<double> slice(const std::vector<double>& list, std::size_t first, std::size_t count) {
  const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

std::string spectral_data_text(const TableHead& head) {
  std::string text;
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = head.*described.curve;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      (text += described.name) += ',';
      append_number(text, curve.wavelength_um[i]);
      append_number(text += ',', curve.values[i]);
      text += '\n';
    }
  }
  return text;
}

void take_spectral_data(TableHead& head, const std::string& name) {
  const auto found = std::ranges::find(head.attributes, kSpectralData, &Attribute::name);
  if (found == head.attributes.end()) return;
  for (const TableCurve& described : kTableCurves) {
    Curve& curve = head.*described.curve;
    curve = {{}, {}, std::move(curve.used)};
  }
  const auto* text = std::get_if<std::string>(&found->value);
  const std::string rows = text ? *text : "a number";
  for (const std::string_view line : split_lines(rows)) {
    const std::vector<std::string_view> cells = split(line, ',');
    const auto described = std::ranges::find(kTableCurves, cells.front(), &TableCurve::name);
    const bool is_row = cells.size() == 3 && described != kTableCurves.end();
    const std::optional<double> wavelength_um = is_row ? parse_number(cells[1]) : std::nullopt;
    const std::optional<double> value = is_row ? parse_number(cells[2]) : std::nullopt;
    if (!wavelength_um || !value) {
      throw InputError(
          fmt::format("{}: attribute {}: \"{}\": must be index_n, index_k or irradiance, a wavelength and a "
                      "value",
                      name, kSpectralData, one_line(line)));
    }
    (head.*described->curve).wavelength_um.push_back(*wavelength_um);
    (head.*described->curve).values.push_back(*value);
  }
  head.attributes.erase(found);
}

std::string coordinate_names(const TableHead& head) {
  std::vector<std::string> names;
  if (!head.axes[Axis::kMaterial].empty()) names.emplace_back(kMaterialName.name);
  if (!head.axes[Axis::kBand].empty()) names.insert(names.end(), {kBandLow.name, kBandHigh.name});
  if (!head.wind_m_s.empty()) names.emplace_back(kWind.name);
  for (const TableCurve& described : kTableCurves) {
    if (!(head.*described.curve).used.empty()) names.emplace_back(described.name);
  }
  return fmt::format("{}", fmt::join(names, " "));
}

std::vector<std::string> derivative_keys(const TableHead& head) {
  std::vector<std::string> keys;
  if (const auto* const stored = find_attribute<std::string>(head, kDerivativeKeys))
    for (const std::string_view key : split(*stored, ',')) keys.emplace_back(key);
  return keys;
}

std::vector<DerivativeColumn> derivative_columns(const std::vector<std::string>& keys) {
  std::vector<DerivativeColumn> columns;
  for (const std::string& key : keys) {
    std::string name = "__" + key;
    std::ranges::replace(name, '.', '_');
    columns.push_back({"d_dolp" + name, "derivative of dolp by " + key, ""});
    columns.push_back({"d_q_over_i" + name, "derivative of q_over_i by " + key, ""});
    columns.push_back({"derivative_error" + name, "estimated error of the derivatives by " + key, ""});
  }
  return columns;
}

TableLayout values_layout(const TableValues& table) {
  TableLayout layout{static_cast<const TableHead&>(table), table.quantities(), !table.status.empty()};
  std::ranges::copy_if(kAllResponseVariables, std::back_inserter(layout.responses),
                       [&](ResponseVariable variable) { return !table.responses[variable].empty(); });
  for (const DerivativeColumn& column : table.derivatives)
    layout.derivatives.push_back({column.name, column.long_name, column.units});
  return layout;
}

std::vector<std::string> variable_names(const TableLayout& layout) {
  std::vector<std::string> names;
  for (const Quantity quantity : layout.quantities) names.emplace_back(describe(quantity).name);
  for (const ResponseVariable variable : layout.responses) names.emplace_back(describe(variable).name);
  for (const DerivativeColumn& column : layout.derivatives) names.push_back(column.name);
  if (layout.has_status) names.emplace_back("status");
  return names;
}

TableHead part_head(const TableHead& whole, const GridBox& box) {
  TableHead head = whole;
  head.axes = axes_part(whole.axes, box);
  if (!head.wind_m_s.empty()) head.wind_m_s = slice(head.wind_m_s, box.first[Axis::kSigma], box.count[Axis::kSigma]);
  for (const TableCurve& described : kTableCurves) {
    std::vector<double>& used = (head.*described.curve).used;
    if (!used.empty()) used = slice(used, box.first[Axis::kWavelength], box.count[Axis::kWavelength]);
  }
  return head;
}

ValueSums value_sums(const TableValues& part, const TableLayout& layout, const PerAxis& first) {
  ValueSums sums;
  for_each_variable(layout, [&](const auto& of, std::size_t width) {
    std::uint64_t& sum = sums.emplace_back(0);
    const std::span values(of(part));
    for_each_run({first, part.counts()}, layout.head.counts(), [&](const GridRun& run) {
      sum += sum_of_values(values.subspan(run.in_part * width, run.count * width), run.in_whole * width);
    });
  });
  return sums;
}

void add(ValueSums& sums, const ValueSums& part_sums) {
  sums.resize(part_sums.size(), 0);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += part_sums[i];
}

/// Axes that the hash contains even if a table lacks them. An axis that is not here leaves the hashes of older files
/// as they are.
constexpr std::array kAlwaysHashed = {Axis::kWavelength, Axis::kN, Axis::kK};

std::string values_hash(const TableLayout& layout, const ValueSums& sums) {
  const TableHead& head = layout.head;
  std::uint64_t hash = kHashStart;
  for (const Axis axis : kAllAxes) {
    const std::vector<double>& values = head.axes[axis];
    if (describe(axis).has_labels) {  // hashes the texts: their numbers differ in a file with a part of the table
      for (const double value : values) hash = hashed(hashed(hash, head.label(axis, value)), std::uint64_t{0});
    } else if (!values.empty() || std::ranges::count(kAlwaysHashed, axis) > 0) {
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
    hash = hashed(hash, std::string_view(i < layout.quantities.size() ? describe(layout.quantities[i]).name : other));
    hash = hashed(hash, sums[i]);
  }
  return fmt::format("placed64:{:016x}", hash);
}

}  // namespace dolp
