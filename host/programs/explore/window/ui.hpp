// The window's content: menus, panels, dialogs and shortcuts.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "explore/window/actions.hpp"
#include "explore/window/controls_panel.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

class Ui {
 public:
  /// `name` begins the file names that dialogs suggest; `catch_up` is called between controls and plots, so that these
  /// show what the controls have changed. Session and actions must outlive this.
  Ui(Session& session, Actions& actions, const std::string& name, std::function<void()> catch_up);

  /// Draws everything, between ImGui's NewFrame and Render.
  void draw();

  /// The last drawn area of a control, or of the tab "panel NAME". Errors: std::out_of_range when it was not drawn.
  Area area(const std::string& name) const;
  const CurveView& curves() const { return curve_view_; }
  const MapView& map() const { return map_view_; }

 private:
  /// A menu entry with its shortcut: Ctrl, Shift or not, and a key.
  struct Command {
    const char* menu;
    const char* text;
    char key;  ///< 0: none
    std::function<void()> run;
    std::function<bool()> is_checked = {};  ///< none: not a switch
    bool has_shift = false;

    std::string shortcut() const { return key == 0 ? "" : std::string(has_shift ? "Ctrl+Shift+" : "Ctrl+") + key; }
  };
  /// A dialog that asks for a path.
  struct PathDialog {
    std::string title;
    std::string path;
    bool must_exist = false;
    std::function<void(const std::string&)> accept;
    bool is_opening = false;
  };

  void add_file_commands(const std::string& name);
  void add_view_commands();
  void draw_menus();
  void draw_menu(const char* menu);
  void run_shortcuts();
  void copy_command();
  void draw_path_dialog();
  void draw_help();
  void draw_view_controls();
  void draw_map_axes(View& view, bool& is_changed);
  void draw_fit();
  void draw_pins();
  void draw_readout();
  void draw_plots(ImVec2 size);
  void draw_panels(ImVec2 size);
  void draw_price();

  Session& session_;
  Actions& actions_;
  std::function<void()> catch_up_;
  std::vector<Command> commands_;
  ControlsPanel controls_;
  NumberFields fields_;
  MapView map_view_;
  ScatteringView scattering_view_;
  ShapeView shape_view_;
  std::map<std::string, Area> areas_;
  CurveView curve_view_;
  PathDialog dialog_;
  bool shows_help_ = false;
};

}  // namespace dolp::explore
