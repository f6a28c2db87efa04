#include "evaluate/vulkan/arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <random>
#include <span>
#include <vector>

#include "base/numbers.hpp"
#include "spirv.hpp"

namespace dolp::vulkan {
namespace {

constexpr std::size_t kOperands = 8'192;
constexpr std::size_t kResults = 3;    // per pair of operands
constexpr int kLargestExponent = 60;   // operands of kernels are between 2^-60 and 2^60, and so quotients are normal
constexpr double kUnit = 0x1p-23;      // unit of OperationErrors
constexpr unsigned kProbeSeed = 2357;  // all runs measure the same operands
// Relative errors that Vulkan 1.2 allows (appendix "Precision and Operation of SPIR-V Instructions"): 2.5 ulp for a
// division; the square root is 1/inversesqrt(x), and inversesqrt has 2 ulp.
constexpr double kAllowedDivision = 2.5;
constexpr double kAllowedRoot = 4.5;

using Operands = std::array<float, 2>;

std::vector<Operands> random_operands() {
  std::mt19937 random(kProbeSeed);
  const auto draw = [&random] {
    const auto mantissa = static_cast<float>(1.0 + kUnit * static_cast<double>(random() >> 9U));
    const int exponent = static_cast<int>(random() % (2 * kLargestExponent)) - kLargestExponent;
    const float size = std::ldexp(mantissa, exponent);
    return random() % 2 == 0 ? size : -size;
  };
  std::vector<Operands> operands(kOperands);
  for (Operands& pair : operands) pair = {draw(), draw()};
  return operands;
}

/// Collects the errors of one operation.
class Errors {
 public:
  void add(float computed, double exact) {
    const double error = (static_cast<double>(computed) - exact) / (exact * kUnit);
    // A result that is no number counts as an infinite error.
    largest_ = std::max(largest_, std::isnan(error) ? kInfinity : std::abs(error));
    sum_ += error;
    ++count_;
  }
  OperationErrors result() const { return {largest_, sum_ / count_}; }

 private:
  double largest_ = 0.0, sum_ = 0.0, count_ = 0.0;
};

void require_below(double allowed, const OperationErrors& errors, const char* operation, const std::string& device) {
  if (errors.largest <= allowed) return;
  throw DeviceError(
      fmt::format("{}: its {} in float is wrong by up to {:.2f} ulp, and Vulkan allows {:g}: use another "
                  "device, or the evaluator cpu",
                  device, operation, errors.largest, allowed));
}

}  // namespace

ArithmeticProbe::ArithmeticProbe(const Device& device, Kernels& kernels)
    : kernels_(kernels),
      operands_(device, kOperands * sizeof(Operands), false),
      results_(device, kOperands * kResults * sizeof(float), MemoryUse::kReadback),
      pipeline_(kernels.create(spirv::arithmetic_float, {})) {}

Arithmetic ArithmeticProbe::measure(CommandStream& stream, double timeout_s) {
  const std::vector<Operands> operands = random_operands();
  Kernels::Bindings bindings;
  bindings.buffers[DOLP_BINDING_THETAS] = operands_.get();
  bindings.buffers[DOLP_BINDING_MOMENTS] = results_.get();
  kernels_.bind(bindings);
  stream.begin();
  operands_.write(std::as_bytes(std::span(operands)), stream);
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(kernels_, pipeline_.get(), 0, static_cast<std::uint32_t>(operands.size()), 0);
  stream.barrier(Barrier::kKernelToHost);
  stream.submit_and_wait(timeout_s);
  std::vector<float> results(kOperands * kResults);
  results_.read(std::as_writable_bytes(std::span(results)));
  Errors division, root;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const double dividend = operands[i][0], divisor = operands[i][1];
    division.add(results[kResults * i], dividend / divisor);
    division.add(results[kResults * i + 1], 1.0 / divisor);
    root.add(results[kResults * i + 2], std::sqrt(std::abs(divisor)));
  }
  return {division.result(), root.result()};
}

void require_allowed(const Arithmetic& measured, const std::string& device) {
  require_below(kAllowedDivision, measured.division, "division", device);
  require_below(kAllowedRoot, measured.root, "square root", device);
}

}  // namespace dolp::vulkan
