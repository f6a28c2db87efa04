// The shaders' text as C++ classes of the tests' own, dolp::tested_float::Text and dolp::tested_double::Text, and what
// tests of both precisions share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <type_traits>

#include "model/choices.hpp"

namespace dolp::tested_float {
using real = float;
using real2 = glm::vec2;
using real4 = glm::vec4;
}  // namespace dolp::tested_float

#define DOLP_TEXT_NAMESPACE tested_float
#include "evaluate/text/text_body.hpp"
#undef DOLP_TEXT_NAMESPACE

namespace dolp::tested_double {
using real = double;
using real2 = glm::dvec2;
using real4 = glm::dvec4;
}  // namespace dolp::tested_double

#define DOLP_TEXT_NAMESPACE tested_double
#define DOLP_DOUBLE
#include "evaluate/text/text_body.hpp"
#undef DOLP_DOUBLE
#undef DOLP_TEXT_NAMESPACE

namespace dolp {

/// The number that a text computes with.
template <class Text>
using RealOf = std::remove_const_t<decltype(Text::kPi)>;

/// Spacing of its numbers at 1.
template <class Text>
constexpr double kEpsilon = static_cast<double>(std::numeric_limits<RealOf<Text>>::epsilon());

/// Both texts, for typed test suites.
using Texts = ::testing::Types<tested_float::Text, tested_double::Text>;

struct TextNames {
  template <class Text>
  static std::string GetName(int) {
    return std::is_same_v<RealOf<Text>, float> ? "Float" : "Double";
  }
};

/// Structures of the kernel data in the text's precision.
template <class Text>
typename Text::ThetaNode theta_in(const kernel::ThetaNode& node) {
  return convert_reals<RealOf<Text>, typename Text::ThetaNode, double>(node);
}
template <class Text>
typename Text::ShapeNode shape_in(const kernel::ShapeNode& node) {
  return convert_reals<RealOf<Text>, typename Text::ShapeNode, double>(node);
}
template <class Text>
typename Text::IndexNode index_in(const kernel::IndexNode& node) {
  return convert_reals<RealOf<Text>, typename Text::IndexNode, double>(node);
}
template <class Text>
typename Text::RuleNode rule_in(const kernel::RuleNode& node) {
  return convert_reals<RealOf<Text>, typename Text::RuleNode, double>(node);
}

/// A text with the model and the rules of `data`, and room for the masking table of one shape.
template <class Text>
Text text_for(const KernelData& data) {
  Text text = Text::of(data);
  text.masking_table.resize(Text::kMaskingNodes);
  return text;
}

/// A shape with its table at the first node, as a row of one.
template <class Text>
typename Text::Row row_of(const typename Text::ShapeNode& shape) {
  return {{shape}, {0U}};
}

/// What the masking of a text says of a direction and facets of slope t: 1 - G1 of `integral` or L of smith.
template <class Text>
RealOf<Text> masked(Text& text, const typename Text::ShapeNode& shape, RealOf<Text> cos_theta, RealOf<Text> sin_theta,
                    RealOf<Text> t) {
  const auto row = row_of<Text>(shape);
  const auto of_direction = text.masking_of_direction(row, cos_theta, sin_theta);
  return (text.kMasking == DOLP_MASKING_INTEGRAL ? text.shadows(row, of_direction, cos_theta, sin_theta, t)
                                                 : of_direction)
      .value[0];
}

/// One slope distribution of a test.
struct ShapeCase {
  Distribution distribution;
  double sigma;
  double q;
};

inline std::string name_of(const ShapeCase& shape) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%s sigma %g q %g", name_of(shape.distribution), shape.sigma, shape.q);
  return text.data();
}

/// One entry, at 60 degrees.
inline MomentsRequest request_of(const ShapeCase& shape, Masking masking, const OpticalConstants& index) {
  MomentsRequest request;
  request.distribution = shape.distribution;
  request.masking = masking;
  request.sigma = {shape.sigma};
  request.q = {shape.q};
  request.indices = {index};
  request.theta_deg = {60.0};
  return request;
}

/// The plan's data for one shape and, where a test needs one, one index.
inline KernelData data_of(const ShapeCase& shape, Masking masking, const OpticalConstants& index = {}) {
  return kernel_data(request_of(shape, masking, index));
}

/// The largest value of what a test measures, and where.
struct Worst {
  double value = 0.0;
  std::string where;
  void update(double candidate, const std::string& here) {
    if (candidate <= value) return;
    value = candidate;
    where = here;
  }
};

}  // namespace dolp
