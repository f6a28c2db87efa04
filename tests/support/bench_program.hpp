// dolp-bench and its plot script, run from outside.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace dolp {

class BenchProgram : public testing::Test {
 protected:
  std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }

  Outcome bench(std::vector<std::string> arguments,
                std::vector<std::pair<std::string, std::string>> environment = {}) const {
    arguments.insert(arguments.begin(), DOLP_BENCH_PROGRAM);
    Command command{.arguments = std::move(arguments), .folder = folder_.path()};
    command.environment = std::move(environment);
    return run(command);
  }
  Outcome plot(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"/usr/bin/python3", DOLP_BENCH_PLOT});
    return run({.arguments = std::move(arguments), .folder = folder_.path()});
  }
  /// The results of a study, `fixed` options first.
  nlohmann::json study_of(const std::vector<std::string>& fixed, std::vector<std::string> options) const {
    options.insert(options.begin(), fixed.begin(), fixed.end());
    const Outcome outcome = bench(options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  static void expect_keys(const nlohmann::json& object, const std::set<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object.dump();
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace dolp
