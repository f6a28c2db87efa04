// Evaluator factory.
#pragma once

#include <dolp/options.hpp>
#include <memory>

#include "model/choices.hpp"
#include "model/evaluator.hpp"

namespace dolp {

/// `needs_double`: of a device, double precision in kernels.
/// Errors: InputError for another name, and for a device beside cpu or reference; DeviceError when vulkan is asked for
/// and there is no usable device.
std::unique_ptr<MomentsEvaluator> make_evaluator(const EvaluatorOptions& wanted, bool needs_double);

}  // namespace dolp
