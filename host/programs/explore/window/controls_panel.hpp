// The left side of the window: everything of the scene that can be moved, made from parameter descriptions.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "explore/parameters.hpp"
#include "explore/session.hpp"
#include "explore/window/fields.hpp"
#include "explore/window/plot.hpp"

namespace dolp::explore {

/// The text of a row, in a column of fixed width; the control follows beside it.
void row_label(const std::string& text);

class ControlsPanel {
 public:
  /// Fills the current ImGui window.
  void draw(Session& session);
  /// Tolerance and precision, which stand beside what they cost; to be called after `draw`.
  void draw_accuracy(Session& session);

  /// Sliders, lists and boxes by their scene key, "vary KEY" of the box that lets it vary, "field KEY" of a number's
  /// field, "field fit KEY 0" and "1" of its range in fits, "sky", "sky zenith" and "sky horizon", for tests that move
  /// the mouse there.
  const std::map<std::string, Area>& areas() const { return areas_; }

 private:
  void remember_area(const std::string& key);
  void draw_choice(Session& session, const Choice& choice, std::size_t word);
  void draw_choices(Session& session, const std::string& table);
  void draw_fit_box(Session& session, const Parameter& parameter);
  void draw_fit_range(Session& session, const Parameter& parameter, double value);
  void draw_parameter(Session& session, const Parameter& parameter, double value);
  void draw_table(Session& session, const std::string& table);
  void draw_spectrum(Session& session);
  void draw_sky(Session& session);
  void draw_sky_list(Session& session);
  void draw_sky_temperature(Session& session, const std::string& name, double SkyPair::*part);
  void draw_field(Session& session, const std::string& id, double value,
                  const std::function<Setting(const std::string& text)>& change);
  void draw_taken_field(Session& session, const std::string& id, double value, const NumberFields::Take& take);
  /// Fields "ID 0" and "ID 1", whose texts are taken together, so that one that was refused goes with the other.
  void draw_ends(Session& session, const std::string& id, const std::array<double, 2>& ends,
                 const std::function<std::string(const std::string& low, const std::string& high)>& take);
  void show_reason(const std::string& id) const;

  NumberFields fields_;
  std::string sky_file_;  ///< of the scene, whose sky is known
  std::optional<SkyPair> sky_;
  std::map<std::string, Area> areas_;
};

}  // namespace dolp::explore
