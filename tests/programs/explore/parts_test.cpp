// Parts of the window without a display: controls, edits of the scene, the worker, measured points, exports.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "base/text.hpp"
#include "explore/scene_edits.hpp"
#include "explore/session.hpp"
#include "explore_support.hpp"
#include "temporary_file.hpp"

namespace dolp::explore::parts_test {
namespace {

std::string sixteen_films() {
  std::string films;
  for (int i = 0; i < 16; ++i) films += "{n=1.5,k=0,thickness_um=1},";
  return "surface.coating=[" + films + "]";
}

/// A setting that a scene needs before it accepts this key.
std::string needed_by(const Key& key) {
  for (const auto& [begin, setting] : {std::pair{"source.scale", "source.irradiance=1"},
                                       {"surface.wind_m_s", "surface.distribution=gaussian"},
                                       {"surface.sigma_cross", "surface.masking=none"},
                                       {"surroundings.vapour_cm", "surroundings.profile=clear-sky"},
                                       {"surroundings.air_temperature_K", "surroundings.profile=overcast"},
                                       {kZenithSky, "surroundings.horizon_temperature_K=250"},
                                       {kHorizonSky, "surroundings.zenith_temperature_K=250"}}) {
    if (key.key == begin) return setting;
  }
  return key.layer > 0 ? sixteen_films() : "title=paint";
}

TEST(Controls, EndsOfEverySlider_AreAccepted) {
  for (const Control& control : controls()) {
    if (!control.is_number()) continue;
    const std::string& key = control.key->key;
    for (const double end : {control.slider.from, control.slider.to}) {
      const Scene scene = paint({needed_by(*control.key), key + "=" + format_number(end)}).scene();
      EXPECT_EQ(scene.number(key), end) << key;
      EXPECT_TRUE(control.value(scene) || !control.may_apply(scene)) << key;
    }
    EXPECT_TRUE(!control.slider.is_log || control.slider.from > 0.0) << key;
  }
}

TEST(Controls, OfSlopesAlongAndAcross_AreShownWhereTheyAct_AndStayWithinAFactorOfThree) {
  const Control &cross = control(kSigmaCross), &azimuth = control(kSurfaceAzimuth), &wind = control("surface.wind_m_s");
  EXPECT_EQ(cross.value(paint().scene()), 0.15);  // the default, sigma
  EXPECT_FALSE(cross.value(paint({"surface.masking=smith"}).scene()) || azimuth.value(paint().scene()));
  const Scene brushed = paint({"surface.sigma_cross=0.3"}).scene();
  EXPECT_EQ(azimuth.value(brushed), 0.0);
  EXPECT_DOUBLE_EQ(range_in(brushed, cross).to, 0.45);
  EXPECT_DOUBLE_EQ(range_in(brushed, control("surface.sigma")).from, 0.1);
  const Scene sea = paint({"surface.distribution=gaussian", "surface.wind_m_s=8"}).scene();
  EXPECT_EQ(control("surface.wind_model").word(sea), 0U);
  EXPECT_FALSE(control("surface.wind_model").word(brushed) || cross.value(sea));
  EXPECT_EQ(range_in(sea, wind).from, 0.0);
  EXPECT_EQ(range_in(sea.with("surface.wind_model", "directional"), wind).from, 0.2);
}

TEST(Controls, OfDiffuseLightAndOfTheAir_AreShownWhereTheSceneUsesThem) {
  const Control &light = control("surface.diffuse_polarisation"), &water = control("surroundings.vapour_cm"),
                &air = control("surroundings.air_temperature_K");
  EXPECT_EQ(light.word(paint().scene()), 0U);
  EXPECT_FALSE(light.word(paint({"surface.diffuse=0"}).scene()));
  for (const char* sky : {"clear-sky", "overcast"}) {
    const Scene scene = paint({std::string("surroundings.profile=") + sky}).scene();
    EXPECT_EQ(water.value(scene), 1.27);
    EXPECT_EQ(air.value(scene), 288.15);
    EXPECT_EQ(water.value(scene.with("surroundings.vapour_cm", 0.3)), 0.3);
  }
  EXPECT_FALSE(water.value(paint().scene()) || air.value(paint().scene()));
}

TEST(Materials, AreSortedWithinTheirKinds_AndFoundByWords) {
  const std::vector<BuiltInMaterial> all = sorted_materials();
  EXPECT_EQ(all.size(), materials().size());
  EXPECT_EQ(all.front().name, "aluminium (Ordal)");
  std::vector<std::string> kinds;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_same_kind = !kinds.empty() && kinds.back() == all[i].kind;
    EXPECT_TRUE(!is_same_kind || lower_case(all[i - 1].name) < lower_case(all[i].name)) << all[i].name;
    EXPECT_TRUE(is_same_kind || std::ranges::count(kinds, all[i].kind) == 0) << all[i].name;
    kinds.push_back(all[i].kind);
  }
  EXPECT_EQ(std::ranges::count(kinds, "metal"), 13);
  EXPECT_EQ(std::ranges::count(kinds, ""), 0);
  EXPECT_TRUE(has_words("metal gold (Ordal), 2 to 20 µm", "Ord GOLD"));
  EXPECT_FALSE(has_words("metal gold (Ordal), 2 to 20 µm", "gold olmon"));
  EXPECT_TRUE(has_words("iron", " "));
}

TEST(ControlRows, RowsOnceShown_StayUntilAnotherSceneIsOpened_AndAlternativesShareOne) {
  SceneEdits edits = paint();
  ControlRows rows;
  rows.follow(edits.opened());
  const auto stays = [&](const char* key) { return rows.stays(edits.scene(), control(key)); };
  EXPECT_FALSE(stays("geometry.view_zenith_deg"));
  for (const Control& shown : controls()) {
    if (shown.applies(edits.scene())) rows.note(shown.key->key);
  }
  EXPECT_FALSE(stays("surface.q"));
  edits.set({{"surface.distribution", "gaussian"}, {"surface.wind_m_s", 8.0}, {"surface.material", "gold (Ordal)"}});
  edits.set({{"surface.diffuse", 0.0}, {"surroundings", Value()}});
  for (const char* key : {"surface.q", "surface.n", "surface.diffuse_exponent", "surroundings.temperature_K"})
    EXPECT_TRUE(stays(key)) << key;
  EXPECT_FALSE(stays("surface.sigma"));  // the wind has its row
  EXPECT_FALSE(stays("surface.specular"));
  EXPECT_EQ(unused_text(edits.scene(), control("surface.q")), "surface.q: needs the distribution cauchy");
  EXPECT_EQ(unused_text(edits.scene(), control("surface.n")), "surface.n: the scene has surface.material instead");
  rows.follow(edits.opened());
  EXPECT_TRUE(stays("surface.q"));
  rows.follow(Scene::from_text(kPaint, {}, "other.toml"));
  EXPECT_FALSE(stays("surface.q"));
}

using Changes = std::vector<Setting>;

/// The value of a key as text, or "-" if the scene does not have the key.
std::string value_of(const Scene& scene, const std::string& key) {
  if (described(key).type == Key::Type::kPair)
    return scene.numbers(key).empty() ? "-" : Value(scene.numbers(key)).text();
  if (described(key).type != Key::Type::kNumber) return scene.word(key).value_or("-");
  return scene.number(key) ? format_number(*scene.number(key)) : "-";
}

struct EditCase {
  std::vector<std::string> opened;  ///< settings with which the window opens
  /// A step is "KEY=VALUE", "reset KEY", or "reset" for all keys. "KEY=VALUE;KEY=VALUE" makes two changes in one step.
  std::vector<std::string> steps;
  std::vector<std::string> expected;  ///< settings of the scene afterwards
  std::string message = "";           ///< text that the last message contains; empty: no message
  bool is_error = false;
};

const std::vector<EditCase> kEditCases = {
    {{}, {"surface.sigma=99"}, {"surface.sigma=0.15"}, "out of range", true},
    {{}, {"surface.n=none"}, {"surface.n=1.5"}, "surface.n", true},
    {{}, {"surface.sigma=99", "surface.sigma=0.2"}, {"surface.sigma=0.2"}},
    {{"surface.sigma=0.3"}, {"surface.sigma=0.5", "reset surface.sigma"}, {"surface.sigma=0.3"}},
    {{"surface.sigma=0.3"}, {"surface.sigma=0.5", "surface.n=2", "reset"}, {"surface.sigma=0.3", "surface.n=1.5"}},
    {{}, {"surface.material=gold (Ordal)"}, {"surface.material=gold (Ordal)", "surface.n=-"}},
    {{"surface.material=gold (Ordal)"}, {"surface.n=1.6;surface.k=0.2"}, {"surface.material=-", "surface.k=0.2"}},
    {{},
     {"spectrum.band_um=[8,14]", "spectrum.wavelength_um=9", "spectrum.band_um=[8,12]"},
     {"spectrum.band_um=[8, 12]", "spectrum.wavelength_um=-"}},
    {{}, {"source.preset=sun", "source.irradiance=2"}, {"source.irradiance=2"}, "a camera needs geometry.mode"},
    {{"spectrum.band_um=[8,14]"},
     {"surface.material=oxidised Al mirror"},
     {"surface.n=1.5"},
     "known at 2 to 12.5 um",
     true},
    {{}, {"surroundings=none"}, {"surroundings.temperature_K=-"}},
    {{"emission.bracket=true", "emission.temperature_K=310"},
     {"emission=none", "reset emission"},
     {"emission.temperature_K=310", "emission.bracket=true"}},
    // A setting may exclude other settings. The window then changes those settings, too, and says so in its message.
    {{"surface.masking=smith", "emission.bracket=true"},
     {"surface.scattering=multiple"},
     {"surface.masking=v-cavity", "emission.bracket=false"},
     "surface.scattering = multiple also sets surface.masking = v-cavity, emission.bracket = false"},
    {{"surface.masking=smith"}, {"surface.scattering=multiple", "surface.sigma=0.2"}, {"surface.sigma=0.2"}},
    {{}, {"surface.scattering=multiple;surface.masking=smith"}, {"surface.masking=v-cavity"}, "scattering", true},
    {{"emission.model=direct"},
     {"emission=none", "surface.masking=integral", "reset emission"},
     {"emission.model=direct", "surface.masking=v-cavity"},
     "emission = as opened also sets surface.masking = v-cavity"},
    // A wind determines sigma. If the distribution changes, the scene keeps this sigma instead of the wind.
    {{"surface.distribution=gaussian", "surface.wind_m_s=8"}, {"surface.wind_m_s=12"}, {"surface.wind_m_s=12"}},
    {{"surface.distribution=gaussian", "surface.wind_m_s=10"},
     {"surface.distribution=cauchy"},
     {"surface.wind_m_s=-", "surface.sigma=0.1646207763315433"},
     "surface.sigma = 0.16462"},
    {{"surface.distribution=gaussian", "surface.wind_m_s=10", "surface.wind_model=directional"},
     {"surface.masking=smith"},
     {"surface.wind_m_s=10", "surface.wind_model=isotropic"},
     "surface.masking = smith also sets surface.wind_model = isotropic"},
    {{"surface.distribution=gaussian", "surface.wind_m_s=10", "surface.wind_model=directional"},
     {"surface.sigma=0.2"},
     {"surface.wind_m_s=-", "surface.wind_model=isotropic"}},
    {{"surface.sigma_cross=0.3", "grid.sigma_cross=[0.3, 0.4]"},
     {"emission.bracket=true"},
     {"surface.sigma_cross=-", "emission.bracket=true"},
     "grid.sigma_cross = "},
    {{"emission.bracket=true"}, {"surface.sigma_cross=0.3"}, {"surface.sigma_cross=0.3"}, "emission.bracket = false"},
    {{"surface.coating=[{n=1.4,thickness_um=2}]"},
     {"surface.coating.1.k=0.3", "surface.coating=[{n=1.6,thickness_um=3},{n=1.4,k=0.3,thickness_um=2}]",
      "surface.coating.2.thickness_um=5", "surface.coating.1.n=1.7"},
     {"surface.coating.1.n=1.7", "surface.coating.1.thickness_um=3", "surface.coating.2.k=0.3",
      "surface.coating.2.thickness_um=5"}},
    {{"surface.coating=[{n=1.4,thickness_um=2}]"},
     {"surface.coating.1.n=1.7", "surface.coating=none"},
     {"surface.coating.1.n=-", "surface.n=1.5"}},
    {{}, {"surface.coating=[{n=1.4,thickness_um=-2}]"}, {"surface.coating.1.n=-"}, "thickness_um", true},
    {{}, {"surroundings.profile=clear-sky"}, {"surroundings.temperature_K=-", "surroundings.profile=clear-sky"}},
    {{},
     {"surroundings.zenith_temperature_K=220;surroundings.horizon_temperature_K=280",
      "reset surroundings.zenith_temperature_K"},
     {"surroundings.temperature_K=240", "surroundings.horizon_temperature_K=-"}},
    {{"surroundings=none"},
     {"surroundings.zenith_temperature_K=220;surroundings.horizon_temperature_K=280",
      "reset surroundings.horizon_temperature_K"},
     {"surroundings.temperature_K=-", "surroundings.zenith_temperature_K=-"}},
    {{"surface.material=gold (Ordal)"},
     {"surface.n=1.6;surface.k=0.2", "reset surface.n"},
     {"surface.material=gold (Ordal)", "surface.n=-"}},
    {{"emission.bracket=true"}, {"surroundings.profile=overcast"}, {"emission.bracket=true"}},
    {{"surroundings.profile=overcast"}, {"surroundings.temperature_K=250"}, {"surroundings.profile=-"}},
    {{"surroundings.profile=clear-sky", "surroundings.vapour_cm=0.3"},
     {"surroundings.temperature_K=250"},
     {"surroundings.temperature_K=250", "surroundings.profile=-", "surroundings.vapour_cm=-"}},
    {{"surface.diffuse_polarisation=transmission"},
     {"surface.coating=[{n=1.4,thickness_um=2}]"},
     {"surface.coating.1.n=1.4", "surface.diffuse_polarisation=none"},
     "also sets surface.diffuse_polarisation = none"},
    {{"surface.masking=smith"}, {"surface.q=1.2"}, {"surface.q=3", "surface.masking=smith"}, "surface.q", true},
};

void take_step(Session& session, const std::string& step) {
  if (step == "reset") return session.reset_all();
  if (step.starts_with("reset ")) return session.reset(step.substr(6));
  Changes changes;
  for (const std::string_view setting : split(step, ';')) changes.push_back(Setting::from_text(std::string(setting)));
  session.set(changes);
}

TEST(Edits, EachKind_GivesTheValuesAndTheMessage) {
  for (const EditCase& edit : kEditCases) {
    SCOPED_TRACE(edit.steps.front());
    Session session(paint(edit.opened));
    for (const std::string& step : edit.steps) take_step(session, step);
    for (const std::string& setting : edit.expected) {
      const std::string key = setting.substr(0, setting.find('='));
      EXPECT_EQ(key + '=' + value_of(session.scene(), key), setting);
    }
    EXPECT_TRUE(contains(session.message().text, edit.message));
    EXPECT_EQ(session.message().text.empty(), edit.message.empty()) << session.message().text;
    EXPECT_EQ(session.message().is_error, edit.is_error);
    session.reset_all();
    EXPECT_FALSE(session.edits().is_changed());
    EXPECT_EQ(session.scene().toml(), paint(edit.opened).scene().toml());
  }
}

bool is_accepted(const SceneEdits& edits, const Changes& changes) {
  try {
    edits.scene().with(changes);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// A combination gives each of the keys one of its words. Returns all combinations that the scene reader accepts.
std::vector<Changes> accepted_combinations(const std::vector<std::string>& keys) {
  std::vector<Changes> all = {{}};
  for (const std::string& key : keys) {
    std::vector<Changes> longer;
    for (const Changes& begun : all) {
      for (const std::string& word : described(key).words) {
        longer.push_back(begun);
        longer.back().push_back({key, TomlText{word}});
      }
    }
    all = std::move(longer);
  }
  std::erase_if(all, [](const Changes& changes) { return !is_accepted(paint(), changes); });
  return all;
}

TEST(Conflicts, EveryChoiceInEveryScene_IsTakenWithTheLeastThatItNeeds) {
  const std::vector<Changes> combinations = accepted_combinations(
      {"surface.masking", "surface.scattering", "emission.model", "emission.bracket", "geometry.mode"});
  EXPECT_EQ(combinations.size(), 28U);
  for (const Changes& combination : combinations) {
    SceneEdits edits = paint();
    edits.set(combination);
    for (const Control& choice : controls()) {
      // The window shows these two only beside a response_file and a wind.
      if (choice.key->key == "spectrum.response_per" || choice.key->key == "surface.wind_model") continue;
      for (const std::string& word : choice.key->words) {
        const Setting chosen = {choice.key->key, TomlText{word}};
        SceneEdits changed = edits;
        Changes needed = change_with_needed(changed, [&](SceneEdits& trial) { trial.set({chosen}); });
        EXPECT_EQ(needed.empty(), is_accepted(edits, {chosen})) << chosen.key << " = " << word;
        EXPECT_EQ(changed.scene().word(chosen.key), word);
        needed.push_back(chosen);
        for (std::size_t i = 0; i + 1 < needed.size(); ++i) {
          Changes fewer = needed;
          fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
          EXPECT_FALSE(is_accepted(edits, fewer)) << chosen.key << " = " << word;
        }
      }
    }
  }
}

constexpr auto kMoment = std::chrono::milliseconds(1);

/// An evaluator whose calls wait until is_open is true.
struct SlowEvaluator {
  Evaluate evaluate() {
    return [this](const Scene& scene, const std::vector<Column>& points, const RunOptions& options) {
      for (++calls; !is_open; std::this_thread::sleep_for(kMoment)) {
        if (options.progress(0, 1)) continue;
        ++cancelled;
        throw Cancelled("no file was written");
      }
      return on_the_cpu(scene, points, options);
    };
  }
  static void wait_for(const std::atomic<int>& count) {
    while (count == 0) std::this_thread::sleep_for(kMoment);
  }

  std::atomic<int> calls = 0, cancelled = 0;
  std::atomic<bool> is_open = false;
};

Job job_of(const std::string& key) {
  const Scene scene = paint().scene();
  return {.key = key, .scene = scene, .list = points_at(scene, {10.0, 20.0, 30.0, 40.0})};
}

std::vector<JobResult> finish(Worker& worker) {
  while (!worker.is_idle()) std::this_thread::sleep_for(kMoment);
  return worker.take_news();
}

TEST(ExploreWorker, RunningJob_EndsWhenItIsNoLongerWantedUnlessItIsBrief) {
  using Keys = std::vector<std::string>;
  // While the job "first" runs, the worker gets a new list of jobs. next: keys of this list. expected: keys of the
  // results, in their order. cancelled: how often a running job is cancelled.
  for (const auto& [is_brief, next, expected, cancelled] : {std::tuple{false, Keys{"new"}, Keys{"new"}, 1},
                                                            {false, Keys{"new", "first"}, Keys{"first", "new"}, 0},
                                                            {true, Keys{"new"}, Keys{"first", "new"}, 0},
                                                            {false, Keys{}, Keys{}, 1}}) {
    SlowEvaluator evaluator;
    Worker worker(evaluator.evaluate(), [] {});
    Job first = job_of("first");
    first.is_brief = is_brief;
    worker.want({first});
    evaluator.wait_for(evaluator.calls);
    std::vector<Job> jobs;
    for (const std::string& key : next) jobs.push_back(job_of(key));
    worker.want(std::move(jobs));
    if (cancelled > 0) evaluator.wait_for(evaluator.cancelled);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // time in which a wrong cancellation would occur
    evaluator.is_open = true;
    std::vector<std::string> keys;
    for (const JobResult& result : finish(worker)) keys.push_back(result.key);
    EXPECT_EQ(keys, expected);
    EXPECT_EQ(evaluator.cancelled, cancelled);
  }
}

TEST(ExploreWorker, Jobs_AreComputedInOrderAtTheWiderTolerance_OneOfHigherRankBetweenThem) {
  for (const auto& [wanted, taken] : {std::pair{1e-2, 1e-2}, {1e-6, 1e-3}}) {
    SlowEvaluator evaluator;
    Worker worker(evaluator.evaluate(), [] {});
    Job first = job_of("first"), second = job_of("second");
    first.tolerance = second.tolerance = wanted;
    worker.want({first, second});
    evaluator.wait_for(evaluator.calls);
    worker.want({job_of("urgent"), first, second});
    evaluator.is_open = true;
    const std::vector<JobResult> news = finish(worker);
    ASSERT_EQ(news.size(), 3U);
    EXPECT_EQ(news[1].key, "urgent");
    for (const std::size_t i : {0U, 2U}) {
      EXPECT_EQ(news[i].key, i == 0 ? "first" : "second");
      EXPECT_EQ(news[i].scene.number("accuracy.tolerance"), taken);
      expect_same(news[i].points, truth(news[i].scene, first.list));
    }
    EXPECT_GT(news[2].results.integrand_evaluations, 0.0);
  }
}

TEST(ExploreWorker, RefusedJob_HasPointsWithoutValues_AndTheReasonIsTold) {
  Worker worker(on_the_cpu, [] {});
  const Scene scene = paint({"surface.sigma_cross=10"}).scene();
  worker.want({{.key = "wide", .scene = scene, .list = points_at(scene, {10.0, 20.0}), .wants_effects = true}});
  const std::vector<JobResult> news = finish(worker);
  ASSERT_EQ(news.size(), 1U);
  ASSERT_EQ(news[0].points.size(), 2U);
  for (const Point& point : news[0].points) EXPECT_EQ(point.status, kOutsideModelDomain);
  Session session(paint());
  session.take(news);
  EXPECT_TRUE(contains(session.message().text, "quotient of the widths"));
  EXPECT_TRUE(session.message().is_error);
}

TEST(ExploreWorker, LostDevice_IsThrownToWhoAsksForNews) {
  const auto lost = [](const auto&...) -> Results { throw DeviceError("lost"); };
  Worker worker(lost, [] {});
  worker.want({job_of("any")});
  while (!worker.is_idle()) std::this_thread::sleep_for(kMoment);
  EXPECT_THROW(worker.take_news(), DeviceError);
}

TEST(Measured, DataAndScenesWithDoubtfulUnits_AreRemarkedOnOnce_AndDataWithSettingsAreRefused) {
  Session session(paint({"emission.temperature_K=25"}));
  const auto says = [&](const char* end) {
    return session.message().text.ends_with(end) && !session.message().is_error;
  };
  EXPECT_TRUE(contains(session.message().text, "25 K is cold"));
  session.load_measured(TemporaryFile("r.csv", "theta_deg,dolp\n0.5,0.01\n1.2,0.1\n").path());
  EXPECT_TRUE(says("is it in radians?")) << session.message().text;
  session.set("surface.sigma", 0.2);
  EXPECT_EQ(session.message().text, "");
  session.set("emission.temperature_K", 20.0);
  EXPECT_TRUE(says("20 K is cold; were degrees Celsius meant?")) << session.message().text;
  Residuals residuals(paint().scene());
  EXPECT_THROW(residuals.load(MeasuredData::from_csv("theta_deg,dolp\n60,0.1\n", "data", {{"surface.n", 2.0}})),
               InputError);
}

TEST(Measured, Emissivities_AreThoseThatAFitCompares) {
  const Scene paint_scene = paint().scene();
  const Scene direct = paint_scene.with({{"surface.masking", "smith"}, {"emission.model", "direct"}});
  const Point with = truth(direct, points_at(direct, {60.0})).front();
  EXPECT_EQ(described(Plotted::kEmissivityS).value(with), with[Quantity::kEmissivityS]);
  EXPECT_EQ(described(Plotted::kEmissivityP).value(with), with[Quantity::kEmissivityP]);
  EXPECT_NE(with[Quantity::kEmissivityS], 1.0 - with[Quantity::kRhoI] - with[Quantity::kRhoQ]);
  const Scene cold = paint_scene.without("emission").with("surroundings.temperature_K", 250.0);
  const Point without = truth(cold, points_at(cold, {60.0})).front();
  EXPECT_EQ(described(Plotted::kEmissivityS).value(without),
            1.0 - (without[Quantity::kRhoI] + without[Quantity::kRhoQ]));
}

TEST(Measured, Residuals_AreMeasuredMinusModelAtTheMeasuredPoints) {
  Driver session(paint());
  for (const auto& [column, plotted, quantity] :
       {std::tuple{"dolp", Plotted::kDolp, Quantity::kDolp}, {"q_over_i", Plotted::kSignedDolp, Quantity::kQOverI}}) {
    const TemporaryFile file(".csv", std::string("theta_deg,") + column + "\n33.3,0.05\n61.7,0.06\n");
    session.load_measured(file.path());
    session.settle();
    const Scene& scene = session.scene();
    const std::vector<Point> model = truth(scene, points_at(scene, {33.3, 61.7}));
    const std::vector<Measurement> residuals = session.residuals().residuals(plotted);
    ASSERT_EQ(residuals.size(), 2U);
    EXPECT_EQ(residuals[0].value, 0.05 - model[0][quantity]);
    EXPECT_EQ(residuals[1].value, 0.06 - model[1][quantity]);
    EXPECT_DOUBLE_EQ(*residual_rms(residuals), std::hypot(residuals[0].value, residuals[1].value) / std::sqrt(2.0));
    EXPECT_FALSE(residual_rms(session.residuals().residuals(Plotted::kAlbedo)));
  }
}

TEST(BackgroundTask, Phase_HasANameAndAProgressFromZero_AndCancellingIsSaid) {
  std::atomic<int> changes = 0;
  BackgroundTask task([&] { ++changes; });
  const auto work = [&task](const Progress& progress) -> BackgroundTask::Ending {
    static_cast<void>(progress(3, 4));
    task.set_phase("intervals");
    while (progress(1, 4)) std::this_thread::sleep_for(kMoment);
    throw Cancelled();
  };
  EXPECT_TRUE(task.start(work));
  EXPECT_FALSE(task.start(work));
  while (changes < 2) std::this_thread::sleep_for(kMoment);
  EXPECT_EQ(task.phase(), "intervals");
  EXPECT_EQ(task.progress(), 0.25);
  task.cancel();
  while (task.is_running()) task.finish();
  EXPECT_EQ(task.state(), BackgroundTask::State::kCancelled);
  EXPECT_EQ(task.message(), "cancelled");
}

TEST(Exports, TrueError_IsBelowItsBound) {
  const Scene scene = paint().scene();
  Curve curve(scene);
  curve.follow("paint", scene, false);
  curve.take(done(curve.wanted(Curve::Stage::kFine).value()));
  const std::string text = true_error(curve, {});
  constexpr std::string_view kBound = "bound ";
  ASSERT_TRUE(contains(text, kBound));
  const double error = std::stod(text);
  const double bound = std::stod(text.substr(text.find(kBound) + kBound.size()));
  EXPECT_LE(error, bound) << text;
  EXPECT_GT(error, 0.0) << text;
}

}  // namespace
}  // namespace dolp::explore::parts_test
