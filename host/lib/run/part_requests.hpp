#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/response_basis.hpp"
#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"
#include "radiometry/radiometry.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Some entries of a part of a run, or all of them.
struct Selection {
  const SceneEntries& part;
  std::span<const std::size_t> chosen = {};  ///< positions in the part; empty: all

  std::size_t size() const { return chosen.empty() ? part.size() : chosen.size(); }
  std::size_t position(std::size_t member) const { return chosen.empty() ? member : chosen[member]; }
  SceneEntry operator[](std::size_t member) const { return part[position(member)]; }
};

/// The zenith of the moments of an entry: in bistatic mode the zenith of the view, otherwise its theta.
double moment_zenith_deg(const SceneValues& scene, double theta_deg);

bool wants_moments(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// True if the evaluator must compute the beam: not for a mirror, nor with source and view both at 90 degrees.
bool wants_beam(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// The beam of an entry that needs no evaluator. It is undefined (NaN) in the specular direction of a mirror, and with
/// source and view both at 90 degrees; otherwise it is 0.
Scattered beam_without_evaluator(const SceneValues& scene, double theta_deg);

/// For each variant of the entries, the indices at its spectral samples.
using SpectralIndices = std::vector<std::vector<FacetOptics>>;
SpectralIndices spectral_indices(const SceneValues& scene, const SceneEntries& entries);

/// The samples with `index` as the medium under their films. Without films all samples become equal, so one is
/// returned. Without `index` the samples are returned as they are.
std::vector<FacetOptics> with_index(const std::vector<FacetOptics>& samples,
                                    const std::optional<OpticalConstants>& index);

/// The requests of one level of refinement for a selection. For a grid, the request for moments is a grid too. It has
/// the directions (in bistatic mode the view) and the indices of the selection, and all slope distributions of the
/// part. So the result of an entry does not depend on which entries are selected in other directions. Points share
/// moments if they differ only in values on which moments do not depend.
class PartRequests {
 public:
  PartRequests(const SceneValues& scene, const SpectralIndices& samples, const EffectPlan& plan,
               const Selection& selection, const RefinementLevel& level);

  const MomentsRequest& moments() const { return moments_; }
  const ScatteringRequest& beams() const { return beams_; }

  /// The position of the moments of a member in the answer: `first + j * stride` for spectral sample j.
  struct MomentsSpan {
    std::size_t first = 0;
    std::size_t stride = 0;
  };
  MomentsSpan moments_of(std::size_t member) const;
  /// The position, in a request for a grid, of the direction whose moments a member uses.
  std::size_t direction_of(std::size_t member) const;
  /// The position of the first beam of a member, which has one beam per spectral sample.
  std::size_t beams_of(std::size_t member) const { return first_beam_[member]; }

 private:
  void request_grid(const Selection& selection);
  void request_indices(const SceneEntries& grid, const std::vector<char>& is_used);
  void mark_wanted(const Selection& selection);
  std::size_t index_set(const SceneEntries& grid, const PerAxis& on_axes) const;
  std::vector<FacetOptics> samples_of(const SceneEntries& grid, std::size_t set) const;
  bool has_films() const { return !samples_.front().front().is_bare(); }
  void request_points(const Selection& selection);
  void request_beams(const Selection& selection);

  const SceneValues& scene_;
  const SpectralIndices& samples_;
  const EffectPlan& plan_;
  const Selection selection_;
  MomentsRequest moments_;
  ScatteringRequest beams_;
  // For a grid, positions in the request: of each theta, sigma and q of the part, and of the first index of each set. A
  // set is the indices of a variant, or one index from the axes n and k.
  std::vector<std::uint32_t> theta_at_, sigma_at_, q_at_, index_set_offset_;
  std::vector<MomentsSpan> spans_of_points_;  ///< positions of the moments of each point of a list
  std::vector<std::size_t> first_beam_;
};

/// The responses from which a run combines the moments of its many indices. Their error meets the tolerance of the
/// scene; tighter levels refine only the quadrature. Their choice follows from the whole grid, even for a part of it.
/// Null if responses save nothing: for a grid with few entries per index, for points that mostly differ in direction or
/// slope distribution, for few indices, with several bounces, and for a scene without interpolation.
std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan);

}  // namespace dolp
