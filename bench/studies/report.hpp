// Output of results for all studies.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "methods/method.hpp"

namespace dolp::bench {

/// Fills `warnings` of a study with problems of its times, and remedies. Reads `context`, and in `results` the fields
/// that name a row (method or effect, case, setting) and raw_times_s if present.
void add_warnings(nlohmann::ordered_json& result);

/// A method as an element of `methods`.
nlohmann::ordered_json method_json(const Method& method);

/// Adds the device or processor of a method to `methods`.
void note_where(nlohmann::ordered_json& result, const Method& method, const Solver& solver);

/// A study as text of its file: indented, except `results`, which come last with one row per line.
std::string json_text(nlohmann::ordered_json result);

}  // namespace dolp::bench
