#include "plan/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <mutex>
#include <tuple>

#include "base/parallel_ranges.hpp"
#include "model/choices.hpp"
#include "model/direction.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {
namespace {

constexpr std::array kDroppingOrder = {Part::kMoments,      Part::kSource,  Part::kSurroundings, Part::kEmission,
                                       Part::kPathRadiance, Part::kDiffuse, Part::kMoments,      Part::kFurtherBounces};

constexpr double kFarBelow = 0.1;

constexpr std::size_t kEntriesAtOnce = 256;  // of a thread; some microseconds each

DropBound worst_of(const DropBound& a, const DropBound& b) {
  return {std::max(a.dolp, b.dolp), std::max(a.rho, b.rho)};
}

bool is_within(const DropBound& bound, double limit) { return bound.dolp <= limit && bound.rho <= limit; }

/// Which part may go, and what it may change.
struct Candidate {
  Part part;
  KeptEffects kept;
  double limit = 0.0;
};

/// The bounds of a scene at each wavelength of its entries.
class BoundsOfEntries {
 public:
  BoundsOfEntries(const Scene& scene, const SceneEntries& entries) {
    if (entries.wavelength_um().empty()) scenes_.push_back(scene);
    for (const double wavelength_um : entries.wavelength_um()) scenes_.push_back(at_wavelength(scene, wavelength_um));
    for (const Scene& at : scenes_) bounds_.emplace_back(at, spectral_rule(at));
  }
  const InfluenceBounds& operator[](const SceneEntry& entry) const { return bounds_[entry.wavelength]; }
  bool add_nothing(Part part, const KeptEffects& kept) const {
    return std::ranges::all_of(bounds_, [&](const InfluenceBounds& b) { return b.adds_nothing(part, kept); });
  }

 private:
  std::deque<Scene> scenes_;  // the bounds refer to them
  std::vector<InfluenceBounds> bounds_;
};

/// One for the entries of one wavelength after the other.
class MemoryOfEntries {
 public:
  ReflectanceMemory& operator[](const SceneEntry& entry) {
    if (entry.wavelength != wavelength_) memory_ = {};
    wavelength_ = entry.wavelength;
    return memory_;
  }

 private:
  ReflectanceMemory memory_;
  std::uint32_t wavelength_ = 0;
};

/// The bound at one entry, no closer than it takes to see that it is far below the limit.
DropBound entry_bound(const BoundsOfEntries& bounds, const Candidate& candidate, const KeptEffects& kept,
                      const SceneEntry& entry, MemoryOfEntries& memory) {
  for (const Detail detail : {Detail::kCoarse, Detail::kMiddle}) {
    const DropBound bound = bounds[entry].bound(candidate.part, kept, entry, detail, memory[entry]);
    if (is_within(bound, kFarBelow * candidate.limit)) return bound;
  }
  return bounds[entry].bound(candidate.part, kept, entry, Detail::kFine, memory[entry]);
}

/// The bound of what a part adds at one entry, no closer than it takes to see that it is not above `most`.
double bound_above(const BoundsOfEntries& bounds, Part part, const SceneEntry& entry, double most,
                   MemoryOfEntries& memory) {
  for (const Detail detail : {Detail::kCoarse, Detail::kMiddle}) {
    const double bound = bounds[entry].bound(part, {}, entry, detail, memory[entry]).dolp;
    if (bound <= most) return bound;
  }
  return bounds[entry].bound(part, {}, entry, Detail::kFine, memory[entry]).dolp;
}

/// Entries in the order in which their bounds are looked at: in bistatic mode, where those of one shape share the
/// reflectance, one shape after the other.
class OrderedEntries {
 public:
  OrderedEntries(const Scene& scene, const SceneEntries& entries)
      : entries_(entries), is_by_shape_(scene.geometry.mode == Mode::kBistatic && entries.is_grid()) {}

  std::size_t size() const { return entries_.size(); }
  SceneEntry operator[](std::size_t i) const {
    if (!is_by_shape_) return entries_[i];
    const std::size_t of_shape = size() / entries_.of_direction();
    return entries_[i % of_shape * entries_.of_direction() + i / of_shape];
  }

 private:
  const SceneEntries& entries_;
  bool is_by_shape_;
};

/// The worst bound of some entries; stops, above the limit, as soon as it is there.
DropBound worst_of_entries(const BoundsOfEntries& bounds, const Candidate& candidate, const OrderedEntries& entries,
                           std::size_t first, std::size_t last) {
  MemoryOfEntries memory;
  DropBound worst;
  for (std::size_t i = first; i < last; ++i) {
    const SceneEntry entry = entries[i];
    worst = worst_of(worst, entry_bound(bounds, candidate, candidate.kept, entry, memory));
    // What counts in the whole scene is not dropped for want of what it acts on.
    if (candidate.part != Part::kMoments && candidate.kept != KeptEffects{})
      worst = worst_of(worst, entry_bound(bounds, candidate, {}, entry, memory));
    if (!is_within(worst, candidate.limit)) break;
  }
  return worst;
}

/// The position whose bound is the worst most often: the last one of a grid, which is grazing; for further bounces the
/// roughest of those.
std::size_t likely_worst(Part part, const OrderedEntries& entries) {
  const std::size_t last = entries.size() - 1;
  if (part != Part::kFurtherBounces) return last;
  const auto key = [&](std::size_t i) {
    const SceneEntry entry = entries[i];
    return std::tuple(entry.theta_deg, entry.shape.sigma, -entry.shape.q);
  };
  std::size_t worst = last;
  for (std::size_t i = 0; i < last; ++i) {
    if (key(i) > key(worst)) worst = i;
  }
  return worst;
}

/// The worst entry's bound, or one above the limit where there is such an entry.
DropBound worst_bound(const BoundsOfEntries& bounds, const Candidate& candidate, const OrderedEntries& entries) {
  const bool adds_now = is_kept(candidate.kept, candidate.part) && !bounds.add_nothing(candidate.part, candidate.kept);
  const bool adds_in_all = candidate.part != Part::kMoments && !bounds.add_nothing(candidate.part, {});
  if (entries.size() == 0 || (!adds_now && !adds_in_all)) return {};
  const std::size_t likely = likely_worst(candidate.part, entries);
  DropBound worst = worst_of_entries(bounds, candidate, entries, likely, likely + 1);
  if (!is_within(worst, candidate.limit)) return worst;
  std::mutex mutex;
  std::atomic<bool> is_over = false;
  parallel_ranges(entries.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t end) {
    if (is_over) return;
    const DropBound of_range = worst_of_entries(bounds, candidate, entries, first, end);
    const std::lock_guard lock(mutex);
    worst = worst_of(worst, of_range);
    is_over = !is_within(worst, candidate.limit);
  });
  return worst;
}

bool is_asked_for(const Scene& scene, Part part) {
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

bool is_bistatic(const Scene& scene) { return scene.geometry.mode == Mode::kBistatic; }

bool emits_as(const Scene& scene, EmissionModel model) { return scene.emission && scene.emission->model == model; }

bool is_fresnel(const Scene& scene) { return emits_as(scene, EmissionModel::kFresnel); }

bool needs_beams(const Scene& scene, const BoundsOfEntries& bounds, const KeptEffects& kept) {
  return is_bistatic(scene) && kept.source && !bounds.add_nothing(Part::kSource, kept) && scene.surface.specular > 0.0;
}

const DroppedPart* find_dropped(const EffectPlan& plan, Part part) {
  const auto found = std::ranges::find(plan.dropped, part, &DroppedPart::part);
  return found == plan.dropped.end() ? nullptr : &*found;
}

std::string below_share(double bound, double tolerance) {
  return fmt::format("changes DOLP by {:.2g} at most, {:.2g} of the tolerance", bound, bound / tolerance);
}

/// Why the moments are not needed although nothing is lost.
std::string why_no_moments(const Scene& scene, const KeptEffects& kept) {
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
EffectRow part_row(const Scene& scene, const EffectPlan& plan, const char* name, Part part, EffectRow row) {
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

std::string moments_needs(const Scene& scene) {
  return is_bistatic(scene) ? fmt::format("moments at {:g} deg", scene.geometry.view_zenith_deg)
                            : "moments at each theta";
}

EffectRow specular_row(const Scene& scene, const EffectPlan& plan) {
  constexpr const char* kName = "specular";
  if (scene.surface.specular == 0.0) return absent(kName, "surface.specular is 0");
  EffectRow row{kName, EffectState::kKept, {}, {}, {}, Part::kMoments};
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

EffectRow model_row(const Scene& scene, const EffectPlan& plan, const char* name, const std::string& choice,
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

EffectRow scattering_row(const Scene& scene, const EffectPlan& plan, const SceneEntries& entries) {
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

EffectRow complex_index_row(const Scene& scene, const EffectPlan& plan, const SceneEntries& entries) {
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

EffectRow emission_row(const Scene& scene, const EffectPlan& plan) {
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

EffectRow source_row(const Scene& scene, const EffectPlan& plan) {
  constexpr const char* kName = "source";
  if (!scene.source) return absent(kName, "no [source]");
  EffectRow row{kName, EffectState::kKept};
  row.reason = is_bistatic(scene) ? "one beam, one direction of view" : "a beam, reflected into the view";
  row.needs = is_bistatic(scene) ? (plan.needs_beams ? "f at each theta" : "closed form") : moments_needs(scene);
  if (!is_bistatic(scene) && !plan.needs_moments) row.needs = "closed form";
  return part_row(scene, plan, kName, Part::kSource, row);
}

EffectRow surroundings_row(const Scene& scene, const EffectPlan& plan) {
  constexpr const char* kName = "surroundings";
  if (!scene.surroundings) return absent(kName, "no [surroundings]");
  EffectRow row{kName, EffectState::kKept};
  row.reason = fmt::format("{:g} K, reflected into the view", scene.surroundings->temperature_K);
  row.needs = plan.needs_moments ? moments_needs(scene) : "closed form";
  return part_row(scene, plan, kName, Part::kSurroundings, row);
}

EffectRow path_row(const Scene& scene, const EffectPlan& plan) {
  constexpr const char* kName = "path";
  if (!scene.path) return absent(kName, "no [path]");
  EffectRow row{kName, EffectState::kKept, {}, "closed form"};
  if (!is_asked_for(scene, Part::kPathRadiance)) {
    row.reason = "its transmittance alone, which DOLP does not see";
    row.bound = 0.0;
    return row;
  }
  row.reason = "its radiance adds to I";
  row = part_row(scene, plan, kName, Part::kPathRadiance, row);
  if (row.state == EffectState::kDropped) row.reason = "its radiance " + row.reason + "; the transmittance stays";
  return row;
}

EffectRow diffuse_row(const Scene& scene, const EffectPlan& plan) {
  constexpr const char* kName = "diffuse";
  if (scene.surface.diffuse == 0.0) return absent(kName, "surface.diffuse is 0");
  EffectRow row{kName, EffectState::kKept, "adds to rho_I", "closed form"};
  return part_row(scene, plan, kName, Part::kDiffuse, row);
}

EffectRow band_row(const Scene& scene) {
  constexpr const char* kName = "band";
  if (!scene.spectrum.is_band()) return absent(kName, "a single wavelength");
  const std::size_t count = spectral_rule(scene).samples.size();
  EffectRow row{kName, EffectState::kKept};
  row.reason = fmt::format("{:g}..{:g} um", scene.spectrum.min_um, scene.spectrum.max_um);
  row.needs = count == 1 ? "one index for the whole band" : fmt::format("{} spectral samples", count);
  return row;
}

EffectRow masking_row(const Scene& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (scene.surface.masking == Masking::kNone) return absent("masking", "surface.masking is none");
  return model_row(scene, plan, "masking", name_of(scene.surface.masking), entries);
}

}  // namespace

bool gives_emissivity(const Scene& scene, const EffectPlan& plan) {
  return scene.emission && (plan.gives_rho || is_fresnel(scene));
}

EffectPlan plan_effects(const Scene& scene, const SceneEntries& entries, bool keep_all) {
  const BoundsOfEntries bounds(scene, entries);
  const double allowed = kDroppedShare * scene.accuracy.tolerance;
  const OrderedEntries ordered(scene, entries);
  EffectPlan plan;
  plan.keep_all = keep_all;
  if (!keep_all) {
    for (const Part part : kDroppingOrder) {
      if (!is_kept(plan.kept, part)) continue;
      if (part == Part::kMoments && scene.emission && scene.emission->has_bracket) continue;  // it is made of them
      const double left = allowed - std::max(plan.bound.dolp, plan.bound.rho);
      const DropBound bound = worst_bound(bounds, {part, plan.kept, left}, ordered);
      if (!is_within(bound, left)) continue;
      plan.kept = without(plan.kept, part);
      plan.bound = {plan.bound.dolp + bound.dolp, plan.bound.rho + bound.rho};
      if (is_asked_for(scene, part)) plan.dropped.push_back({part, bound});
    }
  }
  plan.needs_moments = plan.kept.moments;
  plan.needs_direct = plan.needs_moments && scene.emission &&
                      (scene.emission->has_bracket || (emits_as(scene, EmissionModel::kDirect) && plan.kept.emission));
  plan.needs_beams = needs_beams(scene, bounds, plan.kept);
  plan.gives_rho = plan.needs_moments || scene.surface.specular == 0.0;
  return plan;
}

Needs needs_without(const Scene& scene, const EffectPlan& plan, Part part) {
  const BoundsOfEntries bounds(scene, {});
  const KeptEffects kept = without(plan.kept, part);
  return {kept.moments && !bounds.add_nothing(Part::kMoments, kept),
          part != Part::kMoments && needs_beams(scene, bounds, kept)};
}

std::vector<EffectRow> effect_rows(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan) {
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

void add_influences(std::vector<EffectRow>& rows, const Scene& scene, const SceneEntries& entries) {
  const BoundsOfEntries bounds(scene, entries);
  std::vector<EffectRow*> open;
  for (EffectRow& row : rows) {
    if (row.state == EffectState::kKept && row.part && !row.bound) open.push_back(&row);
  }
  for (EffectRow* row : open) row->bound = 0.0;
  if (open.empty() || entries.empty()) return;
  const OrderedEntries ordered(scene, entries);
  std::mutex mutex;
  const auto look_at = [&](std::size_t first, std::size_t last) {
    MemoryOfEntries memory;
    std::vector<double> most;
    std::vector<std::size_t> unbounded(open.size(), 0);
    {
      const std::lock_guard lock(mutex);
      for (const EffectRow* row : open) most.push_back(*row->bound);
    }
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t r = 0; r < open.size(); ++r) {
        const double bound = bound_above(bounds, *open[r]->part, ordered[i], most[r], memory);
        if (std::isinf(bound)) ++unbounded[r];
        if (!std::isinf(bound)) most[r] = std::max(most[r], bound);
      }
    }
    const std::lock_guard lock(mutex);
    for (std::size_t r = 0; r < open.size(); ++r) {
      open[r]->bound = std::max(*open[r]->bound, most[r]);
      open[r]->unbounded += unbounded[r];
    }
  };
  // The last entry of a grid, which is grazing, is the worst most often: it spares the others a close look.
  look_at(ordered.size() - 1, ordered.size());
  parallel_ranges(ordered.size() - 1, kEntriesAtOnce, look_at);
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
