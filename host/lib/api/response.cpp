// Response tables.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "api/impl.hpp"
#include "report/run_report.hpp"
#include "run/response_run.hpp"
#include "scene/scene_reader.hpp"
#include "table/table_output.hpp"

namespace dolp {
namespace {

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

/// The scene of the surface, which it may be already.
SceneValues surface_of(const SceneValues& scene) {
  const std::vector<Setting> settings = surface_settings();
  const auto last = std::span(scene.settings).last(std::min(scene.settings.size(), settings.size()));
  return std::ranges::equal(last, settings) ? scene : with_settings(scene, settings);
}

}  // namespace

std::vector<Setting> surface_settings() {
  std::vector<Setting> settings;
  for (const char* unused : {"emission", "source", "surroundings", "path", "surface.material", "surface.material_file",
                             "surface.reflectance_file", "surface.coating", "surface.specular", "surface.diffuse",
                             "spectrum.band_um", "surface.diffuse_exponent", "grid.wavelength_um", "grid.n", "grid.k"})
    settings.push_back({unused, {}});
  settings.push_back({"surface.n", 1.5});
  settings.push_back({"surface.k", 0.0});
  settings.push_back({"spectrum.wavelength_um", 10.0});
  settings.push_back({"emission.temperature_K", 300.0});
  return settings;
}

Table Evaluator::response(const Scene& scene, const RunOptions& of_call) {
  return impl().exclusively(scene, of_call, [&](const SceneValues& whole, const RunOptions& options) {
    const SceneValues values = surface_of(whole);
    const TableLayout layout = response_layout(values);
    TableValues table;
    static_cast<TableHead&>(table) = layout.head;
    const auto take = [&](const TableValues& part, const PerAxis&) {
      const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
      };
      append(table[Quantity::kAlbedo], part[Quantity::kAlbedo]);
      for (const ResponseVariable variable : layout.responses)
        append(table.responses[variable], part.responses[variable]);
    };
    const ResponseOutcome run = run_responses(values, layout, options, *impl_->begin(values), take);
    table.attributes.insert(table.attributes.end(), run.attributes.begin(), run.attributes.end());
    return Table(std::make_shared<const Table::Impl>(std::move(table), "response table"));
  });
}

Report Evaluator::write_response(const Scene& scene, const std::filesystem::path& path, const RunOptions& of_call) {
  return impl().exclusively(scene, of_call, [&](const SceneValues& whole, const RunOptions& options) {
    const SceneValues values = surface_of(whole);
    check_output_is_no_input(path, files_of(whole));
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
