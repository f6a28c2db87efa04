// What is behind the window, piece by piece: parameters, edits, worker, measured points, exports, ticks, lines.
#include <gtest/gtest.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/error.hpp"
#include "base/text.hpp"
#include "explore/background_task.hpp"
#include "explore/conflicts.hpp"
#include "explore/contours.hpp"
#include "explore/exports.hpp"
#include "explore/parameters.hpp"
#include "explore/ticks.hpp"
#include "explore_support.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::explore {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;

// ---- Parameters and edits ------------------------------------------------------------------------------------------

TEST(Parameters, All_HaveSymbolEquationAndASliderInsideTheirRange) {
  EXPECT_GT(parameters().size(), 15U);
  for (const Parameter& p : parameters()) {
    EXPECT_STRNE(p.symbol, "") << p.description->key;
    EXPECT_STRNE(p.equation, "") << p.description->key;
    EXPECT_TRUE(p.description->range.contains(p.slider.min)) << p.description->key;
    EXPECT_TRUE(p.description->range.contains(p.slider.max)) << p.description->key;
    EXPECT_TRUE(!p.is_log || p.slider.min > 0.0) << p.description->key;
  }
  EXPECT_TRUE(parameter("surface.sigma").is_log);
}

TEST(Parameters, SliderPositions_ComeBackToFourDigits) {
  constexpr double kFourDigits = 6e-4;  // half of the last of four digits of a number that begins with 1, and rounding
  for (const Parameter& p : parameters()) {
    EXPECT_EQ(slider_value(p, 0.0), p.slider.min) << p.description->key;
    EXPECT_EQ(slider_value(p, 1.0), p.slider.max) << p.description->key;
    for (const double position : {0.1, 0.37, 0.5, 0.93}) {
      const double value = slider_value(p, position);
      EXPECT_EQ(*parse_number(format_number(value)), value);
      EXPECT_NEAR(slider_position(p, value), position, kFourDigits) << p.description->key;
    }
  }
}

TEST(Edits, RefusedChange_LeavesTheSceneAsItWas) {
  SceneEdits edits = paint();
  EXPECT_THROW(edits.set("surface.sigma", -1.0), InputError);
  EXPECT_THROW(edits.set("surface.n", "none"), InputError);
  EXPECT_EQ(edits.scene().surface.sigma, 0.15);
  EXPECT_TRUE(edits.overrides().empty());
}

TEST(Edits, Reset_GivesTheValueOfTheCommandLineBack) {
  SceneEdits edits = paint({"surface.sigma=0.3"});
  edits.set("surface.sigma", 0.5);
  EXPECT_TRUE(edits.is_changed());
  edits.reset("surface.sigma");
  EXPECT_EQ(edits.scene().surface.sigma, 0.3);
  EXPECT_FALSE(edits.is_changed());
}

TEST(Edits, Alternatives_ReplaceOneAnother) {
  SceneEdits edits = paint();
  edits.set("spectrum.wavelength_um", "10.6");
  edits.set("surface.material", "gold (Ordal)");
  EXPECT_EQ(edits.scene().surface.material.name, "gold (Ordal)");
  const OpticalConstants gold = edits.scene().surface.material.at(10.6);
  edits.set("spectrum.band_um", "[8, 12]");
  EXPECT_EQ(edits.scene().surface.material.at(10.6), gold);
  edits.set("spectrum.wavelength_um", "10.6");
  edits.set({{"surface.n", "1.6"}, {"surface.k", "0.2"}});
  EXPECT_EQ(edits.scene().surface.material.constant, (OpticalConstants{1.6, 0.2}));
  edits.set("spectrum.band_um", "[8, 14]");
  EXPECT_TRUE(edits.scene().spectrum.is_band());
  edits.set("source.preset", "sun");
  edits.set("source.irradiance", 2.0);
  EXPECT_EQ(edits.scene().source->irradiance, 2.0);
}

TEST(Edits, Effects_GoAndComeBack) {
  SceneEdits edits = paint();
  edits.set("surroundings.temperature_K", 250.0);
  edits.set("surroundings", "none");
  EXPECT_FALSE(edits.scene().surroundings);
  edits.reset("surroundings");
  EXPECT_EQ(edits.scene().surroundings->temperature_K, 240.0);
}

TEST(Edits, EffectOfTheCommandLine_ComesBackAsOpened) {
  SceneEdits edits = paint({"emission.bracket=true", "emission.temperature_K=310"});
  edits.set("emission", "none");
  edits.reset("emission");
  EXPECT_EQ(edits.scene().emission->temperature_K, 310.0);
  EXPECT_TRUE(edits.scene().emission->has_bracket);
  EXPECT_FALSE(edits.is_changed());
}

// ---- Choices that exclude one another ------------------------------------------------------------------------------

using Changes = std::vector<SceneEdits::Change>;

bool is_accepted(const SceneEdits& edits, const Changes& changes) {
  std::vector<std::string> arguments;
  for (const auto& [key, word] : changes) arguments.push_back(key + '=' + word);
  try {
    edits.variant(arguments);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Every combination of the words of some choices that the scene reader accepts.
std::vector<Changes> accepted_combinations(const std::vector<std::string>& keys) {
  std::vector<Changes> all = {{}};
  for (const Choice& choice : choices()) {
    if (std::ranges::find(keys, choice.description->key) == keys.end()) continue;
    std::vector<Changes> longer;
    for (const Changes& begun : all) {
      for (const std::string& word : words_of(*choice.description)) {
        longer.push_back(begun);
        longer.back().emplace_back(choice.description->key, word);
      }
    }
    all = std::move(longer);
  }
  std::erase_if(all, [](const Changes& changes) { return !is_accepted(paint(), changes); });
  return all;
}

TEST(Conflicts, EveryChoiceInEveryScene_IsTakenWithTheLeastThatItAsksFor) {
  const std::vector<Changes> combinations = accepted_combinations(
      {"surface.masking", "surface.scattering", "emission.model", "emission.bracket", "geometry.mode"});
  EXPECT_EQ(combinations.size(), 28U);
  for (const Changes& combination : combinations) {
    SceneEdits edits = paint();
    edits.set(combination);
    for (const Choice& choice : choices()) {
      for (const std::string& word : words_of(*choice.description)) {
        const SceneEdits::Change chosen = {choice.description->key, word};
        Changes asked = asked_for(edits.scene(), {chosen});
        EXPECT_EQ(asked.empty(), is_accepted(edits, {chosen})) << chosen.first << " = " << word;
        asked.push_back(chosen);
        EXPECT_TRUE(is_accepted(edits, asked)) << chosen.first << " = " << word;
      }
    }
  }
}

TEST(Conflicts, BothSidesChosen_AreLeftToTheReader) {
  const Changes both = {{"surface.scattering", "multiple"}, {"surface.masking", "smith"}};
  EXPECT_TRUE(asked_for(paint().scene(), both).empty());
}

TEST(SceneToml, ShippedScenesWithChanges_ReadBackAsTheSameScene) {
  for (const auto& file : std::filesystem::directory_iterator(kHostDir + "/scenes")) {
    SCOPED_TRACE(file.path().string());
    const std::string path = file.path().string();
    SceneEdits edits(read_text(path, ""), path, {"title=a \"quoted\" title", "surface.sigma=0.1234567890123"});
    const std::string text = edits.toml(kHostDir);
    const Scene again = parse_scene(text, kHostDir + "/again.toml", {});
    EXPECT_EQ(again.title, "a \"quoted\" title");
    EXPECT_EQ(again.grid.theta_deg, edits.scene().grid.theta_deg);
    EXPECT_EQ(again.grid.sigma, edits.scene().grid.sigma);
    EXPECT_EQ(again.grid.q, edits.scene().grid.q);
    const SceneEntries entries = entries_at(edits.scene(), {0.0, 35.0, 70.0});
    EXPECT_EQ(entries_at(again, {70.0})[0].shape, entries[2].shape);
    expect_same(truth(edits.scene(), entries), truth(again, entries));
  }
}

TEST(SceneToml, WhatGoesBeyondSingleScattering_IsSaved) {
  const auto saved = [](const std::vector<std::string>& overrides) {
    SceneEdits edits = paint();
    for (const std::string& override : overrides) {
      const std::size_t equals = override.find('=');
      edits.set(override.substr(0, equals), override.substr(equals + 1));
    }
    return parse_scene(edits.toml("."), "again.toml", {});
  };
  EXPECT_EQ(saved({"surface.scattering=multiple"}).surface.scattering, Scattering::kMultiple);
  const Scene bracket = saved({"emission.model=direct", "emission.bracket=true"});
  EXPECT_EQ(bracket.emission->model, EmissionModel::kDirect);
  EXPECT_TRUE(bracket.emission->has_bracket);
}

TEST(SceneToml, NamedFiles_AreFoundFromTheNewFolder) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "dolp-scene-toml";
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "saved");
  std::ofstream(folder / "scenes" / "paint.csv") << "wavelength_um,n,k\n8,1.5,0.1\n14,1.6,0.2\n";
  const std::string path = (folder / "scenes" / "paint.toml").string();
  const SceneEdits edits(kPaint, path, {"surface.material_file=paint.csv"});
  const Scene again = parse_scene(edits.toml(folder / "saved"), (folder / "saved" / "s.toml").string(), {});
  EXPECT_EQ(again.surface.material.constant, edits.scene().surface.material.constant);
  std::filesystem::remove_all(folder);
}

// ---- Worker --------------------------------------------------------------------------------------------------------

/// Waits in each call until it is let go, and notes what it was asked for.
class SlowEvaluator final : public MomentsEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    std::unique_lock lock(mutex_);
    ++calls;
    changed_.notify_all();
    while (!is_open_) {
      changed_.wait_for(lock, std::chrono::milliseconds(1));
      if (!progress(0, 1)) {
        ++cancelled;
        throw Cancelled{};
      }
    }
    return cpu_.evaluate(request, progress);
  }
  EvaluationReport report() const override { return cpu_.report(); }
  void open() {
    const std::scoped_lock lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wait_for_call() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return calls > 0; });
  }
  int calls = 0;
  int cancelled = 0;

 private:
  CpuEvaluator cpu_{Precision::kAuto};
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
};

Job job_of(const std::string& key) {
  Job job;
  job.key = key;
  job.scene = parse_scene(kPaint, "paint.toml", {});
  job.entries = entries_at(job.scene, {10.0, 20.0, 30.0, 40.0});
  return job;
}

std::vector<JobPart> finish(Worker& worker) {
  std::vector<JobPart> news;
  while (!worker.is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (JobPart& part : worker.take_news()) news.push_back(std::move(part));
  return news;
}

TEST(ExploreWorker, StaleJob_IsCancelledAndItsResultsNeverCome) {
  SlowEvaluator evaluator;
  Worker worker(evaluator, [] {});
  worker.want({job_of("stale")});
  evaluator.wait_for_call();
  worker.want({job_of("new")});
  evaluator.open();
  const std::vector<JobPart> news = finish(worker);
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(news.front().key, "new");
}

TEST(ExploreWorker, JobUnderWay_GoesOnWhenItIsStillWanted) {
  SlowEvaluator evaluator;
  Worker worker(evaluator, [] {});
  worker.want({job_of("kept")});
  evaluator.wait_for_call();
  worker.want({job_of("first"), job_of("kept")});
  evaluator.open();
  EXPECT_EQ(finish(worker).size(), 2U);
  EXPECT_EQ(evaluator.cancelled, 0);
}

TEST(ExploreWorker, BriefJobUnderWay_IsFinishedThoughItIsNotWanted) {
  SlowEvaluator evaluator;
  Worker worker(evaluator, [] {});
  Job brief = job_of("brief");
  brief.is_brief = true;
  worker.want({brief});
  evaluator.wait_for_call();
  worker.want({job_of("new")});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // time to give it up, were it not brief
  evaluator.open();
  const std::vector<JobPart> news = finish(worker);
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].key, "brief");
  EXPECT_EQ(news[1].key, "new");
  EXPECT_EQ(evaluator.cancelled, 0);
}

TEST(ExploreWorker, BriefJobUnderWay_IsGivenUpAtTheEnd) {
  SlowEvaluator evaluator;
  {
    Worker worker(evaluator, [] {});
    Job brief = job_of("brief");
    brief.is_brief = true;
    worker.want({brief});
    evaluator.wait_for_call();
  }
  EXPECT_EQ(evaluator.cancelled, 1);
}

TEST(ExploreWorker, Parts_ComeInOrderWithTheResultsOfTheWhole) {
  CpuEvaluator evaluator(Precision::kAuto);
  Worker worker(evaluator, [] {});
  Job job = job_of("parts");
  job.parts = job.entries.parts(3);
  worker.want({job});
  const std::vector<JobPart> news = finish(worker);
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].results.size(), 3U);
  EXPECT_FALSE(news[0].is_last);
  EXPECT_EQ(news[1].part, 1U);
  EXPECT_TRUE(news[1].is_last);
  std::vector<PointResult> all = news[0].results;
  all.insert(all.end(), news[1].results.begin(), news[1].results.end());
  expect_same(all, truth(job.scene, job.entries));
}

TEST(ExploreWorker, LostDevice_IsThrownToWhoAsksForNews) {
  class Lost final : public MomentsEvaluator {
   public:
    std::vector<Moments> evaluate(const MomentsRequest&, const Progress&) override { throw DeviceError("lost"); }
    EvaluationReport report() const override { return {}; }
  } evaluator;
  Worker worker(evaluator, [] {});
  worker.want({job_of("any")});
  while (!worker.is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_THROW(worker.take_news(), DeviceError);
}

TEST(Task, Cancelled_EndsAndSaysSo) {
  BackgroundTask task([] {});
  task.start([](const Progress& progress) -> std::string {
    while (progress(1, 2)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw Cancelled{};
  });
  EXPECT_EQ(task.state(), BackgroundTask::State::kRunning);
  task.cancel();
  while (task.state() == BackgroundTask::State::kRunning) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(task.state(), BackgroundTask::State::kCancelled);
}

// ---- Measured points, exports --------------------------------------------------------------------------------------

std::string measured_error(const std::string& text) {
  try {
    parse_measured(text, "m.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Measured, Uncertainties_AreReadWhereTheirColumnIs) {
  EXPECT_TRUE(parse_measured("theta_deg,dolp\n60,0.1\n", "m.csv").uncertainty.empty());
  const MeasuredPoints points = parse_measured("uncertainty,theta_deg,dolp\n0.01,60,0.1\n0.02,70,0.2\n", "m.csv");
  EXPECT_EQ(points.uncertainty, (std::vector<double>{0.01, 0.02}));
  EXPECT_THROW(parse_measured("theta_deg,dolp,uncertainty\n60,0.1,0\n", "m.csv"), InputError);
}

TEST(Measured, WrongFiles_AreNamedByLineAndColumn) {
  EXPECT_EQ(measured_error("theta_deg\n1\n"), "m.csv:1: column \"dolp\" is missing, a number in [-1, 1]");
  EXPECT_EQ(measured_error("dolp,theta_deg\n0.1,95\n"), "m.csv:2: theta_deg = 95: out of range, a number in [0, 90]");
  EXPECT_EQ(measured_error("theta_deg,dolp\n60,0.1\n61\n"), "m.csv:3: dolp: the value is missing, a number in [-1, 1]");
  EXPECT_EQ(measured_error("theta_deg,who,dolp\n60,me,0.1\n"), "no error");
}

TEST(Measured, Residuals_AreMeasuredMinusModelAtTheMeasuredZeniths) {
  Driver driver(paint());
  const std::string path = (std::filesystem::temp_directory_path() / "dolp-measured.csv").string();
  std::ofstream(path) << "theta_deg,dolp\n33.3,0.05\n61.7,0.06\n";
  driver.session.load_measured(path);
  driver.settle();
  const Scene& scene = driver.session.scene();
  const std::vector<PointResult> model = truth(scene, entries_at(scene, {33.3, 61.7}));
  const std::vector<double> residuals = driver.session.residuals().residuals();
  ASSERT_EQ(residuals.size(), 2U);
  EXPECT_EQ(residuals[0], 0.05 - model[0].dolp);
  EXPECT_EQ(residuals[1], 0.06 - model[1].dolp);
  EXPECT_DOUBLE_EQ(*driver.session.residuals().rms(),
                   std::sqrt((residuals[0] * residuals[0] + residuals[1] * residuals[1]) / 2.0));
  std::filesystem::remove(path);
}

TEST(Exports, CancelledTable_LeavesNoFile) {
  const std::string path = (std::filesystem::temp_directory_path() / "dolp-cancelled.nc").string();
  CpuEvaluator evaluator(Precision::kAuto);
  const Scene scene = parse_scene(kPaint, "paint.toml", {});
  EXPECT_THROW(export_table(scene, path, "", evaluator, [](std::size_t, std::size_t) { return false; }), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Exports, TrueError_IsBelowItsBound) {
  Driver driver(paint());
  const std::string text = true_error(driver.session.curve(), {});
  double error = 0.0;
  double theta = 0.0;
  double bound = 0.0;
  ASSERT_EQ(std::sscanf(text.c_str(), "%lf at θ = %lf°, bound %lf", &error, &theta, &bound), 3) << text;
  EXPECT_LE(error, bound);
  EXPECT_GT(error, 0.0);
}

// ---- Ticks and lines -----------------------------------------------------------------------------------------------

TEST(Ticks, Linear_AreRoundAndNotTooMany) {
  EXPECT_EQ(linear_ticks(0.0, 90.0, 10), (std::vector<double>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90}));
  EXPECT_EQ(linear_ticks(0.0, 90.0, 9).size(), 5U);
  for (const auto& [low, high] : {std::pair{-3.3, 7.1}, std::pair{0.0, 1e-9}, std::pair{99.99, 100.01}}) {
    const std::vector<double> ticks = linear_ticks(low, high, 6);
    EXPECT_GE(ticks.size(), 2U);
    EXPECT_LE(ticks.size(), 6U);
    EXPECT_GE(ticks.front(), low - 1e-9 * (high - low));
    EXPECT_LE(ticks.back(), high + 1e-9 * (high - low));
  }
}

TEST(Ticks, Log_AreOneTwoFive) {
  EXPECT_EQ(log_ticks(0.01, 0.1, 10), (std::vector<double>{0.01, 0.02, 0.05, 0.1}));
  EXPECT_LE(log_ticks(1e-9, 1.0, 5).size(), 5U);
}

TEST(Contours, OfAPlane_AreStraightLines) {
  MapField field;
  field.count = 11;
  for (std::size_t row = 0; row < 11; ++row) {
    for (std::size_t column = 0; column < 11; ++column) {
      field.values.push_back(static_cast<double>(column));
      field.is_good.push_back(1);
    }
  }
  const std::vector<Segment> segments = contour(field, 3.5);
  EXPECT_EQ(segments.size(), 10U);
  for (const Segment& s : segments) {
    EXPECT_DOUBLE_EQ(s.x0, 0.35);
    EXPECT_DOUBLE_EQ(s.x1, 0.35);
  }
  field.is_good[3] = 0;
  EXPECT_EQ(contour(field, 3.5).size(), 9U);
}

}  // namespace
}  // namespace dolp::explore
