// Texts about a session (names, values, commands), and its plots as JSON.
#pragma once

#include "explore/session.hpp"

namespace dolp::explore {

// ---- Names of curves. Each ends with the remark on the curve.
/// ", the scene before" for a curve of an earlier scene, ", coarse" for a coarse curve; otherwise empty.
const char* remark(const Session& session, const Curve& curve);
/// Describes the surface of the curve on display.
std::string curve_name(const Session& session);
std::string overlay_name(const Session& session);
/// The typed name of a pin, or its material with the words that distinguish it from the curve on display.
std::string pin_name(const Session& session, const Pin& pin);
/// ", the scene before" if values are outdated; otherwise empty.
const char* stale_text(bool is_stale);

// ---- Lines below the plots.
/// The position of the curve's maximum of polarisation, and its uncertainty.
std::string peak_text(const Session& session);
/// The cause of the polarisation at the maximum: the parts of Q/I from emission, source and surroundings, which add up.
std::string cause_text(const Session& session);
/// The reason why there are no residuals in a range of zeniths; empty if there are some.
std::string no_residuals_text(const Session& session, const Scale& theta);
/// The values under the cursor.
std::string cursor_text(const Session& session);
/// Q/I at the maximum with all effects and without one, in percent: "-14.36 → -59.59 %"; empty if unknown.
std::string without_text(const Session& session, const std::string& effect);
/// A sentence with Q/I with and without an effect; empty also if the model fails without the effect.
std::string without_words(const Session& session, const std::string& effect);
/// The cost of the finished curve, in three lines: time, work, error.
std::vector<std::string> cost_lines(const Session& session);

// ---- For other programs.
/// The command that writes the table of a scene, for a shell.
std::string table_command(const SceneEdits& edits);
/// The text of host/tools/plot_view.py.
extern const char* const kPlotScript;
/// The visible curves with the axes `x` and `y`, the measured points, and the map if it is shown, as JSON for the
/// script.
/// Units: as in the labels. Values that the model does not give are null.
std::string plot_json(const Session& session, const Scale& x, const Scale& y);

}  // namespace dolp::explore
