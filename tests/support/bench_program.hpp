// Runs dolp-bench and its plot script as a user does.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli_support.hpp"

namespace dolp {

class BenchProgram : public CommandLine {
 protected:
  Outcome bench(Words arguments, std::vector<std::pair<std::string, std::string>> environment = {}) const {
    arguments.insert(arguments.begin(), DOLP_BENCH_PROGRAM);
    return run({.arguments = std::move(arguments), .folder = at(""), .environment = std::move(environment)});
  }
  Outcome plot(const Words& arguments) const {
    return run({.arguments = joined({"/usr/bin/python3", DOLP_BENCH_PLOT}, arguments), .folder = at("")});
  }
  /// The JSON result of a study that must succeed.
  nlohmann::json study_of(const Words& arguments) const { return printed_json(bench(joined(arguments, "--json -"))); }
  static void expect_keys(const nlohmann::json& object, const std::set<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object.dump();
  }
};

}  // namespace dolp
