// The evaluator that a name stands for.
#pragma once

#include <memory>
#include <string>

#include "model/choices.hpp"
#include "model/evaluator.hpp"

namespace dolp {

struct EvaluatorChoice {
  std::string name = "vulkan";  ///< vulkan | cpu | reference
  std::string device;           ///< of vulkan: its position or a part of its name; empty is the default
  Precision precision = Precision::kAuto;
  bool is_interactive = false;  ///< of vulkan: in short dispatches
};

/// Errors: InputError for another name, and for a device beside cpu or reference; DeviceError when vulkan is asked for
/// and there is no usable device.
std::unique_ptr<MomentsEvaluator> make_evaluator(const EvaluatorChoice& choice);

}  // namespace dolp
