// The steps that all studies share, from the check of the output file to the results and their warnings.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <dolp/errors.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studies/study.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {

/// The state of a study while it runs: the JSON so far, and the numbers of finished and of expected rows.
class StudyRun {
 public:
  StudyRun(const StudyOptions& options, Progress progress) : options_(options), progress_(std::move(progress)) {}

  const StudyOptions& options() const { return options_; }

  /// Starts the JSON: name of the study, context, and the meanings of `error` and `time_s` in its rows.
  void describe(const std::string& study, const std::string& error, const std::string& time_s);

  /// The JSON. A study writes everything into it except the rows, which `finish` adds.
  nlohmann::ordered_json& json() { return json_; }

  /// Increases the number of rows that the progress bar expects.
  void expect(std::size_t rows) { total_ += rows; }

  /// Adds a finished row. Errors: Cancelled.
  void finish(const nlohmann::ordered_json& row);

  const nlohmann::ordered_json& rows() const { return json_["results"]; }

  /// The finished JSON, with the total time.
  nlohmann::ordered_json result();

 private:
  const StudyOptions& options_;
  Progress progress_;
  nlohmann::ordered_json json_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The functions that each study supplies.
struct StudyParts {
  std::function<void(StudyRun&)> measure;
  std::function<std::string(const nlohmann::ordered_json&)> table_text;                ///< table for the terminal
  std::function<void(nlohmann::ordered_json&)> warn = [](nlohmann::ordered_json&) {};  ///< adds warnings to the JSON
};

/// Runs a study with a progress bar, prints its table and warnings, and writes its JSON. Errors: IoError if the file
/// cannot be written, which is checked before the study starts; the errors of `measure`.
void run_study(const StudyOptions& options, const StudyParts& parts);

/// The members of `all` with these names; all members if no name is given. Errors: InputError that names `option`, the
/// unknown name and the known names.
template <class Named>
std::vector<Named> chosen(const std::vector<Named>& all, const std::vector<std::string>& names, const char* option) {
  std::string known;
  for (const Named& one : all) known += (known.empty() ? "" : ", ") + one.name;
  for (const std::string& name : names) {
    if (std::ranges::find(all, name, &Named::name) != all.end()) continue;
    throw InputError(fmt::format("{} {}: there is none of this name; choose among {}", option, name, known));
  }
  std::vector<Named> kept = all;
  if (!names.empty()) {
    std::erase_if(kept, [&](const Named& one) { return std::ranges::find(names, one.name) == names.end(); });
  }
  return kept;
}

/// Checks the option --device before a study starts. Errors: DeviceError if it names an unknown device.
void check_device(const StudyOptions& options);

/// A time with a unit, for tables: "3.1 us".
std::string time_text(double time_s);

}  // namespace dolp::bench
