#pragma once

#include <string>

#include "explore/window/presenter.hpp"

namespace dolp::explore {

/// Writes a picture as PNG, whole or not at all. Errors: IoError.
void write_png(const Picture& picture, const std::string& path);

}  // namespace dolp::explore
