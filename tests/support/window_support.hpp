// The window on a virtual display, and functions that use it with mouse and keyboard.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "explore/window/app.hpp"
#include "explore_support.hpp"

namespace dolp::explore_test {

using explore::App;
using explore::Area;

/// Starts Xvfb, an X server without a screen, and sets DISPLAY for this process and its children.
class VirtualDisplay {
 public:
  explicit VirtualDisplay(const std::string& size = "1440x900") {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    const std::string end = std::to_string(ends[1]);
    const std::string screen = size + "x24";
    process_ = ::fork();
    if (process_ == 0) {
      // -r: held keys do not repeat. A test on a slow machine may hold a key so long that it would repeat.
      ::execlp("Xvfb", "Xvfb", "-r", "-displayfd", end.c_str(), "-screen", "0", screen.c_str(), "-fbdir",
               folder_.path().c_str(), "-noreset", "-nolisten", "tcp", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string number;
    for (char character = 0; ::read(ends[0], &character, 1) == 1 && character != '\n';) number += character;
    ::close(ends[0]);
    if (process_ < 0 || number.empty()) throw std::runtime_error("Xvfb does not start");
    ::setenv("DISPLAY", (':' + number).c_str(), 1);
  }
  ~VirtualDisplay() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// The pixels of a rectangle, row by row, with four bytes for each pixel.
  std::string pixels(std::size_t left, std::size_t top, std::size_t width, std::size_t height) const {
    // XWD format: a header of big-endian numbers, a colour table with 12 bytes per entry, rows of pixels.
    const std::string screen = read_file(folder_.path() / "Xvfb_screen0");
    const auto field = [&](std::size_t position) {
      std::size_t value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(screen.at(4 * position + i));
      return value;
    };
    const std::size_t begin = field(0) + 12 * field(19);
    const std::size_t row = field(12);
    std::string found;
    for (std::size_t y = top; y < top + height; ++y) found += screen.substr(begin + y * row + 4 * left, 4 * width);
    return found;
  }

 private:
  TemporaryFolder folder_;
  pid_t process_ = -1;
};

/// Runs xdotool, which sends events of mouse and keyboard to the display. Returns its output.
inline std::string xdotool(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "xdotool");
  const Outcome outcome = run({.arguments = arguments, .folder = "/"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

// Position to which drag_slider drags the handle, as a share of the slider's length.
inline constexpr float kPartOfSlider = 0.7F;
// Frames that ImGui needs to process an event.
inline constexpr int kFrames = 4;

// Tolerance of a value that a test sets by dragging a slider: a share of the slider's range, or of the value if the
// slider is logarithmic. It allows for the width of the handle.
inline constexpr double kGrab = 0.2;

class Window : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    // Cheap to compute, because most tests wait for all results.
    put("scene.toml", explore::paint({"accuracy.tolerance=1e-2"}).scene().toml());
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
  /// Sends events, as xdotool() does, and lets the window draw their effects.
  void send(const std::vector<std::string>& events) {
    xdotool(events);
    frames();
  }
  void focus() { send({"windowfocus", "--sync", window_}); }
  void move_to(ImVec2 at) {
    send({"mousemove", "--window", window_, std::to_string(std::lround(at.x)), std::to_string(std::lround(at.y))});
  }
  void click(ImVec2 at) {
    move_to(at);
    send({"mousedown", "1"});
    send({"mouseup", "1"});
  }
  void double_click(ImVec2 at) {
    move_to(at);
    send({"click", "--repeat", "2", "--delay", "20", "1"});
    frames();
  }
  /// The area of a named item in the last frame. Errors: std::out_of_range if the last frame did not draw this item.
  Area area(const std::string& name) const { return app_->control_area(name); }
  void click_control(const std::string& control) { click(area(control).at(0.5F, 0.5F)); }
  void choose(const std::string& list, const std::string& entry) {
    click_control(list);
    click_control(list + ' ' + entry);
    settle();
  }
  void drag_slider(const std::string& key, float to) {
    const Area slider = area(key);
    move_to(slider.at(0.3F, 0.5F));
    send({"mousedown", "1"});
    for (int i = 1; i <= 10; ++i) move_to(slider.at(0.3F + 0.1F * static_cast<float>(i) * (to - 0.3F), 0.5F));
    send({"mouseup", "1"});
    app_->settle();
  }
  void keys(const std::string& combination) {
    xdotool({"windowfocus", "--sync", window_});
    send({"keydown", combination});
    send({"keyup", combination});
  }
  void type(const std::string& text) { send({"type", "--delay", "12", "--", text}); }
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
    send({"keydown", "ctrl"});
    click(area(slider).at(0.1F, 0.5F));
    xdotool({"keyup", "ctrl"});
    app_->settle();
  }
  std::optional<double> number(const std::string& key) const { return session().scene().number(key); }
  std::optional<std::string> word(const std::string& key) const { return session().scene().word(key); }
  std::string pixels(const Area& area) const {
    const auto whole = [](float length) { return static_cast<std::size_t>(std::lround(length)); };
    return display_.pixels(whole(area.min.x), whole(area.min.y), whole(area.width()), whole(area.height()));
  }
  /// True if the background of a field is red, which marks refused text.
  bool is_marked(const std::string& field) {
    frames();
    const ImVec2 at{area(field).max.x - 12.0F, area(field).min.y + 6.0F};
    const std::string pixel = pixels({at, {at.x + 1.0F, at.y + 1.0F}});
    const auto channel = [&](std::size_t byte) { return static_cast<int>(static_cast<unsigned char>(pixel.at(byte))); };
    return channel(2) > 2 * channel(0);
  }

  VirtualDisplay display_;
  std::unique_ptr<App> app_;
  std::string window_;
};

}  // namespace dolp::explore_test
