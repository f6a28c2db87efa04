// Scenes written as TOML read back as the same scenes.
#include <gtest/gtest.h>

#include <array>
#include <dolp/dolp.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "temporary_file.hpp"

namespace dolp::scene_toml_test {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;

TEST(SceneToml, ShippedScenesWithChanges_ReadBackAsTheSameScene) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  for (const auto& file : std::filesystem::directory_iterator(kHostDir + "/scenes")) {
    if (file.path().extension() != ".toml") continue;
    SCOPED_TRACE(file.path().string());
    const Scene scene =
        Scene::from_file(file.path(), {{"title", "a \"quoted\" title"}, {"surface.sigma", 0.1234567890123}});
    const Scene again = Scene::from_text(scene.toml(kHostDir), {}, kHostDir + "/again.toml");
    EXPECT_EQ(again.title(), "a \"quoted\" title");
    for (const char* axis : {"grid.theta_deg", "grid.sigma", "grid.q"})
      EXPECT_EQ(again.numbers(axis), scene.numbers(axis));
    EXPECT_EQ(again.number("surface.sigma"), 0.1234567890123);
    const std::array theta_deg = {0.0, 35.0, 70.0};
    EXPECT_EQ(to_csv({}, evaluator.evaluate(scene, {{"theta_deg", theta_deg}})),
              to_csv({}, evaluator.evaluate(again, {{"theta_deg", theta_deg}})));
  }
}

TEST(SceneToml, NamedFiles_AreFoundFromTheNewFolder) {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "saved");
  std::ofstream(folder / "scenes" / "paint.csv") << "wavelength_um,n,k\n8,1.5,0.1\n14,1.6,0.2\n";
  const std::string path = (folder / "scenes" / "paint.toml").string();
  const Scene paint = Scene::from_file(kHostDir + "/scenes/night_paint.toml");
  const Scene scene = Scene::from_text(paint.toml(), {{"surface.material_file", "paint.csv"}}, path);
  const Scene again = Scene::from_text(scene.toml(folder / "saved"), {}, (folder / "saved" / "s.toml").string());
  EXPECT_EQ(again.refractive_index(10.0), scene.refractive_index(10.0));
}

}  // namespace
}  // namespace dolp::scene_toml_test
