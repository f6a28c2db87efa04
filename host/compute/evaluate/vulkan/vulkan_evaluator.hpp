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
  std::string device;  ///< name or position of the device, see choose_device
  bool needs_double = false;
  /// Any message of the validation layer makes `evaluate` throw DeviceError.
  ValidationMode validation = ValidationMode::kFromEnvironment;
  // The following options do not change results.
  std::uint32_t max_tile_invocations = 65'536;  ///< largest dispatch; progress and cancelling wait for its end
  std::uint32_t max_block_shapes = 4'096;       ///< most shapes whose masking tables are on the device at a time
  /// Copies inputs through staging buffers even if the host can map the memory of the device.
  bool staged_uploads = false;
  double tile_timeout_s = 600.0;
};

/// Returns `options`, with smaller dispatches if the device is a CPU. So a call ends within a second after cancelling.
VulkanOptions for_device(VulkanOptions options, const dolp::Device& device, Precision precision);

class VulkanEvaluator : public ModelEvaluator {
 public:
  /// Errors: DeviceError if no device matches or has the required precision, or if the validation layer is missing.
  explicit VulkanEvaluator(const VulkanOptions& options);
  ~VulkanEvaluator() override;

  /// Errors:
  /// - InputError if the lists of the request do not fit its layout.
  /// - DeviceError if the request needs double precision and the device has none, if the device fails, if it is lost
  ///   twice, if a tile exceeds the time limit (the object is useless then), or if the validation layer has a message.
  /// - MemoryError if even small tiles do not fit.
  /// - Cancelled if `progress`, called after each tile, returns false.
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;

  /// Creates the pipeline for `request` in the background. If this fails, `scatter` throws the error again.
  void prepare(const ScatteringRequest& request) override;

  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;

  bool has_double() const override;

  EvaluationReport report() const override;
  void clear_report() override;

  /// Messages of the validation layer so far; empty after a tile that did not finish in time.
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
