// Output of results, common to all studies.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "methods/method.hpp"

namespace dolp::bench {

/// Fills `warnings` of a study: the problems of its times, and remedies. Reads `context`, and from `results` the fields
/// that name a row (method or effect, case, setting) and raw_times_s where there are any.
void add_warnings(nlohmann::ordered_json& result);

/// A method as studies list it in `methods`.
nlohmann::ordered_json method_json(const Method& method);

/// Adds the device or processor of a method to `methods` of a study.
void note_where(nlohmann::ordered_json& result, const Method& method, const Solver& solver);

/// A study as a file: indented, except `results`, which come last with one row a line.
std::string json_text(nlohmann::ordered_json result);

}  // namespace dolp::bench
