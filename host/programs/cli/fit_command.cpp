#include <algorithm>

#include "cli/commands.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {

int run_fit(const Options& options) {
  const Scene scene = load_scene(options);
  std::vector<MeasuredData> data;
  for (const std::string& argument : options.data) {
    data.push_back(MeasuredData::read(argument));
    warn("dolp", data.back().remarks);
  }
  FitOptions fit;
  for (const std::string& argument : options.vary) fit.vary.push_back(FitRange::from_text(argument));
  for (const std::string& argument : options.compare) fit.compare.push_back(Comparison::from_text(argument));
  fit.starts = options.starts;
  fit.seed = options.seed;
  fit.loss = static_cast<Loss>(std::ranges::find(loss_names(), options.loss) - loss_names().begin());
  fit.model_error = static_cast<ModelError>(std::ranges::find(model_error_names(), options.model_error) -
                                            model_error_names().begin());
  fit.output = options.output_path;
  fit.plot = options.plot_path;
  Report report;
  bool has_minimum = false;
  {
    ProgressBar bar(options.quiet);
    fit.progress = bar.callback();
    fit.phase = [&bar](const std::string& what) { bar.count(what); };
    const Fit found = evaluator_of(options).fit(scene, data, fit);
    report = found.report;
    has_minimum = found.has_minimum;
  }
  const int status = finish(report, options);
  return has_minimum ? status : kExitAccuracy;
}

}  // namespace dolp::cli
