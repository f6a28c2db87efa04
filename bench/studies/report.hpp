// Parts of the JSON that all studies have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "methods/method.hpp"

namespace dolp::bench {

/// Fills `warnings` with problems of the measured times, and what to do about them. Reads `context`, and in each row of
/// `results` the raw times and the fields that name the row, such as method, case and setting.
void add_warnings(nlohmann::ordered_json& result);

/// The description of a method, an element of `methods`.
nlohmann::ordered_json method_json(const Method& method);

/// Adds the device or processor of a method to its description in `methods`.
void note_where(nlohmann::ordered_json& result, const Method& method, const Solver& solver);

/// The text of a study's JSON file. The text is indented. `results` come last, with one row per line.
std::string json_text(nlohmann::ordered_json result);

}  // namespace dolp::bench
