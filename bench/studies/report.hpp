// Output of results, common to all studies.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "methods/method.hpp"

namespace dolp::bench {

/// Fills `warnings` of a study: what is wrong with its times, and what to do about it. Reads `context`, and of
/// `results` what names a row (method or effect, case, setting) and raw_times_s where there are any.
void add_warnings(nlohmann::ordered_json& result);

/// A method as studies list it in `methods`.
nlohmann::ordered_json method_json(const Method& method);

/// Adds to `methods` of a study where a method ran.
void note_where(nlohmann::ordered_json& result, const Method& method, const Solver& solver);

/// A study as a file: indented, but for `results`, which come last and one a line.
std::string json_text(nlohmann::ordered_json result);

}  // namespace dolp::bench
