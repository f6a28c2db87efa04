#include "plan/sky_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

#include "model/angles.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

static_assert(kMostSkyFunctions == DOLP_SKY_FUNCTIONS);

double zenith_deg_at(double u) {
  return std::min(2.0 * std::asin(std::min(u * std::numbers::sqrt2 / 2.0, 1.0)) * 180.0 / std::numbers::pi, 90.0);
}

double u_at(double zenith_deg) { return std::numbers::sqrt2 * std::sin(0.5 * zenith_deg * std::numbers::pi / 180.0); }

Eigen::RowVectorXd values_at(const SkyBasis& basis, double u) { return basis.at(zenith_deg_at(u)); }

/// Values of the basis at the ends of all cells, and in their middles. Doubling the cells keeps the known values.
class Cells {
 public:
  Cells(const SkyBasis& basis, std::uint32_t count) : basis_(basis), ends_(at(0.0, count + 1, count)) { add_middles(); }

  const Eigen::MatrixXd& ends() const { return ends_; }

  void divide() {
    Eigen::MatrixXd all(ends_.rows() + middles_.rows(), ends_.cols());
    for (Eigen::Index i = 0; i < ends_.rows(); ++i) all.row(2 * i) = ends_.row(i);
    for (Eigen::Index i = 0; i < middles_.rows(); ++i) all.row(2 * i + 1) = middles_.row(i);
    ends_ = std::move(all);
    add_middles();
  }

  /// For each function, the largest error of straight lines between the ends of the cells.
  Eigen::RowVectorXd middle_distances() const {
    const Eigen::Index cells = middles_.rows();
    const Eigen::MatrixXd lines = 0.5 * ends_.topRows(cells) + 0.5 * ends_.bottomRows(cells);
    return (lines - middles_).cwiseAbs().colwise().maxCoeff();
  }

 private:
  Eigen::MatrixXd at(double shift, Eigen::Index count, Eigen::Index cells) const {
    Eigen::MatrixXd values(count, static_cast<Eigen::Index>(basis_.size()));
    for (Eigen::Index i = 0; i < count; ++i)
      values.row(i) = values_at(basis_, (static_cast<double>(i) + shift) / static_cast<double>(cells));
    return values;
  }
  void add_middles() { middles_ = at(0.5, ends_.rows() - 1, ends_.rows() - 1); }

  const SkyBasis& basis_;
  Eigen::MatrixXd ends_;
  Eigen::MatrixXd middles_;
};

/// Error of the table at u, for each function: the table is a straight line between the ends of a cell.
Eigen::RowVectorXd distances_at(const SkyBasis& basis, double u, double cells) {
  const double position = std::clamp(u * cells, 0.0, cells);
  const double cell = std::min(std::floor(position), cells - 1.0);
  const double share = position - cell;
  const Eigen::RowVectorXd line =
      (1.0 - share) * values_at(basis, cell / cells) + share * values_at(basis, (cell + 1.0) / cells);
  return (line - values_at(basis, u)).cwiseAbs();
}

Eigen::RowVectorXd corner_distances(const SkyBasis& basis, double cells) {
  Eigen::RowVectorXd largest = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(basis.size()));
  for (const double end_deg : basis.nodes().ends_deg())
    largest = largest.cwiseMax(distances_at(basis, u_at(end_deg), cells));
  return largest;
}

struct Corner {
  double zenith_deg = 0.0;
  Eigen::RowVectorXd bend;  // for each function, the jump of its slope df/du
};

std::vector<Corner> sky_corners(const SkyBasis& basis) {
  constexpr double kStep = 1e-4;
  std::vector<Corner> corners;
  const std::vector<double>& ends_deg = basis.nodes().ends_deg();
  for (std::size_t i = 1; i + 1 < ends_deg.size(); ++i) {
    const double u = u_at(ends_deg[i]);
    const double step = kStep * std::min(u - u_at(ends_deg[i - 1]), u_at(ends_deg[i + 1]) - u);
    const Eigen::RowVectorXd before = values_at(basis, u - step);
    const Eigen::RowVectorXd after = values_at(basis, u + step);
    const Eigen::RowVectorXd bend = (after - 2.0 * values_at(basis, u) + before) / step;
    if (bend.cwiseAbs().maxCoeff() > kLeastBend) corners.push_back({ends_deg[i], bend});
  }
  std::ranges::sort(corners, std::ranges::greater(),
                    [](const Corner& corner) { return corner.bend.cwiseAbs().maxCoeff(); });
  return corners;
}

Eigen::RowVectorXd bend_norms(std::span<const Corner> corners, Eigen::Index functions) {
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(functions);
  for (const Corner& corner : corners) squares += corner.bend.cwiseAbs2();
  return squares.cwiseSqrt();
}

/// How many corners, the sharpest first, must split the azimuths so that the remaining corners have little effect.
std::size_t split_corners(std::span<const Corner> corners, Eigen::Index functions, double tolerance) {
  const std::size_t most = std::min<std::size_t>(corners.size(), DOLP_MOST_SKY_CORNERS);
  std::size_t split = 0;
  while (split < most && bend_norms(corners.subspan(split), functions).maxCoeff() > kMostBends * tolerance) ++split;
  return split;
}

}  // namespace

std::uint32_t SkyTable::word() const {
  return count == 0 ? 0U : start << DOLP_SKY_START_SHIFT | corners << DOLP_SKY_CORNERS_SHIFT | log2_cells;
}

SkyTable append_sky(const SkyBasis& basis, const SkyTolerances& tolerances, bool splits,
                    std::vector<std::array<double, 2>>& nodes) {
  SkyTable table;
  table.count = static_cast<std::uint32_t>(basis.size());
  table.start = static_cast<std::uint32_t>(nodes.size());
  const std::uint32_t most = tolerances.table < kTightSky ? kMostTightSkyCells : kMostSkyCells;
  const double allowed = kSkyTableShare * tolerances.table / kSkyTableSafety;
  std::uint32_t cells = kLeastSkyCells;
  const auto may_double = [&] { return 2 * cells * table.count <= most; };
  while (corner_distances(basis, cells).maxCoeff() > allowed && may_double()) cells *= 2;
  Cells table_cells(basis, cells);
  for (; table_cells.middle_distances().maxCoeff() > allowed && may_double(); cells *= 2) table_cells.divide();
  Eigen::RowVectorXd errors = table_cells.middle_distances();
  errors = kSkyTableSafety * errors.cwiseMax(corner_distances(basis, cells));
  table.log2_cells = static_cast<std::uint32_t>(std::countr_zero(cells));
  const Eigen::MatrixXd& ends = table_cells.ends();
  table.has_cusp = splits && (ends.row(1) - ends.row(0)).cwiseAbs().maxCoeff() * cells > kLeastBend;
  std::vector<Corner> corners = sky_corners(basis);
  const auto split = static_cast<std::ptrdiff_t>(splits ? split_corners(corners, ends.cols(), tolerances.integral) : 0);
  table.corners = static_cast<std::uint32_t>(split);
  const Eigen::RowVectorXd bends = bend_norms(std::span(corners).subspan(static_cast<std::size_t>(split)), ends.cols());
  for (Eigen::Index k = 0; k < ends.cols(); ++k) {
    table.bends.push_back(bends[k]);
    for (Eigen::Index i = 0; i + 1 < ends.rows(); ++i) nodes.push_back({ends(i, k), ends(i + 1, k) - ends(i, k)});
    table.error.push_back(errors[k]);
    table.steepness.push_back(std::abs(ends(1, k) - ends(0, k)) * static_cast<double>(ends.rows() - 1));
  }
  for (std::ptrdiff_t i = 0; i < split; ++i)
    table.corners_deg.push_back(corners[static_cast<std::size_t>(i)].zenith_deg);
  std::ranges::sort(corners.begin(), corners.begin() + split, {}, &Corner::zenith_deg);
  for (auto corner = corners.begin(); corner != corners.begin() + split; ++corner)
    nodes.push_back({cos_sin_deg(corner->zenith_deg).cos, 0.0});
  return table;
}

}  // namespace dolp
