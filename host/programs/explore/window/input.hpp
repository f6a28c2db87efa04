#pragma once

#include <imgui.h>

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>

struct GLFWwindow;

namespace dolp::explore {

/// A rectangle in pixels of the window; y grows downwards.
struct Area {
  ImVec2 min, max;

  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  /// The point at `x` times the width and `y` times the height from the upper left corner.
  ImVec2 at(float x, float y) const { return {min.x + x * width(), min.y + y * height()}; }
};

/// A queue of the events of a window. ImGui reads keys and buttons once per frame, and would miss a key that goes down
/// and up between two frames. So each event gets a frame of ImGui, and the window shows only the last frame.
class Input {
 public:
  /// Occupies GLFW's user pointer of `window`. `on_drop` gets the path of each file that the user drops on the window.
  Input(GLFWwindow* window, std::function<void(const std::string&)> on_drop);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  void begin_frame();  ///< applies the next event, if there is one, and begins a frame of ImGui
  bool has_more() const { return !events_.empty(); }
  int pressed_key() const { return pressed_key_; }  ///< GLFW's number of the key that goes down in this frame
  /// True if there were events since the last call of take_news().
  bool take_news() { return std::exchange(has_news_, false); }
  std::chrono::steady_clock::time_point last_event() const { return last_event_; }
  std::map<std::string, Area>& areas() { return areas_; }  ///< named areas of this frame, by which tests find controls

 private:
  using Clock = std::chrono::steady_clock;
  struct Event {
    std::function<void()> apply;
    bool is_motion;
  };
  static Input& window_input(GLFWwindow* window);
  static void push(GLFWwindow* window, std::function<void()> apply, bool is_motion = false);

  GLFWwindow* window_;
  std::function<void(const std::string&)> on_drop_;
  std::deque<Event> events_;
  bool has_news_ = false;
  Clock::time_point last_event_;
  std::map<std::string, Area> areas_;
  // State of keyboard and mouse after the last event that begin_frame() took from the queue.
  int pressed_key_ = 0;
  bool is_inside_ = false;
  ImVec2 mouse_;
  std::array<bool, 5> buttons_{};
};

/// True in the frame in which the key with GLFW's code `key` goes down. ImGui's own codes depend on its version.
bool is_pressed(int key);

void name_item(const std::string& name);  ///< adds the area of the item drawn last to Input::areas()
void name_area(const std::string& name, const Area& area);

}  // namespace dolp::explore
