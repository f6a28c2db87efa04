// Parts of the JSON that all studies have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "methods/method.hpp"

namespace dolp::bench {

/// Adds the list `warnings` to the JSON of a study. Each warning names a problem of the measured times and a remedy.
/// This function reads `context`. In each row of `results` it reads the raw times, and the fields that name the row,
/// such as method, case and setting.
void add_warnings(nlohmann::ordered_json& result);

/// The description of a method, as an element of the list `methods` in the JSON of a study.
nlohmann::ordered_json method_json(const Method& method);

/// Adds the device or processor on which `solver` runs to the description of `method` in `methods`.
void note_where(nlohmann::ordered_json& result, const Method& method, const Solver& solver);

/// The text of a study's JSON file. The text is indented. `results` come last, with one row per line.
std::string json_text(nlohmann::ordered_json result);

}  // namespace dolp::bench
