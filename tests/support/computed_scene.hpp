// Results and tables of scenes in tests, computed on the CPU.
#pragma once

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_table.hpp"
#include "scene_support.hpp"

namespace dolp {

inline std::vector<PointResult> results_of(const SceneValues& scene, const SceneEntries& entries) {
  CpuEvaluator evaluator;
  return evaluate_scene(scene, entries, evaluator, {});
}
inline std::vector<PointResult> results_of(const SceneValues& scene) { return results_of(scene, grid_entries(scene)); }

inline TableValues table_of(const SceneValues& scene) {
  const SceneEntries entries = grid_entries(scene);
  const TableLayout layout = table_layout(scene, plan_effects(scene, entries, false), scene.grid);
  CpuEvaluator evaluator;
  CollectedResults results(entries);
  run_scene(scene, entries, keep_everything(scene), &evaluator, {results.sink()});
  TableValues table = table_part(layout, entries, results.take());
  static_cast<TableHead&>(table) = layout.head;
  return table;
}

}  // namespace dolp
