// From the kernel's doubts to error bounds: how far an error may exceed the doubt of its rules.
//
// log10 of the factor is linear in features of the entry and of its doubt, with coefficients that are linear in the
// digits of the rule between a few knots. They are the upper envelope of random entries of the whole range:
// host/calibrate/fit_doubts.py finds the lowest such function that no entry exceeds, by linear programming.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "model/moments.hpp"

namespace dolp {

namespace kernel {
struct IndexNode;
struct ShapeNode;
struct ThetaNode;
}  // namespace kernel

/// What a doubt is of: r_i and r_q, or the deficit.
enum class Doubted { kReflected, kDeficit };

inline constexpr std::size_t kDoubtFeatures = 67;
inline constexpr std::size_t kDoubtKnots = 4;

using DoubtFeatures = std::array<double, kDoubtFeatures>;

/// Names of the features, for messages and for the file of the coefficients.
std::span<const std::string_view, kDoubtFeatures> doubt_feature_names();

/// Digits of the rule at which coefficients are given; beyond the first and last they are constant.
std::span<const double, kDoubtKnots> doubt_knots();

/// The factors of one run of the kernel.
class DoubtModel {
 public:
  DoubtModel() = default;
  /// `digits` are those of the rule; the nodes are those of the kernel data.
  DoubtModel(Distribution distribution, Masking masking, double digits, const std::vector<kernel::ThetaNode>& thetas,
             const std::vector<kernel::ShapeNode>& shapes, const std::vector<kernel::IndexNode>& indices);

  /// Error bound over doubt. `relative_doubt`: the doubt over |r_i|, or over the deficit's scale.
  double factor(Doubted doubted, const MomentsEntry& entry, double relative_doubt) const;

  /// What the factor is calibrated with.
  DoubtFeatures features(const MomentsEntry& entry, double relative_doubt) const;

 private:
  static constexpr std::size_t kOwn = 4;
  static constexpr std::size_t kTheta = 8;
  static constexpr std::size_t kShape = 17;
  static constexpr std::size_t kIndex = 11;
  static constexpr std::size_t kPair = kDoubtFeatures - kOwn - kTheta - kShape - kIndex;

  // Logarithms that pairs of nodes need, and the share of the node's own features in the two scores.
  struct Theta {
    double log_cos = 0.0;
    double cos = 0.0;
    double has_line = 0.0;
    std::array<double, kTheta> features{};
    std::array<double, 2> score{};
  };
  struct Shape {
    double log_m = 0.0;
    double log_q = 0.0;
    double cusp_digits = 0.0;
    double is_outside = 0.0;
    std::array<double, kShape> features{};
    std::array<double, 2> score{};
  };
  struct Index {
    double pole_cos = 0.0;
    double is_critical = 0.0;
    double is_nearly_critical = 0.0;
    std::array<double, kIndex> features{};
    std::array<double, 2> score{};
  };

  static Theta theta_of(const kernel::ThetaNode& node);
  Shape shape_of(const kernel::ShapeNode& node) const;
  static Index index_of(const kernel::IndexNode& node);
  std::array<double, kOwn> own_features(double relative_doubt) const;
  std::array<double, kPair> pair_features(const Theta& theta, const Shape& shape, const Index& index) const;

  bool is_cauchy_ = false;
  bool is_smith_cauchy_ = false;
  double digits_ = 0.0;
  std::array<std::array<double, kDoubtFeatures>, 2> coefficients_{};  // at digits_
  std::vector<Theta> thetas_;
  std::vector<Shape> shapes_;
  std::vector<Index> indices_;
};

}  // namespace dolp
