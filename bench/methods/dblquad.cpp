// Runs SciPy's dblquad in a separate process, which also measures the times. So the times exclude the start of Python.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "methods/direct_brdf.hpp"
#include "methods/method.hpp"
#include "model/choices.hpp"
#include "studies/cases.hpp"
#include "studies/child.hpp"

namespace dolp::bench {
namespace {

const std::string kScript = DOLP_BENCH_SCRIPTS "/dblquad.py";

class Dblquad final : public Solver {
 public:
  explicit Dblquad(const SolverOptions& options) : time_limit_s_(options.time_limit_s) {
    std::string tried;
    for (const std::string& python : options.pythons) {
      const ChildOutcome outcome = run_child({python, kScript, "--version"}, ChildErrors::kHidden);
      if (outcome.status == 0 && outcome.out.starts_with("SciPy")) {
        python_ = python;
        version_ = outcome.out.substr(0, outcome.out.find('\n'));
        return;
      }
      tried += (tried.empty() ? "" : ", ") + python;
    }
    throw Unavailable("no Python with SciPy (tried " + tried + "); install python3-scipy");
  }

  Solution solve(const MomentsRequest& request, double setting) override {
    Solution solution{.evaluations = 0.0};
    for (std::size_t i = 0; i < request.size(); ++i) add(entry_of(request, i), setting, solution);
    return solution;
  }
  std::string where() const override { return version_; }

 private:
  void add(const Entry& entry, double tolerance, Solution& solution) const {
    const nlohmann::json question = {{"distribution", to_name(entry.distribution)},
                                     {"masking", to_name(entry.masking)},
                                     {"theta_rad", entry.theta_rad},
                                     {"sigma", entry.shape.sigma},
                                     {"q", entry.shape.q},
                                     {"n", entry.index.n},
                                     {"k", entry.index.k},
                                     {"tolerance", tolerance},
                                     {"time_limit_s", time_limit_s_}};
    const ChildOutcome outcome = run_child({python_, kScript, question.dump()}, ChildErrors::kShown);
    const nlohmann::json reply = nlohmann::json::parse(outcome.out, nullptr, false);
    if (outcome.status != 0 || !reply.is_object()) throw Unavailable(kScript + " failed; its message is above");
    if (reply.contains("too_long")) throw TookTooLong(fmt::format("it takes longer than {:g} s", time_limit_s_));
    solution.answers.push_back({reply["r_i"], reply["r_q"], reply["stated_error"].get<double>()});
    *solution.evaluations += reply["evaluations"].get<double>();
    add_times(reply["times_s"].get<std::vector<double>>(), solution);
  }

  // Each entry is computed and timed several times. Adds the first time of an entry to the first time of the whole
  // call, the second time to the second, and so on, up to the smallest number of repeats.
  static void add_times(const std::vector<double>& times_s, Solution& solution) {
    if (solution.answers.size() == 1) solution.own_times_s.assign(times_s.size(), 0.0);
    solution.own_times_s.resize(std::min(solution.own_times_s.size(), times_s.size()));
    for (std::size_t i = 0; i < solution.own_times_s.size(); ++i) solution.own_times_s[i] += times_s[i];
  }

  double time_limit_s_;
  std::string python_;
  std::string version_;
};

}  // namespace

std::unique_ptr<Solver> make_dblquad(const SolverOptions& options) { return std::make_unique<Dblquad>(options); }

}  // namespace dolp::bench
