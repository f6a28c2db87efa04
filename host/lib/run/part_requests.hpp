// A run's requests to the evaluator for a part of its entries, and the position of each entry's answer.
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

/// The zenith that an entry's moments depend on: in bistatic mode the zenith of the view.
double moment_zenith_deg(const SceneValues& scene, double theta_deg);

bool wants_moments(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// True where the evaluator must compute the beam of an entry: not for a mirror, nor with source and view both at 90
/// degrees.
bool wants_beam(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// The beam of an entry that needs no evaluator: a mirror reflects only toward its specular direction, where the
/// radiance is not defined, as it is not with source and view both at 90 degrees.
Scattered beam_without_evaluator(const SceneValues& scene, double theta_deg);

/// The indices at which a scene needs moments, for each variant among its entries.
using SpectralIndices = std::vector<std::vector<FacetOptics>>;
SpectralIndices spectral_indices(const SceneValues& scene, const SceneEntries& entries);

/// Samples with another medium under their films. Bare samples become equal, so that one is returned.
std::vector<FacetOptics> with_index(const std::vector<FacetOptics>& samples,
                                    const std::optional<OpticalConstants>& index);

/// The requests of one level for a selection. For a grid the moments form a grid again. It has the directions (in
/// bistatic mode the view) and indices of the selection, and all slope distributions, so that the result of an entry
/// does not depend on the entries selected in other directions. Points share moments if they differ only in values that
/// the moments do not depend on.
class PartRequests {
 public:
  PartRequests(const SceneValues& scene, const SpectralIndices& samples, const EffectPlan& plan,
               const Selection& selection, const RefinementLevel& level);

  const MomentsRequest& moments() const { return moments_; }
  const ScatteringRequest& beams() const { return beams_; }

  /// The position of a member's moments in the answer: `first + j * stride` for spectral sample j.
  struct MomentsSpan {
    std::size_t first = 0;
    std::size_t stride = 0;
  };
  MomentsSpan moments_of(std::size_t member) const;
  /// For a grid: the request's direction from which a member has its moments.
  std::size_t direction_of(std::size_t member) const;
  /// The first of its beams, one for each sample.
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
  // For a grid: the position in the request of each value of the part's axes, and of the first index of each set: the
  // indices of a variant, or one index of n and k.
  std::vector<std::uint32_t> theta_at_, sigma_at_, q_at_, index_set_offset_;
  std::vector<MomentsSpan> spans_of_points_;  ///< one for each point of a list
  std::vector<std::size_t> first_beam_;
};

/// Responses from which a run combines the moments of its many indices, at the tolerance of the scene: tighter levels
/// are for the quadrature. They follow from the whole grid, even if the entries are a part of it.
///
/// Null where a basis saves nothing: for a grid with few entries of each index, points that mostly differ in direction
/// or slope distribution, few indices, many bounces, and for a scene without interpolation.
std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan);

}  // namespace dolp
