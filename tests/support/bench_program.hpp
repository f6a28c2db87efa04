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
  Outcome bench(std::vector<std::string> arguments,
                std::vector<std::pair<std::string, std::string>> environment = {}) const {
    arguments.insert(arguments.begin(), DOLP_BENCH_PROGRAM);
    return run({.arguments = std::move(arguments), .folder = at(""), .environment = std::move(environment)});
  }
  Outcome plot(const std::vector<std::string>& arguments) const {
    return run({.arguments = joined({"/usr/bin/python3", DOLP_BENCH_PLOT}, arguments), .folder = at("")});
  }
  /// The JSON result of a study that must succeed.
  nlohmann::json study_of(const std::vector<std::string>& arguments) const {
    const Outcome outcome = bench(joined(arguments, {"--json", "-"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  nlohmann::json study_of(const std::string& line) const { return study_of(split_at(line, ' ')); }
  static void expect_keys(const nlohmann::json& object, const std::set<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object.dump();
  }
};

}  // namespace dolp
