// The text with invocations side by side. With masking tables, whose look-ups each lane has to do alone, it is slower
// than native_text.cpp. Flags of its own, see bench/CMakeLists.txt.
#define DOLP_LANES

#include "bench/text/vector_lanes.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "bench/text/grouped_text.hpp"

#undef DOLP_WIDTH
#define DOLP_WIDTH kWidth

namespace dolp::bench::vector_text {

using real = Real;
using real2 = Vec2<Real>;
using real4 = Vec4<Real>;
using whole = Whole;
using bench::choose;

#include "shaders/physics/prelude.glsl"

template <int kWidth, uint kMasking>
struct Text {
#include "shaders/interface.glsl"
#include "shaders/physics/all.glsl"

  static constexpr uint kDistribution = DOLP_CAUCHY;
  static constexpr bool kTotalReflection = false;
  static constexpr bool kIsMultiple = false;
  static constexpr bool kHasDirect = false;
  int order_of_nodes = 1;
  std::vector<Vec2<float>> rule_nodes;

  int largest_order() const { return order_of_nodes; }
  real2 rule_node(int i) const {
    const Vec2<float> node = rule_nodes[static_cast<std::size_t>(i)];
    return {real(node.x), real(node.y)};
  }
  // There are no tables.
  real4 masking_node(uint) const { return real4(real(0.0)); }
  void store_masking_node(uint, real4) {}
};

template <class Node>
using Nodes = std::array<const Node*, kLanes>;

/// A structure of interface.glsl with a lane for each of `nodes`.
template <class Lanes, class Node>
Lanes side_by_side(const Nodes<Node>& nodes) {
  constexpr std::size_t kCount = sizeof(Node) / sizeof(double);
  std::array<Real, kCount> numbers;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto own = std::bit_cast<std::array<double, kCount>>(*nodes[lane]);
    for (std::size_t i = 0; i < kCount; ++i) numbers[i].v[lane] = static_cast<float>(own[i]);
  }
  return std::bit_cast<Lanes>(numbers);
}

/// One lane of a structure.
template <class Node, class Lanes>
Node lane_of(const Lanes& lanes, std::size_t lane) {
  constexpr std::size_t kCount = sizeof(Node) / sizeof(double);
  const auto numbers = std::bit_cast<std::array<Real, kCount>>(lanes);
  std::array<double, kCount> own;
  for (std::size_t i = 0; i < kCount; ++i) own[i] = static_cast<double>(numbers[i].v[lane]);
  return std::bit_cast<Node>(own);
}

template <int kWidth, uint kMasking>
class Kernel final : public GroupedText {
 public:
  using Own = Text<kWidth, kMasking>;

  explicit Kernel(const GroupedWork& work) : work_(work), alone_(make_native_text(work)) {
    text_.order_of_nodes = work.data.rule_order;
    for (const auto& node : work.data.rule_nodes) {
      text_.rule_nodes.push_back({static_cast<float>(node[0]), static_cast<float>(node[1])});
    }
    rule_ = side_by_side<typename Own::RuleNode>(all_lanes(work.data.rule));
  }

  void build_masking_table(std::size_t) override {}

  void run_pieces(std::size_t first, std::span<kernel::MomentsNode> members) override {
    const std::size_t end = first + members.size() / kWidth;
    for (std::size_t begin = first; begin < end;) {
      std::size_t next = begin + 1;
      while (next < std::min(end, begin + kLanes) && belongs(begin, next)) ++next;
      const auto own = members.subspan((begin - first) * kWidth, (next - begin) * kWidth);
      try {
        run_vector(begin, next - begin, own);
      } catch (const LanesDiffer&) {
        alone_->run_pieces(begin, own);
      }
      begin = next;
    }
  }

 private:
  template <class Node>
  static Nodes<Node> all_lanes(const Node& node) {
    Nodes<Node> nodes;
    nodes.fill(&node);
    return nodes;
  }

  const Row& row_of(std::size_t piece) const { return work_.rows.rows[work_.pieces[piece].row]; }
  std::uint32_t theta_of(std::size_t piece) const { return work_.rows.theta_of(work_.data, row_of(piece)); }

  std::uint32_t word(std::size_t piece) const {
    return task_word(work_.data.pieces[theta_of(piece)], work_.pieces[piece].piece,
                     work_.rows.chunks[row_of(piece).chunk].count);
  }

  /// Whether two pieces may go side by side: they differ in the direction alone.
  bool belongs(std::size_t first, std::size_t next) const {
    return word(first) == word(next) && row_of(first).chunk == row_of(next).chunk &&
           row_of(first).index == row_of(next).index;
  }

  /// Up to kLanes pieces; the lanes left over repeat the last of them.
  __attribute__((flatten)) void run_vector(std::size_t first, std::size_t count,
                                           std::span<kernel::MomentsNode> members) {
    const Chunk& chunk = work_.rows.chunks[row_of(first).chunk];
    Nodes<kernel::ThetaNode> thetas;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      thetas[lane] = &work_.data.thetas[theta_of(first + std::min(lane, count - 1))];
    }
    typename Own::Row row;
    for (std::uint32_t g = 0; g < kWidth; ++g) {
      const kernel::ShapeNode& shape = work_.rows.shapes[chunk.first + std::min(g, chunk.count - 1)];
      row.shape[g] = side_by_side<typename Own::ShapeNode>(all_lanes(shape));
      row.table[g] = 0;
    }
    const auto theta = side_by_side<typename Own::ThetaNode>(thetas);
    const auto index = side_by_side<typename Own::IndexNode>(all_lanes(work_.data.indices[row_of(first).index]));
    const auto moments =
        text_.piece_moments(rule_, theta, row, index, text_.with_slopes(text_.task_of(word(first)), theta));
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t g = 0; g < kWidth; ++g) {
        members[lane * kWidth + g] = lane_of<kernel::MomentsNode>(moments.member[g], lane);
      }
    }
  }

  const GroupedWork& work_;
  std::unique_ptr<GroupedText> alone_;
  typename Own::RuleNode rule_;
  Own text_;
};

template <int kWidth>
std::unique_ptr<GroupedText> make_text(const GroupedWork& work) {
  if (work.data.masking == Masking::kNone) return std::make_unique<Kernel<kWidth, DOLP_MASKING_NONE>>(work);
  return std::make_unique<Kernel<kWidth, DOLP_MASKING_V_CAVITY>>(work);
}

}  // namespace dolp::bench::vector_text

namespace dolp::bench {

std::unique_ptr<GroupedText> make_vector_text(const GroupedWork& work) {
  switch (work.rows.width) {
    case 4:
      return vector_text::make_text<4>(work);
    case 8:
      return vector_text::make_text<8>(work);
    case 16:
      return vector_text::make_text<16>(work);
    default:
      return vector_text::make_text<1>(work);
  }
}

}  // namespace dolp::bench
