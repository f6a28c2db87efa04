#include "evaluate/kernel/order_sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "beams/in_plane_masking.hpp"
#include "model/angles.hpp"

namespace dolp {
namespace {

using Eigen::Index;

constexpr Index kMembers = sizeof(kernel::AzimuthNode) / sizeof(double);
constexpr Index kNumbersOfColumn = 3;  // i, q and u

Index to_index(std::size_t number) { return static_cast<Index>(number); }

/// The position of a member in AzimuthNode.
Index row(double kernel::AzimuthNode::*member) {
  kernel::AzimuthNode node{};
  node.*member = 1.0;
  const auto numbers = std::bit_cast<std::array<double, kMembers>>(node);
  return std::ranges::find(numbers, 1.0) - numbers.begin();
}

/// Sums at one azimuth of the surface: order k has the factor cos(2 k azimuth), or the sine for U.
class AtAzimuth {
 public:
  AtAzimuth(const OrderSums& sums, double eccentricity, double azimuth_deg)
      : sums_(sums), eccentricity_(eccentricity), cosines_(sums.values.cols()), sines_(sums.values.cols()) {
    for (Index k = 0; k < cosines_.size(); ++k) {
      const CosSin turn = cos_sin_deg(2.0 * static_cast<double>(k) * azimuth_deg);  // exact at multiples of 90 degrees
      cosines_[k] = turn.cos;
      sines_[k] = turn.sin;
    }
  }

  double even(Index row) const { return sums_.values.row(row) * cosines_; }
  double odd(Index row) const { return sums_.values.row(row) * sines_; }
  double apart(Index row) const { return sums_.apart.row(row).sum(); }
  double neglected(Index row) const {
    const Index last = sums_.values.cols() - 1;
    return neglected_orders(eccentricity_, last > 1 ? sums_.values(row, last - 1) : 0.0, sums_.values(row, last));
  }

 private:
  const OrderSums& sums_;
  double eccentricity_;
  Eigen::VectorXd cosines_, sines_;
};

kernel::MomentsNode moments_node(const OrderSums& sums, const AtAzimuth& at) {
  using Node = kernel::AzimuthNode;
  kernel::MomentsNode node{};
  node.r_i = at.even(row(&Node::r_i));
  node.r_q = at.even(row(&Node::r_q));
  node.albedo = at.even(row(&Node::albedo));
  node.deficit = at.even(row(&Node::deficit));
  node.behind = sums.values(row(&Node::behind), 0);
  node.many = sums.many;
  node.direct_i = at.even(row(&Node::direct_i));
  node.direct_q = at.even(row(&Node::direct_q));
  node.reflected_difference =
      std::max({at.apart(row(&Node::r_i)), at.apart(row(&Node::r_q)), at.apart(row(&Node::r_u))});
  node.albedo_difference = at.apart(row(&Node::albedo));
  node.deficit_difference = at.apart(row(&Node::deficit));
  node.direct_difference =
      std::max({at.apart(row(&Node::direct_i)), at.apart(row(&Node::direct_q)), at.apart(row(&Node::direct_u))});
  return node;
}

void add_neglected(Moments& moments, const AtAzimuth& at) {
  using Node = kernel::AzimuthNode;
  const double q = std::max(at.neglected(row(&Node::r_q)), at.neglected(row(&Node::r_u)));
  const double reflected = std::max(at.neglected(row(&Node::r_i)), at.neglected(row(&Node::deficit)));
  moments.r_i_error += reflected;
  moments.deficit_error += reflected;
  moments.r_q_error += q;
  moments.albedo_error += at.neglected(row(&Node::albedo));
  moments.direct_i_error += at.neglected(row(&Node::direct_i));
  moments.direct_q_error += std::max(at.neglected(row(&Node::direct_q)), at.neglected(row(&Node::direct_u)));
}

// The emission of the facets that smith masking lets the viewer see. The masking is one factor for all facets.
Moments direct_part(const Moments& facets, const KernelData& data, const MomentsEntry& entry) {
  const kernel::ThetaNode& theta = data.thetas[entry.theta];
  const SlopeShape shape = in_view_plane(data.slopes[entry.shape]);
  const double masking = InPlaneMasking(data.distribution, Masking::kSmith, shape).smith_toward({theta.c, theta.s});
  Moments moments{.deficit = theta.c, .evaluations = facets.evaluations};
  for (const auto member :
       {&Moments::direct_i, &Moments::direct_q, &Moments::direct_u, &Moments::direct_i_error, &Moments::direct_q_error})
    moments.*member = masking * facets.*member;
  return moments;
}

}  // namespace

OrderWeights::OrderWeights(std::size_t orders, std::size_t slopes)
    : of(Eigen::MatrixXd::Zero(to_index(orders), to_index(slopes))) {}

void OrderWeights::add(const Eigen::ArrayXd& weights, double azimuth, double share) {
  for (Index k = 0; k < of.rows(); ++k) {
    const double coefficient = k == 0 ? 1.0 : 2.0 * std::cos(2.0 * static_cast<double>(k) * azimuth);
    of.row(k) += share * coefficient * weights.matrix().transpose();
  }
}

OrderSums order_sums(const SlopeSamples& samples, const OrderWeights& weights,
                     std::span<const kernel::AzimuthNode> azimuths, std::span<const double> columns,
                     const KernelData& data) {
  const Index slopes = to_index(samples.slopes.size());
  const Index orders = weights.of.rows();
  const Index per_slope = to_index(column_azimuths(data));
  OrderSums sums{.values = Eigen::MatrixXd::Zero(kMembers + per_slope, orders),
                 .apart = Eigen::MatrixXd::Zero(kMembers + per_slope, orders),
                 .steeper = weights.steeper};
  for (Index k = 0; k < orders; ++k) {
    const Eigen::Map<const Eigen::MatrixXd> members(&azimuths[static_cast<std::size_t>(k * slopes)].r_i, kMembers,
                                                    slopes);
    const Eigen::Map<const Eigen::MatrixXd> column_samples(columns.data() + k * slopes * per_slope, per_slope, slopes);
    sums.evaluations += members.row(row(&kernel::AzimuthNode::evaluations)).sum();
    const auto sum_of_rule = [&](std::uint32_t first, std::uint32_t count) -> Eigen::VectorXd {
      const auto rule_weights = weights.of.row(k).segment(first, count).transpose();
      Eigen::VectorXd sum(kMembers + per_slope);
      sum << members.middleCols(first, count) * rule_weights, column_samples.middleCols(first, count) * rule_weights;
      return sum;
    };
    for (const SampledPiece& piece : samples.pieces) {
      const Eigen::VectorXd fine = sum_of_rule(piece.first, piece.fine);
      sums.values.col(k) += fine;
      sums.apart.col(k) += (fine - sum_of_rule(piece.first + piece.fine, piece.coarse)).cwiseAbs();
      if (k == 0 && piece.end > slope_with_bounces(DOLP_MOST_BOUNCES))
        sums.many += fine[row(&kernel::AzimuthNode::r_i)];
    }
  }
  return sums;
}

Moments moments_at_azimuth(const OrderSums& sums, const KernelData& data, const MomentsEntry& entry, double azimuth_deg,
                           double unit_roundoff) {
  const AtAzimuth at(sums, eccentricity(data.slopes[entry.shape]), azimuth_deg);
  kernel::MomentsNode node = moments_node(sums, at);
  node.deficit += data.thetas[entry.theta].c * sums.steeper;
  node.evaluations = sums.evaluations;
  std::vector<double> columns;
  for (std::size_t i = 0; i < data.column_count(); ++i) {
    const Index first = kMembers + kNumbersOfColumn * to_index(i);
    const double apart = std::max({at.apart(first), at.apart(first + 1), at.apart(first + 2)});
    columns.insert(columns.end(), {at.even(first), at.even(first + 1), apart, 0.0});
  }
  Moments moments = moments_from_kernel(node, data, entry, unit_roundoff, columns);
  moments.r_u = at.odd(row(&kernel::AzimuthNode::r_u));
  if (data.has_direct) moments.direct_u = at.odd(row(&kernel::AzimuthNode::direct_u));
  add_neglected(moments, at);
  for (std::size_t i = 0; i < data.column_count(); ++i) {
    const Index first = kMembers + kNumbersOfColumn * to_index(i);
    moments.columns[i].u = at.odd(first + 2);
    moments.columns[i].error += std::max({at.neglected(first), at.neglected(first + 1), at.neglected(first + 2)});
  }
  return data.has_only_direct ? direct_part(moments, data, entry) : moments;
}

}  // namespace dolp
