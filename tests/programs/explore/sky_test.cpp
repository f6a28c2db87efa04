// The list of skies in the window, and the sliders of a sky between two temperatures.
#include <gtest/gtest.h>

#include "explore/scene_edits.hpp"
#include "window_support.hpp"

namespace dolp::explore::sky_test {
namespace {

using namespace explore_test;

class Skies : public Window {
 protected:
  /// Chooses a sky from a list. `entry` is the distance of the sky from the top of the list, in heights of one line.
  void choose(float entry) {
    click_control("sky");
    click(app_->control_area("sky").at(0.5F, entry));
    settle();
  }
};

TEST_F(Skies, TwoTemperatures_HaveSliders_UntilACtrlClickRestoresTheSkyAsOpened) {
  choose(4.3F);  // the fourth entry
  EXPECT_EQ(number(kZenithSky), 220.0);
  EXPECT_EQ(number(kHorizonSky), 285.0);
  frames();
  drag_slider(kZenithSky, kPartOfSlider);
  const double zenith_K = number(kZenithSky).value();
  EXPECT_NEAR(zenith_K, 150.0 + 200.0 * static_cast<double>(kPartOfSlider), 200.0 * kGrab);
  for (const auto& [typed, is_good] : {std::pair{"-3", false}, {"288.5", true}}) {
    enter(std::string("field ") + kHorizonSky, typed);
    EXPECT_EQ(is_marked(std::string("field ") + kHorizonSky), !is_good);
    EXPECT_EQ(number(kHorizonSky), is_good ? 288.5 : 285.0);
  }
  answer("ctrl+s");
  EXPECT_TRUE(contains(content("scene_scene.toml"), "horizon_temperature_K = 288.5"));
  succeeded(dolp("plan scene_scene.toml"));
  ctrl_click(kZenithSky);
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
}  // namespace dolp::explore::sky_test
