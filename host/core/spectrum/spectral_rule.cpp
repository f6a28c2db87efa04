#include "spectrum/spectral_rule.hpp"
#include "model/facet_optics.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <iterator>
#include <numbers>
#include <optional>
#include <ranges>

#include "model/direction.hpp"
#include "model/films.hpp"
#include "model/smooth_surface.hpp"
#include "spectrum/planck.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_segment.hpp"

namespace dolp {
namespace {

using FineRule = boost::math::quadrature::gauss<double, 16>;

// The constants below are choices. In a trial each was halved and doubled, except kPieceWavelengthRatio, which must be
// above 1. The tables of night_paint, bare_aluminium and water kept their numbers of evaluations and error bounds.

// A band is cut into pieces so short that 16 Gauss nodes integrate Planck's function to rounding. Limits of a piece:
// change of the exponent h c / (lambda k_B T), and ratio of its longest to its shortest wavelength.
constexpr double kPieceExponentChange = 4.0;
constexpr double kPieceWavelengthRatio = 1.5;
// h c / k_B in um K. Planck's function underflows if the exponent h c / (lambda k_B T) exceeds kLargestPlanckExponent.
constexpr double kExponentScale_umK = 14388.0;
constexpr double kLargestPlanckExponent = 750.0;

// The band is cut into segments at the rows of the optical tables and, with films, at fringe_ends(). A segment gets the
// fewest Gauss nodes, at most kMostNodes, with nodes_error() <= kNodesRelativeError (films: film_rule()).
constexpr double kNodesRelativeError = 1e-10;
// A probe is an angle of incidence on the smooth surface. The nodes of a segment are tested at probes. Some probes are
// fixed. The other probes are critical angles of total reflection, at wavelengths that kCriticalShares places in the
// segment. The error bound is kProbeSafety times the largest error at a probe.
constexpr std::array<double, 7> kProbeCosines = {1.0, 0.5, 0.25, 0.15, 0.1, 0.07, 0.04};
constexpr std::array<double, 7> kCriticalShares = {0.03, 0.19, 0.34, 0.52, 0.67, 0.81, 0.96};
// Without films: if the error with kMostNodes nodes exceeds kShareOfTolerance times the tolerance, the segment is cut
// into panels with kPanelNodes nodes each. The number of panels doubles until the error is at most
// kPanelShareOfTolerance times the tolerance. The limit for a band is about kMostPanels, or kMostMirrorPanels for a
// mirror, whose samples cost little.
constexpr double kShareOfTolerance = 0.005;
constexpr double kPanelShareOfTolerance = 0.03;
constexpr int kLeastPanels = 4;
constexpr double kMostPanels = 32.0;
constexpr double kMostMirrorPanels = 512.0;
constexpr double kMostFringes = 256.0;  // largest number of parts into which fringe_ends() divides a band

const SkyProfile* scene_profile(const SceneModel& scene) {
  return scene.surroundings ? scene.surroundings->profile.get() : nullptr;
}

double source_irradiance(const SceneModel& scene, double wavelength_um, double emitted) {
  const Source& source = *scene.source;
  if (source.relative_irradiance) return source.scale * *source.relative_irradiance * emitted;
  return source.scale * (source.table ? source.table->at(wavelength_um) : source.irradiance);
}

double path_exitance(const Path& path, double wavelength_um) {
  if (path.radiance) return std::numbers::pi * *path.radiance;
  if (!path.temperature_K) return 0.0;
  return std::numbers::pi * (1.0 - path.transmittance) * planck_radiance(wavelength_um, *path.temperature_K);
}

FineNode fine_node(SampledScene& sampled, double wavelength_um, double weight) {
  const SceneModel& scene = sampled.model;
  const double emitted =
      scene.emission ? std::numbers::pi * planck_radiance(wavelength_um, scene.emission->temperature_K) : 0.0;
  double surroundings = 0.0;
  FineNode node;
  if (sampled.sky) {
    const Eigen::VectorXd exitances = sampled.sky->at(wavelength_um);
    surroundings = sampled.sky->mean(exitances);
    node.sky = weight * (exitances.array() - surroundings);
  } else if (scene.surroundings) {
    surroundings = std::numbers::pi * planck_radiance(wavelength_um, scene.surroundings->temperature_K);
  }
  node.wavelength_um = wavelength_um;
  node.emitted = weight * emitted;
  node.surroundings = weight * surroundings;
  node.excess = weight * (surroundings - emitted);
  node.irradiance = scene.source ? weight * source_irradiance(scene, wavelength_um, emitted) : 0.0;
  node.width = weight;
  node.path = scene.path ? weight * path_exitance(*scene.path, wavelength_um) : 0.0;
  return node;
}

std::vector<double> temperatures(const SceneModel& scene) {
  std::vector<double> result;
  if (scene.emission) result.push_back(scene.emission->temperature_K);
  const SkyProfile* profile = scene_profile(scene);
  if (scene.surroundings && !profile) result.push_back(scene.surroundings->temperature_K);
  if (profile && profile->kind == SkyProfile::Kind::kLayers)
    result.insert(result.end(), {profile->air_K, profile->beyond_K});
  if (profile && profile->kind == SkyProfile::Kind::kTemperature) {
    const auto [coldest, warmest] = std::ranges::minmax(profile->values);
    result.insert(result.end(), {coldest, warmest});
  }
  if (scene.path && scene.path->temperature_K) result.push_back(*scene.path->temperature_K);
  return result;
}

bool is_one_piece(const SceneModel& scene, double from_um, double to_um) {
  if (to_um > kPieceWavelengthRatio * from_um) return false;
  return std::ranges::all_of(temperatures(scene), [&](double temperature_K) {
    if (temperature_K == 0.0) return true;
    const auto exponent = [&](double wavelength_um) {
      return std::min(kExponentScale_umK / (wavelength_um * temperature_K), kLargestPlanckExponent);
    };
    return exponent(from_um) - exponent(to_um) <= kPieceExponentChange;
  });
}

void append_fine_nodes(SampledScene& scene, double from_um, double to_um, std::vector<FineNode>& nodes) {
  const double middle_um = 0.5 * (from_um + to_um);
  if (!is_one_piece(scene.model, from_um, to_um)) {
    append_fine_nodes(scene, from_um, middle_um, nodes);
    append_fine_nodes(scene, middle_um, to_um, nodes);
    return;
  }
  const double half_um = 0.5 * (to_um - from_um);
  for (std::size_t i = 0; i < FineRule::abscissa().size(); ++i) {
    const double offset_um = half_um * FineRule::abscissa()[i];
    for (const double at_um : {middle_um - offset_um, middle_um + offset_um}) {
      const double response = scene.model.spectrum.weight(at_um);
      if (response > 0.0) nodes.push_back(fine_node(scene, at_um, half_um * FineRule::weights()[i] * response));
    }
  }
}

std::vector<double> segment_ends(double from_um, double to_um,
                                 std::initializer_list<std::vector<double>> wavelengths_um) {
  std::vector<double> ends = {from_um, to_um};
  for (const std::vector<double>& list : wavelengths_um)
    for (const double wavelength_um : list)
      if (wavelength_um > from_um && wavelength_um < to_um) ends.push_back(wavelength_um);
  std::ranges::sort(ends);
  const auto repeated = std::ranges::unique(ends);
  ends.erase(repeated.begin(), repeated.end());
  return ends;
}

std::vector<double> rows_um(const std::shared_ptr<const SpectralTable>& table) {
  return table ? table->wavelength_um : std::vector<double>{};
}

/// Rows at which the response is 0. Between two of them, a segment may have no radiation.
std::vector<double> response_zeros_um(const Spectrum& spectrum) {
  std::vector<double> zeros_um;
  for (std::size_t i = 0; spectrum.response && i < spectrum.response->value.size(); ++i) {
    if (spectrum.response->value[i] == 0.0) zeros_um.push_back(spectrum.response->wavelength_um[i]);
  }
  return zeros_um;
}

std::vector<double> lagrange(const std::vector<double>& nodes_um, double wavelength_um) {
  std::vector<double> values(nodes_um.size(), 1.0);
  for (std::size_t j = 0; j < nodes_um.size(); ++j)
    for (std::size_t k = 0; k < nodes_um.size(); ++k)
      if (k != j) values[j] *= (wavelength_um - nodes_um[k]) / (nodes_um[j] - nodes_um[k]);
  return values;
}

const std::vector<double>& legendre_zeros(int count) {
  static const auto zeros = [] {
    std::array<std::vector<double>, kMostNodes + 1> all;
    for (int i = 1; i <= kMostNodes; ++i) all[static_cast<std::size_t>(i)] = boost::math::legendre_p_zeros<double>(i);
    return all;
  }();
  return zeros[static_cast<std::size_t>(count)];
}

/// Wavelengths that divide the band into parts in which the films cause about one interference fringe each.
std::vector<double> fringe_ends(const SceneModel& scene) {
  const double from = 1.0 / scene.spectrum.max_um;
  const double to = 1.0 / scene.spectrum.min_um;
  double fringes = 0.0;
  const std::vector<Film> films = scene.surface.optics_at(scene.spectrum.max_um).films;
  for (std::size_t i = 0; i < films.size(); ++i) {
    if (is_blurred(films[i])) continue;
    const Layer& layer = scene.surface.coating[i];
    const double n = std::max(layer.material.at(scene.spectrum.min_um).n, layer.material.at(scene.spectrum.max_um).n);
    fringes += 2.0 * layer.thickness_um * n * (to - from);
  }
  const int count = static_cast<int>(std::min(std::ceil(fringes), kMostFringes));
  std::vector<double> ends_um;
  for (int i = 1; i < count; ++i) ends_um.push_back(1.0 / std::lerp(from, to, static_cast<double>(i) / count));
  return ends_um;
}

template <typename Node>
void add_probe(ProbeSums& sums, const Node& node, const FacetOptics& index, double cosine) {
  const SmoothAbsorptance at = smooth_absorptance(index, cosine);
  const std::array<double, 3> factors = {node.emitted, node.surroundings, node.irradiance};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    sums[i].whole += factors[i];
    sums[i].s += factors[i] * at.s;
    sums[i].p += factors[i] * at.p;
  }
}

/// Divisor of an error at a probe: see probe_error().
double error_scale(const ProbeSum& sum, double least) {
  const double absorbed = 0.5 * (sum.s + sum.p);
  return std::max(std::min(absorbed, sum.whole - absorbed), least * sum.whole);
}

}  // namespace

SampledScene::SampledScene(const SceneModel& scene) : model(scene) {
  if (const SkyProfile* profile = scene_profile(scene)) sky.emplace(*profile);
}

std::vector<FineNode> fine_nodes(SampledScene& scene, double from_um, double to_um) {
  const std::optional<Source>& source = scene.model.source;
  const SkyProfile* profile = scene_profile(scene.model);
  const std::vector<double> ends =
      segment_ends(from_um, to_um,
                   {rows_um(source ? source->table : nullptr), profile ? profile->breaks_um() : std::vector<double>{},
                    rows_um(scene.model.spectrum.response)});
  std::vector<FineNode> nodes;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) append_fine_nodes(scene, ends[i], ends[i + 1], nodes);
  return nodes;
}

std::vector<FineNode> finer_nodes(SampledScene& scene, double from_um, double to_um) {
  const double middle_um = 0.5 * (from_um + to_um);
  std::vector<FineNode> nodes = fine_nodes(scene, from_um, middle_um);
  std::ranges::move(fine_nodes(scene, middle_um, to_um), std::back_inserter(nodes));
  return nodes;
}

std::vector<double> gauss_wavelengths(double from_um, double to_um, int count) {
  std::vector<double> wavelengths_um;
  for (const double zero : legendre_zeros(count)) {
    const double offset_um = 0.5 * (to_um - from_um) * zero;
    wavelengths_um.push_back(0.5 * (from_um + to_um) + offset_um);
    if (zero > 0.0) wavelengths_um.push_back(0.5 * (from_um + to_um) - offset_um);
  }
  std::ranges::sort(wavelengths_um);
  return wavelengths_um;
}

std::vector<SpectralSample> samples_at(const SceneModel& scene, const std::vector<double>& nodes_um,
                                       const std::vector<FineNode>& fine) {
  std::vector<SpectralSample> samples(nodes_um.size());
  for (std::size_t j = 0; j < nodes_um.size(); ++j) {
    samples[j].wavelength_um = nodes_um[j];
    samples[j].index = scene.surface.optics_at(nodes_um[j]);
  }
  for (const FineNode& node : fine) {
    const std::vector<double> values = lagrange(nodes_um, node.wavelength_um);
    for (std::size_t j = 0; j < samples.size(); ++j) samples[j].add(node, values[j]);
  }
  return samples;
}

std::vector<double> critical_cosines(const Surface& surface, double from_um, double to_um) {
  std::vector<double> cosines;
  for (const double share : kCriticalShares) {
    const OpticalConstants index = surface.material.at(std::lerp(from_um, to_um, share));
    const double square = index.n * index.n - index.k * index.k;
    if (square > 0.0 && square < 1.0) cosines.push_back(std::sqrt(1.0 - square));
  }
  return cosines;
}

std::vector<ProbeSums> exact_sums(const Surface& surface, const std::vector<FineNode>& fine,
                                  const std::vector<double>& cosines) {
  std::vector<ProbeSums> sums(cosines.size());
  for (const FineNode& node : fine) {
    const FacetOptics index = surface.optics_at(node.wavelength_um);
    for (std::size_t i = 0; i < cosines.size(); ++i) add_probe(sums[i], node, index, cosines[i]);
  }
  return sums;
}

double probe_error(const std::vector<SpectralSample>& samples, const ProbeSums& exact, double cosine,
                   const ProbeSums& scale, double least) {
  ProbeSums sums;
  for (const SpectralSample& sample : samples) add_probe(sums, sample, sample.index, cosine);
  double worst = 0.0;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    if (exact[j].whole == 0.0) continue;
    const double part = error_scale(scale[j], least);
    worst = std::max({worst, std::abs(exact[j].s - sums[j].s) / part, std::abs(exact[j].p - sums[j].p) / part});
  }
  return worst;
}

double enough_for_tolerance(const SceneModel& scene) {
  return std::max(kShareOfTolerance * scene.accuracy.tolerance, kNodesRelativeError);
}

namespace {

/// The largest probe_error() of all probes, each relative to its own sums.
double nodes_error(const std::vector<SpectralSample>& samples, const std::vector<ProbeSums>& exact,
                   const std::vector<double>& cosines, double least) {
  double worst = 0.0;
  for (std::size_t i = 0; i < cosines.size(); ++i)
    worst = std::max(worst, probe_error(samples, exact[i], cosines[i], exact[i], least));
  return worst;
}

void append_merged(std::vector<SpectralSample>& samples, const SpectralSample& sample) {
  const auto same = std::ranges::find(samples, sample.index, &SpectralSample::index);
  if (same == samples.end()) {
    samples.push_back(sample);
    return;
  }
  same->add(sample, 1.0);
}

struct SegmentRule {
  std::vector<SpectralSample> samples;
  double error = 0.0;
};

SegmentRule smooth_segment(SampledScene& sampled, double from_um, double to_um, const std::vector<FineNode>& fine,
                           const std::vector<double>& cosines) {
  const SceneModel& scene = sampled.model;
  if (scene.surface.has_constant_optics()) return {samples_at(scene, gauss_wavelengths(from_um, to_um, 1), fine), 0.0};
  SegmentRule rule;
  const std::vector<ProbeSums> exact = exact_sums(scene.surface, finer_nodes(sampled, from_um, to_um), cosines);
  for (int count = 1; count <= kMostNodes; ++count) {
    rule.samples = samples_at(scene, gauss_wavelengths(from_um, to_um, count), fine);
    rule.error = nodes_error(rule.samples, exact, cosines, kSmallestPart);
    if (rule.error <= kNodesRelativeError) break;
  }
  return rule;
}

SegmentRule segment_of_panels(SampledScene& scene, double from_um, double to_um, int panels,
                              const std::vector<double>& cosines) {
  SegmentRule rule;
  std::vector<FineNode> all;
  for (int i = 0; i < panels; ++i) {
    const double start_um = std::lerp(from_um, to_um, static_cast<double>(i) / panels);
    const double end_um = std::lerp(from_um, to_um, static_cast<double>(i + 1) / panels);
    const std::vector<FineNode> fine = finer_nodes(scene, start_um, end_um);
    for (const SpectralSample& sample : samples_at(scene.model, gauss_wavelengths(start_um, end_um, kPanelNodes), fine))
      rule.samples.push_back(sample);
    all.insert(all.end(), fine.begin(), fine.end());
  }
  rule.error = nodes_error(rule.samples, exact_sums(scene.model.surface, all, cosines), cosines, 1.0);
  return rule;
}

/// Adds the samples of a segment to `rule`, or to `panels` if the segment must be cut into panels.
void append_segment(SampledScene& sampled, double from_um, double to_um, SpectralRule& rule,
                    std::vector<SpectralSample>& panels) {
  const SceneModel& scene = sampled.model;
  const std::vector<FineNode> fine = fine_nodes(sampled, from_um, to_um);
  if (fine.empty()) return;
  for (const FineNode& node : fine) rule.path_exitance += node.path;
  std::vector<double> cosines = critical_cosines(scene.surface, from_um, to_um);
  cosines.insert(cosines.end(), kProbeCosines.begin(), kProbeCosines.end());
  SegmentRule segment = smooth_segment(sampled, from_um, to_um, fine, cosines);
  const double tolerance = scene.accuracy.tolerance;
  if (segment.error <= enough_for_tolerance(scene)) {
    if (segment.error > 0.0) rule.relative_error = std::max(rule.relative_error, kProbeSafety * segment.error);
    for (const SpectralSample& sample : segment.samples) append_merged(rule.samples, sample);
    return;
  }
  const double share = (to_um - from_um) / (scene.spectrum.max_um - scene.spectrum.min_um);
  const double most = share * (is_mirror({.sigma = scene.surface.sigma}) ? kMostMirrorPanels : kMostPanels);
  for (int count = kLeastPanels;; count *= 2) {
    segment = segment_of_panels(sampled, from_um, to_um, count, cosines);
    if (segment.error <= kPanelShareOfTolerance * tolerance || 2 * count > most) break;
  }
  panels.insert(panels.end(), segment.samples.begin(), segment.samples.end());
}

SpectralRule smooth_rule(SampledScene& sampled, const std::vector<double>& ends_um) {
  SpectralRule rule;
  rule.relative_error = kPieceRelativeError;
  std::vector<SpectralSample> panels;
  for (std::size_t i = 0; i + 1 < ends_um.size(); ++i)
    append_segment(sampled, ends_um[i], ends_um[i + 1], rule, panels);
  rule.panels = panels.size() / kPanelNodes;
  rule.samples.insert(rule.samples.end(), panels.begin(), panels.end());
  return rule;
}

DiffuseSpectrum diffuse_spectrum(SampledScene& sampled) {
  const Spectrum& band = sampled.model.spectrum;
  const SpectralTable& k_d = *sampled.model.surface.diffuse_table;
  const std::vector<double> ends_um = segment_ends(band.min_um, band.max_um, {k_d.wavelength_um});
  SpectralFactors all, diffuse;
  for (std::size_t i = 0; i + 1 < ends_um.size(); ++i) {
    for (const FineNode& node : fine_nodes(sampled, ends_um[i], ends_um[i + 1])) {
      all.add(node, 1.0);
      diffuse.add(node, k_d.at(node.wavelength_um));
    }
  }
  const double mean = all.emitted > 0.0 ? diffuse.emitted / all.emitted : diffuse.width / all.width;
  return {mean, diffuse.surroundings - mean * all.surroundings, diffuse.irradiance - mean * all.irradiance};
}

SpectralRule single_wavelength_rule(const SceneModel& scene, double wavelength_um) {
  SampledScene sampled(scene);
  const FineNode node = fine_node(sampled, wavelength_um, 1.0);
  SpectralSample sample;
  sample.wavelength_um = wavelength_um;
  sample.index = scene.surface.optics_at(wavelength_um);
  sample.add(node, 1.0);
  return {.samples = {sample}, .path_exitance = node.path};
}

}  // namespace

void SpectralFactors::add(const SpectralFactors& more, double factor) {
  emitted += factor * more.emitted;
  surroundings += factor * more.surroundings;
  excess += factor * more.excess;
  irradiance += factor * more.irradiance;
  width += factor * more.width;
  if (sky.size() == 0) sky.setZero(more.sky.size());
  if (more.sky.size() > 0) sky += factor * more.sky;
}

std::vector<FacetOptics> SpectralRule::indices() const {
  std::vector<FacetOptics> result;
  for (const SpectralSample& sample : samples) result.push_back(sample.index);
  return result;
}

SpectralRule spectral_rule(const SceneModel& scene) {
  if (!scene.spectrum.is_band()) return single_wavelength_rule(scene, scene.spectrum.min_um);
  const std::vector<double> ends =
      segment_ends(scene.spectrum.min_um, scene.spectrum.max_um,
                   {scene.surface.optics_rows_um(), fringe_ends(scene), response_zeros_um(scene.spectrum)});
  SampledScene sampled(scene);
  SpectralRule rule = scene.surface.coating.empty() ? smooth_rule(sampled, ends) : film_rule(sampled, ends);
  if (scene.surface.diffuse_table) rule.diffuse = diffuse_spectrum(sampled);
  return rule;
}

SpectralRule kept_rule(SpectralRule rule, const KeptEffects& kept) {
  for (SpectralSample& sample : rule.samples) {
    if (!kept.surroundings) sample.excess = -sample.emitted;
    if (!kept.emission) sample.excess = kept.surroundings ? sample.surroundings : 0.0;
    if (!kept.surroundings) sample.surroundings = 0.0;
    if (!kept.surroundings || !kept.profile) sample.sky.resize(0);
    if (!kept.emission) sample.emitted = 0.0;
    if (!kept.source) sample.irradiance = 0.0;
  }
  if (!kept.path_radiance) rule.path_exitance = 0.0;
  if (!kept.diffuse) rule.diffuse.reset();
  if (rule.diffuse && !kept.surroundings) rule.diffuse->surroundings = 0.0;
  if (rule.diffuse && !kept.source) rule.diffuse->irradiance = 0.0;
  return rule;
}

}  // namespace dolp
