#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "plan/weighted_sums.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// further_light() for the entries of a grid. It is computed at a few nodes of each axis and interpolated; but for
/// films and measured reflectances at each wavelength, because of their fringes. Accuracy: a grid and points differ in
/// bit 32 at less than 1 % of the entries (tests ModelChange_Grid*).
class GrooveTable {
 public:
  /// `grid`: the grid of a run. Runs of other parts of the whole grid get the same values.
  GrooveTable(const SceneValues& scene, const SceneEntries& grid, const SpectralRules& rules);

  /// Nodes of an axis, and for each value of the axis the weights with which values at the nodes add up.
  struct AxisNodes {
    std::vector<double> nodes;
    Eigen::MatrixXd weights;  ///< values of the axis x nodes
  };

  /// ln(i / (1 - i)) and q / (i (1 - i)) for one material, band and wavelength.
  /// Shape: nodes of kOuterAxes x groups x sigma x q.
  struct Block {
    std::size_t groups = 0;
    std::vector<double> logits, quotients;
  };

  /// Reads entries of a part of the grid. It keeps what neighbouring entries share, so each thread needs its own.
  class Reader {
   public:
    Reader(const GrooveTable& table, const SceneEntries& part) : table_(table), part_(part) {}
    /// One value per group of middle_samples(), or one for all groups. Valid until the next call.
    std::span<const FurtherLight> at(std::size_t position);

   private:
    void begin_direction(const PerAxis& on);
    void add_block(const Block& block, double share, const PerAxis& on);
    void begin_row(std::size_t position);

    const GrooveTable& table_;
    const SceneEntries& part_;
    std::optional<PerAxis> direction_;  ///< position of the entries in logits_, on the axes that these depend on
    std::size_t first_ = 0;             ///< position of the first entry of a row, whose entries differ only in q
    std::size_t groups_ = 1;
    Eigen::MatrixXd logits_, quotients_;  ///< as in Block. Shape: (groups x nodes of sigma) x nodes of q
    std::vector<FurtherLight> row_;
  };

 private:
  static constexpr std::array kOuterAxes = {Axis::kN, Axis::kK, Axis::kTheta};

  /// A wavelength of the axis lies between two of wavelength_nodes_, at this share of the way from `node` to the next.
  struct WavelengthPlace {
    std::size_t node = 0;
    double share = 0.0;
  };
  /// The optics of one group at one node of n and k.
  struct GroupOptics {
    std::size_t block = 0;
    std::size_t index_node = 0;  ///< position among the nodes of n and k
    std::size_t group = 0;
    FacetOptics optics;
  };

  std::size_t node_count(std::span<const Axis> axes) const;
  void place_wavelengths(const SceneValues& scene, const SceneEntries& grid);
  /// Gives the last block its size, and appends its optics to `all`.
  void add_optics(const SceneVariant& variant, const SceneEntries& grid, const SpectralRules& rules,
                  std::vector<GroupOptics>& all);
  void fill(const SceneValues& scene, const GroupOptics& own);

  Axis zenith_axis_;  ///< moment_axis() of the scene; its nodes are in axes_[kTheta]
  AxisArray<AxisNodes> axes_;
  std::vector<Block> blocks_;  ///< for each material, for each band, for each of wavelength_nodes_
  std::size_t bands_ = 1;
  std::vector<std::size_t> wavelength_nodes_;  ///< positions on the axis; {0} if the grid has no wavelengths
  std::vector<WavelengthPlace> wavelengths_;   ///< for each value of the axis
};

}  // namespace dolp
