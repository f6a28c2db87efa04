// The library as its users see it: this file includes the public header alone.
#include <gtest/gtest.h>
#include <dolp/dolp.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

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

class Library : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("dolp-library-" + std::string(test.name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  dolp::Scene scene_ = dolp::Scene::from_text(kScene);
  dolp::Evaluator evaluator_{{.evaluator = "cpu"}};
};

TEST_F(Library, Tables_InMemoryAndInAFile_AreTheSameBits_AndPointsAgree) {
  const dolp::Table table = evaluator_.table(scene_);
  for (const dolp::Axis axis : dolp::kAllAxes)
    EXPECT_EQ(table.axes()[axis].empty(), !dolp::description_of(axis).is_required);
  const auto path = evaluator_.write_table(scene_, folder_ / "t.nc").output;
  const dolp::Table read = dolp::Table::read(path);
  const std::vector<double> theta = {60, 60}, sigma = {0.1, 0.4}, q = {3.5};
  const dolp::Results points = evaluator_.evaluate(scene_, {{"theta_deg", theta}, {"sigma", sigma}, {"q", q}});
  EXPECT_EQ(table.results().quantities(), read.results().quantities());
  for (const dolp::Quantity quantity : table.results().quantities()) {
    ASSERT_EQ(table.results()[quantity].size(), 12U);
    EXPECT_EQ(table.results()[quantity], read.results()[quantity]) << dolp::description_of(quantity).name;
  }
  const auto agree = [&](std::size_t point, std::size_t entry) {
    const dolp::PointResult a = points.at(point), b = table.results().at(entry);
    EXPECT_LE(std::abs(a[Quantity::kDolp] - b[Quantity::kDolp]),
              a[Quantity::kErrorEstimate] + b[Quantity::kErrorEstimate]);
  };
  agree(0, 9);
  agree(1, 11);
}

TEST_F(Library, PartsOfATable_AreTheTable) {
  const dolp::Scene scene =
      scene_.with({{"surface.masking", "none"}, {"surface.distribution", "gaussian"}, {"accuracy.tolerance", 1e-2}})
          .with_grid(
              {{"q", {2.0}}, {"theta_deg", dolp::AxisRange{0, 80, 1200}}, {"sigma", dolp::AxisRange{0.1, 1, 1000}}});
  const dolp::Table whole = evaluator_.table(scene);
  const std::vector<double>& expected = whole.results()[Quantity::kDolp];
  std::size_t entries = 0, parts = 0;
  evaluator_.table_parts(scene, [&](const dolp::Table& part) {
    ++parts;
    EXPECT_EQ(part.axes()[dolp::Axis::kTheta][0], whole.axes()[dolp::Axis::kTheta][entries / 1000]);
    for (const double value : part.results()[Quantity::kDolp]) EXPECT_EQ(value, expected[entries++]);
  });
  EXPECT_EQ(entries, 1'200'000U);
  EXPECT_GT(parts, 1U);
}

TEST_F(Library, Shards_AreFilesOfTheirOwn) {
  EXPECT_EQ(evaluator_.write_table(scene_, folder_ / "t.nc", {}, {2, 3}).output.filename(), "t.2-of-3.nc");
}

TEST_F(Library, MergedShards_AreTheTable_AndOneThatIsThereIsKept) {
  evaluator_.write_table(scene_, folder_ / "whole.nc");
  std::vector<std::filesystem::path> shards;
  for (std::size_t i = 1; i <= 2; ++i) {
    shards.push_back(evaluator_.write_table(scene_, folder_ / "t.nc", {}, {i, 2}).output);
  }
  EXPECT_NE(evaluator_.write_table(scene_, folder_ / "t.nc", {}, {1, 2}).text.find("is there already"),
            std::string::npos);
  EXPECT_EQ(dolp::merge(shards, folder_ / "merged.nc").output, folder_ / "merged.nc");
  const dolp::Table whole = dolp::Table::read(folder_ / "whole.nc"), merged = dolp::Table::read(folder_ / "merged.nc");
  for (const dolp::Quantity quantity : whole.results().quantities())
    EXPECT_EQ(whole.results()[quantity], merged.results()[quantity]) << dolp::description_of(quantity).name;
  EXPECT_THROW(dolp::merge({shards[0]}, folder_ / "half.nc"), dolp::InputError);
}

TEST_F(Library, FilesOfPoints_HaveTheNumbersOfPointsInMemory) {
  std::ofstream(folder_ / "points.csv") << "theta_deg\n10\n50\n";
  const std::vector<double> theta = {10, 50};
  const auto dolp_of = [&](const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line, cell;
    std::vector<double> values;
    std::optional<std::size_t> column;
    while (std::getline(file, line)) {
      const bool is_header = !column;
      std::istringstream cells(line);
      for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
        if (is_header && cell == "dolp") column = i;
        if (!is_header && i == column) values.push_back(std::stod(cell));
      }
    }
    return values;
  };
  const dolp::Report written = evaluator_.write_points(scene_, folder_ / "points.csv", folder_ / "results.csv");
  EXPECT_TRUE(written.is_good);
  EXPECT_NE(written.json.find("\"entries\": 2"), std::string::npos) << written.json;
  const auto expected = evaluator_.evaluate(scene_, {{"theta_deg", theta}});
  const std::vector<double> found = dolp_of(folder_ / "results.csv");
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(found[i], expected[Quantity::kDolp][i]);

  evaluator_.write_table(scene_.with_grid({{"sigma", {0.2}}, {"q", {3.0}}}), folder_ / "t.nc");
  dolp::write_lookup(folder_ / "t.nc", folder_ / "points.csv", folder_ / "between.csv");
  const dolp::Results between = dolp::Table::read(folder_ / "t.nc").lookup({{"theta_deg", theta}});
  EXPECT_EQ(dolp_of(folder_ / "between.csv"), between[Quantity::kDolp]);
  EXPECT_THROW(evaluator_.write_points(scene_, folder_ / "points.csv", folder_ / "points.csv"), dolp::InputError);
}

TEST_F(Library, CsvOfResults_IsTheFileOfThePoints) {
  std::ofstream(folder_ / "points.csv") << "theta_deg,sigma\n10,0.1\n50,0.3\n";
  const dolp::Scene scene = scene_.with("emission.bracket", true);
  evaluator_.write_points(scene, folder_ / "points.csv", folder_ / "results.csv");
  std::stringstream file;
  file << std::ifstream(folder_ / "results.csv").rdbuf();
  const std::vector<double> theta = {10, 50}, sigma = {0.1, 0.3};
  const std::vector<dolp::Column> points = {{"theta_deg", theta}, {"sigma", sigma}};
  const dolp::Results results = evaluator_.evaluate(scene, points);
  EXPECT_EQ(dolp::to_csv(points, results), file.str());
  EXPECT_GT(results.integrand_evaluations, 0.0);
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

TEST_F(Library, EveryKeyWithADefault_HasIt) {
  for (const dolp::Key& key : dolp::keys()) {
    if (key.fallback.empty() || key.fallback == "required" || key.key.starts_with("grid.")) continue;
    const dolp::Scene scene = scene_.with({{"source.irradiance", 1},
                                           {"path.radiance", 1},
                                           {"surface.masking", "integral"},
                                           {key.key, dolp::TomlText{key.fallback}}});
    const std::string value =
        key.words.empty() ? std::to_string(scene.number(key.key).value()) : scene.word(key.key).value();
    const std::string wanted = key.words.empty() ? std::to_string(std::stod(key.fallback)) : key.fallback;
    EXPECT_EQ(value, wanted) << key.key;
  }
}

TEST_F(Library, Keys_NameTheirWordsAndRivals) {
  const auto named = [](const std::string& key) { return *std::ranges::find(dolp::keys(), key, &dolp::Key::key); };
  EXPECT_EQ(named("surface.scattering").words, (std::vector<std::string>{"single", "multiple"}));
  EXPECT_EQ(named("emission.bracket").words, (std::vector<std::string>{"false", "true"}));
  EXPECT_EQ(named("surface.k").rivals, (std::vector<std::string>{"surface.material", "surface.material_file"}));
  EXPECT_TRUE(named("surface.sigma").rivals.empty());
}

TEST_F(Library, Effects_OfWhatIsDroppedABound_OfWhatIsKeptAnEstimate) {
  const std::vector<double> theta = {60};
  const dolp::Scene warm = scene_.with("surroundings.temperature_K", 280.0);
  const auto path_of = [&](const dolp::Scene& scene) {
    const auto all = dolp::effects(scene, {{"theta_deg", theta}});
    return *std::ranges::find(all, "path", &dolp::Effect::name);
  };
  EXPECT_EQ(path_of(warm).state, "absent");
  const dolp::Effect faint = path_of(warm.with("path.transmittance", 0.9).with("path.radiance", 1e-6));
  EXPECT_EQ(faint.state, "dropped");
  EXPECT_LT(faint.bound, 1e-5);
  EXPECT_FALSE(faint.influence);
  const dolp::Effect strong = path_of(warm.with("path.transmittance", 0.5).with("path.temperature_K", 300.0));
  EXPECT_EQ(strong.state, "kept");
  EXPECT_GT(strong.influence, 1e-3);
  EXPECT_FALSE(strong.bound);
}

TEST_F(Library, Fit_GivesValuesWithIntervals) {
  const std::vector<double> theta = {20, 40, 50, 60, 70, 80};
  const dolp::Results truth = evaluator_.evaluate(scene_.with("surface.sigma", 0.3), {{"theta_deg", theta}});
  std::string csv = "theta_deg,dolp,uncertainty\n";
  for (std::size_t i = 0; i < theta.size(); ++i) {
    csv += std::to_string(theta[i]) + ',' + std::to_string(truth[Quantity::kDolp][i]) + ",0.002\n";
  }
  const dolp::MeasuredData data = dolp::MeasuredData::from_csv(csv);
  const std::vector<dolp::Measurement>& measured = data.measurements;
  ASSERT_EQ(measured.size(), theta.size());
  EXPECT_EQ(measured[1].observable, dolp::Observable::kDolp);
  EXPECT_EQ(measured[1].theta_deg, 40.0);
  EXPECT_EQ(measured[1].uncertainty, 0.002);
  EXPECT_EQ(measured[1].wavelength_um, std::nullopt);
  const dolp::Fit fit = evaluator_.fit(scene_, {data}, {.vary = {{"surface.sigma", 0.05, 1.0}}});
  ASSERT_EQ(fit.parameters.size(), 1U);
  EXPECT_NEAR(fit.parameters[0].value, 0.3, 1e-3);
  EXPECT_EQ(fit.scene.number("surface.sigma"), fit.parameters[0].value);
  const dolp::FitInterval& likely = fit.parameters[0].interval_68;
  ASSERT_TRUE(likely.low && likely.high);
  EXPECT_NEAR(*likely.high - *likely.low, 2.0 * fit.parameters[0].standard_error.value(), 0.01);
  EXPECT_LT(fit.chi_square, 1e-3);
  EXPECT_EQ(fit.degrees_of_freedom, 5U);
  EXPECT_GT(fit.p_value, 0.99);
  EXPECT_THROW(dolp::MeasuredData::from_csv("theta_deg,dolp\n95,0.1\n"), dolp::InputError);
}

TEST_F(Library, Verify_ATableAndADevice_SayWhatIsWrong) {
  evaluator_.write_table(scene_, folder_ / "t.nc");
  const dolp::Report table = dolp::verify(folder_ / "t.nc", {.samples = 3});
  EXPECT_TRUE(table.is_good) << table.text;
  EXPECT_NE(table.text.find("3 of 12 entries"), std::string::npos) << table.text;
  EXPECT_THROW(dolp::verify_device({.evaluator = "cpu", .tolerance = 1.0}), dolp::InputError);
  EXPECT_THROW(dolp::verify_device({.evaluator = "cpu", .precision = "half"}), dolp::InputError);
}

TEST_F(Library, Lookup_BetweenEntries_StatesItsError) {
  const dolp::Table table =
      evaluator_.table(scene_.with_grid({{"theta_deg", dolp::AxisRange{0, 80, 41}}, {"sigma", {0.2}}, {"q", {3.0}}}));
  const std::vector<double> theta = {33.3};
  const dolp::Results found = table.lookup({{"theta_deg", theta}});
  const dolp::Results exact = evaluator_.evaluate(scene_, {{"theta_deg", theta}});
  EXPECT_LE(std::abs(found[Quantity::kDolp][0] - exact[Quantity::kDolp][0]),
            found[Quantity::kErrorEstimate][0] + exact[Quantity::kErrorEstimate][0]);
}

TEST_F(Library, Mueller_OfSpecularPair_Reflects) {
  const std::vector<double> theta = {40}, azimuth = {180};
  const auto matrices =
      evaluator_.mueller(scene_, {{"theta_i_deg", theta}, {"theta_r_deg", theta}, {"delta_phi_deg", azimuth}});
  ASSERT_EQ(matrices.size(), 1U);
  EXPECT_GT(matrices[0][0], 0.0);
}

TEST_F(Library, WrongInput_IsAnInputError_OfOneLine) {
  const auto line_of = [](const auto& call) {
    try {
      call();
    } catch (const dolp::InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::vector<double> theta = {95};
  for (const std::string& line : {line_of([&] { dolp::Scene::from_file(folder_ / "none.toml"); }),
                                  line_of([&] { scene_.with("surface.n", 0); }), line_of([&] {
                                    evaluator_.evaluate(scene_, {{"theta_deg", theta}});
                                  }),
                                  line_of([&] {
                                    evaluator_.evaluate(scene_, {{"zenith", theta}});
                                  }),
                                  line_of([&] { dolp::Evaluator({.evaluator = "abacus"}).table(scene_); })}) {
    EXPECT_NE(line, "no error");
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  EXPECT_THROW(evaluator_.write_table(scene_, folder_ / "none" / "t.nc"), dolp::IoError);
}

TEST_F(Library, AProgressThatReturnsFalse_Cancels_AndLeavesNoFile) {
  const dolp::RunOptions options = {.progress = [](std::size_t, std::size_t) { return false; }};
  EXPECT_THROW(evaluator_.write_table(scene_, folder_ / "t.nc", options), dolp::Cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Library, AnEvaluator_ServesSeveralThreads) {
  const std::vector<double> theta = {10, 50};
  const dolp::Results expected = evaluator_.evaluate(scene_, {{"theta_deg", theta}});
  std::vector<dolp::Results> found(4);
  std::vector<std::thread> threads;
  for (dolp::Results& results : found) {
    threads.emplace_back([&] { results = evaluator_.evaluate(scene_, {{"theta_deg", theta}}); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const dolp::Results& results : found) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(results[Quantity::kDolp][i], expected[Quantity::kDolp][i]);
  }
}

TEST_F(Library, Facts_AreThere) {
  EXPECT_FALSE(dolp::keys().empty());
  EXPECT_NE(dolp::citation().find("cff-version"), std::string::npos);
  EXPECT_NE(dolp::plan(scene_).text.find("12"), std::string::npos);
  EXPECT_EQ(dolp::kStatusBits.size(), 4U);
}

}  // namespace
