// Divides a request into dispatches. Calls no Vulkan function, so it can also count dispatches without a device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "device/devices.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "plan/rows.hpp"

namespace dolp::vulkan {

using MaskingNode = std::array<double, 4>;

/// Memory that a tile needs per shape and per invocation. An invocation computes a slope or a piece of a row.
struct TileCosts {
  std::uint64_t invocation_bytes = 0;  ///< bytes in all buffers that grow with the invocations of a tile
  std::uint64_t shape_bytes = 1;   ///< bytes of a shape's node and masking table; 1 without tables, as it is a divisor
  std::uint64_t shape_texels = 0;  ///< texels of a shape's masking table
  std::uint64_t rule_bytes = 0;    ///< bytes of the rule nodes, which all tiles share
};

/// Largest number of invocations per dispatch, and of shapes whose masking tables are bound at a time; at least one
/// each.
struct TileSizes {
  std::uint32_t invocations = 1;
  std::uint32_t shapes = 1;
};

/// The CPU driver lavapipe runs this many invocations in lockstep: a loop lasts until all of them leave it. So
/// different loop bounds add iterations, and after 65,535 iterations lavapipe stops the group without an error.
inline constexpr std::uint32_t kLockstep = 16;

/// Chooses the number of invocations of each tile from the times that the device took for the tiles before. The first
/// tile is small, because the cost of an invocation depends on the request and on the device.
class TilePace {
 public:
  /// `tile_s`: wanted time of a tile; `first`, `most`: invocations of the first tile, and of the largest
  TilePace(double tile_s, std::uint32_t first, std::uint32_t most)
      : tile_s_(tile_s), most_(most), invocations_(first < most ? first : most) {}
  std::uint32_t invocations() const { return invocations_; }
  void note(std::size_t invocations, double seconds);

 private:
  double tile_s_;
  std::uint32_t most_, invocations_;
};

/// Consecutive shapes whose masking tables are on the device at a time, and the kernel rows with these shapes.
struct Block {
  std::uint32_t first_shape = 0;
  std::uint32_t shape_count = 0;
  std::uint32_t first_row = 0;
  std::uint32_t row_count = 0;
};

/// The slope samples of some bundles, and the kernel's input for them. A run computes one batch at a time.
struct SlopeBatch {
  std::vector<SlopeSamples> samples;
  /// Where the results of one of `slopes` belong in SampledAzimuths: the result of order g of its group at node + g *
  /// stride.
  struct Output {
    std::size_t node = 0;
    std::size_t stride = 0;
    std::size_t orders = 1;
  };
  std::vector<std::size_t> first;       ///< for each of `samples`, the position of its first slope in `slopes`
  std::vector<std::size_t> first_node;  ///< for each of `samples`, the position of its first node in SampledAzimuths
  std::size_t nodes = 0;                ///< number of nodes in SampledAzimuths
  std::size_t orders_at_once = 1;       ///< azimuthal orders that an invocation computes
  std::vector<kernel::SlopeNode> slopes;
  std::vector<Output> outputs;             ///< for each of `slopes`
  std::vector<std::uint32_t> in_lockstep;  ///< positions in `slopes`: groups of kLockstep slopes with equal loop bounds
};

struct DispatchCount {
  std::uint32_t tile_invocations = 0;
  std::uint32_t block_shapes = 0;
  std::uint32_t row_width = 1;     ///< largest number of entries per invocation, see plan/rows.hpp
  std::uint64_t rows = 0;          ///< kernel rows; for slope samples, bundles
  std::uint64_t slopes = 0;        ///< slopes of all slope samples
  std::uint64_t dispatches = 0;    ///< at least; TilePace divides the work into more if it takes long
  std::uint64_t device_bytes = 0;  ///< upper bound of the memory of all buffers
};

/// The dispatches of a request for moments, if the kernel computes rows of entries (plan/rows.hpp).
struct RowTiles {
  RowTiles(const MomentsRequest& request, const dolp::Device& device, const VulkanOptions& options,
           Tables tables = Tables::kComputed);
  /// Divides the shapes into blocks of at most sizes.shapes shapes. Shapes that share a kernel row stay in one block.
  std::vector<Block> blocks() const;
  DispatchCount count() const;

  Packing packing;
  KernelData data;
  Rows rows;
  TileCosts costs;
  TileSizes sizes;
};

/// Azimuthal orders that one invocation computes.
std::size_t orders_at_once(const KernelData& data);

/// The dispatches of a request for moments, if the kernel computes slope samples.
struct SlopeTiles {
  SlopeTiles(const MomentsRequest& request, const dolp::Device& device, const VulkanOptions& options,
             Tables tables = Tables::kComputed);
  static constexpr std::size_t kBatchBundles = 1024;  ///< each has some hundred slopes
  SlopeBatch batch(std::size_t first) const;          ///< `first`: position of its first bundle
  DispatchCount count() const;

  Packing packing;
  KernelData data;
  SlopeSampling sampling;
  TileCosts costs;
  std::uint32_t slopes = 0;  ///< largest number of slopes per dispatch; a multiple of kLockstep
};

/// Numbers the items of a list in the order of their first use. So a tile uploads only the items that it needs.
class Renumbering {
 public:
  explicit Renumbering(std::size_t list_size) : number_(list_size, kUnused) {}
  std::uint32_t operator()(std::uint32_t member);
  std::span<const std::uint32_t> used() const { return used_; }
  void clear();

 private:
  static constexpr std::uint32_t kUnused = UINT32_MAX;
  std::vector<std::uint32_t> number_, used_;
};

}  // namespace dolp::vulkan

namespace dolp {

vulkan::DispatchCount count_dispatches(const MomentsRequest& request, const dolp::Device& device);

/// A device with the limits that every Vulkan device guarantees, for plans without a device. Its memory is a guess.
dolp::Device least_device();

}  // namespace dolp
