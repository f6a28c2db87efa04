#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <utility>

#include "api/results.hpp"
#include "api/scene_impl.hpp"
#include "api/table_impl.hpp"
#include "api/translated.hpp"
#include "base/stopwatch.hpp"
#include "evaluate/named/named_evaluator.hpp"
#include "fit/fit.hpp"
#include "fit/fit_data.hpp"
#include "report/fit_report.hpp"
#include "run/mueller_run.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "run/table_run.hpp"
#include "table/table_file.hpp"

namespace dolp::api {
namespace {

using Clock = std::chrono::steady_clock;

/// Refuses Vulkan in a process that was forked from one that has used it: drivers keep threads and locks that a fork
/// does not copy, so that calls would wait for ever.
void check_no_fork() {
  static std::atomic<pid_t> first_user = 0;
  const pid_t own = getpid();
  pid_t user = 0;
  if (first_user.compare_exchange_strong(user, own) || user == own) return;
  throw dolp::DeviceError(
      fmt::format("this process was forked from process {}, which uses Vulkan, and a device does not outlive a fork: "
                  "start processes afresh (in Python multiprocessing.set_start_method(\"spawn\")), or take the "
                  "evaluator cpu",
                  user));
}

/// What ran: nothing, where no evaluator was needed.
EvaluationReport report_of(const MomentsEvaluator* evaluator) {
  if (evaluator != nullptr) return evaluator->report();
  EvaluationReport nothing;
  nothing.evaluator = nothing.device = nothing.precision = "none";
  return nothing;
}

/// Calls a function with each part of a run.
class Parts final : public Sink {
 public:
  using Take = std::function<void(const SceneEntries& part, const std::vector<PointResult>& results)>;
  explicit Parts(Take take) : take_(std::move(take)) {}
  void write(const SceneEntries& part, std::vector<PointResult> results, const SelfCheck& /*check*/) override {
    take_(part, results);
  }

 private:
  Take take_;
};

/// Results of entries, and the head of a table of them.
struct Run {
  std::vector<PointResult> results;
  TableLayout layout;
};

}  // namespace

struct Evaluator::Impl {
  explicit Impl(EvaluatorOptions own) : options(std::move(own)) {}

  /// The evaluator for a scene, before a run. Errors: those of make_evaluator.
  MomentsEvaluator* begin(const dolp::Scene& scene) {
    const Precision precision = scene.accuracy.precision;
    std::unique_ptr<MomentsEvaluator>& evaluator = evaluators[precision];
    if (!evaluator) evaluator = make_evaluator({options.evaluator, options.device, precision});
    evaluator->clear_report();
    return evaluator.get();
  }

  /// Calls `body` with nobody else using the evaluators; a device that failed is not used again.
  template <class Body>
  auto exclusively(const Body& body) {
    return translated([&] {
      if (options.evaluator == "vulkan") check_no_fork();
      const std::lock_guard lock(mutex);
      try {
        return body();
      } catch (const dolp::DeviceError&) {
        evaluators.clear();
        throw;
      }
    });
  }

  /// All entries of a grid or of points.
  Run run(const dolp::Scene& scene, const SceneEntries& entries, const RunOptions& wanted) {
    const Clock::time_point start = Clock::now();
    const EffectPlan plan = plan_effects(scene, entries, wanted.keep_all);
    MomentsEvaluator* const evaluator = wants_evaluator(scene, entries, plan) ? begin(scene) : nullptr;
    CollectedResults collected(entries);
    const SelfCheck check = run_scene(scene, entries, plan, evaluator, collected, wanted.progress);
    Run run{collected.take(), table_layout(scene, plan, entries.axes())};
    const std::vector<EffectRow> effects = effect_rows(scene, entries, plan);
    std::vector<dolp::Attribute>& attributes = run.layout.head.attributes;
    for (dolp::Attribute& attribute :
         attributes_of(scene, {plan, effects, report_of(evaluator), check, seconds_since(start), wanted.history})) {
      attributes.push_back(std::move(attribute));
    }
    return run;
  }

  EvaluatorOptions options;
  std::mutex mutex;
  std::map<Precision, std::unique_ptr<MomentsEvaluator>> evaluators;
  pid_t owner = getpid();
};

Evaluator::Evaluator(EvaluatorOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

Evaluator::~Evaluator() {
  // In a forked process the driver's threads, which its end would wait for, are not there.
  if (impl_ && impl_->owner != getpid()) static_cast<void>(impl_.release());
}

Table Evaluator::table(const Scene& scene, const RunOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const SceneEntries entries = grid_entries(own);
    Run run = impl_->run(own, entries, options);
    dolp::Table table = table_part(run.layout, entries, run.results);
    static_cast<TableHead&>(table) = std::move(run.layout.head);
    return Table(std::make_shared<const Table::Impl>(std::move(table), "table"));
  });
}

void Evaluator::table_parts(const Scene& scene, const std::function<void(const Table&)>& take,
                            const RunOptions& options) {
  impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const SceneEntries entries = grid_entries(own);
    const EffectPlan plan = plan_effects(own, entries, options.keep_all);
    MomentsEvaluator* const evaluator = wants_evaluator(own, entries, plan) ? impl_->begin(own) : nullptr;
    const TableLayout layout = table_layout(own, plan, entries.axes());
    Parts parts([&](const SceneEntries& part, const std::vector<PointResult>& results) {
      dolp::Table table = table_part(layout, part, results);
      table.stokes_units = layout.head.stokes_units;
      take(Table(std::make_shared<const Table::Impl>(std::move(table), "part")));
    });
    run_scene(own, entries, plan, evaluator, parts, options.progress);
  });
}

std::filesystem::path Evaluator::write_table(const Scene& scene, const std::filesystem::path& path,
                                             const RunOptions& options, const Shard& shard) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    TableJob job;
    job.shard = {shard.number, shard.count};
    job.path = shard_path(path, job.shard);
    job.is_resumable = false;
    job.keep_all = options.keep_all;
    job.command_line = options.history;
    job.start = Clock::now();
    check_output_path(job.path);
    run_table_job(
        own, job, [&] { return impl_->begin(own); }, options.progress);
    return job.path;
  });
}

Results Evaluator::evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const SceneEntries entries = point_entries(own, points_of_columns(points, PointsKind::kDirections));
    const Run run = impl_->run(own, entries, options);
    return results_of(run.results, extra_columns(own), run.layout.head);
  });
}

Fit Evaluator::fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    std::vector<fit::FitData> sets;
    for (const MeasuredData& one : data) {
      sets.push_back(fit::parse_fit_data(one.csv, one.name));
      sets.back().overrides = one.overrides;
    }
    std::vector<fit::Parameter> parameters;
    for (const std::string& one : options.vary) parameters.push_back(fit::parse_parameter(one));
    const fit::Model model({own.text, own.path_name, own.overrides}, std::move(sets), parameters);
    const std::optional<fit::FitResult> found =
        fit::fit(model, *impl_->begin(own), {options.starts, options.seed, fit::Loss::kSquares, options.progress});
    if (!found) throw dolp::InputError("fit: no descent converged; try other ranges, or more starts");
    Report report;
    add_fit(report, model, *found);
    Eigen::VectorXd values(static_cast<Eigen::Index>(found->parameters.size()));
    for (Eigen::Index j = 0; j < values.size(); ++j) values[j] = found->parameters[static_cast<std::size_t>(j)].value;
    return Fit{report.text(), report.json_text(), scene.with(model.overrides(values))};
  });
}

std::vector<MuellerMatrix> Evaluator::mueller(const Scene& scene, const std::vector<Column>& points,
                                              const RunOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const auto geometries = mueller_points(own, points_of_columns(points, PointsKind::kGeometries));
    return evaluate_mueller(own, geometries, *impl_->begin(own), options.progress);
  });
}

}  // namespace dolp::api
