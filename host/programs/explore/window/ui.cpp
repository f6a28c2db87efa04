#include "explore/window/ui.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/text.hpp"
#include "explore/readout.hpp"
#include "explore/window/input.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoBackground;
constexpr char kOpenKey = 'O';
constexpr char kUndoKey = 'Z';
constexpr char kLargerKey = '=';
constexpr char kSmallerKey = '-';

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown(text).c_str());
  ImGui::SameLine();
}

/// Beside the last item, or in a new line where there is less room than this many times the size of the font.
void go_on(float width) {
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < width * ImGui::GetFontSize()) ImGui::NewLine();
}

/// True for the key itself or that of the number pad.
bool is_shortcut_pressed(char key) {
  return is_pressed(key) || (key == kLargerKey && is_pressed(GLFW_KEY_KP_ADD)) ||
         (key == kSmallerKey && is_pressed(GLFW_KEY_KP_SUBTRACT)) || (key == '0' && is_pressed(GLFW_KEY_KP_0));
}

/// Returns why the text is refused; nothing where it is taken.
std::string set_theta_max(View& view, const std::string& text) {
  const std::optional<double> typed = parse_number(text);
  if (!typed || *typed < Session::kLeastThetaMaxDeg || *typed > 90.0) {
    return fmt::format("θ up to = {}: must be a number in [{}, 90]", text, Session::kLeastThetaMaxDeg);
  }
  view.theta_max_deg = *typed;
  return {};
}

/// A bar with a button to cancel, whose area is "cancel NAME", or the result of a task.
void draw_task(const char* name, BackgroundTask& task, std::map<std::string, Area>& areas) {
  ImGui::PushID(name);
  if (task.is_running()) {
    if (ImGui::Button("Cancel")) task.cancel();
    areas[std::string("cancel ") + name] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
    ImGui::SameLine();
    const std::string phase = task.phase();
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImGui::GetStyleColorVec4(ImGuiCol_ButtonHovered));
    ImGui::ProgressBar(static_cast<float>(task.progress()), {-1.0F, 0.0F}, phase.empty() ? nullptr : phase.c_str());
    ImGui::PopStyleColor();
  } else if (task.state() != BackgroundTask::State::kNone) {
    coloured_text(task.state() == BackgroundTask::State::kFailed ? kErrorColour : kTextColour, task.message());
  }
  ImGui::PopID();
}

}  // namespace

Ui::Ui(Session& session, Actions& actions, std::function<void()> catch_up)
    : session_(session), actions_(actions), catch_up_(std::move(catch_up)) {
  add_file_commands();
  add_view_commands();
}

void Ui::add_view_commands() {
  const auto add_switch = [this](const char* text, char key, bool View::*flag) {
    const auto toggle = [this, flag] {
      View view = session_.view();
      view.*flag = !(view.*flag);
      session_.set_view(view);
    };
    commands_.push_back({"View", text, key, toggle, [this, flag] { return session_.view().*flag; }});
  };
  add_switch("Logarithmic axis", 'L', &View::is_log);
  add_switch("Overlay the other slope distribution", 'D', &View::has_overlay);
  add_switch("Keep all effects", 'G', &View::keeps_all);
  const auto add_zoom = [this](const char* text, char key, void (*change)(Preferences&)) {
    commands_.push_back({"View", text, key, [this, change] { actions_.prefer(change); }});
  };
  add_zoom("Larger", kLargerKey, [](Preferences& of) { of.zoom_by(1); });
  add_zoom("Smaller", kSmallerKey, [](Preferences& of) { of.zoom_by(-1); });
  add_zoom("Usual size", '0', [](Preferences& of) { of.zoom_to_default(); });
  add_zoom("Light theme", 0, [](Preferences& of) { of.is_light = !of.is_light; });
  commands_.back().is_checked = [this] { return actions_.preferences().is_light; };
  commands_.push_back({"Scene", "Undo", kUndoKey, [this] { session_.undo(); }});
  commands_.push_back({"Scene", "Redo", kUndoKey, [this] { session_.redo(); }, {}, true});
  commands_.push_back({"Scene", "Copy the command that gives its table", 'C', [this] { copy_command(); }, {}, true});
  commands_.push_back({"Scene", "Pin the curve", 'P', [this] { session_.pin(); }});
  commands_.push_back({"Scene", "Take a snapshot", 'B', [this] { session_.take_snapshot(); }});
  commands_.push_back({"Scene", "True error of the curve", 'K', [this] { actions_.find_true_error(); }});
  commands_.push_back({"Scene", "Fit to the measured points", 'F', [this] { actions_.fit(); }});
  commands_.push_back({"Scene", "Take all changes back", 'R', [this] { session_.reset_all(); }});
  commands_.push_back({"Help", "Shortcuts and hints", 'H', [this] { shows_help_ = true; }});
}

std::string Ui::Command::shortcut() const {
  if (key == 0) return {};
  return std::string(has_shift ? "Ctrl+Shift+" : "Ctrl+") + (key == kLargerKey ? '+' : key);
}

void Ui::run_shortcuts() {
  if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId)) return;
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.KeyCtrl || io.KeyAlt) return;
  for (const Command& command : commands_) {
    if (command.has_shift != io.KeyShift && command.key != kLargerKey) continue;  // many keyboards have + above =
    if (command.key == kUndoKey && io.WantTextInput) continue;                    // the field undoes its own text
    // GLFW's number of a letter's key is that of the letter.
    if (command.key != 0 && is_shortcut_pressed(command.key)) command.run();
  }
}

void Ui::remember_next(const std::string& name, const char* text) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();  // an open menu is an item of its own
  areas_[name] = {corner, {corner.x + ImGui::CalcTextSize(text).x, corner.y + ImGui::GetTextLineHeight()}};
}

void Ui::draw_menu(const char* menu) {
  remember_next(std::string("menu ") + menu, menu);
  if (!ImGui::BeginMenu(menu)) return;
  for (const Command& command : commands_) {
    if (std::string_view(command.menu) != menu) continue;
    remember_next(command.text, command.text);
    const bool is_checked = command.is_checked && command.is_checked();
    const bool is_enabled = !command.is_enabled || command.is_enabled();
    if (ImGui::MenuItem(command.text, command.shortcut().c_str(), is_checked, is_enabled)) command.run();
    if (command.key == kOpenKey) draw_recent();
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

void Ui::draw_help() {
  if (!shows_help_) return;
  ImGui::SetNextWindowSize({36.0F * ImGui::GetFontSize(), 0.0F}, ImGuiCond_Appearing);
  const ImVec2 centre = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(centre, ImGuiCond_Appearing, {0.5F, 0.5F});
  if (is_pressed(GLFW_KEY_ESCAPE) && !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup)) {
    shows_help_ = false;
  }
  if (ImGui::Begin("Shortcuts and hints", &shows_help_, ImGuiWindowFlags_NoCollapse)) {
    for (const Command& command : commands_) {
      if (command.key != 0) ImGui::BulletText("%s: %s", command.shortcut().c_str(), command.text);
    }
    ImGui::Separator();
    for (const char* hint :
         {"Drag in the curve: moves θ. Drag in the map: moves what its axes are of, and the curve follows.",
          "Wheel in the curve: zooms (Shift: along θ, Alt: along the values). Right button: moves it. Double click: "
          "all. On the numbers of an axis: its ends.",
          "Click in the legend: hides or shows a curve. Right click on a pin: its name.",
          "Ctrl-click on a slider: back to the value of the scene as opened. Type any allowed value beside it.",
          "Rest the mouse on a control: its meaning, equation and range. Drop a scene, a session or measured points on "
          "the window.",
          "Grey in map and curve: the model fails there; the line under the plots says how."}) {
      coloured_text(kTextColour, hint);
    }
  }
  ImGui::End();
}

void Ui::draw_view_controls() {
  View view = session_.view();
  bool is_changed = false;
  const float width = 6.5F * ImGui::GetFontSize();
  label("show");
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##quantity", shown(described(view.quantity).name).c_str())) {
    for (const PlottedDescription& of : kAllPlotted) {
      const std::string text = shown(fmt::format("{}: {}", of.name, of.meaning));
      if (!ImGui::Selectable(text.c_str(), of.quantity == view.quantity)) continue;
      view.quantity = of.quantity;
      is_changed = true;
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  is_changed |= ImGui::Checkbox("log", &view.is_log);
  ImGui::SameLine();
  is_changed |= ImGui::Checkbox("overlay", &view.has_overlay);
  go_on(18.0F);
  draw_map_axes(view, is_changed);
  go_on(14.0F);
  label("   θ up to");
  ImGui::SetNextItemWidth(0.5F * width);
  fields_.draw("theta max", view.theta_max_deg, [&](const std::string& text) {
    std::string wrong = set_theta_max(view, text);
    is_changed = is_changed || wrong.empty();
    return wrong;
  });
  ImGui::SameLine();
  label("°  ");
  if (ImGui::Button("pin (Ctrl+P)")) session_.pin();
  if (is_changed) session_.set_view(view);
  if (const std::string reason = fields_.reason("theta max"); !reason.empty()) coloured_text(kErrorColour, reason);
}

void Ui::draw_map_axes(View& view, bool& is_changed) {
  label("   map over");
  const auto label_of = [&](Axis axis) {
    return shown(MapAxis{.axis = axis, .is_wind = has_wind(session_.scene())}.label());
  };
  Axis* const axes[] = {&view.map_x, &view.map_y};
  for (int i = 0; i < 2; ++i) {
    ImGui::SetNextItemWidth(5.5F * ImGui::GetFontSize());
    if (ImGui::BeginCombo(i == 0 ? "##map x" : "##map y", label_of(*axes[i]).c_str())) {
      for (const Axis axis : kMapAxes) {
        if (!ImGui::Selectable(label_of(axis).c_str(), axis == *axes[i])) continue;
        // The two axes swap if the other one is this.
        if (*axes[1 - i] == axis) *axes[1 - i] = *axes[i];
        *axes[i] = axis;
        is_changed = true;
      }
      ImGui::EndCombo();
    }
    if (i == 0) ImGui::SameLine();
  }
}

void Ui::draw_fit() {
  if (!session_.residuals().data()) return;
  ImGui::Spacing();
  // The bar stands where the button was, and the result goes elsewhere, so that the sliders below stay where they are.
  if (actions_.fit_task().is_running()) return draw_task("fit", actions_.fit_task(), areas_);
  const bool is_ready = session_.fit_job().has_value();
  ImGui::BeginDisabled(!is_ready);
  if (ImGui::Button("Fit (Ctrl+F)")) actions_.fit();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const std::string file = std::filesystem::path(session_.residuals().data()->name).filename().string();
  ImGui::TextDisabled("%s", shown(is_ready ? file : "mark what varies").c_str());
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
    const std::string name = shown(pin.name.empty() ? surface_name(pin.curve.shown_scene()) : pin.name);
    const float room =
        ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemInnerSpacing.x;
    if (ImGui::Checkbox(in_lines(name, room).c_str(), &is_visible)) session_.show_pin(i, is_visible);
    ImGui::PopStyleColor();
    if (const auto typed = typed_name(pin.name, name)) session_.rename_pin(i, *typed);
    ImGui::PopID();
  }
  if (removed < session_.pins().size()) session_.remove_pin(removed);
}

void Ui::draw_message() {
  const Message& message = session_.message();
  if (!message.text.empty()) coloured_text(message.is_error ? kErrorColour : kTextColour, message.text);
}

void Ui::draw_readout() {
  if (is_narrow_) draw_message();
  coloured_text(kTextColour, peak_text(session_));
  coloured_text(kTextColour, cause_text(session_));
  coloured_text(kDimColour, cursor_text(session_));
}

void Ui::draw_price() {
  controls_.draw_accuracy(session_);
  for (const std::string& line : cost_lines(session_)) coloured_text(kTextColour, line);
  ImGui::BeginDisabled(!session_.curve().is_finished() || actions_.true_error_task().is_running());
  if (ImGui::Button("True error (Ctrl+K)")) actions_.find_true_error();
  ImGui::EndDisabled();
  draw_task("reference", actions_.true_error_task(), areas_);
  if (actions_.is_true_error_old()) coloured_text(kDimColour, "The true error is that of the scene before.");
  if (actions_.table_task().state() != BackgroundTask::State::kNone) {
    label("table");
    draw_task("table", actions_.table_task(), areas_);
  }
  if (!is_narrow_) draw_message();
}

void Ui::draw_plots(ImVec2 size) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float curve_width = 0.54F * size.x;
  constexpr ImGuiWindowFlags kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  ImGui::BeginChild("curves", {curve_width, size.y}, false, kStill);
  curve_view_.draw(session_, ImGui::GetContentRegionAvail());
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("maps", {size.x - curve_width - gap, size.y}, false, kStill);
  draw_panel_tabs();
  draw_panel(ImGui::GetContentRegionAvail());
  ImGui::EndChild();
}

bool Ui::draw_tab(const char* name, bool is_shown) {
  const ImGuiStyle& style = ImGui::GetStyle();
  if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(name).x + 2.0F * style.FramePadding.x) ImGui::NewLine();
  ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(is_shown ? ImGuiCol_TabActive : ImGuiCol_Tab));
  const bool is_clicked = ImGui::SmallButton(name);
  ImGui::PopStyleColor();
  areas_[fmt::format("panel {}", name)] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  ImGui::SameLine();
  return is_clicked;
}

void Ui::draw_panel_tabs() {
  View view = session_.view();
  for (const PanelDescription& of : kPanels) {
    if (draw_tab(of.name, is_narrow_ ? page_.empty() && of.panel == view.panel : of.panel == view.panel)) {
      view.panel = of.panel;
      page_.clear();
    }
  }
  ImGui::NewLine();
  if (view.panel != session_.view().panel) session_.set_view(view);
}

void Ui::draw_panel(ImVec2 size) {
  const Panel panel = session_.view().panel;
  if (panel == Panel::kMap) map_view_.draw(session_, size);
  if (panel == Panel::kSlopes) draw_slopes(session_, size);
  if (panel == Panel::kMaterial) draw_material(session_, size);
  if (panel == Panel::kScattering) scattering_view_.draw(session_, size);
  if (panel == Panel::kShapes) shape_view_.draw(session_, size);
  if (panel == Panel::kSky) draw_sky(session_, size);
  if (panel == Panel::kFit) draw_fit_result(session_, areas_);
}

void Ui::draw_one_page() {
  for (const char* name : {"curve", "effects", "accuracy"}) {
    if (draw_tab(name, page_ == name)) page_ = name;
  }
  draw_panel_tabs();
  if (page_ == "effects") return draw_effects(session_);
  if (page_ == "accuracy") return draw_price();
  if (page_ == "curve") return curve_view_.draw(session_, ImGui::GetContentRegionAvail());
  draw_panel(ImGui::GetContentRegionAvail());
}

Area Ui::area(const std::string& name) const {
  const auto tab = areas_.find(name);
  if (tab != areas_.end()) return tab->second;
  const auto file = dialog_.areas().find(name);
  return file == dialog_.areas().end() ? controls_.areas().at(name) : file->second;
}

void Ui::copy_command() {
  if (session_.has_own_sky()) {
    session_.tell("save the scene first: the command names its sky, which has no file yet", true);
    return;
  }
  const std::string command = table_command(session_.edits());
  ImGui::SetClipboardText(command.c_str());
  session_.tell("copied: " + command);
}

void Ui::draw_bottom() {
  const float price = 20.0F * ImGui::GetFontSize();
  ImGui::BeginChild("effects", {ImGui::GetContentRegionAvail().x - price, 0.0F}, true);
  draw_effects(session_);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("price", {0.0F, 0.0F}, true);
  draw_price();
  ImGui::EndChild();
}

void Ui::draw() {
  session_.hold(ImGui::IsMouseDown(ImGuiMouseButton_Left));
  run_shortcuts();
  draw_menus();
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(viewport->WorkPos);
  ImGui::SetNextWindowSize(viewport->WorkSize);
  ImGui::Begin("dolp", nullptr, kFixed);
  ImGui::PushItemFlag(ImGuiItemFlags_NoTabStop, true);  // Tab goes to fields
  const ImVec2 all = ImGui::GetContentRegionAvail();
  const float em = ImGui::GetFontSize();
  const float left = std::clamp(0.36F * all.x, 19.0F * em, 22.0F * em);
  is_narrow_ = all.x - left < 46.0F * em;
  ImGui::BeginChild("controls", {left, all.y}, true);
  draw_fit();
  controls_.draw(session_);
  draw_pins();
  draw_snapshots();
  ImGui::EndChild();
  catch_up_();
  ImGui::SameLine();
  ImGui::BeginChild("right", {0.0F, all.y});
  draw_view_controls();
  const float readout =
      (ImGui::GetContentRegionAvail().x < 64.0F * em ? 4.8F : 3.8F) * ImGui::GetTextLineHeightWithSpacing();
  const ImVec2 rest{ImGui::GetContentRegionAvail().x, ImGui::GetContentRegionAvail().y - readout};
  if (is_narrow_) {
    ImGui::BeginChild("page", {rest.x, rest.y - ImGui::GetStyle().ItemSpacing.y});
    draw_one_page();
    ImGui::EndChild();
  } else {
    // The panels below scroll; the plots keep more than half of what there is.
    const float bottom = std::min(std::max(0.33F * all.y, 15.0F * ImGui::GetTextLineHeight()), 0.45F * rest.y);
    draw_plots({rest.x, rest.y - bottom});
  }
  ImGui::BeginChild("readout", {0.0F, readout});
  draw_readout();
  ImGui::EndChild();
  if (!is_narrow_) draw_bottom();
  ImGui::EndChild();
  ImGui::PopItemFlag();
  ImGui::End();
  draw_help();
  dialog_.draw();
}

}  // namespace dolp::explore
