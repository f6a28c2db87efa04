// The window on a virtual display, with events of mouse and keyboard from outside the program.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <cmath>
#include <functional>
#include <thread>

#include "cli_support.hpp"
#include "explore/files.hpp"
#include "explore/readout.hpp"
#include "explore/scene_edits.hpp"
#include "explore/window/app.hpp"
#include "explore/window/style.hpp"
#include "table/table_file.hpp"
#include "terminal/embedded_texts.hpp"
#include "virtual_display.hpp"
#include "window_support.hpp"

namespace window_test {

using namespace dolp;
using namespace dolp::explore;
using namespace dolp::explore_test;

TEST_F(Window, Slider_Dragged_PlottedValuesChangeAndAgreeWithEval_AndTheDragIsTakenBackAndRepeated) {
  const std::vector<Point> before = session().curve().points();
  drag_slider("surface.sigma", kPartOfSlider);
  const double wanted = 0.01 * std::pow(200.0, kPartOfSlider);
  EXPECT_NEAR(*number("surface.sigma"), wanted, kGrab * wanted);
  ASSERT_TRUE(session().curve().is_finished());
  const std::vector<Point>& after = session().curve().points();
  const Columns truth = evaluated();
  ASSERT_EQ(truth.at("dolp").size(), after.size());
  std::size_t changed = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i][Quantity::kDolp] != before[i][Quantity::kDolp]) ++changed;
    if (std::isnan(after[i][Quantity::kRhoI])) continue;
    const double error = after[i][Quantity::kErrorEstimate] + truth.at("error_estimate")[i];
    EXPECT_NEAR(after[i][Quantity::kDolp], truth.at("dolp")[i], error) << i;
    EXPECT_NEAR(after[i][Quantity::kStokesQ], truth.at("stokes_q")[i], error * after[i][Quantity::kStokesI]) << i;
    EXPECT_LE(error, 2.0 * session().scene().number("accuracy.tolerance").value()) << i;
  }
  EXPECT_GT(changed, after.size() / 2);
  const auto dragged = number("surface.sigma");
  click_control("emission.bracket");
  keys("ctrl+z");
  EXPECT_EQ(word("emission.bracket"), "false");
  EXPECT_EQ(number("surface.sigma"), dragged);
  keys("ctrl+z");
  EXPECT_EQ(number("surface.sigma"), 0.15);
  keys("ctrl+z");
  EXPECT_EQ(session().message().text, "nothing to undo");
  keys("ctrl+shift+z");
  EXPECT_EQ(number("surface.sigma"), dragged);
  keys("ctrl+shift+c");
  EXPECT_EQ(ImGui::GetClipboardText(), table_command(session().edits()));
  ctrl_click("surface.sigma");
  EXPECT_FALSE(session().edits().is_changed());
}

TEST_F(Window, Curve_WheelAndRightButton_ZoomAndShift_ADoubleClickShowsAll) {
  const CurveView& view = app_->curve_view();
  const Scale x = view.x(), y = view.y();
  const ImVec2 at = view.area().at(0.4F, 0.5F);
  move_to(at);
  xdotool({"click", "4"});
  frames();
  EXPECT_LT(view.x().to - view.x().from, 0.9 * (x.to - x.from));
  EXPECT_LT(view.y().to - view.y().from, 0.9 * (y.to - y.from));
  EXPECT_NEAR(view.x().value(0.4), 36.0, 0.3);  // the zoom keeps the zenith under the mouse at its place
  const Scale zoomed = view.x();
  xdotool({"mousedown", "3"});
  frames();
  move_to(view.area().at(0.5F, 0.5F));
  xdotool({"mouseup", "3"});
  frames();
  EXPECT_NEAR(view.x().to - view.x().from, zoomed.to - zoomed.from, 1e-6);
  EXPECT_NEAR(view.x().value(0.5), 36.0, 0.3);
  xdotool({"keydown", "shift", "click", "5", "keyup", "shift"});
  frames();
  EXPECT_NE(view.y(), y);
  xdotool({"click", "--repeat", "2", "--delay", "20", "1"});
  frames();
  EXPECT_EQ(view.x(), x);
  EXPECT_EQ(view.y(), y);
}

TEST_F(Window, Legend_PinClicked_HidesIt) {
  keys("ctrl+p");
  drag_slider("surface.sigma", kPartOfSlider);
  const Area area = app_->curve_view().area();
  const float line = ImGui::GetTextLineHeight();
  // The pin's name is in one of the two lines above the plot. A click on the name hides the pin.
  const auto is_visible = [&] { return session().pins()[0].is_visible; };
  ASSERT_TRUE(is_visible());
  for (float x = area.min.x; x < area.max.x && is_visible(); x += 3.0F * line) {
    for (float y = area.min.y - 5.0F * line; y < area.min.y - 2.0F * line && is_visible(); y += 0.8F * line)
      click({x, y});
  }
  EXPECT_FALSE(is_visible());
}

TEST_F(Window, LegendOfFiveCurves_HasNoScrollbar) {
  for (const char* sigma : {"0.2", "0.3", "0.4"}) {
    session().set({{"surface.sigma", TomlText{sigma}}, {"surface.material", "carbon"}});
    settle();
    keys("ctrl+p");
    session().pins().back().name =
        std::string("a pin with quite a long name, so that each needs a line of its own, ") + sigma;
  }
  frames();
  const ImGuiWindow* legend = nullptr;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    if (std::string(window->Name).find("legend") != std::string::npos) legend = window;
  }
  ASSERT_TRUE(legend);
  EXPECT_EQ(legend->ScrollMax.y, 0.0F);
  EXPECT_FALSE(legend->ScrollbarY);
  EXPECT_GT(legend->Size.y, 4.0F * ImGui::GetTextLineHeight());
}

TEST_F(Window, CurveAndMapClicked_MoveTheCursor_AndTheCurveFollowsTheMap) {
  show_map();
  const double before = session().theta_deg();
  click(app_->curve_view().area().at(0.5F, 0.5F));
  EXPECT_NE(session().theta_deg(), before);
  const std::size_t version = session().map().version();
  click(app_->map_view().area().at(0.5F, 0.5F));
  settle();
  EXPECT_NEAR(session().theta_deg(), 45.0, 0.5);
  EXPECT_NE(number("surface.sigma"), 0.15);
  EXPECT_NEAR(session().map_cursor(session().map().y()), 0.5, 0.01);
  EXPECT_EQ(session().map().version(), version);
  EXPECT_EQ(session().curve().shown_scene().number("surface.sigma"), number("surface.sigma"));
  EXPECT_TRUE(session().map().is_finished());
  xdotool({"key", "ctrl+q"});
  bool is_open = true;
  for (int i = 0; i < kFrames && is_open; ++i) is_open = app_->frame();
  EXPECT_FALSE(is_open);
}

TEST_F(Window, CurveAndTable_ByShortcut_EqualThoseOfTheCommands) {
  answer("ctrl+e");
  EXPECT_EQ(content("scene_curve.csv"), session().curve().finished().csv);
  put("points.csv", "theta_deg\n45\n");
  const std::string command = dolp("eval scene.toml --points points.csv -o -").out;
  const std::string header = command.substr(command.find(','), command.find('\n') - command.find(','));
  EXPECT_TRUE(content("scene_curve.csv").starts_with("theta_deg,sigma,q" + header + '\n'));
  succeeded(dolp("table scene.toml -o t.nc --quiet"));
  const TableValues wanted = read_table(at("t.nc"));
  answer("ctrl+t");
  for (int i = 0; i < 2000 && !std::filesystem::exists(at("scene_table.nc")); ++i) app_->frame();
  const TableValues made = read_table(at("scene_table.nc"));
  EXPECT_EQ(made[Quantity::kDolp], wanted[Quantity::kDolp]);
  EXPECT_EQ(made.axes[Axis::kTheta], wanted.axes[Axis::kTheta]);
  succeeded(dolp("verify scene_table.nc"));
}

TEST_F(Window, List_OpensAndClosesOnTheScreenWithoutTheMouseMoving) {
  const Area area = app_->control_area("surface.masking");
  move_to(area.at(0.5F, 0.5F));
  app_->answer();
  const auto below = [&] {
    return display_.pixels(static_cast<std::size_t>(area.min.x), static_cast<std::size_t>(area.max.y) + 8, 60, 60);
  };
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(500)); };
  const std::string closed = below();
  std::string opened, closed_again;
  std::jthread hand([&] {
    xdotool({"mousedown", "1"});
    xdotool({"mouseup", "1"});
    pause();
    opened = below();
    xdotool({"windowfocus", "--sync", window_, "keydown", "Escape", "sleep", "0.3", "keyup", "Escape"});
    pause();
    closed_again = below();
    app_->close();
  });
  app_->run();
  hand.join();
  EXPECT_NE(opened, closed);
  EXPECT_EQ(closed_again, closed);
}

TEST_F(Window, EventsBetweenTwoFrames_AllCount) {
  click_control("field surface.sigma");
  xdotool({"key", "--delay", "12", "0", "period", "2", "Tab", "Tab", "4", "Return"});
  frames();
  EXPECT_EQ(number("surface.sigma"), 0.2);
  EXPECT_EQ(number("surface.q"), 4.0);
  xdotool({"key", "--delay", "12", "ctrl+p", "ctrl+p"});
  frames();
  EXPECT_EQ(session().pins().size(), 2U);
  // A click acts where the mouse was at that moment, even if the mouse moves away before the next frame.
  const ImVec2 box = app_->control_area("emission.bracket").at(0.5F, 0.5F);
  xdotool({"mousemove", "--window", window_, std::to_string(std::lround(box.x)), std::to_string(std::lround(box.y)),
           "click", "1", "mousemove", "--window", window_, "700", "300"});
  frames();
  EXPECT_EQ(word("emission.bracket"), "true");
}

TEST_F(Window, TypedNumber_IsTakenWhereverTypingEnds_AndStaysWhereItIsRefused) {
  const std::function<void()> ends[] = {[&] { keys("Return"); }, [&] { keys("Tab"); },
                                        [&] { click(app_->curve_view().area().at(0.5F, 0.5F)); },
                                        [&] {
                                          xdotool({"windowfocus", root_window()});
                                        }};
  double wanted = 0.2;
  for (const auto& end : ends) {
    for (const bool is_good : {true, false}) {
      const auto before = number("surface.sigma");
      focus();
      click_control("field surface.sigma");
      type(is_good ? fmt::format("{}", wanted) : "-3");
      EXPECT_EQ(number("surface.sigma"), before);
      end();
      frames();
      EXPECT_EQ(number("surface.sigma"), is_good ? wanted : before);
      EXPECT_EQ(is_marked("field surface.sigma"), !is_good);
      EXPECT_EQ(session().message().is_error, !is_good);
      if (is_good) continue;
      click_control("field surface.sigma");
      keys("Escape");
      EXPECT_FALSE(is_marked("field surface.sigma"));
      EXPECT_EQ(session().message().text, "");
      EXPECT_EQ(number("surface.sigma"), before);
    }
    wanted += 0.125;
  }
}

TEST_F(Window, EndsOfABand_OfWhichOneWasRefused_AreTakenTogether) {
  open({{"spectrum.band_um", {8.0, 14.0}}});
  click_control("field spectrum.band_um 0");
  xdotool({"type", "15"});
  xdotool({"key", "Tab"});  // not keys(), which holds a key long enough to move on by two fields
  EXPECT_TRUE(is_marked("field spectrum.band_um 0"));
  xdotool({"type", "20"});
  keys("Return");
  EXPECT_EQ(session().scene().numbers("spectrum.band_um"), (std::vector<double>{15.0, 20.0}));
  EXPECT_FALSE(is_marked("field spectrum.band_um 0"));
}

/// The plot area of the curve, in a window on a display with the given size and resolution.
Area plot_on(const std::string& size, const std::string& dots_per_inch) {
  const VirtualDisplay display(size);
  succeeded(run({.arguments = {"xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER",
                               "Xft.dpi: " + dots_per_inch},
                 .folder = "/"}));
  App app(SceneEdits(Scene::from_text(kEdited)), {});
  for (int i = 0; i < kFrames; ++i) app.frame();
  return app.curve_view().area();
}

TEST(WindowScale, Display_At200Percent_DoublesThePlot_OrLeavesItAFifthOfTheHeight) {
  const Area single = plot_on("1440x900", "96");
  const Area twice = plot_on("2880x1800", "192");
  const float height = single.height();
  EXPECT_GT(height, 300.0F);
  EXPECT_NEAR(twice.height(), 2.0F * height, 0.05F * height);
  EXPECT_NEAR(twice.width(), 2.0F * single.width(), 0.05F * height);
  EXPECT_GT(plot_on("1440x900", "192").height(), 0.2F * 900.0F);
}

TEST(WindowText, WithoutAGreekFont_IsAscii) {
  EXPECT_EQ(ascii("θ ≤ 90°"), "theta <= 90 deg");
  std::string all;
  for (const Control& control : controls()) all += control.label + control.equation + unit_text(*control.key);
  for (const PlottedDescription& quantity : kAllPlotted) all += std::string(quantity.name) + quantity.meaning;
  const std::string plain = ascii(all);
  EXPECT_TRUE(std::ranges::all_of(plain, [](char c) { return static_cast<unsigned char>(c) < 128; })) << plain;
}

class ExploreCommand : public CommandLine {
 protected:
  VirtualDisplay display_;
};

TEST_F(ExploreCommand, FramesAndScreenshot_WriteAPictureAndTheTimes_AlsoOfASession) {
  Session session(SceneEdits(Scene::from_file(at("scene.toml"))));
  session.pin();
  save_session(session, at("session.toml").string());
  const Outcome outcome =
      succeeded(dolp("explore session.toml --set surface.sigma=0.2 --frames 5 --screenshot shot.png"));
  EXPECT_TRUE(contains(outcome.out, "frames     5 frames"));
  EXPECT_TRUE(content("shot.png").starts_with("\x89PNG"));
  EXPECT_GT(content("shot.png").size(), 50'000U);
  succeeded(dolp("explore --frames 1"));
  EXPECT_EQ(Scene::from_text(std::string(embedded_night_paint_toml())).title(),
            "Night: paint under a uniform cold sky, 8-14 um");
  expect_refused(dolp("explore session.toml --frames 1 --set surface.sigma=-1"), "surface.sigma");
  put("session.toml", "dolp_session = 1\n");
  expect_refused(dolp("explore session.toml --frames 1"), "session.toml: scene.file is missing");
}

TEST_F(ExploreCommand, WrongArguments_AreInputErrors_AndAnUnknownDeviceIsADeviceError) {
  EXPECT_EQ(dolp("explore scene.toml --screenshot shot.png").status, 2);
  EXPECT_EQ(dolp("explore missing.toml --frames 1").status, 2);
  EXPECT_EQ(dolp("explore scene.toml --frames 1 --set surface.sigma=-1").status, 2);
  EXPECT_EQ(dolp({"explore", "--frames", "1", "--device", "no such device"}).status, 3);
  put("measured.csv", "theta_deg,dolp\n60,two\n");
  expect_refused(dolp("explore scene.toml --frames 1 --measured measured.csv"),
                 "dolp: measured.csv:2: dolp = two: not a number; must be a number in [-1, 1]\n");
}

TEST_F(CommandLine, Explore_WithoutDisplay_SaysSoInOneLine) {
  Command wanted = command("explore --frames 1");
  wanted.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  expect_refused(run(wanted), "dolp: no display", 3);
}

}  // namespace window_test
