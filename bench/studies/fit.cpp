// The study of fits: how well fits recover the known truth of synthetic data, and how long a fit takes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "base/stopwatch.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"
#include "studies/child.hpp"
#include "studies/fit_sets.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kQuickSets = 10;
constexpr std::size_t kBracketSets = 60;
constexpr int kRepeats = 3;
constexpr const char* kPython = "/usr/bin/python3";

ordered_json interval_json(const FitInterval& interval) {
  const auto end = [](const std::optional<double>& value) { return value ? ordered_json(*value) : ordered_json(); };
  return {end(interval.low), end(interval.high)};
}

ordered_json set_row(const char* part, const FitSet& set, std::size_t number, const SetOutcome& outcome) {
  ordered_json row = {{"part", part}, {"case", set.keys()}, {"setting", number}};
  for (const Setting& setting : set.scene.settings) row["model"].push_back(setting.text());
  row["noise"] = set.has_noise ? set.uncertainty : 0.0;
  row["truth"] = std::vector<double>(set.truth.begin(), set.truth.end());
  for (const FitParameter& one : outcome.result.parameters) {
    row["values"].push_back(one.value);
    row["interval_68"].push_back(interval_json(one.interval_68));
    row["interval_95"].push_back(interval_json(one.interval_95));
  }
  row["held_68"] = outcome.held_68;
  row["held_95"] = outcome.held_95;
  row["chi_square"] = outcome.result.chi_square;
  row["chi_square_of_truth"] = outcome.chi_square_of_truth;
  row["chi_square_from_truth"] = outcome.chi_square_from_truth;
  row["is_global"] = outcome.is_global();
  row["is_consistent"] = outcome.is_consistent();
  row["minima"] = outcome.result.minima.size() - 1;
  row["evaluations"] = outcome.result.evaluations;
  row["error"] = outcome.result.numerical_error;
  row["time_s"] = outcome.time_s;
  return row;
}

/// Summary of the rows of one part of the study: the shares of intervals that contain the true value, the number of
/// global minima, the mean number of model evaluations per fit, and the median time of a fit.
ordered_json coverage_json(const ordered_json& rows, const char* part) {
  std::size_t intervals = 0, held_68 = 0, held_95 = 0, global = 0, evaluations = 0;
  std::vector<double> times_s;
  for (const ordered_json& row : rows) {
    if (row["part"] != part) continue;
    intervals += row["truth"].size();
    held_68 += row["held_68"].get<std::size_t>();
    held_95 += row["held_95"].get<std::size_t>();
    global += row["is_global"].get<bool>() ? 1 : 0;
    evaluations += row["evaluations"].get<std::size_t>();
    times_s.push_back(row["time_s"].get<double>());
  }
  const auto share = [&](std::size_t held) { return static_cast<double>(held) / static_cast<double>(intervals); };
  return {{"sets", times_s.size()},
          {"intervals", intervals},
          {"share_68", share(held_68)},
          {"share_95", share(held_95)},
          {"global_minima", global},
          {"evaluations", static_cast<double>(evaluations) / static_cast<double>(times_s.size())},
          {"median_time_s", median(times_s)}};
}

/// Fits the data with SciPy's least_squares, which starts in the middle of the search ranges. Returns the output of
/// fit_scipy.py with one more number: the largest distance between a fitted value of SciPy and the value of the same
/// parameter in `result`, in standard errors of the parameter. Returns null if SciPy or xarray is missing.
ordered_json scipy_json(const FitSet& set, const MeasuredData& data, const fit::FitResult& result) {
  const std::string script = DOLP_BENCH_SCRIPTS "/fit_scipy.py";
  if (run_child({kPython, "-c", "import scipy, xarray"}, ChildErrors::kHidden).status != 0) return {};
  ordered_json question = {{"package", std::filesystem::path(own_program()).replace_filename("python").string()},
                           {"scene", scene_toml(set.scene, {})},
                           {"tolerance", result.tolerance},
                           {"uncertainty", set.uncertainty}};
  for (const FitRange& one : set.parameters) {
    question["columns"].push_back(one.key.substr(one.key.find('.') + 1));
    question["low"].push_back(one.low);
    question["high"].push_back(one.high);
    question["start"].push_back(one.at(0.5));
  }
  for (const dolp::Measurement& one : data.measurements) {
    question["theta_deg"].push_back(one.theta_deg);
    question["measured"].push_back(one.value);
  }
  const ChildOutcome outcome = run_child({kPython, script, question.dump()}, ChildErrors::kShown);
  ordered_json reply = ordered_json::parse(outcome.out, nullptr, false);
  if (outcome.status != 0 || !reply.is_object()) throw IoError(script + " failed; its message is above");
  double apart = 0.0;
  for (std::size_t j = 0; j < set.parameters.size(); ++j) {
    const FitParameter& one = result.parameters[j];
    apart = std::max(apart, std::abs(reply["values"][j].get<double>() - one.value) / one.standard_error.value_or(kNaN));
  }
  reply["apart_in_standard_errors"] = apart;
  return reply;
}

/// Times a whole fit: the search and the intervals. The time to create the device does not count.
ordered_json time_json(ModelEvaluator& evaluator) {
  const FitSet set = timed_set();
  const MeasuredData data = synthetic_data(set, 0, evaluator);
  const fit::Model model(set.scene, {data}, set.parameters);
  fit::FitResult result;
  std::vector<double> times_s;
  for (int i = 0; i < kRepeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    result = fit::fit(model, evaluator, {}).value();
    times_s.push_back(rounded_time(seconds_since(start)));
  }
  return {{"parameters", set.parameters.size()},
          {"points", set.points},
          {"times_s", times_s},
          {"time_s", median(times_s)},
          {"evaluations", result.evaluations},
          {"chi_square", result.chi_square},
          {"scipy", scipy_json(set, data, result)}};
}

constexpr std::size_t kSpectrumWavelengths = 300;
constexpr double kSpectrumNoise = 0.002;
constexpr std::uint64_t kSpectrumSeed = 20261126;
const std::string kWater = R"toml(
[surface]
material = "water 25C"
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
temperature_K = 290
[surroundings]
temperature_K = 240
[spectrum]
wavelength_um = 10
)toml";

/// Times a fit of spectra: finds sigma and q of water from 300 wavelengths at each of three zeniths.
ordered_json spectrum_json(ModelEvaluator& evaluator) {
  const SceneValues scene = parse_scene(kWater, "water");
  std::string points = "theta_deg,wavelength_um\n";
  for (const double theta_deg : {40.0, 60.0, 70.0}) {
    for (std::size_t i = 0; i < kSpectrumWavelengths; ++i)
      points += fmt::format("{},{}\n", theta_deg, 8.0 + 6.0 * static_cast<double>(i) / (kSpectrumWavelengths - 1));
  }
  const Points at = parse_points(points, "points", PointsKind::kDirections);
  const std::vector<PointResult> results = evaluate_scene(scene, point_entries(scene, at), evaluator, {});
  std::mt19937_64 engine(kSpectrumSeed);
  std::normal_distribution<double> noise(0.0, kSpectrumNoise);
  std::string csv = "theta_deg,wavelength_um,q_over_i,uncertainty\n";
  for (std::size_t i = 0; i < results.size(); ++i)
    csv += fmt::format("{},{},{}\n", at.rows[i], results[i][Quantity::kQOverI] + noise(engine), kSpectrumNoise);
  const fit::Model model(scene, {MeasuredData::from_csv(csv)}, {{"surface.sigma", 0.05, 0.6}, {"surface.q", 1.6, 6.0}});
  const auto start = std::chrono::steady_clock::now();
  const fit::FitResult result = fit::fit(model, evaluator, {}).value();
  return {{"points", results.size()},          {"time_s", rounded_time(seconds_since(start))},
          {"evaluations", result.evaluations}, {"sigma", result.parameters[0].value},
          {"q", result.parameters[1].value},   {"chi_square", result.chi_square}};
}

/// Median length of the 95 % interval of n, as a share of the range in which the fit searches n. The median is over the
/// data sets that bracket_set makes.
double median_share_of_n(const ordered_json& rows) {
  const FitRange range = bracket_set(0).parameters.front();
  std::vector<double> shares;
  for (const ordered_json& row : rows) {
    if (row["part"] != "bracket") continue;
    const ordered_json& ends = row["interval_95"][0];
    const auto end = [&](std::size_t i, double open) { return ends[i].is_null() ? open : ends[i].get<double>(); };
    shares.push_back((end(1, range.high) - end(0, range.low)) / (range.high - range.low));
  }
  return median(shares);
}

void measure_sets(StudyRun& run) {
  VulkanEvaluator evaluator(VulkanOptions{.device = run.options().device});
  run.describe("fit", "largest bound of the model's error, in uncertainties",
               "seconds a fit with its intervals; the device and its kernels are there");
  const std::size_t sets = run.options().quick ? std::min(kQuickSets, run.options().entries) : run.options().entries;
  const std::size_t bracket_sets = std::min(kBracketSets, sets);
  run.expect(sets + bracket_sets);
  run.json()["time"] = time_json(evaluator);
  run.json()["spectrum"] = spectrum_json(evaluator);
  const std::size_t first = run.options().first_set;
  for (std::size_t number = first; number < first + sets; ++number) {
    const FitSet set = fit_set(number);
    run.finish(set_row("set", set, number, fit_outcome(set, number, evaluator)));
  }
  for (std::size_t number = first; number < first + bracket_sets; ++number) {
    const FitSet set = bracket_set(number);
    run.finish(set_row("bracket", set, number, fit_outcome(set, number, evaluator)));
  }
  run.json()["coverage"] = coverage_json(run.rows(), "set");
  run.json()["bracket"] = coverage_json(run.rows(), "bracket");
  run.json()["bracket"]["share_of_n"] = median_share_of_n(run.rows());
}

std::string fits_table(const ordered_json& result) {
  const ordered_json& coverage = result["coverage"];
  std::string text = fmt::format(
      "{} synthetic sets, {} intervals\n  68 % intervals hold the truth {:.1f} %\n  95 % intervals {:.1f} %\n"
      "  global minimum found in {}\n  parameter sets of a fit {:.0f}\n  median time {}\n",
      coverage["sets"].get<std::size_t>(), coverage["intervals"].get<std::size_t>(),
      100.0 * coverage["share_68"].get<double>(), 100.0 * coverage["share_95"].get<double>(),
      coverage["global_minima"].get<std::size_t>(), coverage["evaluations"].get<double>(),
      time_text(coverage["median_time_s"].get<double>()));
  const ordered_json& bracket = result["bracket"];
  text += fmt::format(
      "{} sets of all bounces, fitted with --model-error bracket\n  68 % intervals hold the truth {:.1f} %, 95 % "
      "{:.1f} %\n"
      "  95 % leaves {:.0f} % of the range of n (median)\n",
      bracket["sets"].get<std::size_t>(), 100.0 * bracket["share_68"].get<double>(),
      100.0 * bracket["share_95"].get<double>(), 100.0 * bracket["share_of_n"].get<double>());
  const ordered_json& time = result["time"];
  text += fmt::format("a fit of {} parameters to {} points: {}, {} evaluations\n",
                      time["parameters"].get<std::size_t>(), time["points"].get<std::size_t>(),
                      time_text(time["time_s"].get<double>()), time["evaluations"].get<std::size_t>());
  const ordered_json& spectrum = result["spectrum"];
  text += fmt::format("a fit of 2 parameters to {} points of spectra: {}, {} evaluations\n",
                      spectrum["points"].get<std::size_t>(), time_text(spectrum["time_s"].get<double>()),
                      spectrum["evaluations"].get<std::size_t>());
  const ordered_json& scipy = time["scipy"];
  if (scipy.is_null()) return text;
  text += fmt::format("  one descent of SciPy around dolp.evaluate: {}, {} calls, {:.2g} standard errors apart\n",
                      time_text(scipy["time_s"].get<double>()), scipy["calls"].get<std::size_t>(),
                      scipy["apart_in_standard_errors"].get<double>());
  return text;
}

/// Warns of each data set whose intervals are not consistent with the true values, see SetOutcome::is_consistent. Also
/// warns of each fit that missed the global minimum.
void warn(ordered_json& result) {
  for (const ordered_json& row : result["results"]) {
    if (row["part"] != "set") continue;
    if (!row["is_consistent"].get<bool>()) {
      result["warnings"].push_back(fmt::format("set {}: an interval leaves out a truth whose chi^2 lies inside",
                                               row["setting"].get<std::size_t>()));
    }
    if (row["is_global"].get<bool>()) continue;
    result["warnings"].push_back(fmt::format("set {}: chi^2 {:.6g}, and {:.6g} from the truth",
                                             row["setting"].get<std::size_t>(), row["chi_square"].get<double>(),
                                             row["chi_square_from_truth"].get<double>()));
  }
}

}  // namespace

void run_fit_study(const StudyOptions& options) {
  run_study(options, {.measure = measure_sets, .table_text = fits_table, .warn = warn});
}

}  // namespace dolp::bench
