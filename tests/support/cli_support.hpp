// A scene, points and a folder for tests that run `dolp` as a user does.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "contains.hpp"
#include "in_folder.hpp"
#include "program.hpp"

namespace dolp {

inline const std::string kScene = read_file(DOLP_TEST_DATA_DIR "/scene.toml");

inline const std::string kPoints = "theta_deg,sigma,q\n0,0.1,2\n60.0,0.4,3.5\n 80.5,0.1 ,2\n";

inline const std::vector<std::string> kResultColumns = {
    "rho_i",        "rho_q",        "albedo",   "stokes_i",       "stokes_q",
    "stokes_u",     "stokes_v",     "dolp",     "error_estimate", "rho_error_estimate",
    "emissivity_s", "emissivity_p", "q_over_i", "aolp_deg",       "status"};

/// Environment in which the Vulkan loader finds no driver.
inline const std::vector<std::pair<std::string, std::string>> kNoDriver = {{"VK_DRIVER_FILES", "/nonexistent.json"},
                                                                           {"VK_ICD_FILENAMES", "/nonexistent.json"}};

inline std::vector<std::string> split_at(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// The words of a command line: a list, or a text that is cut at its spaces.
struct Words : std::vector<std::string> {
  Words() = default;
  Words(std::initializer_list<std::string> words) : std::vector<std::string>(words) {}
  Words(std::vector<std::string> words) : std::vector<std::string>(std::move(words)) {}
  Words(const std::string& line) : Words(split_at(line, ' ')) {}
  Words(const char* line) : Words(std::string(line)) {}
};

inline Words joined(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Expects the exit status 0, and returns the outcome.
inline Outcome succeeded(Outcome outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  return outcome;
}

/// The JSON that a program printed. Expects the exit status 0.
inline nlohmann::json printed_json(const Outcome& outcome) { return nlohmann::json::parse(succeeded(outcome).out); }

/// Expects a message of `program` that is one line and contains `part`.
inline void expect_one_line(const std::string& err, const std::string& part = "", const std::string& program = "dolp") {
  EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  EXPECT_TRUE(err.starts_with(program + ": ") && err.ends_with('\n')) << err;
  EXPECT_TRUE(contains(err, part));
}

/// Expects the exit status `status`, no output, and a message of one line that contains `part`.
inline void expect_refused(const Outcome& outcome, const std::string& part, int status = 2,
                           const std::string& program = "dolp") {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  expect_one_line(outcome.err, part, program);
}

/// Columns of a CSV file, by name.
using Columns = std::map<std::string, std::vector<double>>;

/// The lines of a CSV file without its attributes (#), which contain time and command line.
inline std::vector<std::string> data_lines(const std::string& csv) {
  std::vector<std::string> lines = split_at(csv, '\n');
  std::erase_if(lines, [](const std::string& line) { return line.starts_with('#'); });
  return lines;
}

inline Columns parse_csv(const std::string& csv) {
  const std::vector<std::string> lines = data_lines(csv);
  Columns columns;
  if (lines.empty()) return columns;
  const std::vector<std::string> names = split_at(lines.front(), ',');
  for (const std::string& name : names) columns[name] = {};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> cells = split_at(lines[i], ',');
    if (cells.size() != names.size())
      ADD_FAILURE() << "line " << i << " has " << cells.size() << " cells: " << lines[i];
    for (std::size_t j = 0; j < std::min(cells.size(), names.size()); ++j) {
      columns[names[j]].push_back(std::strtod(cells[j].c_str(), nullptr));
    }
  }
  return columns;
}

/// Runs `dolp` in a new folder with scene.toml and points.csv.
class CommandLine : public InFolder {
 protected:
  void SetUp() override {
    put("scene.toml", kScene);
    put("points.csv", kPoints);
  }

  Command command(Words arguments) const {
    arguments.insert(arguments.begin(), DOLP_PROGRAM);
    return {.arguments = std::move(arguments), .folder = folder()};
  }
  Outcome dolp(const Words& arguments, const std::string& input = "") const {
    Command wanted = command(arguments);
    wanted.input = input;
    return run(wanted);
  }
  /// Runs `dolp` without a Vulkan device.
  Outcome without_device(const Words& arguments) const {
    Command wanted = command(arguments);
    wanted.environment = kNoDriver;
    return run(wanted);
  }
  /// The JSON report of a command that must succeed.
  nlohmann::json report(const Words& arguments) const { return printed_json(dolp(joined(arguments, "--json"))); }
  /// The output of `dolp eval` for points.csv.
  Columns eval(const Words& options) const {
    const Words start = "eval scene.toml --points points.csv -o - --quiet";
    return parse_csv(succeeded(dolp(joined(start, options))).out);
  }
};

}  // namespace dolp
