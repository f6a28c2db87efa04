// The window on a virtual display, with events of mouse and keyboard from outside the program: its controls, its look.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <cmath>
#include <functional>
#include <thread>

#include "explore/files.hpp"
#include "explore/readout.hpp"
#include "explore/window/style.hpp"
#include "table/table_file.hpp"
#include "terminal/embedded_texts.hpp"
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
  // Results of `dolp eval` for the scene as changed in the window, at the zeniths of the curve in the window.
  std::string csv = "theta_deg\n";
  for (const Point& point : after) csv += std::to_string(point.theta_deg) + '\n';
  put("points.csv", csv);
  const Columns truth = eval({"--set", session().edits().changes().front().text()});
  ASSERT_EQ(truth.at("dolp").size(), after.size());
  std::size_t changed = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i][Quantity::kDolp] != before[i][Quantity::kDolp]) ++changed;
    if (std::isnan(after[i][Quantity::kRhoI])) continue;
    EXPECT_EQ(after[i][Quantity::kDolp], truth.at("dolp")[i]) << i;
    EXPECT_EQ(after[i][Quantity::kStokesQ], truth.at("stokes_q")[i]) << i;
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
  const CurveView& view = app_->ui().curves;
  const Scale x = view.x(), y = view.y();
  const ImVec2 middle = area("plot curve").at(0.5F, 0.5F);
  move_to(area("plot curve").at(0.4F, 0.5F));
  send({"click", "4"});
  EXPECT_LT(view.x().to - view.x().from, 0.9 * (x.to - x.from));
  EXPECT_LT(view.y().to - view.y().from, 0.9 * (y.to - y.from));
  EXPECT_NEAR(view.x().value(0.4), 36.0, 0.3);  // the zoom keeps the zenith under the mouse at its place
  const Scale zoomed = view.x();
  send({"mousedown", "3"});
  move_to(middle);
  send({"mouseup", "3"});
  EXPECT_NEAR(view.x().to - view.x().from, zoomed.to - zoomed.from, 1e-6);
  EXPECT_NEAR(view.x().value(0.5), 36.0, 0.3);
  send({"keydown", "shift", "click", "5", "keyup", "shift"});
  EXPECT_NE(view.y(), y);
  double_click(middle);
  EXPECT_EQ(view.x(), x);
  EXPECT_EQ(view.y(), y);
}

TEST_F(Window, Legend_PinClicked_HidesIt) {
  keys("ctrl+p");
  drag_slider("surface.sigma", kPartOfSlider);
  for (const bool is_visible : {true, false, true}) {
    EXPECT_EQ(session().pins()[0].is_visible, is_visible);
    click_control("legend pin");
  }
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
  click_control("plot curve");
  EXPECT_NE(session().theta_deg(), before);
  const std::size_t version = session().map().version();
  click_control("plot map");
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
  EXPECT_EQ(content("scene_curve.csv"), session().curve().finished().csv());
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
  const Area list = area("surface.masking");
  move_to(list.at(0.5F, 0.5F));
  app_->answer();
  const auto below = [&] {
    return pixels({{list.min.x, list.max.y + 8.0F}, {list.min.x + 60.0F, list.max.y + 68.0F}});
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
  send({"key", "--delay", "12", "0", "period", "2", "Tab", "Tab", "4", "Return"});
  EXPECT_EQ(number("surface.sigma"), 0.2);
  EXPECT_EQ(number("surface.q"), 4.0);
  send({"key", "--delay", "12", "ctrl+p", "ctrl+p"});
  EXPECT_EQ(session().pins().size(), 2U);
  // A click acts where the mouse was at that moment, even if the mouse moves away before the next frame.
  const ImVec2 box = area("emission.bracket").at(0.5F, 0.5F);
  send({"mousemove", "--window", window_, std::to_string(std::lround(box.x)), std::to_string(std::lround(box.y)),
        "click", "1", "mousemove", "--window", window_, "700", "300"});
  EXPECT_EQ(word("emission.bracket"), "true");
}

TEST_F(Window, TypedNumber_IsTakenWhereverTypingEnds_AndStaysWhereItIsRefused) {
  const std::string tree = run({.arguments = {"xwininfo", "-root"}, .folder = "/"}).out;
  const std::string root = tree.substr(tree.find("0x"), tree.find(' ', tree.find("0x")) - tree.find("0x"));
  const std::function<void()> ends[] = {[&] { keys("Return"); }, [&] { keys("Tab"); },
                                        [&] { click_control("plot curve"); },
                                        [&] {
                                          xdotool({"windowfocus", root});
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

class WindowLook : public Window {
 protected:
  /// Mean brightness of the red channel in the upper left part of the screen.
  double brightness() const {
    const std::string rows = pixels({{0.0F, 0.0F}, {300.0F, 300.0F}});
    double sum = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += 4) sum += static_cast<unsigned char>(rows[i]);
    return 4.0 * sum / static_cast<double>(rows.size());
  }
  Area plot() const { return area("plot curve"); }
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
  const auto height = [&] { return area("surface.sigma").height(); };
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
  EXPECT_THROW(area("panel effects"), std::out_of_range);
  resize("800", "560");
  EXPECT_GT(plot().width(), 350.0F);
  EXPECT_GT(plot().height(), 200.0F);
  for (const char* page : {"effects", "accuracy", "map", "slopes", "sky"}) {
    const Area tab = area(std::string("panel ") + page);
    EXPECT_LT(tab.max.x, 800.0F) << page;
    EXPECT_LT(tab.max.y, plot().min.y) << page;
  }
  const Area place = plot();
  const std::string curve = pixels(place);
  click_control("panel effects");
  EXPECT_NE(pixels(place), curve);
  click_control("panel curve");
  resize("1280", "800");
  EXPECT_GT(plot().width(), 380.0F);
  EXPECT_LT(plot().max.x, area("panel map").min.x);
  resize("200", "150");
}

TEST_F(WindowLook, Note_WaitsForTheMouseToRest_AndLeavesTheNextValueInSight) {
  const Area slider = area("surface.sigma");
  Area next = area("surface.q");
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

/// The plot area of the curve, in a window on a display with the given size and resolution.
Area plot_on(const std::string& size, const std::string& dots_per_inch) {
  const VirtualDisplay display(size);
  succeeded(run({.arguments = {"xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER",
                               "Xft.dpi: " + dots_per_inch},
                 .folder = "/"}));
  App app(paint(), {});
  for (int i = 0; i < kFrames; ++i) app.frame();
  return app.control_area("plot curve");
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
