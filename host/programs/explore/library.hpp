// The public header, and what the window uses of it.
#pragma once

#include <dolp/dolp.hpp>

namespace dolp::explore {

using api::Cancelled;
using api::Column;
using api::Effect;
using api::Evaluator;
using api::EvaluatorOptions;
using api::FitInterval;
using api::InputError;
using api::Key;
using api::MeasuredData;
using api::Progress;
using api::Results;
using api::RunOptions;
using api::Scene;

}  // namespace dolp::explore
