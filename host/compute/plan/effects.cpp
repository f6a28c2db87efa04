#include "plan/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "model/choices.hpp"

namespace dolp {
namespace {

constexpr std::array kDroppingOrder = {Part::kSource,       Part::kSurroundings, Part::kProfile,       Part::kEmission,
                                       Part::kPathRadiance, Part::kMoments,      Part::kFurtherBounces};

std::vector<EffectBounds> scene_bounds(const SceneValues& scene, const SceneEntries& entries,
                                       const SpectralRules& rules) {
  const std::vector<EntriesExtent> extents = entry_extents(scene, entries);
  std::vector<EffectBounds> bounds;
  for (const SceneVariant& variant : entries.variants()) {
    const EntriesExtent& extent = extents[std::min(bounds.size(), extents.size() - 1)];
    bounds.emplace_back(with_variant(scene, variant), *rules.at(variant), extent);
  }
  return bounds;
}

bool add_nothing(const std::vector<EffectBounds>& bounds, Part part, const KeptEffects& kept) {
  return std::ranges::all_of(
      bounds, [&](const EffectBounds& variant_bounds) { return variant_bounds.adds_nothing(part, kept); });
}

/// The largest bound of `part` over all variants of the scene. It covers the scene with the effects `kept` and, except
/// for moments and profile, also the scene with all its effects.
double worst_bound(const std::vector<EffectBounds>& bounds, Part part, const KeptEffects& kept) {
  double worst = 0.0;
  for (const EffectBounds& variant_bounds : bounds) {
    worst = std::max(worst, variant_bounds.bound(part, kept));
    if (part != Part::kMoments && part != Part::kProfile) worst = std::max(worst, variant_bounds.bound(part, {}));
  }
  return worst;
}

bool has_profile(const SceneValues& scene) { return scene.surroundings && scene.surroundings->profile; }

constexpr std::array<bool (*)(const SceneValues&), 8> kHasPart = {  // in the order of Part
    [](const SceneValues& scene) { return scene.surface.scattering == Scattering::kMultiple; },
    [](const SceneValues& scene) { return scene.surface.specular > 0.0; },
    [](const SceneValues& scene) { return scene.source.has_value(); },
    [](const SceneValues& scene) { return scene.surroundings.has_value(); },
    [](const SceneValues& scene) { return scene.emission.has_value(); },
    [](const SceneValues& scene) { return scene.path && (scene.path->temperature_K || scene.path->radiance); },
    [](const SceneValues& scene) { return scene.surface.diffuse > 0.0; },
    [](const SceneValues& scene) { return has_profile(scene); }};

bool scene_has_part(const SceneValues& scene, Part part) { return kHasPart[static_cast<std::size_t>(part)](scene); }

bool is_bistatic(const SceneValues& scene) { return scene.geometry.mode == Mode::kBistatic; }

bool emits_as(const SceneValues& scene, EmissionModel model) {
  return scene.emission && scene.emission->model == model;
}

bool is_fresnel(const SceneValues& scene) { return emits_as(scene, EmissionModel::kFresnel); }

void drop_effects(EffectPlan& plan, const SceneValues& scene, const std::vector<EffectBounds>& bounds) {
  const double allowed = kDroppedShare * scene.accuracy.tolerance;
  for (const Part part : kDroppingOrder) {
    if (!is_kept(plan.kept, part)) continue;
    if (part == Part::kMoments && scene.emission && scene.emission->has_bracket) continue;  // for dolp_low, dolp_high
    const double bound = worst_bound(bounds, part, plan.kept);
    if (bound > allowed - plan.bound) continue;
    plan.kept = without(plan.kept, part);
    plan.bound += bound;
    if (scene_has_part(scene, part)) plan.dropped[part] = bound;
  }
}

void set_needs(EffectPlan& plan, const SceneValues& scene, const std::vector<EffectBounds>& bounds) {
  plan.needs_direct = plan.kept.moments && scene.emission &&
                      (scene.emission->has_bracket || (emits_as(scene, EmissionModel::kDirect) && plan.kept.emission));
  plan.needs_beams = is_bistatic(scene) && plan.kept.source && scene.surface.specular > 0.0 &&
                     !add_nothing(bounds, Part::kSource, plan.kept);
  const bool has_only_direct = scene.surface.has_only_direct() && scene.surface.specular > 0.0;
  plan.gives_rho = (plan.kept.moments || scene.surface.specular == 0.0) && !has_only_direct;
  plan.gives_albedo = plan.kept.moments && !has_only_direct;
}

std::string why_no_moments(const SceneValues& scene, const KeptEffects& kept) {
  const bool has_emission = scene.emission && kept.emission;
  const bool has_surroundings = scene.surroundings && kept.surroundings;
  if (has_emission && has_surroundings && !is_fresnel(scene)) {
    return "surroundings as warm as the surface reflect what it does not emit: its thermal radiation is unpolarised";
  }
  if (has_emission) return "emission is that of the smooth surface, and nothing shines on it from all around";
  return "no emission and no surroundings: f in the one direction is enough";
}

Effect absent(const char* name, std::string why) { return {name, EffectState::kAbsent, std::move(why)}; }

Effect part_row(const SceneValues& scene, const EffectPlan& plan, Part part, Effect row) {
  row.part = part;
  const auto dropped = plan.dropped.find(part);
  if (dropped == plan.dropped.end()) return row;
  row.state = EffectState::kDropped;
  row.needs.clear();
  row.bound = dropped->second;
  row.reason = row.bound == 0.0 ? "adds nothing"
                                : fmt::format("changes DOLP by {:.2g} at most, {:.2g} of the tolerance", *row.bound,
                                              *row.bound / scene.accuracy.tolerance);
  return row;
}

std::string needs_of_moments(const SceneValues& scene, const EffectPlan& plan) {
  if (!plan.kept.moments) return "closed form";
  return is_bistatic(scene) ? "moments at each view zenith" : "moments at each theta";
}

Effect specular_row(const SceneValues& scene, const EffectPlan& plan) {
  if (scene.surface.specular == 0.0) return absent("specular", "surface.specular is 0");
  Effect row{"specular", EffectState::kKept, {}, {}, Part::kMoments};
  if (plan.kept.moments) {
    row.reason = "what is emitted or reflected depends on it";
    row.needs = needs_of_moments(scene, plan) + (plan.needs_beams ? ", f of each beam" : "");
    return row;
  }
  row.bound = 0.0;  // the moments are dropped only where they add exactly nothing
  row.reason = why_no_moments(scene, plan.kept);
  if (plan.needs_beams) {
    row.needs = "f of each beam";
    row.reason = "reflects the source; no moments: " + row.reason;
  } else {
    row.state = EffectState::kDropped;
  }
  return row;
}

/// Row about a choice of the model, such as the masking. If the effect is kept, the text is `choice` + `reason`.
Effect model_row(const SceneValues& scene, const EffectPlan& plan, const char* name, const std::string& choice,
                 const SceneEntries& entries, const char* reason = ", a choice of the model: never swapped") {
  const auto is_flat = [](const SceneEntry& entry) { return entry.shape.sigma == 0.0; };
  const bool all_mirrors = !entries.empty() && std::ranges::all_of(entries.all(), is_flat);
  if (all_mirrors) return absent(name, "sigma is 0 everywhere: a mirror");
  if (scene.surface.specular == 0.0) return absent(name, "surface.specular is 0");
  if (plan.kept.moments || plan.needs_beams) return {name, EffectState::kKept, choice + reason};
  return {name, EffectState::kNotNeeded, choice + ": nothing depends on it without the specular part"};
}

Effect masking_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (scene.surface.masking == Masking::kNone) return absent("masking", "surface.masking is none");
  return model_row(scene, plan, "masking", to_name(scene.surface.masking), entries);
}

Effect scattering_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (scene.surface.scattering == Scattering::kSingle) {
    return absent("scattering", "surface.scattering is single: light is followed to its first facet");
  }
  Effect row = model_row(scene, plan, "scattering", "all bounces in V-grooves", entries, "");
  if (row.state != EffectState::kKept) return row;
  row.needs = plan.kept.moments ? needs_of_moments(scene, plan) : "f of each beam";
  return part_row(scene, plan, Part::kFurtherBounces, row);
}

/// The spectral rule of the first entries. A scene has the first material and band of its grid.
std::shared_ptr<const SpectralRule> first_rule(const EffectPlan& plan, const SceneEntries& entries) {
  return plan.rules->at(entries.variants().front());
}

Effect complex_index_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  constexpr const char* kName = "complex index";
  const auto is_complex = [](const FacetOptics& optics) {
    const auto absorbs = [](const Film& film) { return film.index.k > 0.0; };
    return optics.index.k > 0.0 || optics.measured || std::ranges::any_of(optics.films, absorbs);
  };
  const auto has_k = [](const OpticalConstants& index) { return index.k > 0.0; };
  if (std::ranges::none_of(entries.own_indices(), has_k) &&
      std::ranges::none_of(first_rule(plan, entries)->indices(), is_complex))
    return absent(kName, "k is 0");
  const bool is_used = plan.kept.moments || plan.needs_beams || (is_fresnel(scene) && plan.kept.emission);
  if (!is_used) return {kName, EffectState::kNotNeeded, "nothing depends on the index"};
  return {kName, EffectState::kKept, "costs nothing: the kernel treats real indices alike"};
}

Effect emission_row(const SceneValues& scene, const EffectPlan& plan) {
  if (!scene.emission) return absent("emission", "no [emission]");
  const char* of = is_fresnel(scene)                         ? "of the smooth surface"
                   : emits_as(scene, EmissionModel::kDirect) ? "of the facets, straight to the viewer"
                                                             : "1 - rho of the surface (Kirchhoff)";
  return part_row(scene, plan, Part::kEmission,
                  {"emission", EffectState::kKept, fmt::format("{:g} K, {}", scene.emission->temperature_K, of),
                   is_fresnel(scene) ? "closed form" : needs_of_moments(scene, plan)});
}

Effect source_row(const SceneValues& scene, const EffectPlan& plan) {
  if (!scene.source) return absent("source", "no [source]");
  Effect row{"source", EffectState::kKept, "a beam, reflected into the view", needs_of_moments(scene, plan)};
  if (is_bistatic(scene)) {
    row.reason = "one beam, one direction of view";
    row.needs = plan.needs_beams ? "f of each beam" : "closed form";
  }
  return part_row(scene, plan, Part::kSource, row);
}

Effect surroundings_row(const SceneValues& scene, const EffectPlan& plan) {
  if (!scene.surroundings) return absent("surroundings", "no [surroundings]");
  const Surroundings& sky = *scene.surroundings;
  const std::string light =
      !scene.names.profile.empty() ? scene.names.profile
      : sky.profile ? fmt::format("{:g} K in the zenith, {:g} K at the horizon", *sky.zenith_K, *sky.horizon_K)
                    : fmt::format("{:g} K", sky.temperature_K);
  return part_row(
      scene, plan, Part::kSurroundings,
      {"surroundings", EffectState::kKept, light + ", reflected into the view", needs_of_moments(scene, plan)});
}

Effect profile_row(const SceneValues& scene, const EffectPlan& plan) {
  if (!has_profile(scene)) return absent("profile", "the same in all directions");
  Effect row{"profile", EffectState::kKept, "the sky over the zenith, beyond its mean", {}};
  const std::size_t functions = plan.sky ? plan.sky->size() : 0;
  row.needs = functions == 0   ? std::string("closed form")
              : functions == 1 ? std::string("moments with 1 function of the sky")
                               : fmt::format("moments with {} functions of the sky", functions);
  return part_row(scene, plan, Part::kProfile, row);
}

Effect path_row(const SceneValues& scene, const EffectPlan& plan) {
  if (!scene.path) return absent("path", "no [path]");
  Effect row{"path", EffectState::kKept, "its radiance adds to I", "closed form"};
  if (!scene_has_part(scene, Part::kPathRadiance)) {
    row.reason = "its transmittance alone, which DOLP does not see";
    row.influence = 0.0;
    return row;
  }
  row = part_row(scene, plan, Part::kPathRadiance, row);
  if (row.state == EffectState::kDropped) row.reason = "its radiance " + row.reason + "; the transmittance stays";
  return row;
}

Effect diffuse_row(const SceneValues& scene, const EffectPlan& plan) {
  if (scene.surface.diffuse == 0.0) return absent("diffuse", "surface.diffuse is 0");
  return part_row(scene, plan, Part::kDiffuse, {"diffuse", EffectState::kKept, "adds to rho_I", "closed form"});
}

Effect band_row(const SceneValues& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (!scene.spectrum.is_band()) return absent("band", "a single wavelength");
  const std::size_t count = first_rule(plan, entries)->samples.size();
  const std::string band = fmt::format("{:g}..{:g} um{}", scene.spectrum.min_um, scene.spectrum.max_um,
                                       scene.spectrum.response ? ", response of the camera" : "");
  return {"band", EffectState::kKept,
          scene.bands.size() > 1 ? fmt::format("{} bands, the first {}", scene.bands.size(), band) : band,
          count == 1 ? "one index for the whole band" : fmt::format("{} spectral samples", count)};
}

}  // namespace

bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan) {
  if (!scene.emission || is_fresnel(scene)) return scene.emission.has_value();
  if (!emits_as(scene, EmissionModel::kDirect)) return plan.gives_rho;
  return plan.kept.emission && (plan.kept.moments || scene.surface.specular == 0.0);
}

EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all) {
  EffectPlan plan;
  plan.rules = std::make_shared<const SpectralRules>(scene, entries);
  plan.keep_all = keep_all;
  const std::vector<EffectBounds> bounds = scene_bounds(scene, entries, *plan.rules);
  if (!keep_all && !entries.empty()) drop_effects(plan, scene, bounds);
  set_needs(plan, scene, bounds);
  if (!entries.empty()) return with_spectra(std::move(plan), scene, entries);
  plan.rules = nullptr;
  return plan;
}

EffectPlan with_spectra(EffectPlan plan, const SceneValues& scene, const SceneEntries& entries) {
  if (!plan.rules) plan.rules = std::make_shared<const SpectralRules>(scene, entries);
  const bool needs_sky = has_profile(scene) && plan.kept.moments && plan.kept.surroundings && plan.kept.profile;
  if (plan.sky || !needs_sky) return plan;
  std::vector<std::shared_ptr<const SpectralRule>> rules;
  std::vector<const SpectralRule*> all;
  for (const SceneVariant& variant : entries.variants())
    all.push_back(rules.emplace_back(plan.rules->at(variant)).get());
  plan.sky = sky_basis(scene, all);
  return plan;
}

EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept) {
  EffectPlan plan;
  plan.kept = kept;
  set_needs(plan, scene, scene_bounds(scene, {}, SpectralRules(scene, {})));
  return plan;
}

EffectPlan keep_everything(const SceneValues& scene) { return plan_effects(scene, {}, true); }

std::vector<Effect> list_effects(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& given) {
  const EffectPlan plan = with_spectra(given, scene, entries);
  return {specular_row(scene, plan),
          diffuse_row(scene, plan),
          model_row(scene, plan, "distribution", to_name(scene.surface.distribution), entries),
          masking_row(scene, plan, entries),
          scattering_row(scene, plan, entries),
          complex_index_row(scene, plan, entries),
          emission_row(scene, plan),
          source_row(scene, plan),
          surroundings_row(scene, plan),
          profile_row(scene, plan),
          path_row(scene, plan),
          band_row(scene, plan, entries)};
}

std::string effects_text(const std::vector<Effect>& rows, const EffectPlan& plan) {
  std::string kept;
  std::string dropped;
  for (const Effect& row : rows) {
    if (row.state == EffectState::kKept) kept += (kept.empty() ? "" : ", ") + row.name;
    if (row.state != EffectState::kDropped) continue;
    dropped += fmt::format("{}{} ({})", dropped.empty() ? "" : ", ", row.name, row.reason);
  }
  const std::string why = plan.keep_all ? " (all are kept)" : "";
  return fmt::format("kept: {}; dropped{}: {}", kept, why, dropped.empty() ? "nothing" : dropped);
}

}  // namespace dolp
