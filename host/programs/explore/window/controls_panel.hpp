// The left side of the window: the controls of the scene, made from parameter descriptions.
#pragma once

#include "explore/session.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

/// What the controls keep from frame to frame.
struct ControlsState {
  NumberFields fields;
  std::string sky_file;  ///< the scene's sky, which `sky` describes
  std::optional<SkyPair> sky;
};

/// Fills the current ImGui window with the controls of a scene. Areas have the key of their control as name, "vary KEY"
/// for the box that lets a number vary in fits, "field KEY" for a field, "field fit KEY 0" and "1" for the ends of its
/// range in fits, "sky", "sky zenith" and "sky horizon".
void draw_controls(Session& session, ControlsState& state);
/// Draws tolerance and precision, which stand beside their cost.
void draw_accuracy_controls(Session& session, ControlsState& state);

}  // namespace dolp::explore
