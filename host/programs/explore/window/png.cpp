#include "explore/window/png.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>
#include <dolp/errors.hpp>

#include "base/atomic_file.hpp"

namespace dolp::explore {

void write_png(const Picture& picture, const std::string& path) {
  constexpr int kChannels = 4;
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  const int width = static_cast<int>(picture.width);
  const int height = static_cast<int>(picture.height);
  if (stbi_write_png_to_func(append, &bytes, width, height, kChannels, picture.rgba.data(), kChannels * width) == 0) {
    throw IoError(path + ": the picture cannot be made");
  }
  write_text_atomically(path, bytes);
}

}  // namespace dolp::explore
