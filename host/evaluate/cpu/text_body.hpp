// Body of text_float.cpp and text_double.cpp, which define DOLP_TEXT_NAMESPACE, real, real2 and real4 first.

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <vector>

#include "evaluate/cpu/text.hpp"
#include "plan/convert_reals.hpp"

namespace dolp::DOLP_TEXT_NAMESPACE {

using glm::abs;
using glm::clamp;
using glm::floatBitsToUint;
using glm::floor;
using glm::frexp;
using glm::ldexp;
using glm::max;
using glm::min;
using glm::mod;
using glm::sqrt;
using glm::uint;
using glm::uintBitsToFloat;

#include "shaders/physics/prelude.glsl"

/// The text as the body of a class; buffers and specialization constants are its members.
struct Text {
#include "shaders/interface.glsl"
#include "shaders/physics/all.glsl"

  uint kDistribution = DOLP_CAUCHY;
  uint kMasking = DOLP_MASKING_NONE;
  std::vector<real4> rule_nodes;
  std::vector<real4> masking_table;

  real4 rule_node(int i) const { return rule_nodes[static_cast<std::size_t>(i)]; }
  real4 masking_node(uint i) const { return masking_table[i]; }
  void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
};

class TextKernel final : public KernelText {
 public:
  explicit TextKernel(const KernelData& data)
      : data_(data), rule_(convert_reals<real, Text::RuleNode, double>(data.rule)) {
    text_.kDistribution = static_cast<uint>(data.distribution);
    text_.kMasking = static_cast<uint>(data.masking);
    for (const auto& node : data.rule_nodes) text_.rule_nodes.push_back(convert_reals<real, real4, double>(node));
    if (data.needs_masking_table()) text_.masking_table.resize(data.shapes.size() * Text::kMaskingNodes);
  }

  void build_masking_table(std::size_t shape) override { text_.build_masking_table(shape_node(shape), table(shape)); }

  kernel::MomentsNode moments(const MomentsEntry& entry) override {
    const auto node = text_.moments_entry(
        rule_, convert_reals<real, Text::ThetaNode, double>(data_.thetas[entry.theta]), shape_node(entry.shape),
        convert_reals<real, Text::IndexNode, double>(data_.indices[entry.index]), table(entry.shape));
    return convert_reals<double, kernel::MomentsNode, real>(node);
  }

  kernel::MuellerNode mueller(const kernel::BeamNode& beam) override {
    const auto node = text_.mueller(convert_reals<real, Text::BeamNode, double>(beam));
    return convert_reals<double, kernel::MuellerNode, real>(node);
  }

 private:
  static uint table(std::size_t shape) { return static_cast<uint>(shape * Text::kMaskingNodes); }

  Text::ShapeNode shape_node(std::size_t shape) const {
    return convert_reals<real, Text::ShapeNode, double>(data_.shapes[shape]);
  }

  const KernelData& data_;
  Text::RuleNode rule_;
  Text text_;
};

}  // namespace dolp::DOLP_TEXT_NAMESPACE
