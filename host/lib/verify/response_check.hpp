// Recomputes entries of a response table with the independent reference.
#pragma once

#include <string>

#include "verify/table_check.hpp"

namespace dolp {

/// Compares all weights of the sample with the weights of ReferenceEvaluator. They are wrong where they are
/// farther apart, as response_distance measures it, than the table's response_error and the reference's own together.
/// Errors: InputError that begins with `name` for a table without response_error; Cancelled.
TableCheck check_responses(const TableSample& sample, const SceneValues& scene, const std::string& name,
                           const Progress& progress);

}  // namespace dolp
