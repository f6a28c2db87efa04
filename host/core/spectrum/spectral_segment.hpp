// Parts of a band: nodes, samples, and their errors at probes. Used by spectral_rule.cpp and film_rule.cpp.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

inline constexpr double kPieceRelativeError = 1e-12;  // relative error of a sum over FineNodes
inline constexpr double kSmallestPart = 1e-4;         // argument `least` of probe_error()
inline constexpr int kMostNodes = 24;                 // largest number of Gauss nodes in a segment
inline constexpr double kProbeSafety = 10.0;          // error bound, divided by the largest error at a probe

/// A node of the 16-point Gauss rule. Its spectral factors are multiplied by the weight of the node.
struct FineNode : SpectralFactors {
  double wavelength_um = 0.0;
  double path = 0.0;
};

/// A scene, and the sampler of its sky, which takes long to make.
struct SampledScene {
  explicit SampledScene(const SceneModel& scene);
  const SceneModel& model;
  std::optional<SkySampler> sky;
};

/// Nodes with which sums integrate the radiation of the scene to rounding.
std::vector<FineNode> fine_nodes(SampledScene& scene, double from_um, double to_um);
/// fine_nodes() of both halves of the interval.
std::vector<FineNode> finer_nodes(SampledScene& scene, double from_um, double to_um);

std::vector<double> gauss_wavelengths(double from_um, double to_um, int count);

/// Samples at the wavelengths `nodes_um`, with the spectral factors of SpectralSample. `fine`: nodes of the interval.
std::vector<SpectralSample> samples_at(const SceneModel& scene, const std::vector<double>& nodes_um,
                                       const std::vector<FineNode>& fine);

/// Cosines of the critical angles of total reflection at some wavelengths of the interval.
std::vector<double> critical_cosines(const Surface& surface, double from_um, double to_um);

/// Integrals over wavelength of a spectral factor: the factor (`whole`), times 1 - R_s (`s`) and times 1 - R_p (`p`).
struct ProbeSum {
  double whole = 0.0;
  double s = 0.0;
  double p = 0.0;
};
using ProbeSums = std::array<ProbeSum, 3>;  ///< emitted, surroundings, irradiance

/// The sums over `fine` of each probe.
std::vector<ProbeSums> exact_sums(const Surface& surface, const std::vector<FineNode>& fine,
                                  const std::vector<double>& cosines);

/// Computes ProbeSum::s and ProbeSum::p at one probe from `samples`. Returns their largest error, divided by the
/// absorbed or the reflected radiation of `scale`: the smaller of both, but at least `least` times ProbeSum::whole.
/// `scale` has the sums of the segment, or of a band that contains it.
double probe_error(const std::vector<SpectralSample>& samples, const ProbeSums& exact, double cosine,
                   const ProbeSums& scale, double least);

/// Allowed error of the samples at a probe.
double enough_for_tolerance(const SceneModel& scene);

/// Samples for a surface with films. `ends_um` cuts the band into segments.
/// Accuracy: SpectralRule::relative_error, also where films resonate (tests ResonantFilms_*).
SpectralRule film_rule(SampledScene& scene, const std::vector<double>& ends_um);

}  // namespace dolp
