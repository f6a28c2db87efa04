#include "plan/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/choices.hpp"

namespace dolp {
namespace {

constexpr std::array kDroppingOrder = {Part::kMoments,      Part::kSource,  Part::kSurroundings,  Part::kEmission,
                                       Part::kPathRadiance, Part::kMoments, Part::kFurtherBounces};

/// The bounds of a scene at each wavelength of its entries.
std::vector<EffectBounds> bounds_of(const SceneValues& scene, const SceneEntries& entries) {
  std::vector<EffectBounds> bounds;
  const std::vector<double>& wavelength_um = entries.wavelength_um();
  const std::vector<EntriesExtent> extents = extents_of(entries);
  for (std::size_t i = 0; i < extents.size(); ++i) {
    if (extents[i].theta_deg.empty() && !entries.empty()) continue;  // no entry has this wavelength
    bounds.emplace_back(wavelength_um.empty() ? scene : at_wavelength(scene, wavelength_um[i]), extents[i]);
  }
  return bounds;
}

bool add_nothing(const std::vector<EffectBounds>& bounds, Part part, const KeptEffects& kept) {
  return std::ranges::all_of(bounds, [&](const EffectBounds& of_one) { return of_one.adds_nothing(part, kept); });
}

DropBound worst_of(const DropBound& a, const DropBound& b) {
  return {std::max(a.dolp, b.dolp), std::max(a.rho, b.rho)};
}

/// A part that matters in the whole scene is kept even where the parts that it acts on have been dropped.
DropBound worst_bound(const std::vector<EffectBounds>& bounds, Part part, const KeptEffects& kept) {
  DropBound worst;
  for (const EffectBounds& of_one : bounds) {
    worst = worst_of(worst, of_one.bound(part, kept));
    if (part != Part::kMoments) worst = worst_of(worst, of_one.bound(part, {}));
  }
  return worst;
}

bool is_asked_for(const SceneValues& scene, Part part) {
  switch (part) {
    case Part::kFurtherBounces:
      return scene.surface.scattering == Scattering::kMultiple;
    case Part::kMoments:
      return scene.surface.specular > 0.0;
    case Part::kSource:
      return scene.source.has_value();
    case Part::kSurroundings:
      return scene.surroundings.has_value();
    case Part::kEmission:
      return scene.emission.has_value();
    case Part::kPathRadiance:
      return scene.path && (scene.path->temperature_K || scene.path->radiance);
    case Part::kDiffuse:
      return scene.surface.diffuse > 0.0;
  }
  return false;
}

bool is_bistatic(const SceneValues& scene) { return scene.geometry.mode == Mode::kBistatic; }

bool emits_as(const SceneValues& scene, EmissionModel model) {
  return scene.emission && scene.emission->model == model;
}

bool is_fresnel(const SceneValues& scene) { return emits_as(scene, EmissionModel::kFresnel); }

bool needs_beams(const SceneValues& scene, const std::vector<EffectBounds>& bounds, const KeptEffects& kept) {
  return is_bistatic(scene) && kept.source && !add_nothing(bounds, Part::kSource, kept) && scene.surface.specular > 0.0;
}

void drop_effects(EffectPlan& plan, const SceneValues& scene, const std::vector<EffectBounds>& bounds) {
  const double allowed = kDroppedShare * scene.accuracy.tolerance;
  for (const Part part : kDroppingOrder) {
    if (!is_kept(plan.kept, part)) continue;
    if (part == Part::kMoments && scene.emission && scene.emission->has_bracket) continue;  // it needs them
    const DropBound bound = worst_bound(bounds, part, plan.kept);
    if (std::max(bound.dolp, bound.rho) > allowed - std::max(plan.bound.dolp, plan.bound.rho)) continue;
    plan.kept = without(plan.kept, part);
    plan.bound = {plan.bound.dolp + bound.dolp, plan.bound.rho + bound.rho};
    if (is_asked_for(scene, part)) plan.dropped.push_back({part, bound});
  }
}

void set_needs(EffectPlan& plan, const SceneValues& scene, const std::vector<EffectBounds>& bounds) {
  plan.needs_moments = plan.kept.moments;
  plan.needs_direct = plan.needs_moments && scene.emission &&
                      (scene.emission->has_bracket || (emits_as(scene, EmissionModel::kDirect) && plan.kept.emission));
  plan.needs_beams = needs_beams(scene, bounds, plan.kept);
  plan.gives_rho = plan.needs_moments || scene.surface.specular == 0.0;
}

const DroppedPart* find_dropped(const EffectPlan& plan, Part part) {
  const auto found = std::ranges::find(plan.dropped, part, &DroppedPart::part);
  return found == plan.dropped.end() ? nullptr : &*found;
}

std::string below_share(double bound, double tolerance) {
  return fmt::format("changes DOLP by {:.2g} at most, {:.2g} of the tolerance", bound, bound / tolerance);
}

/// The reason why the moments are not needed although no part is lost.
std::string why_no_moments(const SceneValues& scene, const KeptEffects& kept) {
  const bool has_emission = scene.emission && kept.emission;
  const bool has_surroundings = scene.surroundings && kept.surroundings;
  if (has_emission && has_surroundings && !is_fresnel(scene)) {
    return "surroundings as warm as the surface reflect what it does not emit: its thermal radiation is unpolarised";
  }
  if (has_emission) return "emission is that of the smooth surface, and nothing shines on it from all around";
  return "no emission and no surroundings: f in the one direction is enough";
}

EffectRow absent(const char* name, std::string why) { return {name, EffectState::kAbsent, std::move(why)}; }

/// A part as it stands in the plan; `kept` says why and what for.
EffectRow part_row(const SceneValues& scene, const EffectPlan& plan, const char* name, Part part, EffectRow row) {
  row.name = name;
  row.part = part;
  const DroppedPart* dropped = find_dropped(plan, part);
  if (dropped == nullptr) return row;
  row.state = EffectState::kDropped;
  row.needs.clear();
  row.bound = dropped->bound.dolp;
  row.reason = below_share(dropped->bound.dolp, scene.accuracy.tolerance);
  if (dropped->bound.dolp == 0.0) row.reason = "adds nothing";
  return row;
}

std::string moments_needs(const SceneValues& scene) {
  return is_bistatic(scene) ? fmt::format("moments at {:g} deg", scene.geometry.view_zenith_deg)
                            : "moments at each theta";
}

EffectRow specular_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "specular";
  if (scene.surface.specular == 0.0) return absent(kName, "surface.specular is 0");
  EffectRow row{kName, EffectState::kKept, {}, {}, Part::kMoments};
  if (plan.needs_moments) {
    row.reason = "what is emitted or reflected depends on it";
    row.needs = moments_needs(scene) + (plan.needs_beams ? ", f at each theta" : "");
    return row;
  }
  const double bound = find_dropped(plan, Part::kMoments) ? find_dropped(plan, Part::kMoments)->bound.dolp : 0.0;
  row.bound = bound;
  const std::string why =
      bound == 0.0 ? why_no_moments(scene, plan.kept) : below_share(bound, scene.accuracy.tolerance);
  if (plan.needs_beams) {
    row.needs = "f at each theta";
    row.reason = "reflects the source; no moments: " + why;
  } else {
    row.state = EffectState::kDropped;
    row.reason = why;
  }
  return row;
}

EffectRow model_row(const SceneValues& scene, const EffectPlan& plan, const char* name, const std::string& choice,
                    const SceneEntries& entries) {
  const auto is_flat = [](const SceneEntry& entry) { return entry.shape.sigma == 0.0; };
  const bool all_mirrors = !entries.empty() && std::ranges::all_of(entries.all(), is_flat);
  if (all_mirrors) return absent(name, "sigma is 0 everywhere: a mirror");
  if (scene.surface.specular == 0.0) return absent(name, "surface.specular is 0");
  EffectRow row{name, EffectState::kKept, choice + ", a choice of the model: never swapped"};
  if (plan.needs_moments || plan.needs_beams) return row;
  row.state = EffectState::kNotNeeded;
  row.reason = choice + ": nothing depends on it without the specular part";
  return row;
}

EffectRow scattering_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  constexpr const char* kName = "scattering";
  if (scene.surface.scattering == Scattering::kSingle) {
    return absent(kName, "surface.scattering is single: light is followed to its first facet");
  }
  EffectRow row = model_row(scene, plan, kName, "all bounces in V-grooves", entries);
  if (row.state != EffectState::kKept) return row;
  row.reason = "all bounces in V-grooves";
  row.needs = moments_needs(scene);
  return part_row(scene, plan, kName, Part::kFurtherBounces, row);
}

EffectRow complex_index_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  constexpr const char* kName = "complex index";
  const std::vector<OpticalConstants> indices = spectral_rule(scene).indices();
  const auto is_complex = [](const OpticalConstants& index) { return index.k > 0.0; };
  const bool own =
      entries.is_grid()
          ? std::ranges::any_of(entries.axes()[Axis::kK], [](double k) { return k > 0.0; })
          : std::ranges::any_of(entries.all(), [&](const SceneEntry& e) { return e.index && is_complex(*e.index); });
  if (!own && std::ranges::none_of(indices, is_complex)) return absent(kName, "k is 0");
  EffectRow row{kName, EffectState::kKept, "costs nothing: the kernel treats real indices alike"};
  const bool is_used = plan.needs_moments || plan.needs_beams || (is_fresnel(scene) && plan.kept.emission);
  if (is_used) return row;
  row.state = EffectState::kNotNeeded;
  row.reason = "nothing depends on the index";
  return row;
}

EffectRow emission_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "emission";
  if (!scene.emission) return absent(kName, "no [emission]");
  EffectRow row{kName, EffectState::kKept};
  const char* of = is_fresnel(scene)                         ? "of the smooth surface"
                   : emits_as(scene, EmissionModel::kDirect) ? "of the facets, straight to the viewer"
                                                             : "1 - rho of the surface (Kirchhoff)";
  row.reason = fmt::format("{:g} K, {}", scene.emission->temperature_K, of);
  row.needs = is_fresnel(scene) || !plan.needs_moments ? "closed form" : moments_needs(scene);
  return part_row(scene, plan, kName, Part::kEmission, row);
}

EffectRow source_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "source";
  if (!scene.source) return absent(kName, "no [source]");
  EffectRow row{kName, EffectState::kKept};
  row.reason = is_bistatic(scene) ? "one beam, one direction of view" : "a beam, reflected into the view";
  row.needs = is_bistatic(scene) ? (plan.needs_beams ? "f at each theta" : "closed form") : moments_needs(scene);
  if (!is_bistatic(scene) && !plan.needs_moments) row.needs = "closed form";
  return part_row(scene, plan, kName, Part::kSource, row);
}

EffectRow surroundings_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "surroundings";
  if (!scene.surroundings) return absent(kName, "no [surroundings]");
  EffectRow row{kName, EffectState::kKept};
  row.reason = fmt::format("{:g} K, reflected into the view", scene.surroundings->temperature_K);
  row.needs = plan.needs_moments ? moments_needs(scene) : "closed form";
  return part_row(scene, plan, kName, Part::kSurroundings, row);
}

EffectRow path_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "path";
  if (!scene.path) return absent(kName, "no [path]");
  EffectRow row{kName, EffectState::kKept, {}, "closed form"};
  if (!is_asked_for(scene, Part::kPathRadiance)) {
    row.reason = "its transmittance alone, which DOLP does not see";
    row.influence = 0.0;
    return row;
  }
  row.reason = "its radiance adds to I";
  row = part_row(scene, plan, kName, Part::kPathRadiance, row);
  if (row.state == EffectState::kDropped) row.reason = "its radiance " + row.reason + "; the transmittance stays";
  return row;
}

EffectRow diffuse_row(const SceneValues& scene, const EffectPlan& plan) {
  constexpr const char* kName = "diffuse";
  if (scene.surface.diffuse == 0.0) return absent(kName, "surface.diffuse is 0");
  EffectRow row{kName, EffectState::kKept, "adds to rho_I", "closed form"};
  return part_row(scene, plan, kName, Part::kDiffuse, row);
}

EffectRow band_row(const SceneValues& scene) {
  constexpr const char* kName = "band";
  if (!scene.spectrum.is_band()) return absent(kName, "a single wavelength");
  const std::size_t count = spectral_rule(scene).samples.size();
  EffectRow row{kName, EffectState::kKept};
  row.reason = fmt::format("{:g}..{:g} um", scene.spectrum.min_um, scene.spectrum.max_um);
  row.needs = count == 1 ? "one index for the whole band" : fmt::format("{} spectral samples", count);
  return row;
}

EffectRow masking_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (scene.surface.masking == Masking::kNone) return absent("masking", "surface.masking is none");
  return model_row(scene, plan, "masking", name_of(scene.surface.masking), entries);
}

}  // namespace

bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan) {
  return scene.emission && (plan.gives_rho || is_fresnel(scene));
}

EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all) {
  const std::vector<EffectBounds> bounds = bounds_of(scene, entries);
  EffectPlan plan;
  plan.keep_all = keep_all;
  if (!keep_all && !entries.empty()) drop_effects(plan, scene, bounds);
  set_needs(plan, scene, bounds);
  return plan;
}

EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept) {
  EffectPlan plan;
  plan.kept = kept;
  set_needs(plan, scene, bounds_of(scene, {}));
  return plan;
}

EffectPlan keep_everything(const SceneValues& scene) { return plan_effects(scene, {}, true); }

Needs needs_without(const SceneValues& scene, const EffectPlan& plan, Part part) {
  const std::vector<EffectBounds> bounds = bounds_of(scene, {});
  const KeptEffects kept = without(plan.kept, part);
  return {kept.moments && !add_nothing(bounds, Part::kMoments, kept),
          part != Part::kMoments && needs_beams(scene, bounds, kept)};
}

std::vector<EffectRow> effect_rows(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan) {
  return {specular_row(scene, plan),
          diffuse_row(scene, plan),
          model_row(scene, plan, "distribution", name_of(scene.surface.distribution), entries),
          masking_row(scene, plan, entries),
          scattering_row(scene, plan, entries),
          complex_index_row(scene, plan, entries),
          emission_row(scene, plan),
          source_row(scene, plan),
          surroundings_row(scene, plan),
          path_row(scene, plan),
          band_row(scene)};
}

const char* state_name(EffectState state) {
  constexpr std::array kNames = {"absent", "kept", "dropped", "not_needed"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string effects_text(const std::vector<EffectRow>& rows, const EffectPlan& plan) {
  std::string kept;
  std::string dropped;
  for (const EffectRow& row : rows) {
    if (row.state == EffectState::kKept) kept += (kept.empty() ? "" : ", ") + std::string(row.name);
    if (row.state != EffectState::kDropped) continue;
    dropped += fmt::format("{}{} ({})", dropped.empty() ? "" : ", ", row.name, row.reason);
  }
  const std::string why = plan.keep_all ? " (--keep-all)" : "";
  return fmt::format("kept: {}; dropped{}: {}", kept, why, dropped.empty() ? "nothing" : dropped);
}

}  // namespace dolp
