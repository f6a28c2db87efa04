// Parts behind the window, one by one: parameters, edits, worker, measured points, exports, ticks, lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/text.hpp"
#include "explore/background_task.hpp"
#include "explore/conflicts.hpp"
#include "explore/contours.hpp"
#include "explore/exports.hpp"
#include "explore/parameters.hpp"
#include "explore/ticks.hpp"
#include "explore_support.hpp"

namespace dolp::explore {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;

// ---- Parameters and edits ------------------------------------------------------------------------------------------

TEST(Parameters, All_HaveSymbolEquationAndASliderInsideTheirRange) {
  EXPECT_GT(parameters().size(), 15U);
  for (const Parameter& p : parameters()) {
    EXPECT_STRNE(p.symbol, "") << p.key->key;
    EXPECT_STRNE(p.equation, "") << p.key->key;
    for (const double end : {p.slider.min, p.slider.max}) {
      const std::string beside = p.key->key == "source.scale" ? "source.irradiance=1" : "title=paint";
      const Scene scene = paint({beside, p.key->key + "=" + format_number(end)}).scene();
      EXPECT_EQ(scene.number(p.key->key), end) << p.key->key;
    }
    EXPECT_TRUE(!p.is_log || p.slider.min > 0.0) << p.key->key;
  }
  EXPECT_TRUE(parameter("surface.sigma").is_log);
}

TEST(Edits, RefusedChange_LeavesTheSceneAsItWas) {
  SceneEdits edits = paint();
  EXPECT_THROW(edits.set("surface.sigma", -1.0), InputError);
  EXPECT_THROW(edits.set("surface.n", "none"), InputError);
  EXPECT_EQ(edits.scene().number("surface.sigma"), 0.15);
  EXPECT_TRUE(edits.changes().empty());
}

TEST(Edits, Reset_GivesTheValueOfTheCommandLineBack) {
  SceneEdits edits = paint({"surface.sigma=0.3"});
  edits.set("surface.sigma", 0.5);
  EXPECT_TRUE(edits.is_changed());
  edits.reset("surface.sigma");
  EXPECT_EQ(edits.scene().number("surface.sigma"), 0.3);
  EXPECT_FALSE(edits.is_changed());
}

TEST(Edits, Alternatives_ReplaceOneAnother) {
  SceneEdits edits = paint();
  edits.set("spectrum.wavelength_um", 10.6);
  edits.set("surface.material", "gold (Ordal)");
  EXPECT_EQ(edits.scene().word("surface.material"), "gold (Ordal)");
  const auto gold = edits.scene().refractive_index(10.6);
  edits.set("spectrum.band_um", {8.0, 12.0});
  EXPECT_EQ(edits.scene().refractive_index(10.6), gold);
  edits.set("spectrum.wavelength_um", 10.6);
  edits.set({{"surface.n", 1.6}, {"surface.k", 0.2}});
  EXPECT_EQ(edits.scene().refractive_index(10.6), std::pair(1.6, 0.2));
  edits.set("spectrum.band_um", {8.0, 14.0});
  EXPECT_EQ(edits.scene().numbers("spectrum.band_um"), (std::vector<double>{8.0, 14.0}));
  edits.set("source.preset", "sun");
  edits.set("source.irradiance", 2.0);
  EXPECT_EQ(edits.scene().number("source.irradiance"), 2.0);
}

TEST(Edits, Effects_GoAndComeBack) {
  SceneEdits edits = paint();
  edits.set("surroundings.temperature_K", 250.0);
  edits.set("surroundings", Value());
  EXPECT_FALSE(edits.scene().number("surroundings.temperature_K"));
  edits.reset("surroundings");
  EXPECT_EQ(edits.scene().number("surroundings.temperature_K"), 240.0);
}

TEST(Edits, EffectOfTheCommandLine_ComesBackAsOpened) {
  SceneEdits edits = paint({"emission.bracket=true", "emission.temperature_K=310"});
  edits.set("emission", Value());
  edits.reset("emission");
  EXPECT_EQ(edits.scene().number("emission.temperature_K"), 310.0);
  EXPECT_EQ(edits.scene().word("emission.bracket"), "true");
  EXPECT_FALSE(edits.is_changed());
}

// ---- Choices that exclude one another ------------------------------------------------------------------------------

using Changes = std::vector<Setting>;

bool is_accepted(const SceneEdits& edits, const Changes& changes) {
  try {
    edits.scene().with(changes);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Every combination of the words of some choices that the scene reader accepts.
std::vector<Changes> accepted_combinations(const std::vector<std::string>& keys) {
  std::vector<Changes> all = {{}};
  for (const Choice& choice : choices()) {
    if (std::ranges::find(keys, choice.key->key) == keys.end()) continue;
    std::vector<Changes> longer;
    for (const Changes& begun : all) {
      for (const std::string& word : choice.key->words) {
        longer.push_back(begun);
        longer.back().push_back({choice.key->key, TomlText{word}});
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
      for (const std::string& word : choice.key->words) {
        const Setting chosen = {choice.key->key, TomlText{word}};
        Changes asked = asked_for(edits.scene(), {chosen});
        EXPECT_EQ(asked.empty(), is_accepted(edits, {chosen})) << chosen.key << " = " << word;
        asked.push_back(chosen);
        EXPECT_TRUE(is_accepted(edits, asked)) << chosen.key << " = " << word;
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
    const Scene scene =
        Scene::from_file(file.path(), {{"title", "a \"quoted\" title"}, {"surface.sigma", 0.1234567890123}});
    const Scene again = Scene::from_text(scene.toml(kHostDir), {}, kHostDir + "/again.toml");
    EXPECT_EQ(again.title(), "a \"quoted\" title");
    for (const char* axis : {"grid.theta_deg", "grid.sigma", "grid.q"}) {
      EXPECT_EQ(again.numbers(axis), scene.numbers(axis));
    }
    EXPECT_EQ(again.number("surface.sigma"), 0.1234567890123);
    expect_same(truth(scene, points_at(scene, {0.0, 35.0, 70.0})), truth(again, points_at(again, {0.0, 35.0, 70.0})));
  }
}

TEST(SceneToml, WhatGoesBeyondSingleScattering_IsSaved) {
  const auto saved = [](const Setting& change) {
    SceneEdits edits = paint();
    edits.set({change});
    return Scene::from_text(edits.scene().toml()).word(change.key);
  };
  EXPECT_EQ(saved({"surface.scattering", "multiple"}), "multiple");
  EXPECT_EQ(saved({"emission.model", "direct"}), "direct");
  EXPECT_EQ(saved({"emission.bracket", true}), "true");
}

TEST(SceneToml, NamedFiles_AreFoundFromTheNewFolder) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "dolp-scene-toml";
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "saved");
  std::ofstream(folder / "scenes" / "paint.csv") << "wavelength_um,n,k\n8,1.5,0.1\n14,1.6,0.2\n";
  const std::string path = (folder / "scenes" / "paint.toml").string();
  const Scene scene = Scene::from_text(kPaint, {{"surface.material_file", "paint.csv"}}, path);
  const Scene again = Scene::from_text(scene.toml(folder / "saved"), {}, (folder / "saved" / "s.toml").string());
  EXPECT_EQ(again.refractive_index(10.0), scene.refractive_index(10.0));
  std::filesystem::remove_all(folder);
}

// ---- Worker --------------------------------------------------------------------------------------------------------

/// Waits in each call until it is let go, and notes what it was asked for.
class SlowEvaluator {
 public:
  Evaluate evaluate() {
    return [this](const Scene& scene, const PointList& list, const RunOptions& options) {
      std::unique_lock lock(mutex_);
      ++calls;
      changed_.notify_all();
      while (!is_open_) {
        changed_.wait_for(lock, std::chrono::milliseconds(1));
        if (!options.progress(0, 1)) {
          ++cancelled;
          throw Cancelled("no file was written");
        }
      }
      return explore::evaluate(cpu_, scene, list, options);
    };
  }
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
  Evaluator cpu_{EvaluatorOptions{.evaluator = "cpu"}};
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
};

Job job_of(const std::string& key) {
  const Scene scene = paint().scene();
  return {.key = key, .scene = scene, .parts = {points_at(scene, {10.0, 20.0, 30.0, 40.0})}};
}

std::vector<JobPart> finish(Worker& worker) {
  std::vector<JobPart> news;
  while (!worker.is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (JobPart& part : worker.take_news()) news.push_back(std::move(part));
  return news;
}

TEST(ExploreWorker, StaleJob_IsCancelledAndItsResultsNeverCome) {
  SlowEvaluator evaluator;
  Worker worker(evaluator.evaluate(), [] {});
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
  Worker worker(evaluator.evaluate(), [] {});
  worker.want({job_of("kept")});
  evaluator.wait_for_call();
  worker.want({job_of("first"), job_of("kept")});
  evaluator.open();
  EXPECT_EQ(finish(worker).size(), 2U);
  EXPECT_EQ(evaluator.cancelled, 0);
}

TEST(ExploreWorker, BriefJobUnderWay_IsFinishedThoughItIsNotWanted) {
  SlowEvaluator evaluator;
  Worker worker(evaluator.evaluate(), [] {});
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

TEST(ExploreWorker, Parts_ComeInOrderWithTheResultsOfTheWhole) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  Worker worker(on_the_cpu(evaluator), [] {});
  const Job whole = job_of("whole");
  Job job = whole;
  job.parts = {points_at(job.scene, {10.0, 20.0, 30.0}), points_at(job.scene, {40.0})};
  worker.want({job});
  const std::vector<JobPart> news = finish(worker);
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].points.size(), 3U);
  EXPECT_FALSE(news[0].is_last);
  EXPECT_EQ(news[1].part, 1U);
  EXPECT_TRUE(news[1].is_last);
  EXPECT_GT(news[1].evaluations, 0.0);
  std::vector<Point> all = news[0].points;
  all.insert(all.end(), news[1].points.begin(), news[1].points.end());
  expect_same(all, truth(whole.scene, whole.parts.front()));
}

TEST(ExploreWorker, Tolerance_IsTheWiderOfJobAndScene) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  Worker worker(on_the_cpu(evaluator), [] {});
  for (const auto& [wanted, taken] : {std::pair{1e-2, 1e-2}, {1e-6, 1e-3}}) {
    Job job = job_of(std::to_string(wanted));
    job.tolerance = wanted;
    worker.want({job});
    EXPECT_EQ(finish(worker).at(0).scene.number("accuracy.tolerance"), taken);
  }
}

TEST(ExploreWorker, LostDevice_IsThrownToWhoAsksForNews) {
  const auto lost = [](const Scene&, const PointList&, const RunOptions&) -> Results { throw DeviceError("lost"); };
  Worker worker(lost, [] {});
  worker.want({job_of("any")});
  while (!worker.is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_THROW(worker.take_news(), DeviceError);
}

// ---- Measured points, exports --------------------------------------------------------------------------------------

TEST(Measured, Quantities_AreReadAsDolpFitReadsThem) {
  const MeasuredPoints points =
      points_of(MeasuredData::from_csv("uncertainty,theta_deg,q_over_i\n0.01,60,-0.1\n", "m.csv"));
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_EQ(points.points[0].quantity, Plotted::kSignedDolp);
  EXPECT_EQ(points.points[0].value, -0.1);
  EXPECT_EQ(points.points[0].uncertainty, 0.01);
  EXPECT_EQ(points_of(MeasuredData::from_csv("theta_deg,emissivity_s,emissivity_p\n60,0.9,0.8\n")).points.size(), 2U);
  EXPECT_THROW(points_of(MeasuredData::from_csv("theta_deg,dolp\n95,0.1\n")), InputError);
  EXPECT_THROW(points_of(MeasuredData::from_csv("theta_deg,dolp\n60,0.1\n", "data", {{"surface.n", 2.0}})), InputError);
}

TEST(Measured, Residuals_AreMeasuredMinusModelAtTheMeasuredPoints) {
  Driver driver(paint());
  const std::string path = (std::filesystem::temp_directory_path() / "dolp-measured.csv").string();
  for (const bool is_signed : {false, true}) {
    std::ofstream(path) << (is_signed ? "theta_deg,q_over_i\n" : "theta_deg,dolp\n") << "33.3,0.05\n61.7,0.06\n";
    driver.session.load_measured(path);
    driver.settle();
    const Scene& scene = driver.session.scene();
    const std::vector<Point> model = truth(scene, points_at(scene, {33.3, 61.7}));
    const auto value = [&](std::size_t i) { return is_signed ? model[i].stokes_q / model[i].stokes_i : model[i].dolp; };
    const std::vector<double> residuals = driver.session.residuals().residuals();
    ASSERT_EQ(residuals.size(), 2U);
    EXPECT_EQ(residuals[0], 0.05 - value(0));
    EXPECT_EQ(residuals[1], 0.06 - value(1));
    const Plotted quantity = is_signed ? Plotted::kSignedDolp : Plotted::kDolp;
    EXPECT_DOUBLE_EQ(*driver.session.residuals().rms(quantity),
                     std::sqrt((residuals[0] * residuals[0] + residuals[1] * residuals[1]) / 2.0));
    EXPECT_FALSE(driver.session.residuals().rms(Plotted::kAlbedo));
  }
  std::filesystem::remove(path);
}

TEST(Exports, CancelledTable_LeavesNoFile) {
  const std::string path = (std::filesystem::temp_directory_path() / "dolp-cancelled.nc").string();
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  const auto cancelled = [](std::size_t, std::size_t) { return false; };
  EXPECT_THROW(export_table(paint().scene(), path, "", evaluator, cancelled), Cancelled);
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

}  // namespace
}  // namespace dolp::explore
