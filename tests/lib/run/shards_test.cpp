// A file replaces a shard between the first reading and the merge. The merge accepts this file only if it contains the
// same shard.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "error_text.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "in_folder.hpp"
#include "run/table_run.hpp"
#include "scene/scene_reader.hpp"
#include "scene_run_support.hpp"
#include "table/table_file.hpp"

namespace shards_test {

using namespace dolp;
namespace fs = std::filesystem;

class ReplacedShards : public InFolder {
 protected:
  /// Writes shard `number` of two. A different `diffuse` makes it a shard of another table.
  void make(const std::string& name, std::size_t number, double diffuse) const {
    const SceneValues scene = parse_scene(
        "[surface]\nn = 1.5\nsigma = 0.3\nspecular = 0.4\n[emission]\ntemperature_K = 300\n[spectrum]\n"
        "wavelength_um = 10.6\n[grid]\ntheta_deg = [0, 40, 60, 80]\n",
        "s.toml", {{"surface.diffuse", diffuse}});
    CpuEvaluator evaluator;
    write_table(scene, {.path = at(name), .shard = {number, 2}, .options = {}, .evaluator = "cpu"},
                [&] { return &evaluator; });
  }

  void SetUp() override {
    make("1.nc", 1, 0.5);
    make("2.nc", 2, 0.5);
  }
  ShardSet shards() const { return ShardSet({at("1.nc").string(), at("2.nc").string()}); }
};

TEST_F(ReplacedShards, ByAnotherFile_AreRefused) {
  make("other.nc", 2, 0.3);
  fs::copy_file(at("1.nc"), at("first.nc"));
  put("text.nc", "no table");
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"other.nc", "2.nc: is a shard of another table: it has scene fnv1a64:"},
      {"first.nc", "2.nc: is shard 1/2 now, and was 2"},
      {"text.nc", "2.nc: is not a NetCDF table of dolp"}};
  for (const auto& [replacement, message] : rows) {
    SetUp();
    const ShardSet set = shards();
    fs::rename(at(replacement), at("2.nc"));
    const std::string error = error_text([&] { set.merge(at("t.nc"), "test"); });
    EXPECT_NE(error.find(message), std::string::npos) << error;
    EXPECT_FALSE(fs::exists(at("t.nc")));
  }
}

TEST_F(ReplacedShards, ByTheSameShard_AreMerged) {
  const ShardSet set = shards();
  make("2.nc", 2, 0.5);
  EXPECT_EQ(set.merge(at("t.nc"), "test"), 4U);
  EXPECT_EQ(read_table(at("t.nc")).size(), 4U);
}

}  // namespace shards_test
