// Axes of materials, bands and temperatures, in tables, files and lists of points.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <dolp/errors.hpp>
#include <dolp/status.hpp>

#include "agreement.hpp"
#include "base/temporary_folder.hpp"
#include "computed_scene.hpp"
#include "run/scene_remarks.hpp"
#include "run/table_run.hpp"
#include "run/table_scene.hpp"
#include "table/table_file.hpp"
#include "table/table_reader.hpp"
#include "verify/table_check.hpp"

namespace dolp::grid_axes_test {
namespace {

using enum Quantity;

const std::string kScene = R"toml(
[surface]
sigma = 0.2
q = 3.0
masking = "smith"
[emission]
[surroundings]
temperature_K = 250
[grid]
material = ["gold (Ordal)", "quartz", "PET"]
band_um = [[8, 9], [10, 12]]
temperature_K = [280, 300, 320, 350]
theta_deg = [0, 30, 50, 70]
sigma = [0.1, 0.2, 0.3, 0.4]
q = [2, 2.5, 3, 4]
)toml";

SceneValues scene_with(const std::vector<std::string>& overrides = {}) { return parse(kScene, overrides); }

TEST(GridAxes, TableOfManyMaterialsBandsAndTemperatures_HasTheResultsOfEach) {
  for (const char* masking : {"smith", "integral", "none"}) {
    const std::vector<std::string> with_masking = {std::string("surface.masking=") + masking};
    const SceneValues scene = scene_with(with_masking);
    const SceneEntries entries = grid_entries(scene);
    const std::vector<PointResult> results = results_of(scene, entries);
    const std::size_t of_variant = 4 * 4 * 4;
    ASSERT_EQ(results.size(), 3U * 2 * 4 * of_variant);
    for (const std::size_t variant : {0U, 7U, 10U, 13U, 22U}) {
      const SceneVariant& own = entries.variants()[variant];
      const Spectrum band = scene.bands[*own.band];
      std::vector<std::string> one = with_masking;
      one.insert(one.end(), {"grid.material={}", "surface.material=\"" + (*scene.materials)[*own.material].name + '"',
                             "grid.band_um={}", fmt::format("spectrum.band_um=[{}, {}]", band.min_um, band.max_um),
                             "grid.temperature_K={}", fmt::format("emission.temperature_K={}", *own.temperature_K)});
      const SceneValues alone = scene_with(one);
      const std::vector<PointResult> right = results_of(alone);
      for (std::size_t i = 0; i < of_variant; ++i) {
        const PointResult& result = results[variant * of_variant + i];
        SCOPED_TRACE(fmt::format("{}, variant {}, entry {}", masking, variant, i));
        expect_agreement(result, right[i]);
        EXPECT_EQ(result.status & kAnyToleranceNotMet, 0U);
      }
    }
  }
}

TEST(GridAxes, ColumnsOfPoints_NameTheEntriesOfTheTable) {
  const SceneValues scene = scene_with();
  const std::string csv =
      "material,band_um,temperature_K,theta_deg,sigma,q\nGold,8-9,280,30,0.1,2\nsio2,10-12,320,50,0.2,3\n"
      "PET,10-12,350,70,0.4,4\n\"gold (Ordal)\",8-9,280,30,0.1,2\n";
  const SceneEntries points = point_entries(scene, parse_points(csv, "p.csv", PointsKind::kDirections));
  EXPECT_EQ(points.variants().size(), 3U);
  const std::vector<PointResult> results = results_of(scene, points);
  const TableValues table = table_of(scene);
  const std::vector<std::size_t> positions = {(((0 * 2 + 0) * 4 + 0) * 4 + 1) * 16,
                                              (((1 * 2 + 1) * 4 + 2) * 4 + 2) * 16 + 6,
                                              (((2 * 2 + 1) * 4 + 3) * 4 + 3) * 16 + 15};
  for (std::size_t i = 0; i < positions.size(); ++i)
    EXPECT_NEAR(results[i][kDolp], table[kDolp][positions[i]],
                results[i][kErrorEstimate] + table[kErrorEstimate][positions[i]]);
  EXPECT_EQ(results[0][kDolp], results[3][kDolp]);
}

TEST(GridAxes, FileReadBack_HasItsLabelsAndVerifiesWithoutTheMaterials) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "t.nc";
  const SceneValues scene =
      scene_with({"grid.theta_deg=[30]", "grid.sigma=[0.2]", "grid.q=[3]", "grid.temperature_K=[280]",
                  "grid.band_um=[[8, 9], [10, 10.5]]", "surface.masking=v-cavity"});
  write_table(table_of(scene), path);
  const TableReader reader(path);
  EXPECT_EQ(reader.head().labels, scene.labels);
  EXPECT_EQ(reader.head().labels[Axis::kBand], (std::vector<std::string>{"8-9", "10-10.5"}));
  TableSample sample;
  sample.positions = sample_positions(reader.head().size(), reader.head().size(), 0);
  sample.table = reader.read_entries(sample.positions, {});
  const SceneValues again = table_scene(reader.head(), "t.nc");
  const TableCheck check = check_table(sample, again, "t.nc", {});
  EXPECT_TRUE(check.passed());
  EXPECT_EQ(check.checked, 6U);

  // A shard lists only its own materials, and its axis has positions in this short list. use_scene_labels replaces them
  // by positions in the list of the scene.
  TableHead part = reader.head();
  part.axes[Axis::kMaterial] = {0.0};
  part.labels[Axis::kMaterial] = {"PET"};
  use_scene_labels(part, again, "part");
  EXPECT_EQ(part.axes[Axis::kMaterial], std::vector<double>{2.0});
  part.labels[Axis::kMaterial] = {"lead", "PET", "lead"};
  EXPECT_THROW(use_scene_labels(part, again, "part"), InputError);
}

TEST(GridAxes, ShardsOfOneMaterialEach_MergeToTheTable) {
  const TemporaryFolder folder;
  const SceneValues scene = scene_with({"grid.theta_deg=[30]", "grid.sigma=[0.2]", "grid.q=[3]"});
  CpuEvaluator evaluator;
  std::vector<std::string> paths;
  for (std::size_t number = 1; number <= 6; ++number) {
    paths.push_back((folder.path() / fmt::format("{}.nc", number)).string());
    const TableJob job{.path = paths.back(), .shard = {number, 6}, .options = {}, .evaluator = "cpu"};
    write_table(scene, job, [&] { return &evaluator; });
    EXPECT_TRUE(is_there(scene, job));
  }
  EXPECT_EQ(read_table(paths[1]).labels[Axis::kMaterial], std::vector<std::string>{"SiO2 amorphous quartz"});
  const std::filesystem::path merged = folder.path() / "t.nc";
  EXPECT_EQ(ShardSet(paths).merge(merged, "test"), 24U);
  EXPECT_EQ(read_table(merged)[kDolp], table_of(scene)[kDolp]);
}

TEST(GridAxes, Mistakes_AreToldWithTheKeyAndWhatIsAllowed) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> scenes = {
      {{"grid.material=[\"gold\"]"}, "\"gold\": names 2 materials: gold (Ordal), gold evaporated (Olmon)"},
      {{"grid.material=[\"PET\", \"pet\"]"}, "\"PET\" appears twice"},
      {{"grid.material=[1, 2]"}, "must be a text, or a list of texts"},
      {{"grid.material=[]"}, "must be a text, or a list of texts"},
      {{"grid.band_um=[[8, 9], [8, 9]]"}, "8-9 appears twice"},
      {{"grid.band_um=[9, 8]"}, "must be a list of pairs of ascending numbers in [0.1, 1e4]"},
      {{"grid.band_um=[[1, 2]]"}, "known at 2 to 20 um, and the spectrum is 1 to 2 um"},
      {{"emission=none"}, "grid.temperature_K = [280, 300, 320, 350]: needs the table [emission]"},
      {{"surface.n=1.5", "grid.material=\"PET\""}, "grid.material=\"PET\": cannot be combined with surface.n"},
      {{"grid.temperature_K=[0]"}, "0 is out of range; must be a number in (0, 1e4]"}};
  for (const auto& [overrides, message] : scenes) {
    const std::string said = error_of(kScene, overrides);
    EXPECT_TRUE(contains(said, message)) << said;
  }
  const SceneValues scene = scene_with();
  const std::vector<std::pair<const char*, const char*>> points = {
      {"theta_deg,material\n30,lead\n",
       "p.csv:2: material = \"lead\": must be one of gold (Ordal), SiO2 amorphous quartz, PET"},
      {"theta_deg,band_um\n30,7-9\n", "p.csv:2: band_um = \"7-9\": must be one of 8-9, 10-12"},
      {"theta_deg,material,n,k\n30,PET,1.5,0\n", "columns \"material\" and \"n\" cannot be combined"},
      {"theta_deg,material\n30,\n", "p.csv:2: material = \"\": must be one of"},
      {"theta_deg,temperature_K\n30,-1\n", "must be a number in (0, 1e4]"}};
  for (const auto& [csv, message] : points) {
    const std::string said =
        error_text([&, text = csv] { point_entries(scene, parse_points(text, "p.csv", PointsKind::kDirections)); });
    EXPECT_TRUE(contains(said, message)) << said;
  }
}

TEST(GridAxes, SceneWithSeveralMaterials_NeedsAChoice) {
  const Points points = parse_points("theta_deg,band_um\n30,8-9\n", "p.csv", PointsKind::kDirections);
  const auto said = [&](const SceneValues& scene, const Points& at) {
    return error_text([&] { check_labels_chosen(scene, at); });
  };
  EXPECT_NE(said(scene_with(), points)
                .find("grid.material has 3 values; choose one with --set surface.material=NAME, or "
                      "add the column \"material\" to p.csv"),
            std::string::npos);
  EXPECT_NE(said(scene_with(), {}).find("choose one with --set surface.material=NAME"), std::string::npos);
  EXPECT_NO_THROW(check_labels_chosen(scene_with({"surface.material=PET"}), points));
  EXPECT_NO_THROW(check_labels_chosen(scene_with({"surface.material=PET", "spectrum.band_um=[8, 9]"}), {}));
}

TEST(GridAxes, UnlikelyUnits_AreRemarkedWithTheAxis) {
  const auto remarks = remarks_on(scene_with({"grid.temperature_K=[20, 300]"}));
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("grid.temperature_K=[20, 300]: 20 K is cold"), std::string::npos) << remarks[0];
  const auto wide = remarks_on(scene_with({"surface.n=1.5", "grid.band_um=[[8000, 9000]]"}));
  EXPECT_NE(wide[0].find("grid.band_um"), std::string::npos) << wide[0];
}

TEST(GridAxes, SettingThatExcludesAnAxis_ReplacesIt) {
  EXPECT_TRUE(scene_with({"surface.material=PET"}).labels[Axis::kMaterial].empty());
  EXPECT_TRUE(scene_with({"spectrum.band_um=[8, 9]"}).bands.empty());
  EXPECT_EQ(scene_with({"grid.wavelength_um=[9, 10]"}).grid[Axis::kWavelength].size(), 2U);
}

TEST(GridAxes, AllMaterials_AreThoseThatCoverTheSpectrum) {
  const SceneValues scene = scene_with({"grid.material=all", "grid.band_um=[[2, 3]]"});
  const std::vector<std::string>& names = scene.labels[Axis::kMaterial];
  EXPECT_GT(names.size(), 5U);
  EXPECT_EQ(std::ranges::find(names, "SiO2 amorphous quartz"), names.end());  // its n and k are known only from 7 um
}

}  // namespace
}  // namespace dolp::grid_axes_test
