#include "explore/window/ui.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "explore/readout.hpp"
#include "explore/window/colours.hpp"
#include "explore/window/curve_view.hpp"
#include "explore/window/plan_panel.hpp"
#include "explore/window/text.hpp"

namespace dolp::explore {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoBackground;
constexpr const char* kDialog = "###path";

void coloured_text(ImU32 colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(shown(text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

}  // namespace

Ui::Ui(Session& session, BackgroundTask& table_export, BackgroundTask& true_error, BackgroundTask& fit, Actions actions,
       const std::string& name)
    : session_(session), table_export_(table_export), true_error_(true_error), fit_(fit), actions_(std::move(actions)) {
  add_file_commands(name);
  add_view_commands();
}

void Ui::add_file_commands(const std::string& name) {
  const auto ask = [this](const char* title, std::string path, bool must_exist,
                          const std::function<void(const std::string&)>& accept) {
    return [this, title, path = std::move(path), must_exist, &accept] { ask_path(title, path, must_exist, accept); };
  };
  commands_ = {
      {"File",
       "Save the scene",
       GLFW_KEY_S,
       "Ctrl+S",
       ask("Save the scene as TOML", name + "_scene.toml", false, actions_.save_scene),
       {}},
      {"File",
       "Export the table",
       GLFW_KEY_T,
       "Ctrl+T",
       ask("Compute the table of the scene's grid: .nc, .csv, .npy", name + "_table.nc", false, actions_.export_table),
       {}},
      {"File",
       "Save the curve as CSV",
       GLFW_KEY_E,
       "Ctrl+E",
       ask("Save the curve as CSV", name + "_curve.csv", false, actions_.save_curve),
       {}},
      {"File",
       "Save a picture",
       GLFW_KEY_I,
       "Ctrl+I",
       ask("Save a picture of the window as PNG", name + "_window.png", false, actions_.save_picture),
       {}},
      {"File",
       "Load measured points",
       GLFW_KEY_O,
       "Ctrl+O",
       ask("Load measured points: CSV with theta_deg, dolp", "measured.csv", true, actions_.load_measured),
       {}},
      {"File", "Remove measured points", 0, "", [this] { session_.clear_measured(); }, {}},
      {"File", "Quit", GLFW_KEY_Q, "Ctrl+Q", [this] { actions_.quit(); }, {}},
  };
}

void Ui::add_view_commands() {
  const auto toggle = [this](bool View::*flag) {
    return [this, flag] {
      View view = session_.view();
      view.*flag = !(view.*flag);
      session_.set_view(view);
    };
  };
  const auto is_on = [this](bool View::*flag) { return [this, flag] { return session_.view().*flag; }; };
  const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
  add({"View", "Logarithmic axis", GLFW_KEY_L, "Ctrl+L", toggle(&View::is_log), is_on(&View::is_log)});
  add({"View", "Overlay the other slope distribution", GLFW_KEY_D, "Ctrl+D", toggle(&View::has_overlay),
       is_on(&View::has_overlay)});
  add({"View", "Keep all effects", GLFW_KEY_G, "Ctrl+G", toggle(&View::keeps_all), is_on(&View::keeps_all)});
  add({"Scene", "Pin the curve", GLFW_KEY_P, "Ctrl+P", [this] { session_.pin(); }, {}});
  add({"Scene",
       "True error of the curve",
       GLFW_KEY_K,
       "Ctrl+K",
       [this] {
         if (!session_.curve().is_finished()) return;
         true_error_key_ = session_.curve().key();
         actions_.find_true_error();
       },
       {}});
  add({"Scene", "Fit to the measured points", GLFW_KEY_F, "Ctrl+F", [this] { actions_.fit(); }, {}});
  add({"Scene", "Take all changes back", GLFW_KEY_R, "Ctrl+R", [this] { session_.reset_all(); }, {}});
  add({"Help", "Shortcuts and hints", GLFW_KEY_H, "Ctrl+H", [this] { shows_help_ = true; }, {}});
}

void Ui::ask_path(const std::string& title, const std::string& path, bool must_exist,
                  std::function<void(const std::string&)> accept) {
  dialog_ = {title, path, must_exist, std::move(accept), true};
}

void Ui::run_shortcuts() {
  const std::vector<int> pressed = std::exchange(pressed_, {});
  if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId)) return;
  for (const int key : pressed) {
    for (const Command& command : commands_) {
      if (command.key == key) command.run();
    }
  }
}

void Ui::draw_menu(const char* menu) {
  if (!ImGui::BeginMenu(menu)) return;
  for (const Command& command : commands_) {
    if (std::string_view(command.menu) != menu) continue;
    const bool is_checked = command.is_checked && command.is_checked();
    if (ImGui::MenuItem(command.text, command.shortcut, is_checked)) command.run();
  }
  ImGui::EndMenu();
}

void Ui::draw_menus() {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const char* menu : {"File", "View", "Scene", "Help"}) draw_menu(menu);
  ImGui::TextDisabled("|");
  ImGui::TextUnformatted(shown(session_.scene().title()).c_str());
  if (session_.edits().is_changed()) ImGui::TextDisabled("(changed)");
  ImGui::EndMainMenuBar();
}

void Ui::draw_path_dialog() {
  if (dialog_.is_opening) ImGui::OpenPopup(kDialog);
  ImGui::SetNextWindowSize({32.0F * ImGui::GetFontSize(), 0.0F});
  if (!ImGui::BeginPopupModal((dialog_.title + kDialog).c_str(), nullptr, ImGuiWindowFlags_NoResize)) return;
  if (dialog_.is_opening) ImGui::SetKeyboardFocusHere();
  dialog_.is_opening = false;
  ImGui::SetNextItemWidth(-1.0F);
  bool is_accepted = ImGui::InputText("##path", &dialog_.path, ImGuiInputTextFlags_EnterReturnsTrue);
  std::error_code unknown;
  const bool exists = std::filesystem::exists(dialog_.path, unknown);
  const char* remark = dialog_.must_exist ? (exists ? " " : "There is no such file.")
                                          : (exists ? "This file exists and will be replaced." : " ");
  ImGui::TextUnformatted(remark);
  is_accepted |= ImGui::Button("OK");
  ImGui::SameLine();
  const bool is_cancelled = ImGui::Button("Cancel") || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
  if (is_accepted || is_cancelled) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (is_accepted && !dialog_.path.empty()) dialog_.accept(dialog_.path);
}

void Ui::draw_help() {
  if (!shows_help_) return;
  ImGui::SetNextWindowSize({36.0F * ImGui::GetFontSize(), 0.0F}, ImGuiCond_Appearing);
  const ImVec2 centre = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(centre, ImGuiCond_Appearing, {0.5F, 0.5F});
  if (ImGui::Begin("Shortcuts and hints", &shows_help_, ImGuiWindowFlags_NoCollapse)) {
    for (const Command& command : commands_) {
      if (command.key != 0) ImGui::BulletText("%s: %s", command.shortcut, command.text);
    }
    ImGui::Separator();
    for (const char* hint :
         {"Drag in the curve: moves θ. Drag in the map: moves what its axes are of, and the curve follows.",
          "Ctrl-click on a slider: back to the value of the scene as opened. Type any allowed value beside it.",
          "Rest the mouse on a control: its meaning, equation and range. Drop a CSV of measured points on the window.",
          "Grey in map and curve: the model fails there; the line under the plots says how."}) {
      coloured_text(kTextColour, hint);
    }
  }
  ImGui::End();
}

void Ui::show_quantity(Plotted quantity) {
  View view = session_.view();
  view.quantity = quantity;
  session_.set_view(view);
}

void Ui::draw_view_controls() {
  View view = session_.view();
  const float width = 6.5F * ImGui::GetFontSize();
  const auto label = [](const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine();
  };
  label("show");
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##quantity", shown(described(view.quantity).name).c_str())) {
    for (const PlottedDescription& of : all_plotted()) {
      const std::string text = shown(fmt::format("{}: {}", of.name, of.meaning));
      if (ImGui::Selectable(text.c_str(), of.quantity == view.quantity)) show_quantity(of.quantity);
    }
    ImGui::EndCombo();
  }
  view = session_.view();
  ImGui::SameLine();
  bool is_changed = ImGui::Checkbox("log", &view.is_log);
  ImGui::SameLine();
  is_changed |= ImGui::Checkbox("overlay", &view.has_overlay);
  ImGui::SameLine();
  label(shown("   map over").c_str());
  const char* const ids[] = {"##map x", "##map y"};
  AxisKind* const axes[] = {&view.map_x, &view.map_y};
  for (int i = 0; i < 2; ++i) {
    ImGui::SetNextItemWidth(0.7F * width);
    if (ImGui::BeginCombo(ids[i], shown(axis_label(*axes[i])).c_str())) {
      for (const AxisKind kind : {AxisKind::kTheta, AxisKind::kSigma, AxisKind::kQ}) {
        if (!ImGui::Selectable(shown(axis_label(kind)).c_str(), kind == *axes[i])) continue;
        // The two axes swap if the other one has this kind.
        if (*axes[1 - i] == kind) *axes[1 - i] = *axes[i];
        *axes[i] = kind;
        is_changed = true;
      }
      ImGui::EndCombo();
    }
    ImGui::SameLine();
  }
  label(shown("   θ up to").c_str());
  ImGui::SetNextItemWidth(0.5F * width);
  is_changed |=
      ImGui::InputDouble("##theta max", &view.theta_max_deg, 0.0, 0.0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  label(shown("°  ").c_str());
  if (ImGui::Button("pin (Ctrl+P)")) session_.pin();
  if (is_changed) session_.set_view(view);
}

void Ui::draw_fit() {
  const std::optional<MeasuredPoints>& points = session_.residuals().points();
  if (!points) return;
  const bool is_running = fit_.state() == BackgroundTask::State::kRunning;
  const bool is_ready = session_.fit_job().has_value() && !is_running;
  ImGui::Spacing();
  ImGui::BeginDisabled(!is_ready);
  if (ImGui::Button("Fit (Ctrl+F)")) actions_.fit();
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", shown(is_ready || is_running ? std::filesystem::path(points->data.name).filename().string()
                                                         : "mark what varies")
                                .c_str());
  const bool is_old = fit_.state() == BackgroundTask::State::kDone && session_.fit_found() == nullptr;
  if (is_old) {
    coloured_text(kDimColour, "The scene is no longer that of the fit.");
  } else {
    draw_task("fit", fit_);
  }
}

void Ui::draw_pins() {
  if (session_.pins().empty()) return;
  ImGui::Spacing();
  ImGui::TextUnformatted("Pins");
  ImGui::Separator();
  std::size_t removed = session_.pins().size();
  for (std::size_t i = 0; i < session_.pins().size(); ++i) {
    const Pin& pin = session_.pins()[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("x")) removed = i;
    ImGui::SameLine();
    bool is_visible = pin.is_visible;
    ImGui::PushStyleColor(ImGuiCol_Text, pin_style(pin.colour).colour);
    if (ImGui::Checkbox(shown(pin.name).c_str(), &is_visible)) session_.show_pin(i, is_visible);
    ImGui::PopStyleColor();
    ImGui::PopID();
  }
  if (removed < session_.pins().size()) session_.remove_pin(removed);
}

void Ui::draw_readout() {
  coloured_text(kTextColour, peak_text(session_));
  coloured_text(kTextColour, cause_text(session_));
  coloured_text(kDimColour, cursor_text(session_));
}

void Ui::draw_price() {
  if (explore::draw_price(session_, controls_, true_error_)) {
    true_error_key_ = session_.curve().key();
    actions_.find_true_error();
  }
  const bool is_old = true_error_.state() == BackgroundTask::State::kDone && true_error_key_ != session_.curve().key();
  if (is_old) coloured_text(kDimColour, "The true error is that of the scene before.");
  if (table_export_.state() != BackgroundTask::State::kNone) {
    ImGui::TextUnformatted("table");
    ImGui::SameLine();
    draw_task("table", table_export_);
  }
  const Message& message = session_.message();
  if (!message.text.empty()) coloured_text(message.is_error ? kErrorColour : kTextColour, message.text);
}

void Ui::draw_plots(ImVec2 size) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float curve_width = 0.54F * size.x;
  constexpr ImGuiWindowFlags kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  ImGui::BeginChild("curves", {curve_width, size.y}, false, kStill);
  plot_ = draw_curve_view(session_, ImGui::GetContentRegionAvail());
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("maps", {size.x - curve_width - gap, size.y}, false, kStill);
  map_view_.draw(session_, ImGui::GetContentRegionAvail());
  ImGui::EndChild();
}

void Ui::draw() {
  run_shortcuts();
  draw_menus();
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(viewport->WorkPos);
  ImGui::SetNextWindowSize(viewport->WorkSize);
  ImGui::Begin("dolp", nullptr, kFixed);
  const ImVec2 all = ImGui::GetContentRegionAvail();
  const float left = 22.0F * ImGui::GetFontSize();
  ImGui::BeginChild("controls", {left, all.y}, true);
  draw_fit();
  controls_.draw(session_);
  draw_pins();
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("right", {0.0F, all.y});
  draw_view_controls();
  const float readout = 3.8F * ImGui::GetTextLineHeightWithSpacing();
  const ImVec2 rest{ImGui::GetContentRegionAvail().x, ImGui::GetContentRegionAvail().y - readout};
  // The panels below scroll; the plots keep half of what there is.
  const float bottom = std::min(std::max(0.33F * all.y, 15.0F * ImGui::GetTextLineHeight()), 0.5F * rest.y);
  draw_plots({rest.x, rest.y - bottom});
  ImGui::BeginChild("readout", {0.0F, readout});
  draw_readout();
  ImGui::EndChild();
  const float price = 24.0F * ImGui::GetFontSize();
  ImGui::BeginChild("effects", {ImGui::GetContentRegionAvail().x - price, 0.0F}, true);
  draw_effects(session_);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("price", {0.0F, 0.0F}, true);
  draw_price();
  ImGui::EndChild();
  ImGui::EndChild();
  ImGui::End();
  draw_help();
  draw_path_dialog();
}

}  // namespace dolp::explore
