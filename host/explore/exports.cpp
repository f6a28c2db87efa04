#include "explore/exports.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/number_text.hpp"
#include "evaluate/reference/reference_evaluator.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "run/table_run.hpp"
#include "table/result_csv.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kStride = 10;  // of the entries that the reference recomputes: five degrees

}  // namespace

std::string curve_csv(const Curve& curve) {
  const ExtraColumns extra = extra_columns(curve.scene());
  std::string csv = std::string("theta_deg,sigma,q,") + result_header(extra) + '\n';
  for (std::size_t i = 0; i < curve.entries().size(); ++i) {
    const SceneEntry entry = curve.entries()[i];
    csv += number_text(entry.theta_deg) + ',' + number_text(entry.shape.sigma) + ',' + number_text(entry.shape.q) +
           ',' + result_cells(curve.results()[i], extra) + '\n';
  }
  return csv;
}

std::string export_table(const Scene& scene, const std::string& path, const std::string& command_line,
                         MomentsEvaluator& evaluator, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const TableJob job{.path = path, .shard = {}, .is_resumable = false, .command_line = command_line, .start = start};
  const TableRun run = run_table_job(
      scene, job, [&] { return &evaluator; }, progress);
  return fmt::format("{}: {} entries in {:.2f} s", path, run.summary.entries, run.wall_s);
}

std::string true_error(const Curve& curve, const Progress& progress) {
  std::vector<double> theta_deg;
  std::vector<PointResult> stated;
  for (std::size_t i = 0; i < curve.entries().size(); i += kStride) {
    theta_deg.push_back(curve.entries()[i].theta_deg);
    stated.push_back(curve.results()[i]);
  }
  const SceneEntries entries = entries_at(curve.scene(), theta_deg);
  ReferenceEvaluator reference(ReferenceOptions{.threads = 1});
  const std::vector<PointResult> truth = evaluate_scene(curve.scene(), entries, reference, progress);
  std::size_t worst = 0;
  double largest = -1.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = std::abs(stated[i].dolp - truth[i].dolp);
    if (!is_good(stated[i]) || !(error > largest)) continue;
    largest = error;
    worst = i;
  }
  if (largest < 0.0) return "no direction whose DOLP means something";
  return fmt::format("{:.1e} at θ = {:g}°, bound {:.1e}; {} directions", largest, theta_deg[worst],
                     stated[worst].error_estimate, entries.size());
}

}  // namespace dolp::explore
