#include "cli/commands.hpp"
#include "report/plan_report.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {

int run_plan(const Options& options) {
  plan_report(plan_of(load_scene(options), options.device, options.keep_all)).print(options.json, false);
  return kExitDone;
}

}  // namespace dolp::cli
