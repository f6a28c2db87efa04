// The Vulkan evaluator on a GPU or lavapipe, under the validation layer. Without device or layer these tests fail.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <random>

#include "device/context.hpp"
#include "device/devices.hpp"
#include "device/result.hpp"
#include "error_text.hpp"
#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/tiles.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "plan/rows.hpp"
#include "properties_support.hpp"

namespace dolp::vulkan_test {
namespace {

constexpr unsigned kSeed = 20240817;

// Exit statuses of child processes. They differ from 0 and 1, so that a crash does not count as success.
constexpr int kChildPassed = 42;
constexpr int kChildFailed = 43;

constexpr ::uid_t kNobody = 65'534;

VulkanOptions validated(Precision precision = Precision::kFloat) {
  VulkanOptions options;
  options.needs_double = precision == Precision::kDouble;
  options.has_validation = true;
  return options;
}

MomentsRequest small_request(Distribution distribution, Masking masking) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.theta_deg = {0.0, 17.0, 45.0, 60.0, 75.5, 89.0, 90.0};
  std::vector<double> sigma = {0.05, 0.2, 0.445, 0.7, 1.1};
  request.optics = {{1.508, 0.0}, {2.5, 3.0}};
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  std::ranges::shuffle(request.theta_deg, random);
  std::ranges::shuffle(sigma, random);
  request.shapes = shape_product(sigma, std::array{2.0, 1.6});
  request.set_grid();
  return request;
}

/// Calls a function in a separate process and expects true.
void expect_true_in_a_child(bool (*call)()) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(std::_Exit(call() ? kChildPassed : kChildFailed), testing::ExitedWithCode(kChildPassed), "");
}

std::string error_of(const VulkanOptions& options) {
  return error_text<DeviceError>([&] { VulkanEvaluator evaluator(options); });
}

TEST(VulkanDeathTest, ValidationWantedByTheEnvironmentButMissing_IsADeviceError) {
  expect_true_in_a_child([] {
    setenv("DOLP_VALIDATION", "1", 1);
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    return error_of({}).find("VK_LAYER_KHRONOS_validation is not installed") != std::string::npos;
  });
}

TEST(VulkanDeathTest, TileThatExceedsItsTime_IsADeviceErrorAndNoCrash) {
  expect_true_in_a_child([] {
    VulkanEvaluator evaluator({.tile_timeout_s = 1e-9});
    const MomentsRequest request = small_request(Distribution::kCauchy, Masking::kIntegral);
    const std::string late = error_text<DeviceError>([&] { evaluator.evaluate(request, {}); });
    const std::string after = error_text<DeviceError>([&] { evaluator.evaluate(request, {}); });
    return late.find("did not finish") != std::string::npos && after.find("given up") != std::string::npos;
  });
}

TEST(VulkanDeathTest, ThreadsRefused_IsAMemoryErrorAndNoWait) {
  expect_true_in_a_child([] {
    // The limit on the number of threads does not apply to root, so root becomes another user.
    const bool is_bound = ::geteuid() != 0 || ::setuid(kNobody) == 0;
    const ::rlimit none{};
    const bool is_set = ::setrlimit(RLIMIT_NPROC, &none) == 0;
    const std::string message = error_text<MemoryError>([] { VulkanEvaluator evaluator(VulkanOptions{}); });
    return is_bound && is_set && message.find("too few threads") != std::string::npos;
  });
}

TEST(RowTiles, OnlyProcessors_ComputeSeveralEntriesAtOnce) {
  MomentsRequest request = small_request(Distribution::kCauchy, Masking::kSmith);
  request.set_shapes(shape_product(std::array{0.05, 0.2, 0.445, 0.7, 1.1}, std::array{2.0, 2.1, 2.2, 2.3}));
  dolp::Device device = vulkan::Context({}).description();
  for (const bool is_processor : {false, true}) {
    device.type = is_processor ? dolp::Device::Type::kCpu : dolp::Device::Type::kDiscrete;
    const vulkan::DispatchCount count = vulkan::RowTiles(request, device, {}).count();
    EXPECT_EQ(count.row_width, is_processor ? kRowWidth : 1U);
    if (!is_processor) {
      EXPECT_EQ(count.rows, request.size());
    }
  }
}

TEST(VulkanEvaluator, PointsAndSelections_SayTheSameAsTheGrid) {
  VulkanEvaluator evaluator(validated(Precision::kDouble));
  const MomentsRequest request = small_request(Distribution::kCauchy, Masking::kIntegral);
  const std::vector<Moments> expected = evaluator.evaluate(request, {});
  MomentsRequest points;
  points.masking = request.masking;
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < request.size(); i += 3) {
    points.append(request[i]);
    positions.push_back(i);
  }
  const std::vector<Moments> selected = evaluator.evaluate(request.select_entries(positions), {});
  const std::vector<Moments> of_points = evaluator.evaluate(points, {});
  ASSERT_EQ(selected.size(), positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_TRUE(are_same(selected[i], expected[positions[i]])) << i;
    EXPECT_TRUE(are_same(of_points[i], expected[positions[i]])) << i;
  }
}

// One evaluator computes requests in float and in double. These requests must not affect each other.
TEST(VulkanEvaluator, RequestsInBothPrecisions_AreThoseOfEvaluatorsOfTheirOwn) {
  for (const Masking masking : {Masking::kVCavity, Masking::kIntegral}) {
    MomentsRequest request = small_request(Distribution::kCauchy, masking);
    std::array<std::vector<Moments>, 2> expected;
    constexpr std::array kPrecisions = {Precision::kFloat, Precision::kDouble};
    for (std::size_t i = 0; i < kPrecisions.size(); ++i) {
      request.precision = kPrecisions[i];
      expected[i] = VulkanEvaluator(validated()).evaluate(request, {});
    }
    VulkanEvaluator both(validated(Precision::kDouble));
    EXPECT_TRUE(both.has_double());
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{0}}) {
      request.precision = kPrecisions[i];
      EXPECT_TRUE(std::ranges::equal(both.evaluate(request, {}), expected[i], are_same)) << i;
    }
    EXPECT_EQ(both.report().precision, "float and double");
    EXPECT_FALSE(std::ranges::equal(expected[0], expected[1], are_same));
    request.precision = Precision::kAuto;
    EXPECT_TRUE(std::ranges::equal(both.evaluate(request, {}), expected[0], are_same));
    EXPECT_TRUE(both.validation_messages().empty());
  }
}

TEST(VulkanEvaluator, FirstRequestInFloat_MeasuresTheErrorsOfTheDevice) {
  constexpr double kAllowedDivision = 2.5, kAllowedRoot = 4.5;  // by Vulkan
  constexpr double kLeast = 0.45;  // correct rounding has 0.5 at the worst operands; the random ones come near it
  VulkanEvaluator evaluator(validated(Precision::kDouble));
  MomentsRequest request = small_request(Distribution::kCauchy, Masking::kNone);
  request.precision = Precision::kDouble;
  evaluator.evaluate(request, {});
  EXPECT_FALSE(evaluator.report().arithmetic);
  request.precision = Precision::kFloat;
  evaluator.evaluate(request, {});
  const std::optional<Arithmetic> arithmetic = evaluator.report().arithmetic;
  ASSERT_TRUE(arithmetic);
  EXPECT_GT(arithmetic->division.largest, kLeast);
  EXPECT_LE(arithmetic->division.largest, kAllowedDivision);
  EXPECT_GT(arithmetic->root.largest, kLeast);
  EXPECT_LE(arithmetic->root.largest, kAllowedRoot);
  EXPECT_TRUE(evaluator.validation_messages().empty());
}

TEST(FloatRoundoff, DeviceErrors_EnlargeItFromTheOneOfCorrectRounding) {
  constexpr double kCorrect = 0x1p-24;
  EXPECT_EQ(float_roundoff({}), kCorrect);
  EXPECT_EQ(float_roundoff({.division = {.largest = 0.49}, .root = {.largest = 0.1}}), kCorrect);
  EXPECT_GT(float_roundoff({.division = {.largest = 0.6}}), kCorrect);
  EXPECT_GT(float_roundoff({.root = {.largest = 0.6}}), kCorrect);
}

TEST(VulkanEvaluator, Progress_CountsEveryTileAndTheReportEveryDispatch) {
  VulkanOptions options = validated();
  options.max_tile_invocations = 10;
  options.max_block_shapes = 2;
  VulkanEvaluator evaluator(options);
  const MomentsRequest request = small_request(Distribution::kCauchy, Masking::kIntegral);
  std::vector<std::size_t> done;
  evaluator.evaluate(request, [&](std::size_t count, std::size_t total) {
    EXPECT_EQ(total, request.size());
    done.push_back(count);
    return true;
  });
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), request.size());
  EXPECT_GE(done.size(), request.size() / 10);
  const EvaluationReport report = evaluator.report();
  EXPECT_GE(report.dispatches, done.size());
  EXPECT_GT(report.evaluations, static_cast<double>(request.size()));
  EXPECT_GT(report.kernel_s, 0.0);
  EXPECT_GT(report.setup_s, 0.0);
}

constexpr double kNoTime = 1e-9, kLongTime = 1e9;  // seconds; no tile takes less than the one or more than the other

TEST(VulkanEvaluator, WantedTimeOfATile_ChangesTheDispatchesAndNoBit) {
  for (const Masking masking : {Masking::kVCavity, Masking::kIntegral}) {
    MomentsRequest request = small_request(Distribution::kCauchy, masking);
    for (double theta_deg = 1.5; theta_deg < 89.0; theta_deg += 4.0) request.theta_deg.push_back(theta_deg);
    request.set_grid();
    VulkanOptions options = validated();
    options.first_tile_invocations = 64;
    options.tile_s = kLongTime;
    VulkanEvaluator patient(options);
    const std::vector<Moments> expected = patient.evaluate(request, {});
    options.tile_s = kNoTime;
    VulkanEvaluator hasty(options);
    EXPECT_TRUE(std::ranges::equal(hasty.evaluate(request, {}), expected, are_same));
    EXPECT_GT(hasty.report().dispatches, 2 * patient.report().dispatches);
  }
}

TEST(VulkanEvaluator, SmallRequestAfterALargeOne_HasTheBitsOfAFreshEvaluator) {
  const MomentsRequest large = small_request(Distribution::kCauchy, Masking::kIntegral);
  MomentsRequest small = large;
  small.theta_deg = {33.0};
  small.optics = {{1.2, 0.1}};
  small.set_grid();
  MomentsRequest slopes = small;
  slopes.masking = Masking::kVCavity;
  VulkanEvaluator evaluator(validated());
  const std::vector<Moments> before = evaluator.evaluate(large, {});
  for (const MomentsRequest& request : {small, slopes}) {
    const std::vector<Moments> expected = VulkanEvaluator(validated()).evaluate(request, {});
    EXPECT_TRUE(std::ranges::equal(evaluator.evaluate(request, {}), expected, are_same));
  }
  EXPECT_TRUE(std::ranges::equal(evaluator.evaluate(large, {}), before, are_same));
  EXPECT_TRUE(evaluator.validation_messages().empty());
}

TEST(TilePace, TimesOfTiles_LeadToTheWantedTimeInSteps) {
  vulkan::TilePace pace(0.1, 1'000, 50'000);
  EXPECT_EQ(pace.invocations(), 1'000U);
  pace.note(1'000, 0.001);  // 100,000 invocations would take the wanted time
  EXPECT_EQ(pace.invocations(), 4'000U);
  pace.note(1'000, 10.0);  // smaller than half a tile: says nothing
  EXPECT_EQ(pace.invocations(), 4'000U);
  pace.note(4'000, 0.08);
  EXPECT_EQ(pace.invocations(), 4'992U);  // of 5,000, in groups of 16
  pace.note(4'992, 5.0);
  EXPECT_EQ(pace.invocations(), 1'248U);
  for (int i = 0; i < 4; ++i) pace.note(pace.invocations(), kNoTime);
  EXPECT_EQ(pace.invocations(), 50'000U);
  for (int i = 0; i < 9; ++i) pace.note(pace.invocations(), kLongTime);
  EXPECT_EQ(pace.invocations(), 16U);
  EXPECT_EQ(vulkan::TilePace(0.1, 1'000, 7).invocations(), 7U);
}

TEST(VulkanEvaluator, CancelledRequest_LeavesTheEvaluatorUsable) {
  VulkanOptions options = validated();
  options.max_tile_invocations = 20;
  VulkanEvaluator evaluator(options);
  const MomentsRequest request = small_request(Distribution::kCauchy, Masking::kIntegral);
  const std::vector<Moments> expected = evaluator.evaluate(request, {});
  int tiles = 0;
  const auto stop_at_second = [&](std::size_t, std::size_t) { return ++tiles < 2; };
  EXPECT_THROW(evaluator.evaluate(request, stop_at_second), Cancelled);
  EXPECT_EQ(tiles, 2);
  const std::vector<Moments> actual = evaluator.evaluate(request, {});
  EXPECT_TRUE(std::ranges::equal(expected, actual, are_same));
}

using namespace vulkan;

// A Vulkan instance and device with the objects for dispatches. The validation layer writes its messages to `log`.
struct Session {
  explicit Session(ValidationLog& log)
      : instance(&log), device(instance.physical_devices().at(0), {}), kernels(device, false), stream(device) {}
  Instance instance;
  vulkan::Device device;
  Kernels kernels;
  CommandStream stream;
};

constexpr double kTimeout_s = 100.0;

TEST(Validation, CopyBeyondABuffer_IsReported) {
  ValidationLog log;
  {
    Session session(log);
    const Buffer from(session.device, 1'000, MemoryUse::kUpload);
    const Buffer to(session.device, 1'000, MemoryUse::kDeviceOnly);
    session.stream.begin();
    session.stream.copy(from, to.get(), 2'000);
  }
  EXPECT_FALSE(log.messages().empty());
}

constexpr double kSentinel = -12'345.0;
constexpr std::uint32_t kFirst = 3;   // position of the first computed entry
constexpr std::uint32_t kCount = 70;  // number of entries: more than a workgroup, but no multiple of it

// Runs the kernels for a request. The output buffers are longer than needed and begin full of sentinel values. So the
// tests see each value that a kernel has overwritten.
class SentinelRun {
 public:
  SentinelRun(Session& session, const MomentsRequest& request) : session_(session), data_(kernel_data(request)) {
    add(data_.thetas, 0);
    add(data_.shapes, 0);
    add(data_.indices, 0);
    buffers_.emplace_back(session.device, request.size() * sizeof(Words), MemoryUse::kUpload);
    std::vector<Words> words;
    for (std::size_t i = 0; i < request.size(); ++i) {
      const std::size_t bundle = request.find_bundle(i);
      const MomentsEntry entry =
          data_.entry(bundle, data_.bundle_shapes(bundle)[i - request.bundles[bundle].first_entry]);
      words.push_back({entry.theta, entry.shape, entry.index, task_word(data_.pieces[entry.theta], 0, 1)});
    }
    buffers_.back().write(std::as_bytes(std::span(words)));
    using MaskingTable = std::array<double, std::size_t{4} * DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_FLOAT)>;
    add(std::vector<MaskingTable>{}, data_.shapes.size() + 1, packing_.masking_texels());
    add(std::vector<kernel::MomentsNode>{}, request.size() + kLocalSize);
    add(std::vector{data_.rule}, 0);
    add(data_.rule_nodes, 0, packing_.rule_texels());
    Kernels::Bindings bindings;
    for (std::uint32_t i = 0; i < kStorageCount; ++i) bindings.buffers[i] = buffers_[i].get();
    bindings.texels = {buffers_[DOLP_BINDING_RULE_NODES].texels(), buffers_[DOLP_BINDING_MASKING_TABLE].texels()};
    session.kernels.bind(bindings);
  }

  /// Computes `count` entries of the request, beginning with the entry `first`.
  void run(std::uint32_t first, std::uint32_t count) {
    CommandStream& stream = session_.stream;
    stream.begin();
    Kernels& kernels = session_.kernels;
    stream.dispatch(kernels, kernels.pipeline(masking_table_variant(data_)), 0,
                    static_cast<std::uint32_t>(data_.shapes.size()), data_.rule_order);
    stream.barrier(Barrier::kKernelToKernel);
    stream.dispatch(kernels, kernels.pipeline(moments_variant(data_, 1)), first, count, data_.rule_order);
    stream.barrier(Barrier::kKernelToHost);
    stream.submit_and_wait(kTimeout_s);
  }

  std::vector<float> numbers(std::uint32_t binding, std::size_t count) const {
    std::vector<float> values(count);
    buffers_[binding].read(std::as_writable_bytes(std::span(values)));
    return values;
  }

 private:
  using Words = std::array<std::uint32_t, 4>;

  template <class Node>
  void add(const std::vector<Node>& list, std::size_t sentinels, VkFormat texels = VK_FORMAT_UNDEFINED) {
    std::vector<std::byte> bytes, behind;
    packing_.pack(
        list.size(), [&](std::size_t i) { return list[i]; }, bytes);
    packing_.pack(
        sentinels * real_count<Node>(), [](std::size_t) { return kSentinel; }, behind);
    bytes.insert(bytes.end(), behind.begin(), behind.end());
    buffers_.emplace_back(session_.device, bytes.size(), MemoryUse::kReadback, texels);
    buffers_.back().write(bytes);
  }

  Session& session_;
  KernelData data_;
  Packing packing_{false};
  std::vector<Buffer> buffers_;
};

TEST(Kernels, LastWorkgroup_WritesNothingBeyondItsCount) {
  constexpr auto kIsSentinel = [](float value) { return value == static_cast<float>(kSentinel); };
  constexpr std::size_t kNode = real_count<kernel::MomentsNode>();
  constexpr std::size_t kTable = std::size_t{4} * DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_FLOAT);
  ValidationLog log;
  {
    Session session(log);
    const MomentsRequest request = small_request(Distribution::kCauchy, Masking::kIntegral);
    SentinelRun run(session, request);
    run.run(kFirst, kCount);
    const std::size_t room = request.size() + kLocalSize;
    const std::vector<float> moments = run.numbers(DOLP_BINDING_MOMENTS, kNode * room);
    EXPECT_EQ(std::count_if(moments.begin(), moments.begin() + kNode * kCount, kIsSentinel), 0);
    EXPECT_TRUE(std::all_of(moments.begin() + kNode * kCount, moments.end(), kIsSentinel));
    const std::size_t shapes = request.shapes.size();
    const std::vector<float> tables = run.numbers(DOLP_BINDING_MASKING_TABLE, kTable * (shapes + 1));
    const auto end = tables.begin() + static_cast<std::ptrdiff_t>(kTable * shapes);
    EXPECT_EQ(std::count_if(tables.begin(), end, kIsSentinel), 0);
    EXPECT_TRUE(std::all_of(end, tables.end(), kIsSentinel));

    // The first result in `moments` belongs to entry kFirst.
    SentinelRun whole(session, request);
    whole.run(0, static_cast<std::uint32_t>(request.size()));
    const std::vector<float> expected = whole.numbers(DOLP_BINDING_MOMENTS, kNode * request.size());
    EXPECT_TRUE(std::equal(moments.begin(), moments.begin() + kNode * kCount, expected.begin() + kNode * kFirst));
  }
  EXPECT_EQ(log.messages(), std::vector<std::string>{});
}

}  // namespace
}  // namespace dolp::vulkan_test
