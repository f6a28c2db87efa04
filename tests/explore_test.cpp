// What is behind the window: parameters, edits, worker, curve, map, peak, pins, cursor, measured points, exports.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "error.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/run/scene_run.hpp"
#include "explore/background_task.hpp"
#include "explore/contours.hpp"
#include "explore/exports.hpp"
#include "explore/parameters.hpp"
#include "explore/readout.hpp"
#include "explore/session.hpp"
#include "explore/ticks.hpp"
#include "explore/worker.hpp"
#include "scene/scene_reader.hpp"
#include "scene/text.hpp"

namespace dolp::explore {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;

const std::string kPaint = R"(title = "Paint"
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "v-cavity"
specular = 0.97
diffuse = 0.03
[emission]
temperature_K = 290
[surroundings]
temperature_K = 240
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 60]
sigma = [0.1, 0.4]
[accuracy]
tolerance = 1e-3
)";

SceneEdits paint(const std::vector<std::string>& overrides = {}) { return {kPaint, "paint.toml", overrides}; }

/// A session with a worker on the CPU.
class Driver {
 public:
  explicit Driver(SceneEdits edits) : session(std::move(edits)), worker_(evaluator_, [] {}) { settle(); }

  void settle() {
    for (;;) {
      const bool was_idle = worker_.is_idle();
      session.take(worker_.take_news());
      const bool is_changed = session.take_changed();
      std::vector<Job> jobs = is_changed ? session.wanted() : std::vector<Job>{};
      if (was_idle && jobs.empty()) return;
      if (is_changed) worker_.want(std::move(jobs));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Session session;

 private:
  CpuEvaluator evaluator_{Precision::kAuto};
  Worker worker_;
};

std::vector<PointResult> truth(const Scene& scene, const std::vector<SceneEntry>& entries) {
  CpuEvaluator evaluator(Precision::kAuto);
  return evaluate_scene(scene, entries, plan_effects(scene, entries, false), &evaluator, {});
}

void expect_same(const std::vector<PointResult>& a, const std::vector<PointResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i].dolp) && std::isnan(b[i].dolp)) continue;
    EXPECT_EQ(a[i].dolp, b[i].dolp) << i;
    EXPECT_EQ(a[i].error_estimate, b[i].error_estimate) << i;
  }
}

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
    const std::vector<SceneEntry> entries = entries_at(edits.scene(), {0.0, 35.0, 70.0});
    EXPECT_EQ(entries_at(again, {70.0}).front().shape, entries.back().shape);
    expect_same(truth(edits.scene(), entries), truth(again, entries));
  }
}

TEST(SceneToml, NamedFiles_AreFoundFromTheNewFolder) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "dolp-scene-toml";
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "saved");
  std::ofstream(folder / "scenes" / "paint.csv") << "wavelength_um,n,k\n8,1.5,0.1\n14,1.6,0.2\n";
  const std::string path = (folder / "scenes" / "paint.toml").string();
  const SceneEdits edits(kPaint, path, {"surface.material_file=paint.csv"});
  const Scene again = parse_scene(edits.toml(folder / "saved"), (folder / "saved" / "s.toml").string(), {});
  EXPECT_EQ(again.surface.material.at(11.0), edits.scene().surface.material.at(11.0));
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

Job job_of(const std::string& key, std::size_t batch = 0) {
  Job job;
  job.key = key;
  job.scene = parse_scene(kPaint, "paint.toml", {});
  job.entries = entries_at(job.scene, {10.0, 20.0, 30.0, 40.0});
  job.batch = batch;
  return job;
}

std::vector<News> finish(Worker& worker) {
  std::vector<News> news;
  while (!worker.is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (News& part : worker.take_news()) news.push_back(std::move(part));
  return news;
}

TEST(ExploreWorker, StaleJob_IsCancelledAndItsResultsNeverCome) {
  SlowEvaluator evaluator;
  Worker worker(evaluator, [] {});
  worker.want({job_of("stale")});
  evaluator.wait_for_call();
  worker.want({job_of("new")});
  evaluator.open();
  const std::vector<News> news = finish(worker);
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

TEST(ExploreWorker, Batches_GiveThePartsInOrderWithTheResultsOfTheWhole) {
  CpuEvaluator evaluator(Precision::kAuto);
  Worker worker(evaluator, [] {});
  const Job job = job_of("parts", 3);
  worker.want({job});
  const std::vector<News> news = finish(worker);
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].results.size(), 3U);
  EXPECT_FALSE(news[0].is_last);
  EXPECT_EQ(news[1].first, 3U);
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

// ---- Session -------------------------------------------------------------------------------------------------------

TEST(ExploreSession, Curve_IsThatOfTheSceneAtItsTolerance) {
  Driver driver(paint());
  driver.session.set("surface.sigma", 0.3);
  driver.settle();
  const Curve& curve = driver.session.curve();
  ASSERT_TRUE(curve.is_finished());
  EXPECT_EQ(curve.entries().size(), Curve::kFineCount);
  expect_same(curve.results(), truth(driver.session.scene(), curve.entries()));
  EXPECT_LE(curve.worst_error(), 1e-3);
  EXPECT_GT(curve.worst_error(), 0.0);
}

TEST(ExploreSession, RefusedValue_IsAMessageAndNoChange) {
  Driver driver(paint());
  driver.session.set("surface.sigma", 99.0);
  EXPECT_TRUE(driver.session.message().is_error);
  EXPECT_EQ(driver.session.scene().surface.sigma, 0.15);
  EXPECT_TRUE(driver.session.curve().is_finished());
}

TEST(ExploreSession, Overlay_IsTheOtherDistributionOfTheSameD0) {
  Driver driver(paint());
  ASSERT_TRUE(driver.session.overlay());
  const Surface& other = driver.session.overlay()->scene().surface;
  EXPECT_EQ(other.distribution, Distribution::kGaussian);
  EXPECT_DOUBLE_EQ(other.sigma, 0.15 / std::sqrt(2.0));
  driver.session.set({{"surface.distribution", "gaussian"}});
  EXPECT_EQ(driver.session.overlay()->scene().surface.distribution, Distribution::kCauchy);
}

TEST(ExploreSession, Pin_StaysWhileTheSceneChanges) {
  Driver driver(paint());
  const std::vector<PointResult> before = driver.session.curve().results();
  driver.session.pin();
  driver.session.set("surface.sigma", 0.6);
  driver.settle();
  ASSERT_EQ(driver.session.pins().size(), 1U);
  expect_same(driver.session.pins()[0].curve.results(), before);
  EXPECT_NE(driver.session.curve().results()[100].dolp, before[100].dolp);
  driver.session.remove_pin(0);
  EXPECT_TRUE(driver.session.pins().empty());
}

TEST(ExploreSession, PinOfAnUnfinishedCurve_IsFinishedLater) {
  Driver driver(paint());
  driver.session.set("surface.sigma", 0.6);
  driver.session.pin();
  driver.session.set("surface.sigma", 0.2);
  driver.settle();
  const Curve& pinned = driver.session.pins()[0].curve;
  EXPECT_TRUE(pinned.is_finished());
  EXPECT_EQ(pinned.entries().front().shape.sigma, 0.6);
  expect_same(pinned.results(), truth(pinned.scene(), pinned.entries()));
}

TEST(ExploreSession, MapCursor_DrivesTheCurveAndDoesNotChangeTheMap) {
  Driver driver(paint());
  const std::size_t version = driver.session.map().version();
  driver.session.set_map_cursor(0.5, 0.5);
  driver.settle();
  EXPECT_DOUBLE_EQ(driver.session.theta_deg(), 45.0);
  EXPECT_NEAR(driver.session.scene().surface.sigma, 0.2, 1e-4);  // the grid's 0.1 .. 0.4
  EXPECT_EQ(driver.session.curve().entries().front().shape.sigma, driver.session.scene().surface.sigma);
  EXPECT_NEAR(driver.session.map_cursor_y(), 0.5, 1e-3);
  EXPECT_EQ(driver.session.map().version(), version);
}

TEST(ExploreSession, Map_FinishesAt128WithTheValuesOfTheScene) {
  Driver driver(paint());
  const HeatMap& map = driver.session.map();
  ASSERT_TRUE(map.is_finished());
  const MapField field = map.field(Quantity::kDolp);
  ASSERT_EQ(field.count, 128U);
  const auto entry = [&](std::size_t column, std::size_t row) {
    return SceneEntry{
        map.x().value(static_cast<double>(column) / 127.0), {map.y().value(static_cast<double>(row) / 127.0), 3.0}, {}};
  };
  const std::vector<SceneEntry> some = {entry(0, 0), entry(80, 3), entry(5, 127), entry(100, 64)};
  const std::vector<PointResult> exact = truth(driver.session.scene(), some);
  EXPECT_EQ(field.values[80 + 3 * 128], exact[1].dolp);
  EXPECT_EQ(field.values[5 + 127 * 128], exact[2].dolp);
  EXPECT_EQ(field.values[100 + 64 * 128], exact[3].dolp);
}

TEST(ExploreSession, MapAxes_AreNeverTheSame) {
  Driver driver(paint());
  View view = driver.session.view();
  view.map_x = AxisKind::kSigma;
  view.map_y = AxisKind::kSigma;
  driver.session.set_view(view);
  EXPECT_NE(driver.session.map().x().kind, driver.session.map().y().kind);
}

TEST(ExploreSession, Peak_IsTheLargestOfTheCurveAndItsCausesAddUp) {
  Driver driver(paint());
  const Peak& peak = driver.session.peak();
  ASSERT_TRUE(peak.is_complete());
  double sum = 0.0;
  for (const WithoutEffect& away : peak.without()) {
    if (away.radiates) sum += peak.contribution(away);
  }
  EXPECT_NEAR(sum, peak.answer()->q_over_i, 2e-3);  // two runs at a tolerance of 1e-3
  for (const PointResult& result : driver.session.curve().results()) {
    if (!is_good(result)) continue;
    EXPECT_LE(result.dolp, peak.answer()->dolp + result.error_estimate);
  }
  EXPECT_LE(peak.answer()->theta_low_deg, peak.answer()->theta_deg);
  EXPECT_GE(peak.answer()->theta_high_deg, peak.answer()->theta_deg);
  EXPECT_NE(cause_text(driver.session).find("emission -"), std::string::npos) << cause_text(driver.session);
  EXPECT_NE(cause_text(driver.session).find("against it: surroundings +"), std::string::npos);
}

TEST(ExploreSession, ThetaMax_BoundsMapCursorAndPeak) {
  Driver driver(paint());
  View view = driver.session.view();
  view.theta_max_deg = 50.0;
  driver.session.set_view(view);
  driver.settle();
  EXPECT_EQ(driver.session.map().x().to, 50.0);
  EXPECT_EQ(driver.session.theta_deg(), 50.0);
  ASSERT_TRUE(driver.session.peak().answer());
  EXPECT_EQ(driver.session.peak().answer()->theta_deg, 50.0);
  EXPECT_TRUE(driver.session.peak().answer()->is_at_end);
}

TEST(ExploreSession, FlatCurve_HasARival) {
  Driver driver(paint({"surroundings=none", "source.irradiance=1e-9", "geometry.mode=bistatic"}));
  ASSERT_TRUE(driver.session.peak().answer());
  EXPECT_TRUE(driver.session.peak().answer()->rival_deg);
}

TEST(ExploreSession, Effects_AreThoseOfThePlanWithBoundsAtTheCursor) {
  Driver driver(paint());
  driver.session.set_theta(60.0);
  const auto bound_of = [&](const std::string& name) {
    for (const EffectRow& row : driver.session.effects()) {
      if (row.name == name) return row.bound.value_or(-1.0);
    }
    return -2.0;
  };
  const double at_60 = bound_of("surroundings");
  EXPECT_GT(at_60, 0.0);
  driver.session.set_theta(20.0);
  EXPECT_LT(bound_of("surroundings"), at_60);
}

TEST(ExploreSession, RhoOfADroppingPlan_IsComputedWhenItIsShown) {
  Driver driver(paint({"surroundings.temperature_K=290"}));
  EXPECT_TRUE(std::isnan(driver.session.curve().results()[50].rho_i));
  View view = driver.session.view();
  view.quantity = Quantity::kRhoS;
  driver.session.set_view(view);
  driver.settle();
  EXPECT_TRUE(std::isfinite(driver.session.curve().results()[50].rho_i));
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

TEST(Measured, WrongFiles_AreNamedByLineAndColumn) {
  EXPECT_EQ(measured_error("theta_deg\n1\n"), "m.csv:1: column \"dolp\" is missing, a number in [-1, 1]");
  EXPECT_EQ(measured_error("dolp,theta_deg\n0.1,95\n"), "m.csv:2: theta_deg = 95: out of range, a number in [0, 90]");
  EXPECT_EQ(measured_error("theta_deg,dolp\n60,0.1\n61\n"),
            "m.csv:3: dolp = : the value is missing, a number in [-1, 1]");
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
