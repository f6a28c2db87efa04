#include "explore/window/input.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui_internal.h>

#include <algorithm>

namespace dolp::explore {

Input& Input::of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

void Input::push(GLFWwindow* window, std::function<void()> apply, bool is_motion) {
  Input& input = of(window);
  input.has_news_ = true;
  input.last_event_ = Clock::now();
  if (is_motion && input.has_more() && input.events_.back().is_motion) input.events_.pop_back();
  input.events_.push_back({std::move(apply), is_motion});
}

Input::Input(GLFWwindow* window, std::function<void(const std::string&)> on_drop) : on_drop_(std::move(on_drop)) {
  glfwSetWindowUserPointer(window, this);
  double across = 0.0, down = 0.0;
  glfwGetCursorPos(window, &across, &down);
  mouse_ = {static_cast<float>(across), static_cast<float>(down)};
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    push(w, [=] { ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, modifiers); });
  });
  glfwSetCharCallback(window,
                      [](GLFWwindow* w, unsigned letter) { push(w, [=] { ImGui_ImplGlfw_CharCallback(w, letter); }); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    push(w, [=] { of(w).buttons_.at(static_cast<std::size_t>(std::min(button, 4))) = action == GLFW_PRESS; });
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    push(
        w,
        [=] {
          of(w).mouse_ = {static_cast<float>(x), static_cast<float>(y)};
        },
        true);
  });
  glfwSetScrollCallback(
      window, [](GLFWwindow* w, double x, double y) { push(w, [=] { ImGui_ImplGlfw_ScrollCallback(w, x, y); }); });
  glfwSetCursorEnterCallback(
      window, [](GLFWwindow* w, int entered) { push(w, [=] { ImGui_ImplGlfw_CursorEnterCallback(w, entered); }); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    push(w, [=] {
      ImGui_ImplGlfw_WindowFocusCallback(w, focused);
      if (!focused && ImGui::GetIO().WantTextInput) ImGui::ClearActiveID();  // ends the typing in a field
    });
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) push(w, [w, path = std::string(paths[i])] { of(w).on_drop_(path); });
  });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).has_news_ = true; });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).has_news_ = true; });
}

void Input::begin_frame() {
  if (has_more()) {
    events_.front().apply();
    events_.pop_front();
  }
  ImGui_ImplGlfw_NewFrame();
  // ImGui's backend takes the mouse as it is by now, some events later. It tells whether the mouse is in the window.
  ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMousePosValid(&io.MousePos)) io.MousePos = mouse_;
  std::ranges::copy(buttons_, io.MouseDown);
  ImGui::NewFrame();
}

}  // namespace dolp::explore
