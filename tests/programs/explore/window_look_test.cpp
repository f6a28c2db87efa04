// The window's look: theme, scale, small windows, notes, and closing.
#include <gtest/gtest.h>

#include <thread>

#include "explore/window/style.hpp"
#include "window_support.hpp"

namespace window_look_test {

using namespace dolp;
using namespace dolp::explore;
using namespace dolp::explore_test;

class WindowLook : public Window {
 protected:
  std::string pixels(const Area& area) const {
    const auto whole = [](float length) { return static_cast<std::size_t>(length); };
    return display_.pixels(whole(area.min.x), whole(area.min.y), whole(area.width()), whole(area.height()));
  }
  /// Mean brightness of the red channel in the upper left part of the screen.
  double brightness() const {
    const std::string rows = display_.pixels(0, 0, 300, 300);
    double sum = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += 4) sum += static_cast<unsigned char>(rows[i]);
    return 4.0 * sum / static_cast<double>(rows.size());
  }
  Area plot() const { return app_->curve_view().area(); }
};

TEST_F(WindowLook, LightTheme_ChosenInTheMenu_IsKept) {
  EXPECT_LT(brightness(), 100.0);
  click_control("menu View");
  click_control("Light theme");
  frames();
  EXPECT_GT(brightness(), 200.0);
  EXPECT_TRUE(contains(content("config/dolp/window.toml"), "light = true"));
  open({});
  frames();
  EXPECT_GT(brightness(), 200.0);
}

TEST_F(WindowLook, MarkOfAMaximumAtTheEnd_IsWhole) {
  session().set_view(&View::theta_max_deg, 60.0);
  settle();
  ASSERT_GT(session().peak().answer().value().at.theta_deg, 59.9);
  const auto column = [&](float right) {
    return pixels({{plot().max.x + right, plot().min.y}, {plot().max.x + right + 1.0F, plot().max.y}});
  };
  EXPECT_TRUE(column(3.0F) != column(7.0F));  // the mark of the maximum covers the left column, but not the right one
}

TEST_F(WindowLook, Lines_BreakAtSpacesAlone) {
  const auto width = [](const char* text) { return ImGui::CalcTextSize(text).x; };
  EXPECT_EQ(in_lines("0.09382 to 0.1154", width("0.09382 to 0.")), "0.09382 to\n0.1154");
  EXPECT_EQ(in_lines("0.09382 to 0.1154", width("0.09382 to 0.1154")), "0.09382 to 0.1154");
  EXPECT_EQ(in_lines("first\nto 1.5", width("to 1.5")), "first\nto 1.5");
}

TEST_F(WindowLook, Scale_ByKeys_ChangesTheSizeOfTheControls) {
  const auto height = [&] { return app_->control_area("surface.sigma").height(); };
  const float usual = height();
  for (const char* larger : {"ctrl+equal", "ctrl+KP_Add"}) {
    const float before = height();
    keys(larger);
    EXPECT_GT(height(), before);
  }
  EXPECT_NEAR(height(), 1.21F * usual, 2.0F);  // two steps of 10 %; sizes of text and margins are rounded to pixels
  EXPECT_NEAR(scaled(10.0F), 12.1F, 0.5F);
  keys("ctrl+0");
  EXPECT_EQ(height(), usual);
  keys("ctrl+minus");
  EXPECT_LT(height(), usual);
}

TEST_F(WindowLook, LeastSize_ShowsOneThingAtATime) {
  const auto resize = [&](const char* width, const char* height) {
    xdotool({"windowsize", "--sync", window_, width, height});
    frames(2 * kFrames);
    app_->save_picture(at("picture.png").string());
    frames();
    const std::string png = content("picture.png");
    // In a PNG file the last two bytes of the width are at 18 and 19, of the height at 22 and 23.
    const auto number = [&](std::size_t i) { return 256 * std::uint8_t(png.at(i)) + std::uint8_t(png.at(i + 1)); };
    EXPECT_EQ(std::to_string(number(18)) + 'x' + std::to_string(number(22)), std::string(width) + 'x' + height);
  };
  EXPECT_THROW(app_->control_area("panel effects"), std::out_of_range);
  resize("800", "560");
  EXPECT_GT(plot().width(), 350.0F);
  EXPECT_GT(plot().height(), 200.0F);
  for (const char* page : {"effects", "accuracy", "map", "slopes", "sky"}) {
    const Area tab = app_->control_area(std::string("panel ") + page);
    EXPECT_LT(tab.max.x, 800.0F) << page;
    EXPECT_LT(tab.max.y, plot().min.y) << page;
  }
  const std::string curve = pixels(plot());
  click_control("panel effects");
  EXPECT_NE(pixels(plot()), curve);
  click_control("panel curve");
  resize("1280", "800");
  EXPECT_GT(plot().width(), 380.0F);
  EXPECT_LT(plot().max.x, app_->control_area("panel map").min.x);
  resize("200", "150");
}

TEST_F(WindowLook, Note_WaitsForTheMouseToRest_AndLeavesTheNextValueInSight) {
  const Area slider = app_->control_area("surface.sigma");
  Area next = app_->control_area("surface.q");
  next.max = next.at(0.6F, 1.0F);  // without the right end, which the pointer on the sigma slider may cover
  const Area note{{slider.max.x + 150.0F, slider.min.y}, {slider.max.x + 300.0F, slider.max.y + 40.0F}};
  const std::string without = pixels(note);
  const double moved_s = ImGui::GetTime();
  move_to(slider.at(0.9F, 0.5F));
  const std::string next_before = pixels(next);
  // A note appears only if the mouse rests. So this thread only waits for the note, then closes the window.
  std::jthread hand([&] {
    while (pixels(note) == without) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    app_->close();
  });
  app_->run();
  hand.join();
  EXPECT_GE(ImGui::GetTime() - moved_s, static_cast<double>(kTooltipDelay_s));
  EXPECT_EQ(pixels(next), next_before);
}

TEST_F(WindowLook, Escape_ClosesWhatIsOpen) {
  move_to({5.0F, 5.0F});
  const std::string closed = pixels(plot());
  for (const char* open : {"ctrl+h", "ctrl+o", "ctrl+s"}) {
    keys(open);
    frames();
    EXPECT_NE(pixels(plot()), closed) << open;
    keys("Escape");
    std::this_thread::sleep_for(std::chrono::milliseconds(400));  // the dialog fades out
    frames();
    EXPECT_EQ(pixels(plot()), closed) << open;
  }
  click_control("menu File");
  const Area menu{{10.0F, 30.0F}, {150.0F, 200.0F}};
  const std::string opened = pixels(menu);
  keys("Escape");
  EXPECT_NE(pixels(menu), opened);
}

}  // namespace window_look_test
