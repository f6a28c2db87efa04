// Skies that a user makes in the window from two temperatures: their files and their editor.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "explore/scene_edits.hpp"
#include "explore_support.hpp"
#include "temporary_file.hpp"
#include "window_support.hpp"

namespace dolp::explore {
namespace {

using namespace explore_test;

constexpr SkyPair kDusk{231.5, 279.0};

TEST(SkyPair, OnlyFilesOfTwoRows_AreRead) {
  const std::optional<SkyPair> none;
  for (const auto& [csv, sky] : {std::pair{kDusk.csv(), std::optional(kDusk)},
                                 {"zenith_deg,temperature_K\n0,220\n45,250\n90,285\n", none},
                                 {"zenith_deg,temperature_K\n0,220\n80,285\n", none},
                                 {"zenith_deg,radiance\n0,2\n90,8\n", none},
                                 {"wavelength_um,zenith_deg,temperature_K\n8,0,220\n8,90,285\n", none}}) {
    EXPECT_EQ(read_sky_pair(TemporaryFile("sky.csv", csv).path()), sky) << csv;
  }
}

TEST(SkyPair, SceneOfTheWindow_HasTheResultsOfItsCsv) {
  Driver driver(paint());
  driver.session.set("surroundings.profile", driver.session.skies().path(kDusk));
  driver.settle();
  const TemporaryFile file("sky.csv", "zenith_deg,temperature_K\n0,231.5\n90,279\n");
  const Scene scene = paint({"surroundings.profile=" + file.path()}).scene();
  expect_same(driver.session.curve().points(), truth(scene, driver.session.curve().points()));
  driver.session.undo();
  EXPECT_EQ(driver.session.scene().number("surroundings.temperature_K"), 240.0);
}

class Skies : public Window {
 protected:
  /// Chooses a sky from a list. `entry` is the distance of the sky from the top of the list, in heights of one line.
  void choose(float entry) {
    click_control("sky");
    click(app_->control_area("sky").at(0.5F, entry));
    settle();
  }
  std::optional<SkyPair> sky() const { return read_sky_pair(sky_file(session().scene())); }
};

TEST_F(Skies, Editor_MakesASkyBetweenTwoTemperatures_WhichTheSavedSceneKeeps) {
  choose(4.3F);  // the fourth entry
  ASSERT_EQ(sky(), SkyPair());
  drag_slider("sky zenith", kPartOfSlider);
  frames();
  ASSERT_TRUE(sky());
  EXPECT_NEAR(sky()->zenith_K, 150.0 + 200.0 * static_cast<double>(kPartOfSlider), 200.0 * kGrab);
  const double zenith_K = sky()->zenith_K;
  for (const auto& [typed, is_good] : {std::pair{"-3", false}, {"288.5", true}}) {
    enter("field sky horizon", typed);
    EXPECT_EQ(is_marked("field sky horizon"), !is_good);
    EXPECT_EQ(*sky(), (SkyPair{zenith_K, is_good ? 288.5 : SkyPair().horizon_K}));
  }
  keys("ctrl+shift+c");
  EXPECT_TRUE(session().message().text.starts_with("save the scene first")) << session().message().text;
  answer("ctrl+s");
  EXPECT_EQ(content("scene_scene_sky.csv"), fmt::format("zenith_deg,temperature_K\n0,{}\n90,288.5\n", zenith_K));
  succeeded(dolp("plan scene_scene.toml"));
  keys("ctrl+shift+c");
  EXPECT_TRUE(session().message().text.starts_with("copied")) << session().message().text;
  ctrl_click("sky zenith");
  EXPECT_EQ(number("surroundings.temperature_K"), 240.0);
}

TEST_F(Skies, List_OffersUniformAndBuiltInSkies_AndTheFileOfTheSceneAsOpened) {
  for (const auto& [entry, name] : {std::pair{2.5F, "clear-sky"}, {3.4F, "overcast"}, {1.6F, ""}}) {
    choose(entry);
    EXPECT_EQ(word("surroundings.profile").value_or(""), name);
  }
  EXPECT_EQ(number("surroundings.temperature_K"), 240.0);  // the value of the scene as opened
  put("sky.csv", "zenith_deg,temperature_K\n0,220\n70,240\n90,285\n");
  open({{"surroundings.profile", "sky.csv"}});
  for (const auto& [entry, name] : {std::pair{3.4F, "overcast"}, {5.2F, "sky.csv"}}) {
    choose(entry);
    EXPECT_EQ(word("surroundings.profile"), name);
  }
  answer("ctrl+s");
  EXPECT_TRUE(contains(content("scene_scene.toml"), "profile = 'sky.csv'"));
}

}  // namespace
}  // namespace dolp::explore
