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
  std::vector<real2> rule_nodes;
  std::vector<real4> masking_table;

  real2 rule_node(int i) const { return rule_nodes[static_cast<std::size_t>(i)]; }
  real4 masking_node(uint i) const { return masking_table[i]; }
  void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
};

class TextKernel final : public KernelText {
 public:
  explicit TextKernel(const KernelData& data) : data_(data) {
    text_.kDistribution = static_cast<uint>(data.distribution);
    text_.kMasking = static_cast<uint>(data.masking);
    for (const auto& [abscissa, weight] : data.rule_nodes) {
      text_.rule_nodes.emplace_back(static_cast<real>(abscissa), static_cast<real>(weight));
    }
    if (data.needs_masking_table()) text_.masking_table.resize(data.shapes.size() * DOLP_MASKING_NODES);
  }

  void build_masking_table(std::size_t shape) override {
    text_.build_masking_table(shape_node(shape), static_cast<uint>(shape * DOLP_MASKING_NODES));
  }

  kernel::MomentsNode moments(const MomentsEntry& entry) override {
    const auto node = text_.moments_entry(convert_reals<real, Text::ThetaNode, double>(data_.thetas[entry.theta]),
                                          shape_node(entry.shape),
                                          convert_reals<real, Text::IndexNode, double>(data_.indices[entry.index]),
                                          entry.shape * DOLP_MASKING_NODES);
    return convert_reals<double, kernel::MomentsNode, real>(node);
  }

  kernel::MuellerNode mueller(const kernel::GeometryNode& geometry, std::size_t shape, std::size_t index) override {
    const auto node = text_.mueller(convert_reals<real, Text::GeometryNode, double>(geometry), shape_node(shape),
                                    convert_reals<real, Text::IndexNode, double>(data_.indices[index]),
                                    static_cast<uint>(shape * DOLP_MASKING_NODES));
    return convert_reals<double, kernel::MuellerNode, real>(node);
  }

 private:
  Text::ShapeNode shape_node(std::size_t shape) const {
    return convert_reals<real, Text::ShapeNode, double>(data_.shapes[shape]);
  }

  const KernelData& data_;
  Text text_;
};

}  // namespace dolp::DOLP_TEXT_NAMESPACE
