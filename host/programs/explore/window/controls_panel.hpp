// The left side of the window: the controls of the scene, made from parameter descriptions.
#pragma once

#include "explore/session.hpp"
#include "explore/window/widgets.hpp"

namespace dolp::explore {

/// Areas have the key of their control as name, "vary KEY" for the box that lets a number vary in fits, "field KEY" for
/// a field, "field fit KEY 0" and "1" for the ends of its range in fits, "sky", "sky zenith" and "sky horizon".
class ControlsPanel {
 public:
  explicit ControlsPanel(Session& session) : session_(session) {}
  /// Fills the current ImGui window.
  void draw();
  /// Tolerance and precision, which stand beside their cost.
  void draw_accuracy();

 private:
  /// A slider with a field beside it.
  struct Slider {
    std::string id;
    std::string label;
    std::string note;
    std::string reset_key;  ///< Ctrl-click resets it
    Scale scale;
    std::function<Setting(double position)> moved;
    std::function<Setting(const std::string& text)> typed;
  };
  void draw_slider(const Slider& slider, double value, const Parameter* parameter = nullptr);
  void draw_choice(const Choice& choice, std::size_t word);
  void draw_choices(const std::string& table);
  void draw_fit_range(const Parameter& parameter, double value);
  void draw_parameter(const Parameter& parameter, double value);
  void draw_table(const std::string& table);
  void draw_material();
  void draw_source_kind();
  void draw_effect_box(const std::string& table);
  void draw_spectrum();
  void draw_sky();
  void draw_sky_list();
  void draw_sky_temperature(const std::string& name, double SkyPair::*part);
  /// Draws fields, and removes the message about a text when the text is gone.
  void draw_fields(const std::string& id, const std::function<void()>& draw);
  void draw_ends(const std::string& id, const std::array<double, 2>& ends, const NumberFields::ApplyEnds& apply);
  /// Changes the scene; returns why it is refused, or nothing.
  std::string set(const Setting& change);

  Session& session_;
  NumberFields fields_;
  std::string sky_file_;  ///< the scene's sky, which sky_ describes
  std::optional<SkyPair> sky_;
};

}  // namespace dolp::explore
