#include "run/part_requests.hpp"
#include "model/sky_basis.hpp"
#include "plan/constants.hpp"
#include "plan/response_plan.hpp"

#include <algorithm>
#include <array>
#include <boost/functional/hash.hpp>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace dolp {
namespace {

/// The beams of an entry as an evaluator gets them.
BeamAngles requested_angles(const SceneModel& scene, const SceneEntry& entry) {
  BeamAngles angles = beam_angles(scene, entry);
  angles.theta_r_deg = zenith_before_limit_deg(scene.surface.masking, angles.theta_r_deg);
  return angles;
}

SlopeShape normalised(const SceneValues& scene, const SlopeShape& shape) {
  SlopeShape normal = shape;
  if (scene.surface.distribution == Distribution::kGaussian) normal.q = SlopeShape{}.q;
  if (!is_elliptic(shape)) normal.sigma_cross = normal.azimuth_deg = 0.0;
  return normal;
}

Treatment treatment(const SceneValues& scene, const SceneEntry& entry) {
  return choose_treatment(scene.surface.distribution, scene.surface.masking, moment_zenith_deg(scene, entry),
                          entry.shape);
}

/// Appends the used values to `axis`, in their order. Returns for each value its position in `axis`.
std::vector<std::uint32_t> compact_used_values(const std::vector<double>& values, const std::vector<char>& is_used,
                                               std::vector<double>& axis) {
  std::vector<std::uint32_t> positions(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_used[i] == 0) continue;
    positions[i] = static_cast<std::uint32_t>(axis.size());
    axis.push_back(values[i]);
  }
  return positions;
}

/// Numbers different keys in the order of their first use.
template <class Key>
class Numbering {
 public:
  explicit Numbering(std::size_t most) : known_(most) {}
  /// The number of a key. Calls add() if the key is new.
  template <class Add>
  std::uint32_t number(const Key& key, const Add& add) {
    const auto [known, is_new] = known_.try_emplace(key, static_cast<std::uint32_t>(known_.size()));
    if (is_new) add();
    return known->second;
  }

 private:
  std::unordered_map<Key, std::uint32_t, boost::hash<Key>> known_;
};

std::array<double, 4> numbers_in(const SlopeShape& shape) {
  return {shape.sigma, shape.q, shape.sigma_cross, shape.azimuth_deg};
}

/// For each variant, the first variant with the same samples, among neighbours. Variants may differ in other values.
std::vector<std::uint32_t> first_equal_variants(const SpectralIndices& samples) {
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    first.push_back(i > 0 && samples[i] == samples[i - 1] ? first.back() : i);
  return first;
}

// A grid uses responses (see run_basis) only if it has this many entries per index. With fewer, they save little.
constexpr std::size_t kLeastEntries = 24;
constexpr std::size_t kLeastIndices = 2;      // a list uses responses if at least so many indices share them
constexpr std::size_t kDecidingPoints = 512;  // at most so many points of a list decide whether it uses responses

/// The indices of some points of a list; none if the list would use no responses. It uses them if several indices share
/// a direction and slope distribution, or if it is so long that responses may be interpolated.
std::vector<FacetOptics> indices_of_points(const SceneValues& scene, const SceneEntries& entries,
                                           const SpectralIndices& spectral) {
  std::set<std::tuple<double, double, double>> geometries;
  std::vector<FacetOptics> indices;
  const std::size_t drawn = std::min(entries.size(), kDecidingPoints);
  for (std::size_t i = 0; i < drawn; ++i) {
    const SceneEntry entry = entries[(2 * i + 1) * entries.size() / (2 * drawn)];
    if (is_elliptic(entry.shape)) return {};
    geometries.insert({moment_zenith_deg(scene, entry), entry.shape.sigma, entry.shape.q});
    const std::vector<FacetOptics> samples = with_index(spectral[entry.variant], entry.index);
    indices.insert(indices.end(), samples.begin(), samples.end());
  }
  const bool is_shared = indices.size() >= kLeastIndices * geometries.size();
  return is_shared || entries.size() >= kLeastPoints ? indices : std::vector<FacetOptics>{};
}

std::vector<FacetOptics> indices_of_grid(const SceneModel& scene, const EffectPlan& plan, const SceneEntries& entries) {
  if (!is_worth_responses(scene, entries.whole())) return {};
  const SceneEntries whole = entries.whole_entries();
  std::vector<FacetOptics> indices;
  if (whole.has_own_index()) {
    for (const std::vector<FacetOptics>& samples : spectral_indices(plan, whole)) {
      for (const OpticalConstants& own : whole.own_indices()) {
        const std::vector<FacetOptics> with_this_index = with_index(samples, own);
        indices.insert(indices.end(), with_this_index.begin(), with_this_index.end());
      }
      if (samples.front().is_bare()) break;  // without films, the indices are the same at all wavelengths
    }
    return indices;
  }
  for (const std::vector<FacetOptics>& variant_optics : spectral_indices(plan, whole)) {
    if (indices.size() < variant_optics.size() ||
        !std::ranges::equal(variant_optics, std::span(indices).last(variant_optics.size())))
      indices.insert(indices.end(), variant_optics.begin(), variant_optics.end());
  }
  return indices;
}

}  // namespace

Axis moment_axis(const SceneModel& scene) {
  return scene.geometry.mode == Mode::kBistatic ? Axis::kViewZenith : Axis::kTheta;
}

bool is_worth_responses(const SceneModel& scene, const PerAxis& counts) {
  return counts[moment_axis(scene)] * counts[Axis::kSigma] * counts[Axis::kQ] >= kLeastEntries;
}

bool wants_moments(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.kept.moments && treatment(scene, entry) == Treatment::kIntegrated;
}

bool wants_beam(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.needs_beams && !is_mirror(entry.shape) && has_facet(requested_angles(scene, entry));
}

Scattered beam_without_evaluator(const SceneValues& scene, const SceneEntry& entry) {
  const BeamAngles angles = requested_angles(scene, entry);
  const bool is_undefined = !has_facet(angles) || is_specular(angles);
  const double glare = is_undefined ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  return {.i = glare, .q = glare};
}

std::vector<FacetOptics> with_index(const std::vector<FacetOptics>& samples,
                                    const std::optional<OpticalConstants>& index) {
  if (!index) return samples;
  if (samples.front().is_bare()) return {*index};
  std::vector<FacetOptics> changed = samples;
  for (FacetOptics& sample : changed) sample.index = *index;
  return changed;
}

SpectralIndices spectral_indices(const EffectPlan& plan, const SceneEntries& entries) {
  SpectralIndices indices;
  for (const SceneVariant& variant : entries.variants()) indices.push_back(plan.rules->at(variant)->indices());
  return indices;
}

PartRequests::PartRequests(const SceneValues& scene, const SpectralIndices& samples, const EffectPlan& plan,
                           const Selection& selection, const RefinementLevel& level)
    : scene_(scene), samples_(samples), plan_(plan), selection_(selection) {
  moments_.distribution = beams_.distribution = scene.surface.distribution;
  moments_.masking = beams_.masking = scene.surface.masking;
  moments_.scattering = beams_.scattering = plan.kept.further_bounces ? scene.surface.scattering : Scattering::kSingle;
  moments_.wants_direct = plan.needs_direct;
  moments_.precision = level.precision;
  beams_.accuracy = scattering_accuracy(scene.surface.scattering, level.tolerance);
  moments_.tolerance = level.tolerance;
  moments_.scene_tolerance = scene.accuracy.tolerance;
  moments_.has_extra_splits = level.is_check;
  moments_.basis = level.basis;
  moments_.sky = plan.sky;
  moments_.may_interpolate = level.may_interpolate;
  if (plan.kept.moments) request_moments();
  if (moments_.has_elliptic_shapes()) moments_.basis = nullptr;  // responses are for isotropic slopes
  if (plan.needs_beams) request_beams();
}

void PartRequests::request_shapes(const SceneEntries& grid) {
  std::vector<char> sigma(grid.sigma().size(), 0), q(grid.q().size(), 0);
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      if (!is_mirror({grid.sigma()[i], grid.q()[j]})) sigma[i] = q[j] = 1;
    }
  }
  std::vector<double> used_sigma, used_q;
  sigma_at_ = compact_used_values(grid.sigma(), sigma, used_sigma);
  if (scene_.surface.distribution == Distribution::kGaussian) {
    used_q = {SlopeShape{}.q};
    q_at_.assign(q.size(), 0);
  } else {
    q_at_ = compact_used_values(grid.q(), q, used_q);
  }
  const CrossSlopes& slopes = grid.slopes();
  const auto cross =
      grid.has_values(Axis::kSigmaCross) ? grid.axes()[Axis::kSigmaCross] : std::vector{slopes.sigma_cross};
  const auto azimuth =
      grid.has_values(Axis::kSurfaceAzimuth) ? grid.axes()[Axis::kSurfaceAzimuth] : std::vector{slopes.azimuth_deg};
  moments_.shapes = shape_product(used_sigma, used_q);
  std::vector<SlopeShape> elliptic;
  for (const SlopeShape& shape : moments_.shapes) {
    for (const double sigma_cross : cross) {
      for (const double azimuth_deg : azimuth)
        elliptic.push_back(CrossSlopes{sigma_cross, azimuth_deg, slopes.wind_model}.shape(shape.sigma, shape.q));
    }
  }
  shape_counts_[Axis::kQ] = used_q.size();
  shape_counts_[Axis::kSigmaCross] = shape_counts_[Axis::kSurfaceAzimuth] = 1;
  if (std::ranges::any_of(elliptic, is_elliptic)) {  // otherwise all azimuths share their moments
    shape_counts_[Axis::kSigmaCross] = cross.size();
    shape_counts_[Axis::kSurfaceAzimuth] = azimuth.size();
    moments_.shapes = std::move(elliptic);
  }
}

std::uint32_t PartRequests::shape_position(const PerAxis& on_axes) const {
  std::size_t shape = sigma_at_[on_axes[Axis::kSigma]] * shape_counts_[Axis::kQ] + q_at_[on_axes[Axis::kQ]];
  for (const Axis axis : {Axis::kSigmaCross, Axis::kSurfaceAzimuth})
    shape = shape * shape_counts_[axis] + on_axes[axis] % shape_counts_[axis];
  return static_cast<std::uint32_t>(shape);
}

PartRequests::MomentsSpan PartRequests::member_moments(std::size_t member, const PerAxis& on_axes) const {
  MomentsSpan span = spans_[member / members_per_span_];
  if (members_have_all_shapes_) span.first += shape_position(on_axes);
  return span;
}

void PartRequests::request_moments() {
  struct IndexSet {
    std::uint32_t first = 0;  // position in moments_.optics
    std::uint32_t count = 0;
    bool has_own_index = false;  // a bare medium with the n and k of the entry, at all wavelengths
  };
  struct Place {
    std::uint32_t direction = 0, set = 0, shape = 0;
    std::size_t span = 0;
  };
  const bool is_grid = selection_.part.is_grid();
  const bool has_all_shapes = selection_.is_whole_grid();
  members_have_all_shapes_ = has_all_shapes;
  moments_.is_scattered = !is_grid;
  if (is_grid) request_shapes(selection_.part);
  members_per_span_ = has_all_shapes ? selection_.part.entries_per_direction() : 1;
  spans_.resize(selection_.size() / members_per_span_);
  Numbering<double> directions(spans_.size());
  Numbering<std::array<double, 4>> shapes(spans_.size());
  Numbering<std::array<double, 3>> index_sets(spans_.size());
  std::vector<IndexSet> sets;
  std::vector<Place> places;
  places.reserve(spans_.size());
  const std::vector<std::uint32_t> equal_variants = first_equal_variants(samples_);
  EntryReader reader(selection_.part);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const SceneEntry& entry = reader[selection_.position(i * members_per_span_)];
    const auto wants_shape = [&](const SlopeShape& own) {
      SceneEntry with_shape = entry;
      with_shape.shape = own;
      return wants_moments(scene_, with_shape, plan_);
    };
    if (has_all_shapes ? std::ranges::none_of(moments_.shapes, wants_shape) : !wants_shape(entry.shape)) continue;
    const double zenith_deg = zenith_before_limit_deg(scene_.surface.masking, moment_zenith_deg(scene_, entry));
    const bool has_own_index = entry.index && !has_films();
    const double variant = has_own_index ? -1.0 : equal_variants[entry.variant];
    const OpticalConstants key = entry.index.value_or(OpticalConstants{0.0, -1.0});  // no real index has k = -1
    Place& place = places.emplace_back();
    place.span = i;
    place.direction = directions.number(zenith_deg, [&] { moments_.theta_deg.push_back(zenith_deg); });
    place.set = index_sets.number({key.n, key.k, variant}, [&] {
      const std::vector<FacetOptics> own = with_index(samples_[entry.variant], entry.index);
      sets.push_back(
          {static_cast<std::uint32_t>(moments_.optics.size()), static_cast<std::uint32_t>(own.size()), has_own_index});
      moments_.optics.insert(moments_.optics.end(), own.begin(), own.end());
    });
    if (is_grid && !has_all_shapes) place.shape = shape_position(reader.on_axes());
    if (is_grid) continue;
    const SlopeShape shape = normalised(scene_, entry.shape);
    place.shape = shapes.number(numbers_in(shape), [&] { moments_.shapes.push_back(shape); });
  }
  const auto position = [](const Place& place) { return std::tuple(place.direction, place.set, place.shape); };
  std::ranges::sort(places, {}, position);
  moments_.set_shapes(std::move(moments_.shapes));
  std::map<std::vector<std::uint32_t>, std::uint32_t> known;  // positions of lists of shapes in moments_.members
  for (std::size_t i = 0, end = 0; i < places.size(); i = end) {
    const auto& [direction, set, first_shape, span] = places[i];
    const std::size_t first_entry = moments_.size();
    std::vector<std::uint32_t> own;
    for (; end < places.size() && places[end].direction == direction && places[end].set == set; ++end) {
      if (own.empty() || own.back() != places[end].shape) own.push_back(places[end].shape);
      spans_[places[end].span].first = first_entry + own.size() - 1;
    }
    const auto count = static_cast<std::uint32_t>(has_all_shapes ? moments_.shapes.size() : own.size());
    for (std::size_t j = i; j < end; ++j) spans_[places[j].span].stride = sets[set].has_own_index ? 0 : count;
    std::uint32_t first = own.front();  // neighbouring shapes are in moments_.members already
    if (!has_all_shapes && own.back() - first + 1 != count) {
      const auto [list, is_new] = known.try_emplace(own, static_cast<std::uint32_t>(moments_.members.size()));
      if (is_new) moments_.members.insert(moments_.members.end(), own.begin(), own.end());
      first = list->second;
    }
    for (std::uint32_t j = 0; j < sets[set].count; ++j)
      moments_.add_bundle(direction, sets[set].first + j, first, count);
  }
  // The parts of a grid and later requests for some of its entries must do as the whole grid does.
  moments_.has_lone_entries =
      is_grid ? selection_.part.entries_per_direction() == 1 : moments_.size() < 2 * moments_.bundles.size();
}

void PartRequests::request_beams() {
  Numbering<std::array<double, 3>> directions(selection_.size());
  Numbering<std::array<double, 4>> shapes(selection_.size());
  std::vector<std::uint32_t> first_index;
  for (const std::vector<FacetOptics>& wavelength_optics : samples_) {
    first_index.push_back(static_cast<std::uint32_t>(beams_.optics.size()));
    beams_.optics.insert(beams_.optics.end(), wavelength_optics.begin(), wavelength_optics.end());
  }
  first_beam_.reserve(selection_.size());
  for (std::size_t i = 0; i < selection_.size(); ++i) {
    const SceneEntry entry = selection_[i];
    first_beam_.push_back(beams_.entries.size());
    if (!wants_beam(scene_, entry, plan_)) continue;
    const BeamAngles angles = requested_angles(scene_, entry);
    ScatteringEntry wanted;
    wanted.angles = directions.number({angles.theta_i_deg, angles.theta_r_deg, angles.delta_phi_deg},
                                      [&] { beams_.angles.push_back(angles); });
    wanted.shape = shapes.number(numbers_in(entry.shape), [&] { beams_.shapes.push_back(entry.shape); });
    for (std::uint32_t j = 0; j < samples_[entry.variant].size(); ++j) {
      wanted.index = first_index[entry.variant] + j;
      if (entry.index) {
        FacetOptics entry_optics = samples_[entry.variant][j];
        entry_optics.index = *entry.index;
        if (beams_.optics.back() != entry_optics) beams_.optics.push_back(std::move(entry_optics));
        wanted.index = static_cast<std::uint32_t>(beams_.optics.size() - 1);
      }
      beams_.entries.push_back(wanted);
    }
  }
}

std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan) {
  const bool has_bounces = plan.kept.further_bounces && scene.surface.scattering == Scattering::kMultiple;
  if (!scene.accuracy.may_interpolate || !plan.kept.moments || has_bounces) return nullptr;
  const std::vector<FacetOptics> indices = entries.is_grid()
                                               ? indices_of_grid(scene, plan, entries)
                                               : indices_of_points(scene, entries, spectral_indices(plan, entries));
  const std::size_t passes = response_passes(plan.needs_direct, plan.sky ? plan.sky->size() : 0);
  return indices.empty() ? nullptr : ResponseBasis::of(indices, scene.accuracy.tolerance, passes);
}

}  // namespace dolp
