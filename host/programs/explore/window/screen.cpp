#include "explore/window/screen.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

constexpr int kWidth = 1440;
constexpr int kHeight = 900;
constexpr int kLeastWidth = 800;  // a smaller window would cut off labels
constexpr int kLeastHeight = 560;

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

int scaled_length(int length, float scale) { return static_cast<int>(std::lround(scale * static_cast<float>(length))); }

/// Opens a window of kWidth by kHeight, times the scale of the display, but not larger than the display.
GLFWwindow* open_window() {
  // OpenGL 3.2 is the oldest version with which ImGui draws more than 65536 vertices at once.
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  int x = 0, y = 0, width = kWidth, height = kHeight;
  float scale = 1.0F;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    glfwGetMonitorContentScale(monitor, &scale, nullptr);
  }
  GLFWwindow* const window =
      glfwCreateWindow(std::min(scaled_length(kWidth, scale), width), std::min(scaled_length(kHeight, scale), height),
                       "dolp explore", nullptr, nullptr);
  if (!window) throw DeviceError("the display cannot show a window with OpenGL 3.2: " + glfw_error());
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
  return window;
}

/// Looks up a function of OpenGL. `dolp` is not linked to OpenGL, so its commands without a window need no OpenGL.
template <class Function>
Function* opengl(const char* name) {
  return reinterpret_cast<Function*>(glfwGetProcAddress(name));
}

std::string picture(int width, int height) {  // the last frame as a PNG file
  constexpr int kChannels = 4;
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(kChannels * width * height));
  opengl<decltype(glReadPixels)>("glReadPixels")(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t alpha = kChannels - 1; alpha < rgba.size(); alpha += kChannels) rgba[alpha] = UINT8_MAX;
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  stbi_flip_vertically_on_write(1);  // the first row of OpenGL is at the bottom
  if (stbi_write_png_to_func(append, &bytes, width, height, kChannels, rgba.data(), kChannels * width) == 0)
    throw IoError("the picture cannot be made");
  return bytes;
}

}  // namespace

Texture::~Texture() {
  if (id_ != 0) opengl<decltype(glDeleteTextures)>("glDeleteTextures")(1, &id_);
}

void Texture::set(const std::vector<ImU32>& colours, std::size_t count) {
  count_ = count;
  if (id_ == 0) opengl<decltype(glGenTextures)>("glGenTextures")(1, &id_);
  opengl<decltype(glBindTexture)>("glBindTexture")(GL_TEXTURE_2D, id_);
  for (const GLenum size : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    opengl<decltype(glTexParameteri)>("glTexParameteri")(GL_TEXTURE_2D, size, GL_NEAREST);
  opengl<decltype(glTexImage2D)>("glTexImage2D")(GL_TEXTURE_2D, 0, GL_RGBA, static_cast<GLsizei>(count),
                                                 static_cast<GLsizei>(count), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                                                 colours.data());
}

void Texture::draw(ImDrawList* list, ImVec2 min, ImVec2 max) const {
  if (count_ == 0) return;
  const float first = 0.5F / static_cast<float>(count_), last = 1.0F - first;
  // ImTextureID is a pointer or a number, depending on the version of ImGui.
  list->AddImage((ImTextureID)(std::intptr_t)id_, min, max, {first, last}, {last, first});
}

Screen::Library::Library() {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY"))
    throw DeviceError("no display for the window: neither DISPLAY nor WAYLAND_DISPLAY is set");
#ifdef GLFW_PLATFORM
  // Without this hint GLFW 3.4 tries Wayland first, and the Wayland library prints an error.
  if (!is_set("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() == GLFW_FALSE) throw DeviceError("no display for the window: " + glfw_error());
}

Screen::Library::~Library() { glfwTerminate(); }

Screen::Screen() : window_(open_window()) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  follow({});
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 150");
}

Screen::~Screen() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Screen::follow(const Preferences& wanted) {
  if (wanted.is_light != is_light()) set_theme(wanted.is_light);
  float display = 1.0F;
  glfwGetWindowContentScale(window_, &display, nullptr);
  const float wanted_scale = display * static_cast<float>(wanted.zoom());
  if (wanted_scale == scale_) return;
  const bool is_first = std::exchange(scale_, wanted_scale) == 0.0F;
  ImGui::GetStyle() = ImGuiStyle();
  set_theme(wanted.is_light);
  ImGui::GetStyle().ScaleAllSizes(scale_);
  ImGui::GetIO().Fonts->Clear();
  load_font(kFontPixels * scale_);
  if (!is_first) ImGui_ImplOpenGL3_DestroyDeviceObjects();  // the next frame creates them with the new font
  glfwSetWindowSizeLimits(window_, scaled_length(kLeastWidth, scale_), scaled_length(kLeastHeight, scale_),
                          GLFW_DONT_CARE, GLFW_DONT_CARE);
}

std::string Screen::show(bool wants_picture) const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (width == 0 || height == 0) return {};
  const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(kBackground);
  opengl<decltype(glViewport)>("glViewport")(0, 0, width, height);
  opengl<decltype(glClearColor)>("glClearColor")(ground.x, ground.y, ground.z, 1.0F);
  opengl<decltype(glClear)>("glClear")(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  std::string png = wants_picture ? picture(width, height) : "";
  glfwSwapBuffers(window_);
  return png;
}

}  // namespace dolp::explore
