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
  bool has_validation = false;  ///< see DeviceSelector
  // The following options do not change results.
  std::uint32_t max_tile_invocations = 65'536;   ///< limit per dispatch
  std::uint32_t first_tile_invocations = 1'024;  ///< of the first dispatch for kernel rows, whose time is not known
  double tile_s = 0.075;  ///< wanted duration of a dispatch; cancelling waits for the end of up to two dispatches
  std::uint32_t max_block_shapes = 4'096;  ///< largest number of shapes with masking tables on the device
  bool staged_uploads = false;             ///< uses staging buffers even if the host can map the memory of the device
  double tile_timeout_s = 600.0;
};

class VulkanEvaluator : public ModelEvaluator {
 public:
  /// Errors: DeviceError if no device matches or has the required precision, or if the validation layer is missing.
  explicit VulkanEvaluator(const VulkanOptions& options);
  ~VulkanEvaluator() override;

  /// Errors:
  /// - InputError if a list of the request has the wrong length.
  /// - DeviceError if the request needs double precision and the device has none, if the device fails or is lost four
  ///   times in a request, if a tile exceeds tile_timeout_s (all later calls fail too), or if the validation layer has
  ///   a message.
  /// - MemoryError if the device has too little memory even for small tiles.
  /// - Cancelled if `progress`, called after each tile, returns false.
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;

  /// Computes on the host: see beams/scattering.hpp.
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;
  bool has_double() const override;

  EvaluationReport report() const override;
  void clear_report() override;

  /// Messages of the validation layer so far; empty after a tile that did not finish in time.
  std::vector<std::string> validation_messages() const;

 private:
  class Impl;
  void note_setup(double seconds);

  std::unique_ptr<Impl> impl_;
  EvaluationReport report_;
};

}  // namespace dolp
