// The curves over theta.
#pragma once

#include <imgui.h>

#include "explore/session.hpp"
#include "explore/window/area.hpp"

namespace dolp::explore {

/// Fills `size` of the current ImGui window with the current curve, the overlaid one, pins and measured points; a click
/// or drag moves the cursor. Returns the area of the curves.
Area draw_curve_view(Session& session, ImVec2 size);

}  // namespace dolp::explore
