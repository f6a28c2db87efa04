// The text with a vector in place of each number, 16 invocations at a time: what lavapipe makes of a shader, by the C++
// compiler. Only maskings without tables, where it is faster than native_text.cpp; flags of its own, see
// CMakeLists.txt.
#include "bench/text/vector_lanes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "bench/text/grouped_text.hpp"

#undef DOLP_GROUP
#define DOLP_GROUP kGroup
#define INOUT(Type) Type&
#define precise

namespace dolp::bench::vector_text {

using real = Real;
using real2 = Real2;
using real4 = Real4;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // branches within branches
#pragma GCC diagnostic ignored "-Wconversion"
template <int kGroup, std::uint32_t kMasking>
struct Text {
#include "shaders/interface.glsl"
#include "vectorised_text.glsl"

  static constexpr std::uint32_t kDistribution = DOLP_CAUCHY;
  std::vector<Vec4<float>> rule_nodes;

  real4 rule_node(Int i) const { return gathered(rule_nodes.data(), i); }
  real4 masking_node(Uint) const { return real4(real(0.0)); }  // there are no tables
};
#pragma GCC diagnostic pop

/// The place of one lane of number `i` in a structure of numbers.
template <class Lanes>
auto lane_place(Lanes& lanes, std::size_t i, std::size_t lane) {
  using Byte = std::conditional_t<std::is_const_v<Lanes>, const std::byte, std::byte>;
  return reinterpret_cast<Byte*>(&lanes) + (i * kLanes + lane) * sizeof(float);
}

/// Writes a structure of interface.glsl to one lane of the same structure here.
template <class Lanes, class Node>
void set_lane(Lanes& lanes, const Node& node, std::size_t lane) {
  constexpr std::size_t kCount = sizeof(Node) / sizeof(double);
  static_assert(sizeof(Lanes) == kCount * sizeof(Real));
  const auto numbers = std::bit_cast<std::array<double, kCount>>(node);
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto number = static_cast<float>(numbers[i]);
    std::memcpy(lane_place(lanes, i, lane), &number, sizeof number);
  }
}

template <class Node, class Lanes>
Node lane_of(const Lanes& lanes, std::size_t lane) {
  constexpr std::size_t kCount = sizeof(Node) / sizeof(double);
  static_assert(sizeof(Lanes) == kCount * sizeof(Real));
  std::array<double, kCount> numbers;
  for (std::size_t i = 0; i < kCount; ++i) {
    float number;
    std::memcpy(&number, lane_place(lanes, i, lane), sizeof number);
    numbers[i] = static_cast<double>(number);
  }
  return std::bit_cast<Node>(numbers);
}

template <int kGroup, std::uint32_t kMasking>
class Kernel final : public GroupedText {
 public:
  using Own = Text<kGroup, kMasking>;

  explicit Kernel(const GroupedWork& work) : work_(work) {
    all_lanes();
    for (const auto& node : work.data.rule_nodes) {
      text_.rule_nodes.push_back({static_cast<float>(node[0]), static_cast<float>(node[1]), static_cast<float>(node[2]),
                                  static_cast<float>(node[3])});
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) set_lane(rule_, work.data.rule, lane);
  }

  void build_masking_table(std::size_t) override {}

  void run_pieces(std::size_t first, std::span<kernel::MomentsNode> members) override {
    const std::size_t end = first + members.size() / kGroup;
    for (std::size_t begin = first; begin < end;) {
      std::size_t next = begin + 1;
      while (next < std::min(end, begin + kLanes) && work_.pieces[next].piece == work_.pieces[begin].piece) ++next;
      run_vector(begin, next - begin, members.subspan((begin - first) * kGroup, (next - begin) * kGroup));
      begin = next;
    }
  }

 private:
  static void all_lanes() {
    active = ~Ints{};
    retired = Ints{};
  }

  /// Up to kLanes pieces of one number; the lanes left over repeat the last of them.
  __attribute__((flatten)) void run_vector(std::size_t first, std::size_t count,
                                           std::span<kernel::MomentsNode> members) {
    all_lanes();
    typename Own::ThetaNode theta;
    typename Own::IndexNode index;
    typename Own::Group shapes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const GroupPiece& own = work_.pieces[first + std::min(lane, count - 1)];
      const EntryGroup& group = work_.grouping.groups[own.group];
      const ShapeFamily& family = work_.grouping.families[group.family];
      set_lane(theta, work_.data.thetas[group.theta], lane);
      set_lane(index, work_.data.indices[group.index], lane);
      for (std::uint32_t g = 0; g < kGroup; ++g) {
        set_lane(shapes.shape[g], work_.grouping.shapes[family.first + std::min(g, family.count - 1)], lane);
      }
    }
    for (Uint& table : shapes.table) table = Uint(0U);
    const auto moments = text_.piece_moments(rule_, theta, shapes, index, static_cast<int>(work_.pieces[first].piece));
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t g = 0; g < kGroup; ++g) {
        members[lane * kGroup + g] = lane_of<kernel::MomentsNode>(moments.member[g], lane);
      }
    }
  }

  const GroupedWork& work_;
  typename Own::RuleNode rule_;
  Own text_;
};

template <int kGroup>
std::unique_ptr<GroupedText> make_text(const GroupedWork& work) {
  if (work.data.masking == Masking::kNone) return std::make_unique<Kernel<kGroup, DOLP_MASKING_NONE>>(work);
  return std::make_unique<Kernel<kGroup, DOLP_MASKING_V_CAVITY>>(work);
}

}  // namespace dolp::bench::vector_text

namespace dolp::bench {

std::unique_ptr<GroupedText> make_vector_text(const GroupedWork& work) {
  switch (work.grouping.size) {
    case 4: return vector_text::make_text<4>(work);
    case 8: return vector_text::make_text<8>(work);
    case 16: return vector_text::make_text<16>(work);
    default: return vector_text::make_text<1>(work);
  }
}

}  // namespace dolp::bench
