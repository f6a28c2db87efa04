#include "evaluate/cpu/cpu_evaluator.hpp"

#include <chrono>
#include <limits>
#include <memory>

#include "evaluate/cpu/parallel.hpp"
#include "evaluate/cpu/text.hpp"
#include "evaluate/processor.hpp"

namespace dolp {

std::vector<Moments> CpuEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const KernelData data = kernel_data(request);
  const Precision precision = request.precision == Precision::kAuto ? precision_ : request.precision;
  const bool in_double = precision == Precision::kDouble;
  const std::unique_ptr<KernelText> text = in_double ? make_kernel_text_double(data) : make_kernel_text_float(data);
  const double unit_roundoff = in_double ? 0.5 * std::numeric_limits<double>::epsilon()
                                         : 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
  if (data.needs_masking_table()) {
    parallel_for(
        data.shapes.size(), [&](std::size_t i) { text->build_masking_table(i); }, nullptr);
  }
  std::vector<Moments> moments(data.entries.size());
  const auto one = [&](std::size_t i) {
    const MomentsEntry& entry = data.entries[i];
    moments[i] = moments_from_kernel(text->moments(entry), data, entry, unit_roundoff);
  };
  parallel_for(moments.size(), one, progress);

  report_.evaluator = "cpu";
  report_.device = processor_name();
  note_precision(report_.precision, in_double);
  for (const Moments& entry : moments) report_.evaluations += entry.evaluations;
  report_.kernel_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return moments;
}

}  // namespace dolp
