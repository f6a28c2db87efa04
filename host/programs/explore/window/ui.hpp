// The window's content: menus, panels, dialogs and shortcuts.
#pragma once

#include "explore/window/actions.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {

/// Besides the controls and the files of a dialog these areas have names: "panel NAME" of a tab, "snapshot NUMBER",
/// "menu NAME", the text of a menu's entry, "recent PATH" and "cancel NAME" of a task.
class Ui {
 public:
  /// The window calls `catch_up` between controls and plots, so that these show what the controls have changed. Session
  /// and actions must outlive this.
  Ui(Session& session, Actions& actions, std::function<void()> catch_up);

  /// Draws everything, between ImGui's NewFrame and Render.
  void draw();

  const CurveView& curves() const { return curve_view_; }
  const MapView& map() const { return map_view_; }

 private:
  /// An entry of a menu, or a line of text.
  struct Command {
    const char* menu;
    const char* text;
    std::string shortcut;  ///< "Ctrl+KEY" or "Ctrl+Shift+KEY"; empty: none
    std::function<void()> run;
    std::function<bool()> is_checked = {};  ///< empty: not a switch
    std::function<bool()> is_enabled = {};  ///< empty: always

    bool is_pressed(bool is_shift) const;
  };

  // In commands.cpp.
  /// A path beside the scene's file, or in the folder that was chosen last for it.
  std::string suggested_path(const std::string& ending) const;
  /// Runs of commands that ask for a path, whose suggestion has an `ending`, or save a file there.
  std::function<void()> ask_for_path(const char* title, const char* ending, const std::vector<std::string>& suffixes,
                                     const std::function<void(const std::string&)>& accept);
  std::function<void()> save_as(const char* title, const char* ending, const char* suffix,
                                const std::function<void(const std::string&)>& save);
  std::vector<Command> file_commands();
  std::vector<Command> view_commands();
  std::vector<Command> scene_commands();
  void ask_what_to_open();
  void copy_command();
  void draw_menus();
  void draw_recent();
  void run_shortcuts();
  void draw_help();

  /// Everything right of the controls.
  void draw_right(float window_height);
  void draw_view_controls();
  void draw_map_axes(View& view);
  void draw_fit();
  void draw_pins();
  void draw_snapshots();
  void draw_message();
  void draw_readout();
  void draw_plots(ImVec2 size);
  /// One view at a time, where there is no room for two.
  void draw_one_page();
  bool draw_tab(const std::string& name, bool is_shown);
  void draw_panel_tabs();
  void draw_panel(ImVec2 size);
  void draw_accuracy();
  void draw_bottom();

  Session& session_;
  Actions& actions_;
  std::pair<std::string, std::filesystem::path> saved_;  ///< a scene's file, and the last folder it was saved to
  std::function<void()> catch_up_;
  std::vector<Command> commands_;
  ControlsState controls_;
  NumberFields fields_;
  MapView map_view_;
  SweepViews sweep_views_;
  ScatteringView scattering_view_;
  ShapeView shape_view_;
  CurveView curve_view_;
  PathDialog dialog_;
  bool is_narrow_ = false;
  std::string page_ = "curve";  ///< shown in a narrow window; empty: the panel
  bool shows_help_ = false;
};

}  // namespace dolp::explore
