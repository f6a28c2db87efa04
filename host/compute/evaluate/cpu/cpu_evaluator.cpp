#include "evaluate/cpu/cpu_evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/parallel_ranges.hpp"
#include "base/processor.hpp"
#include "base/stopwatch.hpp"
#include "beams/scattering.hpp"
#include "evaluate/kernel/cpu_kernel.hpp"
#include "evaluate/kernel/slope_samples.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kComputedAtOnce = 64;  // entries or bundles that a thread computes in one step
constexpr std::size_t kTablesAtOnce = 4096;  // most masking tables in memory; each has 4 KiB in float, 58 KiB in double

std::unique_ptr<CpuKernel> make_kernel(const KernelData& data, bool in_double) {
  return in_double ? make_cpu_kernel_double(data) : make_cpu_kernel_float(data);
}

double choose_roundoff(bool in_double) { return in_double ? kDoubleRoundoff : kFloatRoundoff; }

std::vector<Moments> by_entries(const MomentsRequest& request, const KernelData& data, CpuKernel& kernel,
                                double unit_roundoff, const Progress& progress) {
  std::vector<MomentsEntry> all;
  all.reserve(request.size());
  for (std::size_t i = 0; i < data.bundles.size(); ++i) {
    for (const std::uint32_t shape : data.bundle_shapes(i)) all.push_back(data.entry(i, shape));
  }
  std::vector<Moments> moments(all.size());
  std::size_t before = 0;
  for (std::size_t first = 0; first < data.shapes.size(); first += kTablesAtOnce) {
    std::vector<std::size_t> entries;
    std::vector<std::uint32_t> shapes;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::uint32_t shape = all[i].shape;
      if (shape < first || shape >= first + kTablesAtOnce) continue;
      entries.push_back(i);
      shapes.push_back(shape);
    }
    std::ranges::sort(shapes);
    const auto twice = std::ranges::unique(shapes);
    shapes.erase(twice.begin(), twice.end());
    kernel.build_masking_tables(std::move(shapes));
    const auto compute_entry = [&](std::size_t i) {
      const MomentsEntry& entry = all[entries[i]];
      std::vector<double> columns(column_sums(data));
      const kernel::MomentsNode node = kernel.moments(entry, columns);
      moments[entries[i]] = moments_from_kernel(node, data, entry, unit_roundoff, columns);
    };
    const Progress total_progress = [&](std::size_t done, std::size_t) {
      return !progress || progress(before + done, all.size());
    };
    parallel_for(entries.size(), kComputedAtOnce, compute_entry, total_progress);
    before += entries.size();
  }
  return moments;
}

std::vector<Moments> by_slope_samples(const MomentsRequest& request, const KernelData& data, CpuKernel& kernel,
                                      double unit_roundoff, const Progress& progress) {
  const SlopeSampling sampling(data);
  std::vector<Moments> moments(request.size());
  const auto compute_bundle = [&](std::size_t i) { sampling.compute(i, kernel, unit_roundoff, moments); };
  const Progress entry_progress = [&](std::size_t done, std::size_t all) {
    return !progress || progress(request.size() * done / all, request.size());
  };
  parallel_for(data.bundles.size(), kComputedAtOnce, compute_bundle, entry_progress);
  return moments;
}

}  // namespace

void CpuEvaluator::note(bool in_double, double seconds) {
  report_.evaluator = "cpu";
  report_.device = processor_name();
  note_precision(report_.precision, in_double ? "double" : "float");
  report_.kernel_s += seconds;
}

std::vector<Moments> CpuEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  const Clock::time_point start = Clock::now();
  const KernelData data = kernel_data(request);
  const bool is_double = request.precision == Precision::kDouble;
  const std::unique_ptr<CpuKernel> kernel = make_kernel(data, is_double);
  const double unit_roundoff = choose_roundoff(is_double);
  std::vector<Moments> moments = has_slope_samples(request)
                                     ? by_slope_samples(request, data, *kernel, unit_roundoff, progress)
                                     : by_entries(request, data, *kernel, unit_roundoff, progress);
  for (const Moments& entry : moments) report_.evaluations += entry.evaluations;
  report_.curves_s += data.curves_s;
  note(is_double, seconds_since(start) - data.curves_s);
  return moments;
}

std::vector<ScatteringMatrix> CpuEvaluator::scatter(const ScatteringRequest& request, const Progress& progress) {
  const Clock::time_point start = Clock::now();
  std::vector<ScatteringMatrix> matrices = scattering_matrices(request, progress);
  note(true, 0.0);
  report_.beams_s += seconds_since(start);
  return matrices;
}

}  // namespace dolp
