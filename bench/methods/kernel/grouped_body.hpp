// The code that native_kernel.cpp and counted_kernel.cpp share. Each defines, before it includes this file, the macro
// DOLP_KERNEL_NAMESPACE, and in that namespace the types real, real2 and real4 and the function as_data. The
// masking and the number of entries per row are template arguments: constants for the compiler, as on a Vulkan device.

#include <algorithm>
#include <array>
#include <bit>

#include "methods/kernel/grouped_kernel.hpp"
#include "plan/kernel_data.hpp"

#undef DOLP_WIDTH
#define DOLP_WIDTH kWidth

namespace dolp::bench::DOLP_KERNEL_NAMESPACE {

#include "physics/prelude.glsl"

template <int kWidth, uint kMasking>
struct Source {
#include "interface.glsl"
#include "physics/all.glsl"

  static constexpr uint kDistribution = DOLP_CAUCHY;
  static constexpr bool kTotalReflection = false;
  static constexpr bool kHasCurves = false;
  static constexpr bool kIsMultiple = false;
  static constexpr bool kHasDirect = false;
  static constexpr bool kHasOrders = false;
  static constexpr uint kColumns = DOLP_COLUMNS_SKY;
  int order_of_nodes = 1;
  std::vector<real2> rule_nodes;
  std::vector<real4> masking_table;

  int largest_order() const { return order_of_nodes; }
  real2 rule_node(int i) const { return rule_nodes[static_cast<std::size_t>(i)]; }
  real2 table_node(int i) const { return rule_node(i); }
  real4 masking_node(uint i) const { return masking_table[i]; }
  void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
};

template <class To, class From>
To narrowed(const From& from) {
  using Numbers = std::array<real, sizeof(To) / sizeof(real)>;
  auto numbers = convert_reals<real, Numbers, double>(from);
  for (real& number : numbers) number = as_data(number);
  return std::bit_cast<To>(numbers);
}

template <int kWidth, uint kMasking>
class Kernel final : public GroupedKernel {
 public:
  using Own = Source<kWidth, kMasking>;

  explicit Kernel(const GroupedWork& work) : work_(work), rule_(narrowed<typename Own::RuleNode>(work.data.rule)) {
    source_.order_of_nodes = work.data.rule_order;
    for (const auto& node : work.data.rule_nodes) source_.rule_nodes.push_back(narrowed<real2>(node));
    for (const auto& shape : work.rows.shapes) shapes_.push_back(narrowed<typename Own::ShapeNode>(shape));
    for (const auto& theta : work.data.thetas) thetas_.push_back(narrowed<typename Own::ThetaNode>(theta));
    for (const auto& index : work.data.indices) indices_.push_back(narrowed<typename Own::IndexNode>(index));
    source_.masking_table.resize(shapes_.size() * Own::kMaskingNodes);
  }

  void build_masking_table(std::size_t shape) override { source_.build_masking_table(shapes_[shape], table(shape)); }

  void run_pieces(std::size_t first, std::span<kernel::MomentsNode> members) override {
    for (std::size_t i = 0; i < members.size() / kWidth; ++i) run_piece(first + i, members.subspan(i * kWidth, kWidth));
  }

 private:
  void run_piece(std::size_t piece, std::span<kernel::MomentsNode> members) {
    const RowPiece& own = work_.pieces[piece];
    const Row& entries = work_.rows.rows[own.row];
    const Chunk& chunk = work_.rows.chunks[entries.chunk];
    const MomentsEntry first = work_.rows.entry(work_.data, entries);
    typename Own::Row row;
    for (std::uint32_t g = 0; g < kWidth; ++g) {
      const std::size_t shape = chunk.first + std::min(g, chunk.count - 1);
      row.shape[g] = shapes_[shape];
      row.table[g] = table(shape);
    }
    const std::uint32_t word = task_word(work_.data.pieces[first.theta], own.piece, chunk.count);
    const auto task = source_.with_slopes(source_.unpack_task(word), thetas_[first.theta]);
    const auto moments = source_.piece_moments(rule_, thetas_[first.theta], row, indices_[first.index], task);
    for (std::size_t g = 0; g < kWidth; ++g) {
      members[g] = convert_reals<double, kernel::MomentsNode, real>(moments.member[g]);
    }
  }

  static uint table(std::size_t shape) { return static_cast<uint>(shape) * Own::kMaskingNodes; }

  const GroupedWork& work_;
  typename Own::RuleNode rule_;
  Own source_;
  std::vector<typename Own::ShapeNode> shapes_;
  std::vector<typename Own::ThetaNode> thetas_;
  std::vector<typename Own::IndexNode> indices_;
};

template <int kWidth>
std::unique_ptr<GroupedKernel> make_kernel(const GroupedWork& work) {
  if (work.data.masking == Masking::kIntegral) return std::make_unique<Kernel<kWidth, DOLP_MASKING_INTEGRAL>>(work);
  return std::make_unique<Kernel<kWidth, DOLP_MASKING_SMITH>>(work);
}

inline std::unique_ptr<GroupedKernel> kernel_for(const GroupedWork& work) {
  return work.rows.width == 1 ? make_kernel<1>(work) : make_kernel<kRowWidth>(work);
}

}  // namespace dolp::bench::DOLP_KERNEL_NAMESPACE
