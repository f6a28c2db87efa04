// The window on a virtual display, and functions that use it with mouse and keyboard.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "explore/window/app.hpp"
#include "virtual_display.hpp"

namespace dolp::explore_test {

using explore::App;
using explore::Area;

// Position to which drag_slider drags the handle, as a share of the slider's length.
inline constexpr float kPartOfSlider = 0.7F;
// Frames that ImGui needs to process an event.
inline constexpr int kFrames = 4;

// Tolerance of a value that a test sets by dragging a slider: a share of the slider's range, or of the value if the
// slider is logarithmic. It allows for the width of the handle.
inline constexpr double kGrab = 0.2;

// The scene in the window. It is cheap to compute, because most tests wait until the map is complete.
inline const std::string kEdited = R"(title = "Painted"
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "v-cavity"
specular = 0.97
diffuse = 0.03
[emission]
temperature_K = 290.0
[surroundings]
temperature_K = 240.0
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 30, 60]
[accuracy]
tolerance = 1e-2
)";

class Window : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    put("scene.toml", kEdited);
    open({});
  }
  /// Opens the window on scene.toml. `settings` replace values of the scene, as `--set` does.
  void open(const std::vector<Setting>& settings) {
    app_.reset();
    const explore::AppOptions options = {
        .device = "", .command_line = "dolp explore", .preferences = at("config/dolp/window.toml")};
    const auto scene = Scene::from_file(at("scene.toml"), settings);
    app_ = std::make_unique<App>(explore::SceneEdits(scene), options);
    // Without a map, frames are faster. Tests that need the map call show_map().
    session().set_view(&explore::View::panel, explore::Panel::kSlopes);
    settle();
    std::string found = xdotool({"search", "--name", "dolp explore"});
    window_ = found.substr(0, found.find('\n'));
    focus();
  }
  void TearDown() override { app_.reset(); }

  explore::Session& session() const { return app_->session(); }
  /// Waits for all results, and shows them.
  void settle() {
    app_->settle();
    frames();
  }
  void show_map() {
    session().set_view(&explore::View::panel, explore::Panel::kMap);
    settle();
  }
  void frames(int count = kFrames) {
    for (int i = 0; i < count; ++i) app_->frame();
  }
  void focus() {
    xdotool({"windowfocus", "--sync", window_});
    frames();
  }
  void move_to(ImVec2 at) {
    xdotool({"mousemove", "--window", window_, std::to_string(std::lround(at.x)), std::to_string(std::lround(at.y))});
    frames();
  }
  void press(const std::string& what) {
    xdotool({what, "1"});
    frames();
  }
  void click(ImVec2 at) {
    move_to(at);
    press("mousedown");
    press("mouseup");
  }
  void click_control(const std::string& control) { click(app_->control_area(control).at(0.5F, 0.5F)); }
  void drag_slider(const std::string& key, float to) {
    const Area area = app_->control_area(key);
    move_to(area.at(0.3F, 0.5F));
    press("mousedown");
    for (int i = 1; i <= 10; ++i) {
      const float part = 0.3F + 0.1F * static_cast<float>(i) * (to - 0.3F);
      move_to(area.at(part, 0.5F));
    }
    press("mouseup");
    app_->settle();
  }
  void keys(const std::string& combination) {
    xdotool({"windowfocus", "--sync", window_});
    xdotool({"keydown", combination});
    frames();
    xdotool({"keyup", combination});
    frames();
  }
  void type(const std::string& text) {
    xdotool({"type", "--delay", "12", "--", text});
    frames();
  }
  void enter(const std::string& field, const std::string& text) {
    click_control(field);
    keys("ctrl+a");
    type(text);
    keys("Return");
  }
  /// Opens a dialog by its shortcut. Types a path, or accepts the path that the dialog suggests.
  void answer(const std::string& shortcut, const std::string& path = "") {
    keys(shortcut);
    if (!path.empty()) type(path);
    keys("Return");
    settle();
  }
  /// Clicks a slider while Ctrl is pressed.
  void ctrl_click(const std::string& slider) {
    xdotool({"keydown", "ctrl"});
    frames();
    click(app_->control_area(slider).at(0.1F, 0.5F));
    xdotool({"keyup", "ctrl"});
    app_->settle();
  }
  std::optional<double> number(const std::string& key) const { return session().scene().number(key); }
  std::optional<std::string> word(const std::string& key) const { return session().scene().word(key); }
  /// True if the background of a field is red, which marks refused text.
  bool is_marked(const std::string& field) {
    frames();
    const Area area = app_->control_area(field);
    const auto left = static_cast<std::size_t>(area.max.x) - 12;
    const std::string pixel = display_.pixels(left, static_cast<std::size_t>(area.min.y) + 6, 1, 1);
    const auto channel = [&](std::size_t byte) { return static_cast<int>(static_cast<unsigned char>(pixel.at(byte))); };
    return channel(2) > 2 * channel(0);
  }
  static std::string root_window() {
    const std::string tree = run({.arguments = {"xwininfo", "-root"}, .folder = "/"}).out;
    const std::size_t number = tree.find("0x");
    return tree.substr(number, tree.find(' ', number) - number);
  }
  /// Results of `dolp eval` for the scene as changed in the window, at the zeniths of the curve in the window.
  Columns evaluated() const {
    std::string points = "theta_deg\n";
    for (const explore::Point& point : session().curve().points()) points += std::to_string(point.theta_deg) + '\n';
    put("points.csv", points);
    std::vector<std::string> options;
    for (const Setting& change : session().edits().changes()) options.insert(options.end(), {"--set", change.text()});
    return eval(options);
  }

  VirtualDisplay display_;
  std::unique_ptr<App> app_;
  std::string window_;
};

}  // namespace dolp::explore_test
