// The library as its users see it: this file includes only the public header.
#include <gtest/gtest.h>
#include <dolp/dolp.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "error_text.hpp"
#include "in_folder.hpp"

namespace api_test {

using dolp::Quantity;

const std::string kScene = R"([surface]
n = 1.5
k = 0.05
sigma = 0.2
q = 3.0
masking = "v-cavity"
[emission]
temperature_K = 300.0
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 30, 60]
sigma = [0.1, 0.4]
q = [2, 3.5]
)";

class Library : public dolp::InFolder {
 protected:
  dolp::Scene scene_ = dolp::Scene::from_text(kScene);
  dolp::Evaluator evaluator_{{.evaluator = "cpu"}};

  /// A scene with a table of many entries that are cheap to compute.
  dolp::Scene large_scene(std::size_t thetas, std::size_t sigmas) const {
    return scene_
        .with({{"surface.masking", "none"}, {"surface.distribution", "gaussian"}, {"accuracy.tolerance", 1e-2}})
        .with_grid(
            {{"q", {2.0}}, {"theta_deg", dolp::AxisRange{0, 80, thetas}}, {"sigma", dolp::AxisRange{0.1, 1, sigmas}}});
  }
};

TEST_F(Library, ResponseTables_InMemoryAndInAFile_AreTheSameBits) {
  const dolp::Table response = evaluator_.response(scene_);
  const dolp::Table written = dolp::Table::read(evaluator_.write_response(scene_, at("r.nc")).output);
  response.write(at("again.nc"));
  const dolp::TableValues& values = response.values();
  EXPECT_EQ(values.responses[dolp::ResponseVariable::kEmissionQ].size(), 12 * values.beta_deg.size());
  for (const dolp::Table& table : {written, dolp::Table::read(at("again.nc"))}) {
    EXPECT_EQ(table.values().responses, values.responses);
    EXPECT_EQ(table.values()[Quantity::kAlbedo], values[Quantity::kAlbedo]);
    EXPECT_EQ(table.values().beta_deg, values.beta_deg);
  }
  EXPECT_NE(dolp::error_text([&] { response.write(at("r.csv")); }).find("must end in .nc"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(at("r.csv")));
}

TEST_F(Library, PartsOfATable_AreTheTable) {
  const dolp::Scene scene = large_scene(1060, 1000);
  const dolp::Table whole = evaluator_.table(scene);
  const std::vector<double>& expected = whole.values()[Quantity::kDolp];
  std::size_t entries = 0, parts = 0;
  evaluator_.table_parts(scene, [&](const dolp::Table& part) {
    ++parts;
    EXPECT_EQ(part.values().axes[dolp::Axis::kTheta][0], whole.values().axes[dolp::Axis::kTheta][entries / 1000]);
    for (const double value : part.values()[Quantity::kDolp]) EXPECT_EQ(value, expected[entries++]);
  });
  EXPECT_EQ(entries, 1'060'000U);
  EXPECT_GT(parts, 1U);
}

TEST_F(Library, FilesOfPoints_AreTheCsvOfPointsInMemory) {
  std::ofstream(at("points.csv")) << "theta_deg,sigma\n10,0.1\n50,0.3\n";
  const std::vector<double> theta = {10, 50}, sigma = {0.1, 0.3};
  const std::vector<dolp::Column> points = {{"theta_deg", theta}, {"sigma", sigma}};
  const dolp::Scene scene = scene_.with("emission.bracket", true);
  const dolp::Report written = evaluator_.write_points(scene, at("points.csv"), at("results.csv"));
  EXPECT_TRUE(written.is_good);
  EXPECT_NE(written.json.find("\"entries\": 2"), std::string::npos) << written.json;
  const dolp::Results results = evaluator_.evaluate(scene, points);
  EXPECT_EQ(dolp::to_csv(points, results), dolp::read_file(at("results.csv")));
  EXPECT_GT(results.integrand_evaluations, 0.0);

  evaluator_.write_table(scene.with_grid({{"q", {3.0}}}), at("t.nc"));
  evaluator_.write_points(dolp::Scene::from_file(at("t.nc")).for_points(), at("points.csv"), at("between.csv"));
  const dolp::Table table = dolp::Table::read(at("t.nc"));
  const dolp::Scene of_table = dolp::Scene::from_attributes(table.file_attributes()).for_points();
  EXPECT_EQ(dolp::to_csv(points, evaluator_.evaluate(of_table, points)), dolp::read_file(at("between.csv")));
  EXPECT_EQ(of_table.evaluator(), "cpu");
  EXPECT_EQ(scene_.evaluator(), "vulkan");
  EXPECT_TRUE(scene_.table_attributes().empty());
  EXPECT_THROW(evaluator_.write_points(scene_, at("points.csv"), at("points.csv")), dolp::InputError);
}

TEST_F(Library, Scene_SaysItsValues) {
  EXPECT_EQ(scene_.number("surface.sigma"), 0.2);
  EXPECT_EQ(scene_.number("surface.specular"), 1.0);  // a default
  EXPECT_EQ(scene_.number("source.scale"), std::nullopt);
  EXPECT_EQ(scene_.word("surface.masking"), "v-cavity");
  EXPECT_EQ(scene_.word("emission.bracket"), "false");
  EXPECT_EQ(scene_.word("surface.material"), std::nullopt);
  EXPECT_EQ(scene_.numbers("grid.q"), (std::vector<double>{2, 3.5}));
  EXPECT_TRUE(scene_.numbers("spectrum.band_um").empty());
  EXPECT_EQ(scene_.refractive_index(10.0), std::pair(1.5, 0.05));
  const dolp::Scene gold = scene_.with({{"surface.material", "GOLD (ordal)"}, {"spectrum.band_um", {8.0, 12.0}}});
  EXPECT_EQ(gold.word("surface.material"), "gold (Ordal)");
  EXPECT_EQ(gold.number("surface.n"), std::nullopt);
  EXPECT_EQ(gold.numbers("spectrum.band_um"), (std::vector<double>{8, 12}));
  EXPECT_GT(gold.refractive_index(10.0).second, 10.0);
  EXPECT_NE(gold.refractive_index(9.0), gold.refractive_index(11.0));
  const dolp::Scene at_10 = scene_.with("surface.material", "water");
  EXPECT_NE(at_10.refractive_index(10.0), at_10.refractive_index(11.0));
  EXPECT_THROW(at_10.refractive_index(1e3), dolp::InputError);
  EXPECT_THROW(scene_.number("surface.masking"), dolp::InputError);
  EXPECT_THROW(scene_.word("surface.colour"), dolp::InputError);
}

TEST_F(Library, Keys_NameTheirWordsAndRivals) {
  const auto named = [](const std::string& key) { return *std::ranges::find(dolp::keys(), key, &dolp::Key::key); };
  EXPECT_EQ(named("surface.scattering").words, (std::vector<std::string>{"single", "multiple"}));
  EXPECT_EQ(named("emission.bracket").words, (std::vector<std::string>{"false", "true"}));
  EXPECT_EQ(named("surface.k").rivals, (std::vector<std::string>{"surface.material", "surface.material_file",
                                                                 "surface.reflectance_file", "grid.material"}));
  EXPECT_EQ(named("grid.sigma").rivals,
            (std::vector<std::string>{"surface.wind_m_s", "grid.wind_m_s", "surface.wind_model"}));
  EXPECT_TRUE(named("surface.q").rivals.empty());
}

TEST_F(Library, Effects_OfWhatIsDroppedABound_OfWhatIsKeptAnEstimate) {
  const std::vector<double> theta = {60};
  const dolp::Scene warm = scene_.with("surroundings.temperature_K", 280.0);
  const auto path_of = [&](const dolp::Scene& scene) {
    const auto all = dolp::effects(scene, {{"theta_deg", theta}});
    return *std::ranges::find(all, "path", &dolp::Effect::name);
  };
  EXPECT_EQ(path_of(warm).state, dolp::EffectState::kAbsent);
  const dolp::Effect faint = path_of(warm.with("path.transmittance", 0.9).with("path.radiance", 1e-6));
  EXPECT_EQ(faint.state, dolp::EffectState::kDropped);
  EXPECT_LT(faint.bound, 1e-5);
  EXPECT_FALSE(faint.influence);
  const dolp::Effect strong = path_of(warm.with("path.transmittance", 0.5).with("path.temperature_K", 300.0));
  EXPECT_EQ(strong.state, dolp::EffectState::kKept);
  EXPECT_GT(strong.influence, 1e-3);
  EXPECT_FALSE(strong.bound);
}

TEST_F(Library, Fit_GivesValuesWithIntervals) {
  const std::vector<double> theta = {20, 40, 50, 60, 70, 80};
  const dolp::Results truth = evaluator_.evaluate(scene_.with("surface.sigma", 0.3), {{"theta_deg", theta}});
  std::string csv = "theta_deg,dolp,uncertainty\n";
  for (std::size_t i = 0; i < theta.size(); ++i)
    csv += std::to_string(theta[i]) + ',' + std::to_string(truth[Quantity::kDolp][i]) + ",0.002\n";
  const dolp::MeasuredData data = dolp::MeasuredData::from_csv(csv);
  const dolp::Fit fit = evaluator_.fit(scene_, {data}, {.vary = {{"surface.sigma", 0.05, 1.0}}});
  ASSERT_EQ(fit.parameters.size(), 1U);
  EXPECT_NEAR(fit.parameters[0].value, 0.3, 1e-3);
  EXPECT_EQ(fit.scene.number("surface.sigma"), fit.parameters[0].value);
  const dolp::FitInterval& likely = fit.parameters[0].interval_68;
  ASSERT_TRUE(likely.low && likely.high);
  EXPECT_NEAR(*likely.high - *likely.low, 2.0 * fit.parameters[0].standard_error.value(), 0.01);
  EXPECT_LT(fit.chi_square, 1e-3);
  EXPECT_EQ(fit.degrees_of_freedom, 5U);
  ASSERT_FALSE(fit.minima.empty());
  EXPECT_EQ(fit.minima[0].values, std::vector<double>{fit.parameters[0].value});
  EXPECT_EQ(fit.minima[0].chi_square, fit.chi_square);
  for (const auto& [label, text] : fit.report.rows) {
    EXPECT_NE(fit.report.text.find("  " + label), std::string::npos) << label;
    EXPECT_NE(fit.report.text.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(std::ranges::any_of(fit.report.rows, [](const auto& row) { return row.first == "minimum"; }));
  EXPECT_GT(fit.p_value, 0.99);
}

TEST_F(Library, WrongInput_IsAnInputError_OfOneLine) {
  const std::vector<double> theta = {95};
  const auto expect_one_line = [](const auto& call) {
    const std::string line = dolp::error_text(call);
    EXPECT_NE(line, "no error");
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  expect_one_line([&] { dolp::Scene::from_file(at("none.toml")); });
  expect_one_line([&] { scene_.with("surface.n", 0); });
  expect_one_line([&] { evaluator_.evaluate(scene_, {{"theta_deg", theta}}); });
  expect_one_line([&] { evaluator_.evaluate(scene_, {{"zenith", theta}}); });
  expect_one_line([&] { dolp::Evaluator({.evaluator = "abacus"}).table(scene_); });
  EXPECT_THROW(evaluator_.write_table(scene_, at("none") / "t.nc"), dolp::IoError);
}

TEST_F(Library, AProgressThatReturnsFalse_Cancels_AndLeavesNoFile) {
  const dolp::RunOptions options = {.progress = [](std::size_t, std::size_t) { return false; }};
  EXPECT_THROW(evaluator_.write_table(scene_, at("t.nc"), options), dolp::Cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(at("")));
}

// The shard exists already, so the second run only reads it, part by part. The test cancels this run before the first
// part, and then another such run before the second part.
TEST_F(Library, Cancelled_WhileAKeptShardIsRead_IsHonoured) {
  const dolp::Scene scene = large_scene(600, 800);
  const std::filesystem::path shard = evaluator_.write_table(scene, at("t.nc"), {}, {1, 1}).output;
  const auto written = std::filesystem::last_write_time(shard);
  for (const int most : {0, 1}) {
    int called = 0;
    const dolp::RunOptions options = {.progress = [&](std::size_t, std::size_t) { return called++ < most; }};
    EXPECT_THROW(evaluator_.write_table(scene, at("t.nc"), options, {1, 1}), dolp::Cancelled) << most;
    EXPECT_EQ(called, most + 1);
  }
  EXPECT_EQ(std::filesystem::last_write_time(shard), written);
}

// After a move, the old object keeps its value, or all its members throw an exception.
TEST_F(Library, MovedFromObjects_KeepTheirValueOrSayWhatTheyAre) {
  dolp::Scene scene = scene_;
  const dolp::Scene taken_scene = std::move(scene);  // NOLINT(performance-move-const-arg): that is the test
  EXPECT_EQ(scene.text(), taken_scene.text());       // NOLINT(bugprone-use-after-move): that is the test
  EXPECT_EQ(scene.with("surface.q", 4.0).number("surface.q"), 4.0);
  dolp::Table table = evaluator_.table(scene_);
  const dolp::Table taken_table = std::move(table);           // NOLINT(performance-move-const-arg): that is the test
  EXPECT_EQ(table.values().axes, taken_table.values().axes);  // NOLINT(bugprone-use-after-move): that is the test
  const std::vector<double> theta = {30}, sigma = {0.1}, q = {2};
  const std::vector<dolp::Column> points = {{"theta_deg", theta}, {"sigma", sigma}, {"q", q}};
  dolp::Evaluator taken = std::move(evaluator_);
  EXPECT_THROW(evaluator_.table(scene_), dolp::InputError);  // NOLINT(bugprone-use-after-move): that is the test
  EXPECT_THROW(evaluator_.table_parts(scene_, [](const dolp::Table&) {}), dolp::InputError);
  EXPECT_THROW(evaluator_.evaluate(scene_, points), dolp::InputError);
  EXPECT_THROW(evaluator_.mueller(scene_, points), dolp::InputError);
  EXPECT_THROW(evaluator_.write_table(scene_, at("t.nc")), dolp::InputError);
  EXPECT_THROW(evaluator_.write_points(scene_, at("p.csv"), at("r.csv")), dolp::InputError);
  EXPECT_THROW(evaluator_.write_mueller(scene_, at("p.csv"), at("r.csv")), dolp::InputError);
  EXPECT_THROW(evaluator_.fit(scene_, {}, {}), dolp::InputError);
  EXPECT_FALSE(taken.evaluate(scene_, points)[Quantity::kDolp].empty());
  evaluator_ = std::move(taken);
  EXPECT_FALSE(evaluator_.evaluate(scene_, points)[Quantity::kDolp].empty());
}

TEST_F(Library, CsvOfColumnsThatDiffer_IsAnInputError) {
  const std::vector<double> theta = {10, 50, 70}, two = {0.1, 0.2}, one = {2.0}, none;
  dolp::Results results = evaluator_.evaluate(scene_, {{"theta_deg", theta}, {"q", one}});
  EXPECT_NO_THROW(dolp::to_csv({{"theta_deg", theta}, {"q", one}}, results));
  EXPECT_THROW(dolp::to_csv({{"theta_deg", two}}, results), dolp::InputError);
  EXPECT_THROW(dolp::to_csv({{"theta_deg", none}}, results), dolp::InputError);
  results[Quantity::kDolp].pop_back();
  EXPECT_THROW(dolp::to_csv({{"theta_deg", theta}}, results), dolp::InputError);
}

TEST_F(Library, EvaluatorInItsOwnCallback_IsAnInputError_AndServesAgain) {
  const std::vector<double> theta = {10, 50}, azimuth = {180, 180};
  const std::vector<dolp::Column> points = {{"theta_deg", theta}};
  const std::vector<dolp::Column> pairs = {{"theta_i_deg", theta}, {"theta_r_deg", theta}, {"delta_phi_deg", azimuth}};
  std::ofstream(at("points.csv")) << "theta_deg\n10\n50\n";
  std::ofstream(at("pairs.csv")) << "theta_i_deg,theta_r_deg,delta_phi_deg\n10,50,180\n";
  const dolp::MeasuredData data = dolp::MeasuredData::from_csv(
      "theta_deg,dolp,uncertainty\n20,0.0062,0.001\n40,0.027,0.001\n50,0.046,0.001\n60,0.071,0.001\n80,0.13,0.001\n");
  int called = 0, refused = 0;
  const auto call = [&] {
    ++called;
    try {
      evaluator_.evaluate(scene_, points);
    } catch (const dolp::InputError&) {
      ++refused;
    }
  };
  const dolp::RunOptions options = {.progress = [&](std::size_t, std::size_t) {
    call();
    return true;
  }};
  evaluator_.write_table(scene_, at("t.nc"), {}, {1, 2});
  std::vector<std::string> phases;
  const dolp::FitOptions fit = {.vary = {{"surface.sigma", 0.05, 1.0}, {"surface.n", 1.1, 3.0}},
                                .starts = 4,
                                .progress = options.progress,
                                .phase =
                                    [&](const std::string& phase) {
                                      call();
                                      phases.push_back(phase);
                                    },
                                .plot = at("fit.png")};
  const std::vector<std::function<void()>> calls = {
      [&] { evaluator_.evaluate(scene_, points, options); },
      [&] { evaluator_.table(scene_, options); },
      [&] { evaluator_.table_parts(scene_, [&](const dolp::Table&) { call(); }); },
      [&] { evaluator_.mueller(scene_, pairs, options); },
      [&] { evaluator_.write_table(scene_, at("t.nc"), options); },
      [&] {
        // this shard exists already
        evaluator_.write_table(scene_, at("t.nc"), options, {1, 2});
      },
      [&] { evaluator_.write_points(scene_, at("points.csv"), at("results.csv"), options); },
      [&] { evaluator_.write_mueller(scene_, at("pairs.csv"), at("matrices.csv"), options); },
      [&] { evaluator_.fit(scene_, {data}, fit); }};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    called = refused = 0;
    calls[i]();
    EXPECT_GT(called, 0) << i;
    EXPECT_EQ(refused, called) << i;
  }
  EXPECT_EQ(phases, (std::vector<std::string>{"descents of the search", "sides of the intervals",
                                              "parameter sets of the contours"}));
  dolp::Evaluator other({.evaluator = "cpu"});
  const dolp::RunOptions with_other = {
      .progress = [&](std::size_t, std::size_t) { return !other.evaluate(scene_, points).status.empty(); }};
  EXPECT_FALSE(evaluator_.evaluate(scene_, points, with_other).status.empty());
}

TEST_F(Library, TableOfItsOwnContents_IsTheSameTable) {
  const dolp::Table table = evaluator_.table(scene_, {.derivatives = {"surface.sigma"}});
  dolp::TableValues values = table.values();
  values.attributes = table.file_attributes();
  const dolp::Table again = dolp::Table::of(values);
  EXPECT_EQ(again.values().attributes, table.values().attributes);
  EXPECT_EQ(again.file_attributes(), table.file_attributes());
  table.write(at("a.nc"));
  again.write(at("b.nc"));
  EXPECT_EQ(dolp::read_file(at("a.nc")), dolp::read_file(at("b.nc")));
  EXPECT_EQ(dolp::Table::read(at("a.nc")).file_attributes(), table.file_attributes());
}

TEST_F(Library, TableOfContentsThatDoNotFit_IsAnInputError) {
  const dolp::TableValues values = evaluator_.table(scene_, {.derivatives = {"surface.sigma"}}).values();
  const auto refuses = [&](const auto& change) {
    dolp::TableValues other = values;
    change(other);
    EXPECT_THROW(dolp::Table::of(other), dolp::InputError);
  };
  refuses([](dolp::TableValues& table) { table.axes[dolp::Axis::kTheta].clear(); });
  refuses([](dolp::TableValues& table) { table.axes[dolp::Axis::kTheta].push_back(50); });
  refuses([](dolp::TableValues& table) { table.axes[dolp::Axis::kTheta][0] = 91; });
  refuses([](dolp::TableValues& table) { table.axes[dolp::Axis::kQ][0] = std::nan(""); });
  refuses([](dolp::TableValues& table) { table[Quantity::kAlbedo].pop_back(); });
  refuses([](dolp::TableValues& table) { table.status.pop_back(); });
  refuses([](dolp::TableValues& table) { table.derivatives[1].values.pop_back(); });
  refuses([](dolp::TableValues& table) { table.derivatives[0].name = "d_dolp__surface_n"; });
  refuses([](dolp::TableValues& table) { table.index_n.values.push_back(1.0); });
  refuses([](dolp::TableValues& table) { table.index_n.used.push_back(1.0); });
  for (const char* const row : {"index_n,8", "index_n,8,x", "index_m,8,1.5", "index_n,8,1.5,2"})
    refuses([&](dolp::TableValues& table) { table.attributes.push_back({"spectral_data", row}); });
  refuses([](dolp::TableValues& table) { table.attributes.push_back({"", "of no name"}); });
  refuses([](dolp::TableValues& table) { table.attributes.push_back({"a/b", "of a name with a /"}); });
  refuses([](dolp::TableValues& table) { table.attributes.push_back(table.attributes.front()); });
}

TEST_F(Library, AnEvaluator_ServesSeveralThreads) {
  const std::vector<double> theta = {10, 50};
  const dolp::Results expected = evaluator_.evaluate(scene_, {{"theta_deg", theta}});
  std::vector<dolp::Results> found(4);
  std::vector<std::thread> threads;
  for (dolp::Results& results : found)
    threads.emplace_back([&] { results = evaluator_.evaluate(scene_, {{"theta_deg", theta}}); });
  for (std::thread& thread : threads) thread.join();
  for (const dolp::Results& results : found) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(results[Quantity::kDolp][i], expected[Quantity::kDolp][i]);
  }
}

TEST_F(Library, Facts_AreThere) {
  EXPECT_FALSE(dolp::keys().empty());
  EXPECT_NE(dolp::citation().find("cff-version"), std::string::npos);
  EXPECT_TRUE(dolp::citation().ends_with("commit: \"" + dolp::commit() + "\"\n"));
  EXPECT_NE(dolp::plan(scene_).text.find("12"), std::string::npos);
  EXPECT_EQ(dolp::kStatusBits.size(), 6U);
}

}  // namespace api_test
