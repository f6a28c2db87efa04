#include "api/results.hpp"

#include <algorithm>

#include "base/number_text.hpp"
#include "base/parallel_ranges.hpp"

namespace dolp::api {
namespace {

constexpr std::size_t kPointsAtOnce = 16384;  // of a thread

bool is_given(const TableVariable& variable, const ExtraColumns& extra) {
  if (variable.member == &PointResult::emissivity_s || variable.member == &PointResult::emissivity_p) {
    return extra.emissivity;
  }
  if (variable.member == &PointResult::dolp_low || variable.member == &PointResult::dolp_high) return extra.bracket;
  return true;
}

}  // namespace

Variable variable_of(const TableVariable& variable, const std::string& stokes_units) {
  return {variable.name, variable.long_name, variable.has_stokes_units ? stokes_units : "1", variable.ancillary};
}

Results results_of(const std::vector<PointResult>& points, const ExtraColumns& extra, const TableHead& head) {
  Results results;
  std::vector<double PointResult::*> members;
  for (const TableVariable& variable : table_variables()) {
    if (!is_given(variable, extra)) continue;
    members.push_back(variable.member);
    results.quantities.push_back({variable_of(variable, head.stokes_units), std::vector<double>(points.size())});
  }
  results.status.resize(points.size());
  parallel_ranges(points.size(), kPointsAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = 0; j < members.size(); ++j) results.quantities[j].values[i] = points[i].*members[j];
      results.status[i] = points[i].status;
    }
  });
  for (const dolp::Attribute& attribute : head.attributes) {
    results.attributes.push_back({attribute.name, attribute.value});
  }
  return results;
}

std::string to_csv(const std::vector<Column>& points, const Results& results) {
  std::vector<const Results::Quantity*> quantities;
  for (const std::string& name : result_columns()) {
    const auto named = [&](const Results::Quantity& quantity) { return quantity.variable.name == name; };
    const auto found = std::ranges::find_if(results.quantities, named);
    if (found != results.quantities.end()) quantities.push_back(&*found);
  }
  std::string csv;
  for (const Column& column : points) csv += column.name + ',';
  for (const Results::Quantity* quantity : quantities) csv += quantity->variable.name + ',';
  csv += "status\n";
  for (std::size_t i = 0; i < results.status.size(); ++i) {
    for (const Column& column : points) {
      append_number(csv, column.values[column.values.size() == 1 ? 0 : i]);
      csv += ',';
    }
    for (const Results::Quantity* quantity : quantities) {
      append_number(csv, quantity->values[i]);
      csv += ',';
    }
    csv += std::to_string(results.status[i]) + '\n';
  }
  return csv;
}

Points points_of_columns(const std::vector<Column>& columns, PointsKind kind) {
  std::size_t count = 1;
  for (const Column& column : columns) {
    if (column.values.size() != 1) count = column.values.size();
  }
  return points_of(columns, count, kind);
}

}  // namespace dolp::api
