#include <fmt/format.h>

#include <atomic>
#include <chrono>

#include "api/evaluator_impl.hpp"
#include "api/reports.hpp"
#include "api/results.hpp"
#include "api/scene_impl.hpp"
#include "api/table_impl.hpp"
#include "base/stopwatch.hpp"
#include "report/run_report.hpp"
#include "run/mueller_run.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"

namespace dolp::api {
namespace {

using Clock = std::chrono::steady_clock;

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
  double evaluations = 0.0;  ///< of integrands
};

/// All entries of a grid or of points. `begin` makes the evaluator, when it is needed.
template <class Begin>
Run run_entries(const dolp::Scene& scene, const SceneEntries& entries, const RunOptions& wanted, const Begin& begin) {
  const Clock::time_point start = Clock::now();
  const EffectPlan plan = plan_effects(scene, entries, wanted.keep_all);
  MomentsEvaluator* const evaluator = wants_evaluator(scene, entries, plan) ? begin(scene) : nullptr;
  api::begin(wanted.progress, entries.size());
  CollectedResults collected(entries);
  const SelfCheck check = run_scene(scene, entries, plan, evaluator, collected, wanted.progress);
  const EvaluationReport evaluation = evaluation_of(evaluator, "none");
  Run run{collected.take(), table_layout(scene, plan, entries.axes()), evaluation.evaluations};
  const std::vector<EffectRow> effects = effect_rows(scene, entries, plan);
  std::vector<dolp::Attribute>& attributes = run.layout.head.attributes;
  for (dolp::Attribute& attribute :
       attributes_of(scene, {plan, effects, evaluation, check, seconds_since(start), wanted.history})) {
    attributes.push_back(std::move(attribute));
  }
  return run;
}

}  // namespace

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
    Run run = run_entries(own, entries, options, [&](const dolp::Scene& one) { return impl_->begin(one); });
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
    api::begin(options.progress, entries.size());
    Parts parts([&](const SceneEntries& part, const std::vector<PointResult>& results) {
      dolp::Table table = table_part(layout, part, results);
      table.stokes_units = layout.head.stokes_units;
      take(Table(std::make_shared<const Table::Impl>(std::move(table), "part")));
    });
    run_scene(own, entries, plan, evaluator, parts, options.progress);
  });
}

Results Evaluator::evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const SceneEntries entries = point_entries(own, points_of_columns(points, PointsKind::kDirections));
    const Run run = run_entries(own, entries, options, [&](const dolp::Scene& one) { return impl_->begin(one); });
    Results results = results_of(run.results, extra_columns(own), run.layout.head);
    results.integrand_evaluations = run.evaluations;
    return results;
  });
}

std::vector<MuellerMatrix> Evaluator::mueller(const Scene& scene, const std::vector<Column>& points,
                                              const RunOptions& options) {
  return impl_->exclusively([&] {
    const dolp::Scene& own = scene.impl().scene;
    const auto geometries = mueller_points(own, points_of_columns(points, PointsKind::kGeometries));
    api::begin(options.progress, geometries.size());
    return evaluate_mueller(own, geometries, *impl_->begin(own), options.progress);
  });
}

}  // namespace dolp::api
