#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "explore/files.hpp"

struct GLFWwindow;

namespace dolp::explore {

/// An image that ImGui draws. It may exist only while a Screen exists.
class Texture {
 public:
  Texture() = default;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  ~Texture();

  /// Replaces the image by `count` rows of `count` pixels, the lowest row first; a row begins on the left.
  void set(const std::vector<ImU32>& colours, std::size_t count);
  /// Draws the image with the centres of its corner pixels at `min` and `max`. Cuts off what lies beyond these points.
  void draw(ImDrawList* list, ImVec2 min, ImVec2 max) const;

 private:
  unsigned id_ = 0;  ///< OpenGL's number of the texture; 0 before set()
  std::size_t count_ = 0;
};

class Screen {
 public:
  /// Errors: DeviceError without a display, or if the display cannot show a window.
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  GLFWwindow* window() const { return window_; }
  void follow(const Preferences& wanted);  ///< applies the theme and the text size; call it between two frames
  /// Shows ImGui's frame, unless the window has no area. If `wants_picture` is true, returns the frame as a PNG file.
  std::string show(bool wants_picture) const;

 private:
  struct Library {  // starts GLFW, and ends GLFW in the destructor
    Library();
    ~Library();
  };

  Library library_;
  GLFWwindow* window_;
  float scale_ = 0.0F;  ///< factor for the size of text and controls
};

}  // namespace dolp::explore
