#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <span>

#include "api/impl.hpp"
#include "base/stopwatch.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "reference/reference_evaluator.hpp"
#include "report/run_report.hpp"
#include "run/mueller_run.hpp"
#include "run/response_run.hpp"
#include "run/scene_remarks.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "scene/scene_reader.hpp"
#include "table/table_output.hpp"

namespace dolp {
namespace {

std::vector<Attribute> all_attributes(const SceneValues& scene, const TableLayout& layout, const RunOutcome& run,
                                      const std::string& history) {
  std::vector<Attribute> attributes = layout.head.attributes;
  std::ranges::move(run_attributes(scene, run, history), std::back_inserter(attributes));
  return attributes;
}

ReportBuilder response_report(const SceneValues& scene, const TableHead& head, const ResponseOutcome& run,
                              const std::string& path) {
  const PerAxis counts = head.counts();
  ReportBuilder report;
  report.line("{}", key("title", scene.title));
  report.row("entries", "{} x {} x {} (theta x sigma x q), with {} local angles of incidence", counts[Axis::kTheta],
             counts[Axis::kSigma], counts[Axis::kQ], key("angles", head.beta_deg.size()));
  report.value("entries", run.entries);
  add_evaluation(report, run.evaluation, run.wall_s);
  report.value("evaluations", run.evaluation.evaluations);
  report.row("error", "response_error <= {:.2g} of the albedo; tolerance {:g}",
             key("worst_error_estimate", run.worst_error), key("tolerance", scene.accuracy.tolerance));
  report.row_if(run.missed > 0, "missed", "{} of {} entries miss the tolerance", key("missed_tolerance", run.missed),
                run.entries);
  report.row("written", "{}", key("output", path));
  return report;
}

SceneValues surface_scene(const SceneValues& scene) {
  const std::vector<Setting> settings = surface_settings();
  const auto last = std::span(scene.settings).last(std::min(scene.settings.size(), settings.size()));
  return std::ranges::equal(last, settings) ? scene : with_settings(scene, settings);
}

}  // namespace

std::unique_ptr<ModelEvaluator> make_evaluator(const EvaluatorOptions& wanted, bool needs_double) {
  const bool is_vulkan = wanted.evaluator == "vulkan";
  if (!is_vulkan && wanted.evaluator != "cpu" && wanted.evaluator != "reference") {
    throw InputError("evaluator " + wanted.evaluator + ": is not one of vulkan, cpu, reference");
  }
  if (!is_vulkan && !wanted.device.empty()) {
    throw InputError("device " + wanted.device + ": needs the evaluator vulkan, and it is " + wanted.evaluator);
  }
  if (wanted.evaluator == "reference") return std::make_unique<ReferenceEvaluator>();
  if (!is_vulkan) return std::make_unique<CpuEvaluator>();
  VulkanOptions options;
  options.device = wanted.device;
  options.needs_double = needs_double;
  if (wanted.is_interactive) options.tile_s = 0.005;
  return std::make_unique<VulkanEvaluator>(options);
}

void check_no_fork() {
  static std::atomic<pid_t> first_user = 0;
  const pid_t process = getpid();
  pid_t user = 0;
  if (first_user.compare_exchange_strong(user, process) || user == process) return;
  throw DeviceError(
      fmt::format("this process was forked from process {}, which uses Vulkan, and a device does not outlive a fork: "
                  "start processes afresh (in Python multiprocessing.set_start_method(\"spawn\")), or take the "
                  "evaluator cpu",
                  user));
}

Evaluator::Evaluator(EvaluatorOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

Evaluator::~Evaluator() {
  // A forked process must not destroy the device: this would wait forever for the driver's threads, which it lacks.
  if (impl_ && impl_->owner != getpid()) static_cast<void>(impl_.release());
}

Evaluator::Impl& Evaluator::impl() {
  if (!impl_) throw InputError("the Evaluator was moved from; another can be assigned to it");
  return *impl_;
}

Table Evaluator::table(const Scene& scene, const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    Run run(values, grid_entries(values), options, impl_->maker(values));
    TableLayout layout = table_layout(values, run);
    choose_variables(layout, options.quantities);
    CollectedResults results(run.entries());
    const RunOutcome outcome = run.compute(results.sink());
    layout.head.attributes.push_back({kIdentity, run_identity(values, impl_->options.evaluator, options)});
    layout.head.attributes = all_attributes(values, layout, outcome, options.history);
    TableValues table = table_part(layout, run.entries(), results.take());
    static_cast<TableHead&>(table) = std::move(layout.head);
    return Table(std::move(table));
  });
}

void Evaluator::table_parts(const Scene& scene, const std::function<void(const Table&)>& take,
                            const RunOptions& call_options) {
  impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    Run run(values, grid_entries(values), options, impl_->maker(values));
    TableLayout layout = table_layout(values, run);
    choose_variables(layout, options.quantities);
    const std::function<void(const Table&)> guarded = impl_->guard_reentry(take);
    run.compute([&](const SceneEntries& part, RunResults results, const RunSummary&) {
      TableValues table = table_part(layout, part, std::move(results));
      table.stokes_units = layout.head.stokes_units;
      guarded(Table(std::move(table)));
    });
  });
}

Results Evaluator::evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    const Points columns = points_of_columns(points, PointsKind::kDirections);
    Run run(values, point_entries(values, columns), options, impl_->maker(values));
    CollectedResults collected(run.entries());
    const RunOutcome outcome = run.compute(collected.sink());
    TableLayout layout = table_layout(values, run);
    layout.quantities = output_quantities(values, nullptr, &run.entries());
    layout.head.attributes = all_attributes(values, layout, outcome, options.history);
    Results results{{run_columns(layout.quantities, collected.take())},
                    layout.quantities,
                    layout.head.stokes_units,
                    layout.head.attributes};
    results.integrand_evaluations = outcome.evaluation.evaluations;
    results.remarks = remarks_on(values, columns);
    return results;
  });
}

std::vector<MuellerMatrix> Evaluator::mueller(const Scene& scene, const std::vector<Column>& points,
                                              const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const RunOptions& options) {
    const auto geometries = mueller_points(values, points_of_columns(points, PointsKind::kGeometries));
    report_start(options.progress, geometries.size());
    return evaluate_mueller(values, geometries, *impl_->beam_evaluator(), options.progress);
  });
}

std::vector<Setting> surface_settings() {
  std::vector<Setting> settings;
  for (const char* unused :
       {"emission", "source", "surroundings", "path", "surface.material", "surface.material_file",
        "surface.reflectance_file", "surface.coating", "surface.specular", "surface.diffuse", "surface.diffuse_file",
        "surface.diffuse_exponent", "spectrum.band_um", "spectrum.response_file", "spectrum.response_per",
        "grid.wavelength_um", "grid.n", "grid.k"})
    settings.push_back({unused, {}});
  settings.push_back({"surface.n", 1.5});
  settings.push_back({"surface.k", 0.0});
  settings.push_back({"spectrum.wavelength_um", 10.0});
  settings.push_back({"emission.temperature_K", 300.0});
  return settings;
}

Table Evaluator::response(const Scene& scene, const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& whole, const RunOptions& options) {
    const SceneValues values = surface_scene(whole);
    const TableLayout layout = response_layout(values);
    TableValues table{layout.head};
    const auto take = [&](const TableValues& part, const PerAxis&) {
      for_each_variable(layout, [&](const auto& of, std::size_t) {
        of(table).insert(of(table).end(), of(part).begin(), of(part).end());
      });
    };
    const ResponseOutcome run = run_responses(values, layout, options, *impl_->begin(values), take);
    table.attributes.insert(table.attributes.end(), run.attributes.begin(), run.attributes.end());
    return Table(std::move(table));
  });
}

Report Evaluator::write_response(const Scene& scene, const std::filesystem::path& path,
                                 const RunOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& whole, const RunOptions& options) {
    const SceneValues values = surface_scene(whole);
    check_output_is_no_input(path, scene_files(whole));
    const TableLayout layout = response_layout(values);
    if (path.extension() != ".nc") throw InputError(path.string() + ": the name of a response table must end in .nc");
    TableOutput output({.path = path, .layout = layout});
    const ResponseOutcome run =
        run_responses(values, layout, options, *impl_->begin(values),
                      [&](TableValues part, const PerAxis& first) { output.write(std::move(part), first, ""); });
    output.finish(run.attributes);
    return public_report(response_report(values, layout.head, run, path.string()), run.missed == 0, path);
  });
}

}  // namespace dolp
