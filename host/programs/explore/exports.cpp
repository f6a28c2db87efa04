#include "explore/exports.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "base/stopwatch.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kStride = 10;  // of the points that the reference recomputes: five degrees

}  // namespace

std::string export_table(const Scene& scene, const std::string& path, const std::string& command_line,
                         Evaluator& evaluator, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  evaluator.write_table(scene, path, {.progress = progress, .history = command_line});
  return fmt::format("{}: written in {:.2f} s", path, seconds_since(start));
}

std::string true_error(const Curve& curve, const Progress& progress) {
  std::vector<Point> stated;
  std::vector<double> theta_deg;
  for (std::size_t i = 0; i < curve.points().size(); i += kStride) {
    stated.push_back(curve.points()[i]);
    theta_deg.push_back(stated.back().theta_deg);
  }
  Evaluator reference(EvaluatorOptions{.evaluator = "reference"});
  const PointList list = points_at(curve.scene(), theta_deg);
  const std::vector<Point> truth =
      points_of(list, reference.evaluate(curve.scene(), list.columns(), {.keep_all = true, .progress = progress}));
  std::size_t worst = 0;
  double largest = -1.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = std::abs(stated[i].dolp - truth[i].dolp);
    if (!is_good(stated[i]) || !(error > largest)) continue;
    largest = error;
    worst = i;
  }
  if (largest < 0.0) return "no direction whose DOLP means something";
  return fmt::format("{:.1e} at θ = {:g}°, bound {:.1e}; {} directions", largest, theta_deg[worst],
                     stated[worst].error_estimate, truth.size());
}

}  // namespace dolp::explore
