// Sums over the slope samples of all azimuthal orders, for slopes that differ along and across (plan/slope_orders.hpp).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "evaluate/kernel/slope_samples.hpp"
#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// For each order a row of weights, one for each slope. An isotropic distribution has only order 0.
struct OrderWeights {
  OrderWeights(std::size_t orders, std::size_t slopes);
  /// Adds a sector that has the share `share` of the facets at the azimuths +-azimuth and pi +- azimuth.
  void add(const Eigen::ArrayXd& weights, double azimuth, double share);

  Eigen::MatrixXd of;
  double steeper = 0.0;  ///< share of the facets that are steeper than the last slope
};

/// For each order the sums over all slopes: the members of an AzimuthNode and then its columns. `apart`: sums over the
/// pieces of the differences between the finer and the coarser rule.
struct OrderSums {
  Eigen::MatrixXd values;  ///< a column for each order
  Eigen::MatrixXd apart;
  double many = 0.0;         ///< MomentsNode::many
  double steeper = 0.0;      ///< OrderWeights::steeper
  double evaluations = 0.0;  ///< of one entry
};

OrderSums order_sums(const SlopeSamples& samples, const OrderWeights& weights,
                     std::span<const kernel::AzimuthNode> azimuths, std::span<const double> columns,
                     const KernelData& data);

/// The moments if the x axis of the surface has the azimuth `azimuth_deg` in the frame of the viewer. The bounds
/// include the neglected orders.
Moments moments_at_azimuth(const OrderSums& sums, const KernelData& data, const MomentsEntry& entry, double azimuth_deg,
                           double unit_roundoff);

}  // namespace dolp
