#include "evaluate/vulkan/vulkan_evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "base/interrupt.hpp"
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "beams/scattering.hpp"
#include "device/context.hpp"
#include "device/result.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "evaluate/vulkan/arithmetic.hpp"
#include "evaluate/vulkan/tiled_run.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kShrinking = 4;
constexpr std::uint32_t kSmallestTile = 64;
constexpr int kMostLosses = 3;  // per request; the first tile has then shrunk from 1,024 to 16 invocations

}  // namespace

class VulkanEvaluator::Impl {
 public:
  explicit Impl(const VulkanOptions& options)
      : options_(options),
        context_({options.device, options.needs_double, options.has_validation}),
        stream_(context_.device()) {}

  const dolp::Device& description() const { return context_.description(); }
  std::vector<std::string> validation_messages() const { return context_.validation_messages(); }
  const VulkanOptions& options() const { return options_; }

  /// Releases the buffers of the last request, and shrinks later tiles. Returns false if they cannot shrink further.
  bool shrink_tiles() {
    run_.reset();
    buffers_ = {};
    if (options_.max_tile_invocations <= kSmallestTile) return false;
    options_.max_tile_invocations /= kShrinking;
    options_.max_block_shapes = std::max(options_.max_block_shapes / kShrinking, 1U);
    return true;
  }

  /// Invocations of the tile that the last request computed when it failed, or none if it failed before the first tile.
  std::optional<std::uint32_t> failed_tile() const {
    return run_ ? std::optional(run_->tile_invocations()) : std::nullopt;
  }

  /// Computes the request in tiles of at most `most` invocations, and adds the cost to `report`. After a DeviceTimeout
  /// this object must not be destroyed.
  std::vector<Moments> compute(const MomentsRequest& request, const Progress& progress, std::uint32_t most,
                               EvaluationReport& report) {
    run_.reset();
    if (request.precision != Precision::kDouble) measure_arithmetic(report);
    const auto make_run = has_slope_samples(request) ? vulkan::slope_run : vulkan::row_run;
    VulkanOptions options = options_;
    options.max_tile_invocations = std::min(options.max_tile_invocations, most);
    run_ = make_run(context_for(request.precision), request, options);
    const Clock::time_point start = Clock::now();
    run_->create_pipelines();
    const double pipelines_s = seconds_since(start);
    report.setup_s += pipelines_s;
    report.pipelines_s += pipelines_s;
    std::vector<Moments> moments;
    try {
      moments = run_->compute(progress);
    } catch (const vulkan::DeviceTimeout&) {
      throw;
    } catch (...) {
      stream_.drain(options_.tile_timeout_s);  // the device still uses the buffers of the run
      throw;
    }
    report += run_->cost();
    note_precision(report.precision, request.precision == Precision::kDouble ? "double" : "float");
    run_.reset();
    context_.check_validation();
    return moments;
  }

 private:
  /// Measures the errors of float operations once. Errors: DeviceError if Vulkan does not allow errors of this size.
  void measure_arithmetic(EvaluationReport& report) {
    const Clock::time_point start = Clock::now();
    if (!arithmetic_) {
      probe_.emplace(context_.device(), kernels_for(Precision::kFloat));
      const Arithmetic measured = probe_->measure(stream_, options_.tile_timeout_s);
      probe_.reset();
      vulkan::require_allowed(measured, description().name);
      arithmetic_ = measured;
    }
    report.arithmetic = arithmetic_;
    report.setup_s += seconds_since(start);
  }

  vulkan::KernelContext context_for(Precision requested) {
    return {.device = context_.device(),
            .description = description(),
            .kernels = kernels_for(requested),
            .stream = stream_,
            .buffers = buffers_,
            .unit_roundoff = requested == Precision::kDouble ? kDoubleRoundoff : float_roundoff(*arithmetic_),
            .staged_uploads = options_.staged_uploads,
            .tile_timeout_s = options_.tile_timeout_s};
  }

  vulkan::Kernels& kernels_for(Precision requested) {
    const bool float64 = requested == Precision::kDouble;
    if (float64 && !description().has_double) {
      throw DeviceError(description().name + " has no double precision (shaderFloat64): use float");
    }
    std::optional<vulkan::Kernels>& kernels = float64 ? double_kernels_ : float_kernels_;
    if (!kernels) kernels.emplace(context_.device(), float64);
    return *kernels;
  }

  VulkanOptions options_;
  vulkan::Context context_;
  std::optional<vulkan::Kernels> float_kernels_, double_kernels_;
  vulkan::CommandStream stream_;
  vulkan::DeviceBuffers buffers_;
  std::optional<Arithmetic> arithmetic_;
  // The next two are members, because they must still exist after a timeout.
  std::optional<vulkan::ArithmeticProbe> probe_;
  std::unique_ptr<vulkan::TiledRun> run_;
};

VulkanEvaluator::VulkanEvaluator(const VulkanOptions& options) {
  const Clock::time_point start = Clock::now();
  impl_ = std::make_unique<Impl>(options);
  note_setup(seconds_since(start));
}

void VulkanEvaluator::clear_report() {
  if (impl_) note_setup(0.0);
}

void VulkanEvaluator::note_setup(double seconds) {
  report_ = {};
  report_.evaluator = "vulkan";
  report_.device = impl_->description().name;
  report_.driver = impl_->description().driver;
  report_.setup_s = seconds;
}

VulkanEvaluator::~VulkanEvaluator() = default;

std::vector<Moments> VulkanEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  if (!impl_) throw DeviceError("the Vulkan device was given up after work that did not finish in time");
  if (request.size() == 0) return {};
  std::uint32_t most = UINT32_MAX;  // invocations of a tile
  for (int losses = 0;;) {
    try {
      return impl_->compute(request, progress, most, report_);
    } catch (const vulkan::DeviceTimeout&) {
      // Vulkan forbids destroying objects that the driver still uses, so they all live until the end of the process.
      static_cast<void>(impl_.release());
      if (interrupted()) throw Cancelled();
      throw;
    } catch (const vulkan::DeviceLost&) {
      if (++losses > kMostLosses) throw;
      ++report_.devices_lost;
      // The driver may have reset the device because the tile took too long.
      if (const auto tile = impl_->failed_tile()) most = std::max(*tile / kShrinking, 1U);
      VulkanOptions options = impl_->options();
      options.first_tile_invocations = std::min(options.first_tile_invocations, most);
      impl_ = std::make_unique<Impl>(options);
    } catch (const MemoryError&) {
      if (!impl_->shrink_tiles()) throw;
    }
  }
}

std::vector<ScatteringMatrix> VulkanEvaluator::scatter(const ScatteringRequest& request, const Progress& progress) {
  const Clock::time_point start = Clock::now();
  std::vector<ScatteringMatrix> matrices = scattering_matrices(request, progress);
  note_precision(report_.precision, "double");
  report_.beams_s += seconds_since(start);
  return matrices;
}

bool VulkanEvaluator::has_double() const { return impl_ && impl_->description().has_double; }

EvaluationReport VulkanEvaluator::report() const { return report_; }

std::vector<std::string> VulkanEvaluator::validation_messages() const {
  return impl_ ? impl_->validation_messages() : std::vector<std::string>{};
}

}  // namespace dolp
