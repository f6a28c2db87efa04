// The public header, and what the window uses of it.
#pragma once

#include <dolp/dolp.hpp>

namespace dolp::explore {

using api::Effect;
using api::Evaluator;
using api::Results;
using api::Scene;

}  // namespace dolp::explore
