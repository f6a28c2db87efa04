#include "verify/table_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <dolp/errors.hpp>
#include <span>

#include "reference/reference_evaluator.hpp"
#include "run/response_run.hpp"

namespace dolp {
namespace {

/// A request for the sample's entries.
MomentsRequest request_of(const TableSample& sample, const Surface& surface) {
  MomentsRequest request = response_request(surface);
  const OpticalConstants index = request.indices.front();
  request.indices.clear();
  const SceneEntries grid = SceneEntries::of_grid(sample.table.axes, index);
  for (const std::size_t position : sample.positions) {
    const SceneEntry entry = grid[position];
    request.append({entry.theta_deg, entry.shape, index});
  }
  return request;
}

}  // namespace

TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress) {
  const TableValues& table = sample.table;
  const std::vector<double>& stated = table.responses[ResponseVariable::kResponseError];
  if (stated.empty()) throw InputError(name + ": has no response_error to check");
  const MomentsRequest request = request_of(sample, scene.surface);
  ReferenceEvaluator reference;
  const EntryResponses right = responses_of(request, scene.accuracy, reference, progress);
  const std::vector<double>& reference_error = right.responses[ResponseVariable::kResponseError];
  TableCheck check;
  check.entries = table.size();
  check.checked = request.size();
  check.tolerance = scene.accuracy.tolerance;
  for (std::size_t i = 0; i < stated.size(); ++i) check.missed += stated[i] > check.tolerance * right.albedo[i] ? 1 : 0;
  for (const ResponseVariable variable : kAllResponseVariables) {
    const ResponseDescription& described = description_of(variable);
    if (!described.has_beta || table.responses[variable].empty()) continue;
    if (table.responses[variable].size() != right.responses[variable].size())
      throw InputError(fmt::format("{}: {} is not at the local angles of this program", name, described.name));
    const bool is_of_q = variable == ResponseVariable::kResponseQ || variable == ResponseVariable::kEmissionQ;
    QuantityCheck& of_variable = check.quantities.emplace_back();
    of_variable.name = described.name;
    for (std::size_t i = 0; i < request.size(); ++i) {
      if (std::isnan(stated[i]) && std::isnan(reference_error[i])) continue;  // there is no reflectance
      const auto own = [&](const std::vector<double>& weights) {
        return std::span(weights).subspan(i * table.beta_deg.size(), table.beta_deg.size());
      };
      CheckedValue value{described.name, position_of(sample.positions[i], table.axes)};
      value.stored = response_distance(own(table.responses[variable]), own(right.responses[variable]), is_of_q);
      value.stated = stated[i];
      value.reference_error = reference_error[i];
      if (!(value.stored <= stated[i] + reference_error[i])) value.complaint = "is too far from the reference";
      if (of_variable.compared++ == 0 || value.ratio() > of_variable.worst.ratio()) of_variable.worst = value;
      if (!value.complaint.empty()) check.failures.push_back(value);
    }
  }
  return check;
}

}  // namespace dolp
