// The window's content: menus, panels, dialogs and shortcuts.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "explore/window/actions.hpp"
#include "explore/window/controls_panel.hpp"
#include "explore/window/path_dialog.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

class Ui {
 public:
  /// `catch_up` is called between controls and plots, so that these show what the controls have changed. Session and
  /// actions must outlive this.
  Ui(Session& session, Actions& actions, std::function<void()> catch_up);

  /// Draws everything, between ImGui's NewFrame and Render.
  void draw();

  /// The last drawn area of a control, of the tab "panel NAME", of "snapshot NUMBER", of "menu NAME" and its entries,
  /// of "recent PATH" or of an entry of the list of files. Errors: std::out_of_range when it was not drawn.
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
    std::function<bool()> is_enabled = {};  ///< in its menu; none: always

    std::string shortcut() const;
  };

  /// A path beside the scene's file, or in the folder that was chosen last for it.
  std::string suggested(const std::string& ending) const;
  void remember_folder(const std::string& path);
  void ask_what_to_open();
  void add_file_commands();
  void add_view_commands();
  void draw_menus();
  void draw_menu(const char* menu);
  void run_shortcuts();
  void copy_command();
  /// The area of a menu or its entry that is drawn next.
  void remember_next(const std::string& name, const char* text);
  void draw_recent();
  void draw_help();
  void draw_view_controls();
  void draw_map_axes(View& view, bool& is_changed);
  void draw_fit();
  void draw_pins();
  void draw_snapshots();
  void draw_message();
  void draw_readout();
  void draw_plots(ImVec2 size);
  /// One thing at a time, where two beside each other would be too small.
  void draw_one_page();
  bool draw_tab(const char* name, bool is_shown);
  void draw_panel_tabs();
  void draw_panel(ImVec2 size);
  void draw_price();
  void draw_bottom();

  Session& session_;
  Actions& actions_;
  std::pair<std::string, std::filesystem::path> saved_;  ///< a scene's file, and the last folder it was saved to
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
  bool is_narrow_ = false;
  std::string page_ = "curve";  ///< of a narrow window; empty: the panel
  bool shows_help_ = false;
};

}  // namespace dolp::explore
