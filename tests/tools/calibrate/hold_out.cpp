#include "calibrate/hold_out.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "reference/reference_evaluator.hpp"
#include "scene/scene.hpp"

namespace dolp {
namespace {

constexpr double kFinerBy = 1e-5;
constexpr double kFinest = 1e-13;
constexpr double kReferenceTolerance = 1e-9;
constexpr std::size_t kAtOnce = 2000;  // entries per call of an evaluator; limits the memory for masking tables
constexpr std::size_t kClimbSteps = 40;
constexpr std::size_t kNeighbours = 16;

/// Moments of some entries, with error bounds. `stated` come from the rule under test. `exact` come from a far more
/// accurate rule or from the reference.
struct Answers {
  std::vector<Moments> stated;
  std::vector<Moments> exact;
};

class Check {
 public:
  Check(const MomentsRequest& model, const HoldOutOptions& options)
      : model_(model),
        tolerance_(options.tolerance),
        against_reference_(options.against_reference),
        bound_share_(options.bound_share) {}

  Answers operator()(const std::vector<MomentsPoint>& entries) const {
    const Precision precision = tolerance_ < kLeastFloatTolerance ? Precision::kDouble : Precision::kFloat;
    CpuEvaluator rules;
    ReferenceEvaluator reference({.relative_tolerance = kReferenceTolerance});
    ModelEvaluator& exact = against_reference_ ? static_cast<ModelEvaluator&>(reference) : rules;
    const double finest = against_reference_ ? 0.0 : std::max(kFinerBy * tolerance_, kFinest);
    Answers answers;
    for (std::size_t first = 0; first < entries.size(); first += kAtOnce) {
      const std::vector part(entries.begin() + static_cast<std::ptrdiff_t>(first),
                             entries.begin() + static_cast<std::ptrdiff_t>(std::min(first + kAtOnce, entries.size())));
      append_all(answers.stated, part, {tolerance_, precision}, rules);
      for (std::size_t i = first; i < answers.stated.size(); ++i) lower_bounds(answers.stated[i]);
      append_all(answers.exact, part, {finest, Precision::kDouble}, exact);
    }
    return answers;
  }

 private:
  void append_all(std::vector<Moments>& moments, const std::vector<MomentsPoint>& entries, const Accuracy& accuracy,
                  ModelEvaluator& evaluator) const {
    MomentsRequest request = model_;
    request.tolerance = accuracy.tolerance;
    request.precision = accuracy.precision;
    request.may_interpolate = false;
    for (const MomentsPoint& entry : entries) request.append(entry);
    const std::vector<Moments> more = evaluator.evaluate(request, {});
    moments.insert(moments.end(), more.begin(), more.end());
  }

  void lower_bounds(Moments& moments) const {
    for (const auto& [value, error] : kMomentMembers) moments.*error *= bound_share_;
  }

  MomentsRequest model_;
  double tolerance_;
  bool against_reference_;
  double bound_share_;
};

/// Divides, for each moment, the difference of both results by the sum of both error bounds. Returns the largest ratio.
double error_over_bound(const Moments& stated, const Moments& exact) {
  double worst = 0.0;
  for (const auto& [value, error] : kMomentMembers) {
    const double difference = std::abs(stated.*value - exact.*value);
    if (difference > 0.0) worst = std::max(worst, difference / (stated.*error + exact.*error));
  }
  return worst;
}

/// Multiplies the distance of `value` from `low` by a random factor between e^-width and e^width.
double moved(Draws& draw, double value, double low, double width) {
  return low + (value - low) * std::exp(width * draw.uniform(-1.0, 1.0));
}

MomentsPoint neighbour(Draws& draw, const MomentsPoint& entry, Domain domain, double q_end, double width) {
  MomentsPoint next = entry;
  const double largest_deg = domain == Domain::kOrdinary ? 85.0 : 90.0;
  next.theta_deg = std::clamp(largest_deg - moved(draw, largest_deg - entry.theta_deg, 0.0, width), 0.0, largest_deg);
  next.shape = {moved(draw, entry.shape.sigma, 0.0, width), moved(draw, entry.shape.q, q_end, width)};
  next.index.index = {moved(draw, entry.index.index.n, domain == Domain::kOrdinary ? 1.0 : 0.0, width),
                      moved(draw, entry.index.index.k, 0.0, width)};
  return next;
}

/// True if a climb may continue at `entry`. In a climb sigma and q stay below the upper ends of their ranges in
/// random_entry(). In the ordinary domain sigma, q and n also stay above the lower ends.
bool is_in(Domain domain, const MomentsPoint& entry, double q_end) {
  if (domain == Domain::kCorners) return entry.shape.sigma <= 10.0 && entry.shape.q <= q_end + 20.0;
  return entry.shape.sigma >= 0.01 && entry.shape.sigma <= 2.0 && entry.shape.q >= q_end + 0.1 &&
         entry.shape.q <= q_end + 10.0 && entry.index.index.n >= 1.1;
}

CheckedEntry climbed(const Check& check, Draws& draw, CheckedEntry best, Domain domain, double q_end) {
  double width = 0.3;
  for (std::size_t step = 0; step < kClimbSteps; ++step) {
    std::vector<MomentsPoint> entries;
    for (std::size_t i = 0; i < kNeighbours; ++i) {
      const MomentsPoint next = neighbour(draw, best.entry, domain, q_end, width);
      if (is_in(domain, next, q_end)) entries.push_back(next);
    }
    const Answers answers = check(entries);
    const double before = best.ratio;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const double ratio = error_over_bound(answers.stated[i], answers.exact[i]);
      if (ratio > best.ratio) best = {entries[i], ratio};
    }
    if (best.ratio == before) width *= 0.8;
  }
  return best;
}

}  // namespace

HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options) {
  const auto [distribution, masking] = std::pair(model.distribution, model.masking);
  Draws draw(options.seed * 8 + 2 * static_cast<std::uint64_t>(masking) + static_cast<std::uint64_t>(distribution));
  const Check check(model, options);
  std::vector<MomentsPoint> entries;
  for (std::size_t i = 0; i < options.entries; ++i) {
    entries.push_back(random_entry(draw, options.domain, distribution, masking));
  }
  const Answers answers = check(entries);
  HoldOut result;
  result.entries = entries.size();
  std::vector<CheckedEntry> checked;
  std::size_t flagged = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Moments& stated = answers.stated[i];
    checked.push_back({entries[i], error_over_bound(stated, answers.exact[i])});
    if (!(checked.back().ratio <= 1.0)) ++result.understated;
    if (!(std::max(stated.r_i_error, stated.r_q_error) <= options.tolerance * answers.exact[i].r_i)) ++flagged;
    result.mean_evaluations += stated.evaluations / static_cast<double>(entries.size());
  }
  result.flagged_share = static_cast<double>(flagged) / static_cast<double>(entries.size());
  std::ranges::sort(checked, std::ranges::greater{}, &CheckedEntry::ratio);
  result.worst = result.climbed = checked.front();
  for (std::size_t i = 0; i < std::min(options.climbs, checked.size()); ++i) {
    const CheckedEntry top = climbed(check, draw, checked[i], options.domain, least_q(distribution, masking));
    if (top.ratio > result.climbed.ratio) result.climbed = top;
  }
  return result;
}

}  // namespace dolp
