// Panel of the plan: effects computed and left out, with reasons and cost.
#pragma once

#include "explore/background_task.hpp"
#include "explore/session.hpp"
#include "explore/window/controls_panel.hpp"

namespace dolp::explore {

/// The table of effects, in the current ImGui window.
void draw_effects(const Session& session);

/// Tolerance, its cost, and the true error on request; returns true where the user asked for it.
bool draw_price(Session& session, ControlsPanel& controls, BackgroundTask& true_error);

/// A bar with a button to cancel, or the result of a task.
void draw_task(const char* name, BackgroundTask& task);

}  // namespace dolp::explore
