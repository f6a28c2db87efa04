// Moments and pBRDFs on a Vulkan device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/devices.hpp"
#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

struct VulkanOptions {
  std::string device;         ///< name or position, see choose_device
  bool needs_double = false;  ///< requires double precision of the device
  /// Any message of the layer makes `evaluate` throw DeviceError.
  ValidationMode validation = ValidationMode::kFromEnvironment;
  // The results depend on none of these.
  std::uint32_t max_tile_invocations = 65'536;  ///< of a dispatch: progress and cancelling wait for one at most
  std::uint32_t max_block_shapes = 4'096;       ///< shapes whose masking tables are on the device at a time
  bool staged_uploads = false;                  ///< copy inputs through staging buffers even where it is not necessary
  double tile_timeout_s = 600.0;
};

/// The options for a precision on a type of device: short dispatches on a processor, which is slow at the most
/// expensive entries, so that a call ends within a second of a cancel.
VulkanOptions for_device(VulkanOptions options, const dolp::Device& device, Precision precision);

/// Computes moments and pBRDFs with the kernels of shaders/. Device and pipelines live as long as the object.
class VulkanEvaluator : public ModelEvaluator {
 public:
  /// Errors: DeviceError when there is no usable device, `device` matches none, it lacks a required double
  /// precision, or the validation layer is requested and missing.
  explicit VulkanEvaluator(const VulkanOptions& options);
  ~VulkanEvaluator() override;

  /// Errors: DeviceError for double precision on a device without it; InputError for lists that do not fit the
  /// request's layout; DeviceError when the device fails, is lost (it is made anew once, to try again) or exceeds
  /// the time allowed for a tile (the object is useless then), or the validation layer complains; MemoryError when even
  /// small tiles do not fit; Cancelled when `progress`, called after each tile, returns false.
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;

  /// Creates the pipeline in the background; an error there occurs again in `scatter`.
  void prepare(const ScatteringRequest& request) override;

  /// Errors: those of evaluate.
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;

  bool has_double() const override;

  /// Totals over all calls since clear_report.
  EvaluationReport report() const override;
  void clear_report() override;

  /// Warnings and errors of the validation layer so far; none after a tile that did not finish in time.
  std::vector<std::string> validation_messages() const;

 private:
  class Impl;
  void note_setup(double seconds);
  template <class Result, class Request>
  std::vector<Result> compute(const Request& request, const Progress& progress);

  std::unique_ptr<Impl> impl_;
  EvaluationReport report_;
};

}  // namespace dolp
