#include "explore/window/input.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <limits>

namespace dolp::explore {
namespace {

#if IMGUI_VERSION_NUM < 18700
// Empty: before version 1.87, ImGui's GLFW backend derives Ctrl, Shift and Alt from the key events that it gets.
void set_modifiers(int, int, int) {}

void set_mouse(ImVec2 position, const std::array<bool, 5>& buttons) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = position;
  std::ranges::copy(buttons, io.MouseDown);
}
#else
// Sets Ctrl, Shift and Alt to their state when the event happened. ImGui's GLFW backend would read their present state.
void set_modifiers(int key, int action, int modifiers) {
  // On X11 `modifiers` does not contain the key of this event yet.
  if (key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER) {
    const int modifier = 1 << (key - GLFW_KEY_LEFT_SHIFT) % 4;
    modifiers = action == GLFW_RELEASE ? modifiers & ~modifier : modifiers | modifier;
  }
  ImGuiIO& io = ImGui::GetIO();
  io.AddKeyEvent(ImGuiMod_Ctrl, (modifiers & GLFW_MOD_CONTROL) != 0);
  io.AddKeyEvent(ImGuiMod_Shift, (modifiers & GLFW_MOD_SHIFT) != 0);
  io.AddKeyEvent(ImGuiMod_Alt, (modifiers & GLFW_MOD_ALT) != 0);
}

void set_mouse(ImVec2 position, const std::array<bool, 5>& buttons) {
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigInputTrickleEventQueue = false;  // handles all these events in one frame
  io.AddMousePosEvent(position.x, position.y);
  for (int i = 0; i < 5; ++i) io.AddMouseButtonEvent(i, buttons[static_cast<std::size_t>(i)]);
}
#endif

}  // namespace

Input& Input::window_input(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

void Input::push(GLFWwindow* window, std::function<void()> apply, bool is_motion) {
  Input& input = window_input(window);
  input.has_news_ = true;
  input.last_event_ = Clock::now();
  if (is_motion && input.has_more() && input.events_.back().is_motion) input.events_.pop_back();
  input.events_.push_back({std::move(apply), is_motion});
}

Input::Input(GLFWwindow* window, std::function<void(const std::string&)> on_drop)
    : window_(window), on_drop_(std::move(on_drop)) {
  glfwSetWindowUserPointer(window, this);
  ImGui::GetIO().UserData = this;
  double across = 0.0, down = 0.0;
  glfwGetCursorPos(window, &across, &down);
  mouse_ = {static_cast<float>(across), static_cast<float>(down)};
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    push(w, [=] {
      ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, modifiers);
      set_modifiers(key, action, modifiers);
      if (action == GLFW_PRESS) window_input(w).pressed_key_ = key;
    });
  });
  glfwSetCharCallback(window,
                      [](GLFWwindow* w, unsigned sign) { push(w, [=] { ImGui_ImplGlfw_CharCallback(w, sign); }); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    push(w, [=] { window_input(w).buttons_.at(static_cast<std::size_t>(std::min(button, 4))) = action == GLFW_PRESS; });
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    const ImVec2 at{static_cast<float>(x), static_cast<float>(y)};
    push(
        w, [=] { window_input(w).mouse_ = at; }, true);
  });
  glfwSetScrollCallback(
      window, [](GLFWwindow* w, double x, double y) { push(w, [=] { ImGui_ImplGlfw_ScrollCallback(w, x, y); }); });
  glfwSetCursorEnterCallback(
      window, [](GLFWwindow* w, int entered) { push(w, [=] { window_input(w).is_inside_ = entered != 0; }); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    push(w, [=] {
      ImGui_ImplGlfw_WindowFocusCallback(w, focused);
      if (!focused && ImGui::GetIO().WantTextInput) ImGui::ClearActiveID();  // ends typing in a field
    });
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) push(w, [w, path = std::string(paths[i])] { window_input(w).on_drop_(path); });
  });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { window_input(w).has_news_ = true; });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { window_input(w).has_news_ = true; });
}

void Input::begin_frame() {
  pressed_key_ = GLFW_KEY_UNKNOWN;
  areas_.clear();
  if (has_more()) {
    events_.front().apply();
    events_.pop_front();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // Sets the mouse to its position at this event. A position outside the window counts only if the window has the
  // focus, because then the user may be dragging beyond the edge.
  constexpr float kNowhere = std::numeric_limits<float>::lowest();
  const bool is_seen = is_inside_ || glfwGetWindowAttrib(window_, GLFW_FOCUSED) != 0;
  set_mouse(is_seen ? mouse_ : ImVec2(kNowhere, kNowhere), buttons_);
  ImGui::NewFrame();
}

bool is_pressed(int key) { return static_cast<const Input*>(ImGui::GetIO().UserData)->pressed_key() == key; }
void name_item(const std::string& name) { name_area(name, {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()}); }

void name_area(const std::string& name, const Area& area) {
  static_cast<Input*>(ImGui::GetIO().UserData)->areas()[name] = area;
}

}  // namespace dolp::explore
