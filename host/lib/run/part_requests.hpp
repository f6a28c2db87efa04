#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// All or some entries of one part of a run. The functions take a `member`: the number of an entry in the selection.
struct Selection {
  const SceneEntries& part;
  std::span<const std::size_t> chosen = {};  ///< position of each member in the part; empty: all entries are selected

  bool is_whole_grid() const { return part.is_grid() && chosen.empty(); }
  std::size_t size() const { return chosen.empty() ? part.size() : chosen.size(); }
  std::size_t position(std::size_t member) const { return chosen.empty() ? member : chosen[member]; }
  SceneEntry operator[](std::size_t member) const { return part[position(member)]; }
};

/// The axis of a grid that has the zeniths of the moments: in bistatic mode the view, otherwise theta.
Axis moment_axis(const SceneModel& scene);

/// True if a grid with so many values on its axes has enough entries per index to use responses (see run_basis).
bool is_worth_responses(const SceneModel& scene, const PerAxis& counts);

bool wants_moments(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// True if the specular pBRDF of an entry needs an evaluator; otherwise beam_without_evaluator() gives it.
bool wants_beam(const SceneValues& scene, const SceneEntry& entry, const EffectPlan& plan);

/// The specular pBRDF of an entry for which wants_beam() is false. It is NaN in the specular direction of a mirror, and
/// if source and view are both at 90 degrees. Otherwise it is 0.
Scattered beam_without_evaluator(const SceneValues& scene, const SceneEntry& entry);

/// For each variant (material, band, wavelength or temperature) of the entries: n and k at each spectral sample.
using SpectralIndices = std::vector<std::vector<FacetOptics>>;
SpectralIndices spectral_indices(const EffectPlan& plan, const SceneEntries& entries);

/// Replaces n and k of the surface by `index` in each of `samples`, and keeps the films. If there are no films, all
/// samples become equal, so the result has only one. An empty `index` replaces nothing.
std::vector<FacetOptics> with_index(const std::vector<FacetOptics>& samples,
                                    const std::optional<OpticalConstants>& index);

/// The requests to an evaluator for a selection of entries at one refinement level. Entries with equal direction, slope
/// distribution and index share moments.
class PartRequests {
 public:
  PartRequests(const SceneValues& scene, const SpectralIndices& samples, const EffectPlan& plan,
               const Selection& selection, const RefinementLevel& level);

  const MomentsRequest& moments() const { return moments_; }
  const ScatteringRequest& beams() const { return beams_; }

  /// Where the evaluator returns the moments of a member of the selection: at `first + j * stride` for wavelength j.
  struct MomentsSpan {
    std::size_t first = 0;
    std::size_t stride = 0;
  };
  /// Domain: wants_moments() of the member's entry. `on_axes`: its axis positions, if the entries are a grid.
  MomentsSpan member_moments(std::size_t member, const PerAxis& on_axes) const;
  /// The position in beams() of the first beam of a member. A member has one beam per wavelength.
  std::size_t first_beam(std::size_t member) const { return first_beam_[member]; }

 private:
  /// Adds the slope distributions of a grid. Requests for some of its entries have them all, because the orders and
  /// nodes for slopes that differ along and across depend on them.
  void request_shapes(const SceneEntries& grid);
  std::uint32_t shape_position(const PerAxis& on_axes) const;
  bool has_films() const { return !samples_.front().front().is_bare(); }
  void request_moments();
  void request_beams();

  const SceneValues& scene_;
  const SpectralIndices& samples_;
  const EffectPlan& plan_;
  const Selection selection_;
  MomentsRequest moments_;
  ScatteringRequest beams_;
  // For a grid: value i of sigma has the number sigma_at_[i] among the values that moments_.shapes have, and so on for
  // q. shape_counts_ has the numbers of values of q, sigma_cross and azimuth.
  std::vector<std::uint32_t> sigma_at_, q_at_;
  PerAxis shape_counts_ = {};
  /// Where the evaluator returns the moments of each member. In a whole grid all members of a direction have one span:
  /// it begins with the first of moments_.shapes.
  std::vector<MomentsSpan> spans_;
  std::size_t members_per_span_ = 1;
  bool members_have_all_shapes_ = false;
  std::vector<std::size_t> first_beam_;
};

/// The responses of a run. A response is a moment with a polynomial instead of the reflectance. The moments of many
/// indices are weighted sums of a few responses. Each part of a grid uses the responses of the whole grid. Null if the
/// run integrates the moments themselves, for example because it has few indices or follows several bounces.
std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan);

}  // namespace dolp
