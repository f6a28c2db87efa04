#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "base/parallel_ranges.hpp"
#include "plan/kernel_data.hpp"

namespace dolp::vulkan {

template <class Node>
constexpr std::size_t real_count() {
  static_assert(std::is_standard_layout_v<Node> && alignof(Node) == alignof(double));
  return sizeof(Node) / sizeof(double);
}

class Packing {
 public:
  explicit Packing(bool float64) : float64_(float64) {}

  std::size_t real_bytes() const { return float64_ ? sizeof(double) : sizeof(float); }
  template <class Node>
  std::size_t node_bytes() const {
    return real_count<Node>() * real_bytes();
  }
  /// Bytes of the result of one invocation: one Node and `numbers` reals.
  template <class Node>
  std::size_t output_bytes(std::size_t numbers) const {
    return node_bytes<Node>() + numbers * real_bytes();
  }
  std::size_t masking_nodes() const {
    return float64_ ? DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE)
                    : DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_FLOAT);
  }
  /// Texel formats of rule nodes (2 reals) and masking nodes (4 reals). A double is 2 uints: no format has doubles.
  VkFormat rule_texels() const { return float64_ ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32_SFLOAT; }
  VkFormat masking_texels() const { return float64_ ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT; }
  std::size_t texels_of_table() const { return masking_nodes() * (float64_ ? 2 : 1); }

  /// Fills `bytes` with make_node(0), ..., make_node(count - 1). All cores call make_node, in any order. Numbers beyond
  /// the range of float become infinite.
  template <class NodeOf>
  void pack(std::size_t count, const NodeOf& make_node, std::vector<std::byte>& bytes) const {
    constexpr std::size_t kNodesAtOnce = 8192;
    const std::size_t each = node_bytes<std::decay_t<decltype(make_node(0))>>();
    bytes.resize(count * each);
    parallel_ranges(count, kNodesAtOnce, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) write(make_node(i), std::span(bytes).subspan(i * each, each));
    });
  }

  template <class Node>
  Node read(std::span<const std::byte> bytes, std::size_t position) const {
    const std::span<const std::byte> source = bytes.subspan(position * node_bytes<Node>(), node_bytes<Node>());
    return float64_ ? read_as<double, Node>(source) : read_as<float, Node>(source);
  }

  void read_numbers(std::span<const std::byte> bytes, std::size_t offset, std::span<double> numbers) const {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::span<const std::byte> source = bytes.subspan(offset + i * real_bytes(), real_bytes());
      numbers[i] = float64_ ? read_as<double, double>(source) : read_as<float, double>(source);
    }
  }

 private:
  template <class Node>
  void write(const Node& node, std::span<std::byte> room) const {
    if (float64_) {
      write_as<double>(node, room);
    } else {
      write_as<float>(node, room);
    }
  }

  template <class Real, class Node>
  static void write_as(const Node& node, std::span<std::byte> room) {
    const auto numbers = convert_reals<Real, std::array<Real, real_count<Node>()>, double>(node);
    std::memcpy(room.data(), numbers.data(), sizeof numbers);
  }

  template <class Real, class Node>
  static Node read_as(std::span<const std::byte> source) {
    std::array<Real, real_count<Node>()> numbers{};
    std::memcpy(numbers.data(), source.data(), source.size());
    return convert_reals<double, Node, Real>(numbers);
  }

  bool float64_;
};

}  // namespace dolp::vulkan
