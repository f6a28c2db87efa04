#pragma once

#include "explore/session.hpp"

namespace dolp::explore {

/// Added to a curve's name: ", the scene before" if it shows an earlier scene, ", coarse" if its points are few, or "".
const char* remark(const Session& session, const Curve& curve);
std::string curve_name(const Session& session);  ///< describes the surface of the curve on display
std::string overlay_name(const Session& session);
/// The name of a pin: as typed by the user, otherwise its material and how it differs from the current scene.
std::string pin_name(const Session& session, const Pin& pin);
std::string zenith_label(const Scene& scene);  ///< label of the axis of the curve
/// Name of the line of Session::sweep(): the zenith at which it is computed.
std::string sweep_name(const Session& session);
Scale sweep_values(const Session& session);      ///< range of the values in the plot of Session::sweep()
const char* stale_text(bool is_stale);           ///< if true, ", the scene before"; otherwise ""
std::string headline(const Session& session);    ///< DOLP at the cursor, then peak_text()
std::string peak_text(const Session& session);   ///< the maximum of the trusted points, its error and position
std::string cause_text(const Session& session);  ///< the parts of Q/I at the cursor: emission, source, surroundings
std::string no_residuals_text(const Session& session, const Scale& theta);  ///< why the plot shows no residuals, or ""
std::string cursor_text(const Session& session);
std::string view_refusal(const Session& session, Panel panel);  ///< why a view cannot show this scene; "" if it can
std::string quantity_refusal(const Scene& scene,
                             Plotted quantity);  ///< why a quantity tells nothing here; "" if it does
/// Q/I at the cursor, first with all effects, then without `effect`: "-14.36 → -59.59 %". Empty if not known.
std::string without_text(const Session& session, const std::string& effect);
/// The numbers of without_text() in a sentence, and the numbers at the maximum in a second one. Empty if not known.
std::string without_words(const Session& session, const std::string& effect);
std::vector<std::string> cost_lines(const Session& session);   ///< time, evaluations and error of the finished curve
std::vector<std::string> about_lines(const Session& session);  ///< version, commit, and the device of the curve
/// The title of the scene as it is: what was typed as its title, otherwise its title as opened, with what has changed.
std::string figure_title(const SceneEdits& edits);
std::string table_command(const SceneEdits& edits);  ///< a shell command that writes the scene's table
/// JSON for tools/plot_view.py: the visible curves with the axes `x` and `y`, the measured points, and the map or the
/// curve over another number if the window shows it. Values have the units of the labels. A value is null where the
/// model gives none.
std::string plot_json(const Session& session, const Scale& x, const Scale& y);

}  // namespace dolp::explore
