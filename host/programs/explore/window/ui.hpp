// The window's content: menus, panels, dialogs and shortcuts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "explore/background_task.hpp"
#include "explore/session.hpp"
#include "explore/window/controls_panel.hpp"
#include "explore/window/map_view.hpp"

namespace dolp::explore {

/// Actions of the window beyond its own state; each takes the path of a file.
struct Actions {
  std::function<void(const std::string&)> save_scene;
  std::function<void(const std::string&)> export_table;
  std::function<void(const std::string&)> save_curve;
  std::function<void(const std::string&)> save_picture;
  std::function<void(const std::string&)> load_measured;
  std::function<void()> find_true_error;
  std::function<void()> fit;
  std::function<void()> quit;
};

class Ui {
 public:
  /// `name` begins the file names that dialogs suggest. All must outlive this.
  Ui(Session& session, BackgroundTask& table_export, BackgroundTask& true_error, BackgroundTask& fit, Actions actions,
     const std::string& name);

  /// Draws everything, between ImGui's NewFrame and Render.
  void draw();

  /// A key went down with Ctrl; its command runs with the next `draw`. Between two frames a key may come and go, which
  /// ImGui does not see.
  void press(int key) { pressed_.push_back(key); }

  const ControlsPanel& controls() const { return controls_; }
  /// The last drawn area of the curves.
  const Area& plot() const { return plot_; }

 private:
  /// A menu entry with its shortcut: Ctrl and a key.
  struct Command {
    const char* menu;
    const char* text;
    int key;  ///< of GLFW
    const char* shortcut;
    std::function<void()> run;
    std::function<bool()> is_checked;  ///< none: not a switch
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
  void ask_path(const std::string& title, const std::string& path, bool must_exist,
                std::function<void(const std::string&)> accept);
  void draw_menus();
  void draw_menu(const char* menu);
  void run_shortcuts();
  void draw_path_dialog();
  void draw_help();
  void draw_view_controls();
  void draw_fit();
  void draw_pins();
  void draw_readout();
  void draw_plots(ImVec2 size);
  void draw_price();
  void show_quantity(Plotted quantity);

  Session& session_;
  BackgroundTask& table_export_;
  BackgroundTask& true_error_;
  BackgroundTask& fit_;
  Actions actions_;
  std::vector<Command> commands_;
  ControlsPanel controls_;
  MapView map_view_;
  Area plot_;
  std::vector<int> pressed_;
  PathDialog dialog_;
  bool shows_help_ = false;
  std::string true_error_key_;  ///< of the curve whose true error is asked for or known
};

}  // namespace dolp::explore
