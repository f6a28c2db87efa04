#include <fmt/format.h>

#include <dolp/status.hpp>
#include "api/reports.hpp"
#include "api/results.hpp"
#include "api/scene_impl.hpp"
#include "base/text.hpp"
#include "base/version.hpp"
#include "plan/effects.hpp"
#include "report/plan_report.hpp"
#include "run/estimates.hpp"
#include "run/scene_run.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"

namespace dolp {
namespace {

BuiltInMaterial facts_of(const Material& material) {
  const Spectrum range = known_range(material);
  return {material.name, range.min_um, range.max_um, material.source};
}

}  // namespace

std::string version() { return program_version(); }
std::string commit() { return program_commit(); }
std::string citation() { return fmt::format("{}commit: \"{}\"\n", embedded_citation_cff(), commit()); }

Report plan(const Scene& scene, const std::string& device, bool keep_all) {
  const SceneValues& own = scene.impl().scene;
  return public_report(plan_report(plan_of(own, device, plan_effects(own, grid_entries(own), keep_all))));
}

std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all) {
  const SceneValues& own = scene.impl().scene;
  const SceneEntries entries = point_entries(own, points_of_columns(points, PointsKind::kDirections));
  std::vector<Effect> all = effects_of(own, entries, plan_effects(own, entries, keep_all));
  add_influences(all, own, entries);
  return all;
}

std::vector<BuiltInMaterial> materials() {
  std::vector<BuiltInMaterial> all;
  for (const Material& material : built_in_materials()) all.push_back(facts_of(material));
  return all;
}

BuiltInMaterial material(const std::string& name) { return facts_of(named_material(name, one_line(name) + ": ")); }

}  // namespace dolp
