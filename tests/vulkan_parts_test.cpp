// The parts of the Vulkan evaluator that need no device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "device/devices.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp {
namespace {

DeviceDescription described(std::string name, DeviceDescription::Type type, bool usable, bool float64) {
  DeviceDescription device;
  device.name = std::move(name);
  device.type = type;
  device.usable = usable;
  device.why_not = usable ? "" : "Vulkan 1.1.0 < 1.2";
  device.float64 = float64;
  return device;
}

std::vector<DeviceDescription> five_devices() {
  using enum DeviceDescription::Type;
  return {described("llvmpipe (LLVM 15)", kCpu, true, true), described("Iris Xe", kIntegrated, true, false),
          described("Old Radeon", kDiscrete, false, true), described("GeForce RTX 4090", kDiscrete, true, true),
          described("Radeon RX 7900", kDiscrete, true, true)};
}

TEST(ChooseDevice, Default_IsTheFirstUsableDiscreteGpu) {
  EXPECT_EQ(choose_device(five_devices(), "", false), 3U);
  std::vector<DeviceDescription> devices = five_devices();
  devices.resize(3);
  EXPECT_EQ(choose_device(devices, "", false), 1U);
  EXPECT_EQ(choose_device(devices, "", true), 0U);
}

TEST(ChooseDevice, PositionOrPartOfTheName_IsThatDevice) {
  EXPECT_EQ(choose_device(five_devices(), "0", false), 0U);
  EXPECT_EQ(choose_device(five_devices(), "LLVMpipe", false), 0U);
  EXPECT_EQ(choose_device(five_devices(), "radeon", false), 4U);
  EXPECT_EQ(choose_device(five_devices(), "4090", false), 3U);
}

TEST(ChooseDevice, NoMatchOrUnfit_ThrowsWithTheReason) {
  const auto message = [](const std::string& choice, bool float64) -> std::string {
    try {
      choose_device(five_devices(), choice, float64);
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "no DeviceError";
  };
  EXPECT_NE(message("voodoo", false).find("'voodoo'; devices: 0 = llvmpipe (LLVM 15), 1 = Iris Xe"), std::string::npos);
  EXPECT_NE(message("6", false).find("no Vulkan device matches '6'"), std::string::npos);
  EXPECT_NE(message("2", false).find("Vulkan 1.1.0 < 1.2"), std::string::npos);
  EXPECT_NE(message("iris", true).find("shaderFloat64"), std::string::npos);
}

}  // namespace

namespace vulkan {
namespace {

TEST(Packing, RealsOfAStructure_ComeBackInTheKernelsPrecision) {
  const std::array<double, 3> values{1.0 / 3.0, -2.5, 1e300};
  for (const bool float64 : {false, true}) {
    const Packing packing(float64);
    std::vector<std::byte> bytes;
    packing.append(std::array<double, 3>{}, bytes);
    packing.append(values, bytes);
    ASSERT_EQ(bytes.size(), 6 * packing.real_bytes());
    const auto read = packing.read<std::array<double, 3>>(bytes, 1);
    EXPECT_EQ(read[0], float64 ? values[0] : static_cast<double>(1.0F / 3.0F));
    EXPECT_EQ(read[1], -2.5);
    EXPECT_EQ(read[2], float64 ? 1e300 : HUGE_VAL);
  }
}

TEST(Packing, ManyStructures_AreThoseOfOneAfterTheOther) {
  using Node = std::array<double, 3>;
  constexpr std::size_t kCount = 20'000;  // more than one thread takes
  const auto node_of = [](std::size_t i) {
    return Node{1.0 / static_cast<double>(i + 1), static_cast<double>(i), 1e60};
  };
  for (const bool float64 : {false, true}) {
    const Packing packing(float64);
    std::vector<std::byte> one_by_one, together(7);
    for (std::size_t i = 0; i < kCount; ++i) packing.append(node_of(i), one_by_one);
    packing.pack(kCount, node_of, together);
    EXPECT_EQ(together, one_by_one);
  }
}

TEST(TileSizes, EachLimit_Binds) {
  const TileLimits limits{.buffer_bytes = 1'000'000,
                          .heap_bytes = 80'000'000,
                          .dispatch_count = 9'000,
                          .tile_invocations = 8'000,
                          .block_shapes = 50};
  const TileCosts costs{.invocation_bytes = 100, .shape_bytes = 10'000};
  EXPECT_EQ(tile_sizes(limits, costs).invocations, 8'000U);
  EXPECT_EQ(tile_sizes(limits, costs).shapes, 50U);
  TileLimits small_buffers = limits;
  small_buffers.buffer_bytes = 400'000;
  EXPECT_EQ(tile_sizes(small_buffers, costs).invocations, 4'000U);
  EXPECT_EQ(tile_sizes(small_buffers, costs).shapes, 40U);
  TileLimits small_heap = limits;
  small_heap.heap_bytes = 800'000;
  EXPECT_EQ(tile_sizes(small_heap, costs).invocations, 1'000U);
  EXPECT_EQ(tile_sizes(small_heap, costs).shapes, 10U);
  TileLimits few_workgroups = limits;
  few_workgroups.dispatch_count = 30;
  EXPECT_EQ(tile_sizes(few_workgroups, costs).invocations, 30U);
  EXPECT_EQ(tile_sizes(few_workgroups, costs).shapes, 30U);
  EXPECT_EQ(tile_sizes({}, costs).invocations, 1U);
}

TEST(BlocksOf, Chunks_AreNeverCut) {
  Rows rows;
  rows.chunks = {{0, 2}, {2, 1}, {3, 4}, {7, 1}};
  for (const std::uint32_t chunk : {0U, 0U, 1U, 2U, 3U}) rows.rows.push_back({.chunk = chunk});
  const auto summary = [&](std::uint32_t block_shapes) {
    std::vector<std::array<std::uint32_t, 4>> all;
    for (const Block& block : blocks_of(rows, block_shapes)) {
      all.push_back({block.first_shape, block.shape_count, block.first_row, block.row_count});
    }
    return all;
  };
  using Blocks = std::vector<std::array<std::uint32_t, 4>>;
  EXPECT_EQ(summary(3), (Blocks{{0, 3, 0, 3}, {3, 4, 3, 1}, {7, 1, 4, 1}}));
  EXPECT_EQ(summary(1), (Blocks{{0, 2, 0, 2}, {2, 1, 2, 1}, {3, 4, 3, 1}, {7, 1, 4, 1}}));
  EXPECT_EQ(summary(100), (Blocks{{0, 8, 0, 5}}));
}

TEST(Renumbering, Members_AreNumberedByFirstUseUntilCleared) {
  Renumbering numbers(10);
  EXPECT_EQ(numbers(7), 0U);
  EXPECT_EQ(numbers(2), 1U);
  EXPECT_EQ(numbers(7), 0U);
  EXPECT_TRUE(std::ranges::equal(numbers.used(), std::vector<std::uint32_t>{7, 2}));
  numbers.clear();
  EXPECT_EQ(numbers(2), 0U);
}

}  // namespace
}  // namespace vulkan
}  // namespace dolp
