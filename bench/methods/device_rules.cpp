// Product rules on a Vulkan device: product_rule.comp, in float.
#include <array>
#include <chrono>
#include <cmath>
#include <dolp/errors.hpp>
#include <map>
#include <numbers>
#include <optional>

#include "base/stopwatch.hpp"
#include "device/buffer.hpp"
#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "methods/bench_device.hpp"
#include "methods/method.hpp"
#include "methods/product_rules.hpp"
#include "model/angles.hpp"
#include "spirv.hpp"

namespace dolp::bench {
namespace {

using std::numbers::pi;
using Node = std::array<double, 4>;
using Pair = std::array<double, 2>;
using EntryWords = std::array<std::uint32_t, 4>;

constexpr double kTimeout = 600.0;                   // longest time of one dispatch, in seconds
constexpr std::size_t kMostIterations = 1U << 14U;   // per invocation; lavapipe stops invocations after 65,535
constexpr std::size_t kMostSamples = 1U << 26U;      // evaluations per dispatch, after which the time is checked
constexpr std::size_t kMostShapes = 1U << 12U;       // slope distributions per call of solve(), 4 kB of tables each
constexpr std::size_t kMostInvocations = 1U << 22U;  // per call of solve(); limits the memory
constexpr std::uint32_t kZenithUnit = 1U << 16U;

/// The nodes of a rule as product_rule.comp reads them: their number per axis, then the zeniths, then the azimuths.
std::vector<Node> product_nodes(const Rule& rule) {
  std::vector<Node> nodes{{static_cast<double>(rule.nodes.size()), 0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta_r = 0.5 * pi * rule.nodes[i];
    nodes.push_back({std::cos(theta_r), std::sin(theta_r), 0.5 * pi * rule.weights[i] * 0.5 * std::sin(theta_r), 0.0});
  }
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    nodes.push_back({std::cos(pi * rule.nodes[i]), pi * rule.weights[i], 0.0, 0.0});
  }
  return nodes;
}

class DeviceRule final : public Solver {
 public:
  DeviceRule(const SolverOptions& options, Rule (*rule)(std::size_t))
      : bench_(options.device), kernels_(bench_.device, false), time_limit_s_(options.time_limit_s), rule_(rule) {}

  Solution solve(const MomentsRequest& request, double setting) override {
    const Rule rule = rule_(static_cast<std::size_t>(setting));
    const KernelData data = kernel_data(request);
    make_words(data, rule.nodes.size());
    if (words_.size() > kMostInvocations || data.shapes.size() > kMostShapes) {
      throw Unavailable("its buffers hold fewer entries than that");
    }
    Solution solution;
    solution.kernel_s = run(request, data, rule);
    solution.evaluations = setting * setting * static_cast<double>(request.size());
    solution.answers = sums(request.size());
    bench_.check_messages();
    return solution;
  }
  std::string where() const override { return bench_.where(); }

 private:
  /// Fills `words_` with one element per invocation: an entry and a range of zenith nodes. The list has all entries
  /// with the first range, then all entries with the second range, and so on.
  void make_words(const KernelData& data, std::size_t nodes) {
    const std::size_t most_zeniths = std::max<std::size_t>(1, kMostIterations / nodes);
    words_.clear();
    for (std::size_t first = 0; first < nodes; first += most_zeniths) {
      const std::size_t zeniths = std::min(most_zeniths, nodes - first);
      for (const Bundle& bundle : data.bundles) {
        for (std::uint32_t member = bundle.first; member < bundle.first + bundle.count; ++member)
          words_.push_back({bundle.direction, data.members[member], bundle.index,
                            static_cast<std::uint32_t>(first + kZenithUnit * zeniths)});
      }
    }
  }

  template <class List>
  vulkan::InputBuffer& upload(std::optional<vulkan::InputBuffer>& buffer, const List& list,
                              VkFormat texels = VK_FORMAT_UNDEFINED) {
    std::vector<std::byte> bytes;
    packing_.pack(
        list.size(), [&](std::size_t i) { return list[i]; }, bytes);
    return upload_bytes(buffer, bytes, texels);
  }
  vulkan::InputBuffer& upload_bytes(std::optional<vulkan::InputBuffer>& buffer, std::span<const std::byte> bytes,
                                    VkFormat texels = VK_FORMAT_UNDEFINED) {
    buffer.emplace(bench_.device, bytes.size(), false, texels);
    buffer->write(bytes, bench_.stream);
    return *buffer;
  }

  double run(const MomentsRequest& request, const KernelData& data, const Rule& rule) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Pair> thetas;
    for (const double theta_deg : request.theta_deg) {
      const CosSin beam = cos_sin_deg(theta_deg);
      thetas.push_back({beam.cos, beam.sin});
    }
    const std::size_t tables = data.needs_masking_table() ? data.shapes.size() * packing_.masking_nodes() : 0;
    masking_.emplace(bench_.device, tables * sizeof(float) * 4, vulkan::MemoryUse::kDeviceOnly,
                     packing_.masking_texels());
    sums_.emplace(bench_.device, words_.size() * sizeof(float) * 2, vulkan::MemoryUse::kReadback);
    vulkan::Kernels::Bindings bindings;
    auto& [buffers, texels] = bindings;
    buffers[DOLP_BINDING_MASKING_TABLE] = masking_->get();
    texels[DOLP_BINDING_MASKING_NODES - vulkan::kStorageCount] = masking_->texels();
    buffers[DOLP_BINDING_MOMENTS] = sums_->get();
    bench_.stream.begin();
    buffers[DOLP_BINDING_THETAS] = upload(theta_buffer_, thetas).get();
    buffers[DOLP_BINDING_SHAPES] = upload(shape_buffer_, data.shapes).get();
    buffers[DOLP_BINDING_INDICES] = upload(index_buffer_, data.indices).get();
    texels[DOLP_BINDING_RULE_NODES - vulkan::kStorageCount] =
        upload(rule_node_buffer_, data.rule_nodes, packing_.rule_texels()).texels();
    buffers[DOLP_BINDING_RULE] = upload(product_buffer_, product_nodes(rule)).get();
    buffers[DOLP_BINDING_TASKS] = upload_bytes(entry_buffer_, std::as_bytes(std::span(words_))).get();
    kernels_.bind(bindings);
    bench_.stream.barrier(vulkan::Barrier::kUploadToKernel);
    if (tables > 0) {
      bench_.stream.dispatch(kernels_, kernels_.pipeline(vulkan::masking_table_variant(data)), 0,
                             static_cast<std::uint32_t>(data.shapes.size()), data.rule_order);
    }
    double kernel_s = bench_.stream.submit_and_wait(kTimeout);
    const std::size_t samples = rule.nodes.size() * std::min(rule.nodes.size(), kMostIterations / rule.nodes.size());
    const std::size_t tile = std::max<std::size_t>(vulkan::kLocalSize, kMostSamples / samples);
    for (std::size_t first = 0; first < words_.size(); first += tile) {
      bench_.stream.begin();
      bench_.stream.barrier(vulkan::Barrier::kKernelToKernel);
      bench_.stream.dispatch(kernels_, pipeline(data), static_cast<std::uint32_t>(first),
                             static_cast<std::uint32_t>(std::min(tile, words_.size() - first)), data.rule_order);
      bench_.stream.barrier(vulkan::Barrier::kKernelToHost);
      kernel_s += bench_.stream.submit_and_wait(kTimeout);
      const double elapsed_s = seconds_since(start);
      if (elapsed_s > time_limit_s_) throw TookTooLong("it takes longer than its time limit");
    }
    return kernel_s;
  }

  VkPipeline pipeline(const KernelData& data) {
    const vulkan::KernelVariant variant{.distribution = data.distribution, .masking = data.masking};
    const auto found = pipelines_.find(variant);
    if (found != pipelines_.end()) return found->second.get();
    return pipelines_.emplace(variant, kernels_.create(spirv::product_rule_float, variant)).first->second.get();
  }

  std::vector<Answer> sums(std::size_t entries) const {
    std::vector<std::byte> bytes(words_.size() * packing_.node_bytes<Pair>());
    sums_->read(bytes);
    std::vector<Answer> answers(entries);
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const auto sum = packing_.read<Pair>(bytes, i);
      answers[i % entries].r_i += sum[0];
      answers[i % entries].r_q += sum[1];
    }
    return answers;
  }

  BenchDevice bench_;
  vulkan::Kernels kernels_;
  vulkan::Packing packing_{false};
  double time_limit_s_;
  Rule (*rule_)(std::size_t);
  std::map<vulkan::KernelVariant, vulkan::UniquePipeline> pipelines_;
  std::vector<EntryWords> words_;
  std::optional<vulkan::InputBuffer> theta_buffer_, shape_buffer_, index_buffer_, rule_node_buffer_, product_buffer_,
      entry_buffer_;
  std::optional<vulkan::Buffer> masking_, sums_;
};

std::unique_ptr<Solver> make_rule(const SolverOptions& options, Rule (*rule)(std::size_t)) {
  try {
    return std::make_unique<DeviceRule>(options, rule);
  } catch (const DeviceError& error) {
    throw Unavailable(error.what());
  }
}

}  // namespace

std::unique_ptr<Solver> make_vulkan_midpoint(const SolverOptions& options) { return make_rule(options, midpoint_rule); }
std::unique_ptr<Solver> make_vulkan_gauss(const SolverOptions& options) { return make_rule(options, gauss_rule); }

}  // namespace dolp::bench
