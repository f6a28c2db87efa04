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
  // These options do not change results.
  std::uint32_t max_tile_invocations = 65'536;  ///< limit for a dispatch; progress and cancelling wait for its end
  std::uint32_t max_block_shapes = 4'096;       ///< number of shapes whose masking tables are on the device at a time
  /// copies inputs through staging buffers even if the device can map its memory
  bool staged_uploads = false;
  double tile_timeout_s = 600.0;
};

/// The options for a precision on a type of device. Dispatches on a processor are short: it is slow at the most
/// expensive entries, and a call must end within a second of a cancel.
VulkanOptions for_device(VulkanOptions options, const dolp::Device& device, Precision precision);

/// Computes moments and pBRDFs with the kernels of shaders/. Device and pipelines live as long as the object.
class VulkanEvaluator : public ModelEvaluator {
 public:
  /// Errors: DeviceError if no usable device matches, the device lacks a required double precision, or the validation
  /// layer is requested and missing.
  explicit VulkanEvaluator(const VulkanOptions& options);
  ~VulkanEvaluator() override;

  /// Errors: InputError for lists that do not fit the request's layout; DeviceError if the device has no double
  /// precision and the request needs it, if the device fails, is lost twice or exceeds the time for a tile (the object
  /// is useless then), or if the validation layer complains; MemoryError if even small tiles do not fit; Cancelled if
  /// `progress`, called after each tile, returns false.
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;

  /// Creates the pipeline in the background; an error there occurs again in `scatter`.
  void prepare(const ScatteringRequest& request) override;

  /// Errors: the errors of evaluate().
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;

  bool has_double() const override;

  /// Totals over all calls since clear_report.
  EvaluationReport report() const override;
  void clear_report() override;

  /// Warnings and errors of the validation layer so far; empty after a tile that did not finish in time.
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
