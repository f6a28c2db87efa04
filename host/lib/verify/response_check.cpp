#include "verify/response_check.hpp"

#include <cmath>
#include <dolp/errors.hpp>
#include <span>

#include "reference/reference_evaluator.hpp"
#include "run/response_run.hpp"

namespace dolp {
namespace {

/// The sample's entries.
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

/// `distance(i)`: between the table and the reference at an entry of the sample.
template <class Distance>
void add_check(TableCheck& check, const char* name, const MomentsRequest& request, const std::vector<double>& stated,
               const std::vector<double>& reference_error, const Distance& distance) {
  QuantityCheck& of_quantity = check.quantities.emplace_back();
  of_quantity.name = name;
  for (std::size_t i = 0; i < request.size(); ++i) {
    if (std::isnan(stated[i]) && std::isnan(reference_error[i])) continue;  // there is no reflectance
    CheckedValue value{.quantity = name,
                       .theta_deg = request.theta_deg[i],
                       .sigma = request.sigma[i],
                       .q = request.q[i],
                       .stored = distance(i),
                       .stated = stated[i],
                       .reference_error = reference_error[i]};
    if (!(value.stored <= stated[i] + reference_error[i])) value.complaint = "is too far from the reference";
    if (of_quantity.compared++ == 0 || value.ratio() > of_quantity.worst.ratio()) of_quantity.worst = value;
    if (!value.complaint.empty()) check.failures.push_back(value);
  }
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
  const std::vector<double>& albedo = table[Quantity::kAlbedo];
  for (std::size_t i = 0; i < albedo.size(); ++i) check.missed += stated[i] > check.tolerance * albedo[i] ? 1 : 0;
  if (!albedo.empty()) {
    add_check(check, "albedo", request, stated, reference_error,
              [&](std::size_t i) { return std::abs(albedo[i] - right.albedo[i]); });
  }
  for (const ResponseVariable variable : kAllResponseVariables) {
    const ResponseDescription& described = description_of(variable);
    const std::vector<double>& own = table.responses[variable];
    if (!described.has_beta || own.empty()) continue;
    const std::size_t width = table.width_of(variable);
    const bool is_of_q = variable == ResponseVariable::kResponseQ || variable == ResponseVariable::kEmissionQ;
    add_check(check, described.name, request, stated, reference_error, [&](std::size_t i) {
      return response_distance(std::span(own).subspan(i * width, width),
                               std::span(right.responses[variable]).subspan(i * width, width), is_of_q);
    });
  }
  return check;
}

}  // namespace dolp
