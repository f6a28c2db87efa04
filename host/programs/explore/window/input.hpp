// Events of mouse and keyboard, which ImGui gets one by one.
#pragma once

#include <imgui.h>

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <utility>

struct GLFWwindow;

namespace dolp::explore {

/// Queues the events of a window. ImGui looks at the state of keys and buttons once a frame, and misses those that go
/// down and up between two: it has a frame for each event, not all of which are shown.
class Input {
 public:
  /// Becomes the window's user pointer. `on_drop` gets the path of a file that is dropped on the window.
  Input(GLFWwindow* window, std::function<void(const std::string&)> on_drop);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Begins a frame of ImGui with the next event, if there is one.
  void begin_frame();
  bool has_more() const { return !events_.empty(); }
  /// The key of GLFW that goes down in this frame.
  int pressed_key() const { return pressed_key_; }
  /// True where there was anything to show since the last call.
  bool take_news() { return std::exchange(has_news_, false); }
  /// Time since the last event.
  double rest_s() const { return std::chrono::duration<double>(Clock::now() - last_event_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Event {
    std::function<void()> apply;
    bool is_motion;
  };
  static Input& of(GLFWwindow* window);
  static void push(GLFWwindow* window, std::function<void()> apply, bool is_motion = false);

  GLFWwindow* window_;
  std::function<void(const std::string&)> on_drop_;
  std::deque<Event> events_;
  bool has_news_ = false;
  Clock::time_point last_event_;
  // As the events so far say.
  int pressed_key_ = 0;
  bool is_inside_ = false;
  ImVec2 mouse_;
  std::array<bool, 5> buttons_{};
};

/// True in the frame in which this key of GLFW goes down. ImGui's own codes of keys depend on its version: up to 1.86
/// they are GLFW's, and ImGui::IsKeyPressed(ImGuiKey_Escape) asks for another key.
bool is_pressed(int key);

}  // namespace dolp::explore
