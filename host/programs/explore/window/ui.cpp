#include "explore/window/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "base/text.hpp"
#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoBackground;

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown(text).c_str());
  ImGui::SameLine();
}

/// Puts the next item beside the last one, or in a new line if `width` times the font size does not fit there.
void continue_row(float width) {
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < width * ImGui::GetFontSize()) ImGui::NewLine();
}

void draw_task(const std::string& name, BackgroundTask& task) {
  ImGui::PushID(name.c_str());
  if (task.is_running()) {
    if (ImGui::Button("Cancel")) task.cancel();
    name_item("cancel " + name);
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

/// Draws a title, and for each of `things` a row with a button to remove it. The IDs of the rows begin with `id`.
template <class Things, class DrawRow>
void draw_removable(const char* title, const char* id, Things& things, const DrawRow& draw_row) {
  if (things.empty()) return;
  ImGui::Spacing();
  ImGui::TextUnformatted(title);
  ImGui::Separator();
  auto removed = things.end();
  for (auto thing = things.begin(); thing != things.end(); ++thing) {
    const std::string name = fmt::format("{} {}", id, thing - things.begin());
    ImGui::PushID(name.c_str());
    if (ImGui::SmallButton("x")) removed = thing;
    ImGui::SameLine();
    draw_row(*thing, name);
    ImGui::PopID();
  }
  if (removed != things.end()) things.erase(removed);
}

void draw_map_axes(const Session& session, View& view) {
  label("   map over");
  const std::vector<MapAxis> axes = map_axes(session.scene(), view.theta_max_deg);
  std::vector<ListEntry> entries;
  for (const MapAxis& axis : axes) entries.push_back({axis.label});
  const MapAxis &x = session.map().x(), &y = session.map().y();
  for (const auto& [id, axis, other] : {std::tuple{"map x", &x, &y}, {"map y", &y, &x}}) {
    const auto position = static_cast<std::size_t>(std::ranges::find(axes, axis->name, &MapAxis::name) - axes.begin());
    if (const auto clicked = draw_list({id, 5.5F * ImGui::GetFontSize(), axis->label, "", position, entries})) {
      // If the user chose the other axis of the map, the two axes swap.
      const std::string& name = axes[*clicked].name;
      const std::string& left = name == other->name ? axis->name : other->name;
      view.map_x = axis == &x ? name : left;
      view.map_y = axis == &x ? left : name;
    }
    if (axis == &x) ImGui::SameLine();
  }
}

void draw_view_controls(Session& session, NumberFields& fields) {
  View view = session.view();
  const float width = 6.5F * ImGui::GetFontSize();
  label("show");
  std::vector<ListEntry> quantities;
  for (const PlottedDescription& quantity : kAllPlotted) {
    const std::string refusal = quantity_refusal(session.scene(), quantity.quantity);
    quantities.push_back({fmt::format("{}: {}", quantity.name, quantity.meaning), refusal, refusal.empty()});
  }
  const auto position = static_cast<std::size_t>(view.quantity);
  if (const auto clicked = draw_list({"quantity", width, described(view.quantity).name, "", position, quantities}))
    view.quantity = kAllPlotted[*clicked].quantity;
  ImGui::SameLine();
  ImGui::Checkbox("log", &view.is_log);
  ImGui::SameLine();
  ImGui::Checkbox("overlay", &view.has_overlay);
  continue_row(18.0F);
  draw_map_axes(session, view);
  continue_row(14.0F);
  label("   θ up to");
  ImGui::SetNextItemWidth(0.5F * width);
  fields.draw("theta max", view.theta_max_deg, [&](const std::string& text) -> std::string {
    const double typed = parse_number(text).value_or(-1.0);
    if (typed < Session::kLeastThetaMaxDeg || typed > 90.0)
      return fmt::format("θ up to = {}: must be a number in [{}, 90]", text, Session::kLeastThetaMaxDeg);
    view.theta_max_deg = typed;
    return {};
  });
  ImGui::SameLine();
  label("°  ");
  if (ImGui::Button("pin (Ctrl+P)")) session.pin();
  if (view != session.view()) session.set_view(view);
  fields.draw_reason("theta max");
}

void draw_fit(const Session& session, Actions& actions) {
  if (!session.residuals().data()) return;
  ImGui::Spacing();
  // The progress bar replaces the button, so that the sliders below do not move.
  if (actions.fit_task.is_running()) return draw_task("fit", actions.fit_task);
  const bool is_ready = session.fit_job().has_value();
  ImGui::BeginDisabled(!is_ready);
  if (ImGui::Button("Fit (Ctrl+F)")) actions.fit();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const std::string file = std::filesystem::path(session.residuals().data()->name).filename().string();
  ImGui::TextDisabled("%s", shown(is_ready ? file : "mark what varies").c_str());
}

void draw_pins(Session& session) {
  draw_removable("Pins", "pin", session.pins(), [](Pin& pin, const std::string&) {
    ImGui::PushStyleColor(ImGuiCol_Text, pin_style(pin.colour).colour);
    const std::string name = shown(pin.name.empty() ? surface_name(pin.curve.shown_scene()) : pin.name);
    const float box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::Checkbox(in_lines(name, ImGui::GetContentRegionAvail().x - box).c_str(), &pin.is_visible);
    ImGui::PopStyleColor();
    if (const auto typed = typed_name(pin.name, name)) pin.name = *typed;
  });
}

void draw_snapshots(Session& session) {
  std::optional<SceneEdits> clicked;
  draw_removable("Snapshots", "snapshot", session.snapshots(), [&](Snapshot& snapshot, const std::string& id) {
    const std::string name = in_lines(shown(snapshot.name), ImGui::GetContentRegionAvail().x);
    const bool is_shown = snapshot.edits.is_same_scene(session.edits());
    if (ImGui::Selectable((name + "###go").c_str(), is_shown)) clicked = snapshot.edits;
    name_item(id);
    tooltip("shows this state of the scene; Ctrl+Z goes back, a right click edits the name");
    if (const auto typed = typed_name(snapshot.name)) snapshot.name = *typed;
  });
  if (clicked) session.go_to(*clicked);
}

void draw_message(const Message& message) {
  if (!message.text.empty()) coloured_text(message.is_error ? kErrorColour : kTextColour, message.text);
}

void draw_accuracy(Ui& ui) {
  draw_accuracy_controls(ui.session, ui.controls);
  for (const std::string& line : cost_lines(ui.session)) coloured_text(kTextColour, line);
  BackgroundTask &reference = ui.actions.true_error_task, &table = ui.actions.table_task;
  ImGui::BeginDisabled(!ui.session.curve().is_finished() || reference.is_running());
  if (ImGui::Button("True error (Ctrl+K)")) ui.actions.find_true_error();
  ImGui::EndDisabled();
  draw_task("reference", reference);
  if (ui.actions.is_true_error_old()) coloured_text(kDimColour, "The true error belongs to the scene before.");
  if (table.state() != BackgroundTask::State::kNone) {
    label("table");
    draw_task("table", table);
  }
  if (!ui.is_narrow) draw_message(ui.session.message());
}

constexpr float kTabPadding = 3.0F;  // left and right of a button's text, in pixels of the usual text size
constexpr float kTabGap = 2.0F;

float tab_width(const std::string& name) { return ImGui::CalcTextSize(name.c_str()).x + scaled(2.0F * kTabPadding); }

/// Draws a button. If `refusal` is not empty, the button is grey, and `refusal` is its tooltip.
bool draw_tab(const std::string& name, bool is_shown, const std::string& refusal = "") {
  if (ImGui::GetContentRegionAvail().x < tab_width(name)) ImGui::NewLine();
  ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(is_shown ? ImGuiCol_TabActive : ImGuiCol_Tab));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {scaled(kTabPadding), 0.0F});
  ImGui::BeginDisabled(!refusal.empty());
  const bool is_clicked = ImGui::SmallButton(name.c_str());
  ImGui::EndDisabled();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  name_item("panel " + name);
  if (!refusal.empty()) tooltip(refusal);
  ImGui::SameLine(0.0F, scaled(kTabGap));
  return is_clicked;
}

void draw_panel_tabs(Ui& ui) {
  for (std::size_t i = 0; i < kPanelNames.size(); ++i) {
    const auto panel = static_cast<Panel>(i);
    const bool is_shown = panel == ui.session.view().panel && (!ui.is_narrow || ui.page.empty());
    if (!draw_tab(kPanelNames[i], is_shown, view_refusal(ui.session, panel))) continue;
    ui.session.set_view(&View::panel, panel);
    ui.page.clear();
  }
  ImGui::NewLine();
}

void draw_panel(Ui& ui, ImVec2 size) {
  using Draw = void (*)(Ui&, ImVec2);
  constexpr std::array<Draw, kPanelNames.size()> kDraw = {
      // in the order of the enum Panel
      [](Ui& u, ImVec2 room) { u.map.draw(u.session, u.axis_editor, room); },
      [](Ui& u, ImVec2 room) { draw_slopes(u.session, room); },
      [](Ui& u, ImVec2 room) { draw_material(u.session, room); },
      [](Ui& u, ImVec2 room) { draw_smooth(u.session, u.axis_editor, room); },
      [](Ui& u, ImVec2 room) { draw_sweep(u.session, u.axis_editor, room); },
      [](Ui& u, ImVec2 room) { u.scattering_view.draw(u.session, room); },
      [](Ui& u, ImVec2 room) { u.shape_view.draw(u.session, room); },
      [](Ui& u, ImVec2 room) { draw_sky(u.session, room); },
      [](Ui& u, ImVec2 room) { draw_sweep(u.session, u.axis_editor, room); },
      [](Ui& u, ImVec2 room) { draw_sweep(u.session, u.axis_editor, room); },
      [](Ui& u, ImVec2) { draw_fit_result(u.session); }};
  const Panel panel = ui.session.view().panel;
  const std::string refusal = view_refusal(ui.session, panel);
  if (!refusal.empty()) return coloured_text(kDimColour, refusal);
  kDraw.at(static_cast<std::size_t>(panel))(ui, size);
}

void draw_plots(Ui& ui, ImVec2 size) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  // The buttons of the views have one line, unless the curve would have less than 47 % of the width.
  float beside_tabs = size.x - gap;
  for (const char* name : kPanelNames) beside_tabs -= tab_width(name) + scaled(kTabGap);
  const float curve_width = beside_tabs < 0.47F * size.x ? 0.5F * size.x : std::min(beside_tabs, 0.54F * size.x);
  constexpr ImGuiWindowFlags kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  ImGui::BeginChild("curves", {curve_width, size.y}, false, kStill);
  ui.curves.draw(ui.session, ui.axis_editor, ImGui::GetContentRegionAvail());
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("maps", {size.x - curve_width - gap, size.y}, false, kStill);
  draw_panel_tabs(ui);
  draw_panel(ui, ImGui::GetContentRegionAvail());
  ImGui::EndChild();
}

void draw_one_page(Ui& ui) {
  for (const char* name : {"curve", "effects", "accuracy"}) {
    if (draw_tab(name, ui.page == name)) ui.page = name;
  }
  draw_panel_tabs(ui);
  if (ui.page == "effects") return draw_effects(ui.session);
  if (ui.page == "accuracy") return draw_accuracy(ui);
  if (ui.page == "curve") return ui.curves.draw(ui.session, ui.axis_editor, ImGui::GetContentRegionAvail());
  draw_panel(ui, ImGui::GetContentRegionAvail());
}

void draw_right(Ui& ui, float window_height) {  // draws everything right of the controls
  draw_view_controls(ui.session, ui.controls.fields);
  const float em = ImGui::GetFontSize();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float readout = (room.x < 64.0F * em ? 4.8F : 3.8F) * ImGui::GetTextLineHeightWithSpacing();
  const float height = room.y - readout;
  if (ui.is_narrow) {
    ImGui::BeginChild("page", {room.x, height - ImGui::GetStyle().ItemSpacing.y});
    draw_one_page(ui);
    ImGui::EndChild();
  } else {
    // The plots get more than half of the height. The panels below scroll if they do not fit in the rest.
    const float below = std::max(0.33F * window_height, 15.0F * ImGui::GetTextLineHeight());
    draw_plots(ui, {room.x, height - std::min(below, 0.45F * height)});
  }
  ImGui::BeginChild("readout", {0.0F, readout});
  if (ui.is_narrow) draw_message(ui.session.message());
  coloured_text(kTextColour, headline(ui.session));
  coloured_text(kTextColour, cause_text(ui.session));
  coloured_text(kDimColour, cursor_text(ui.session));
  ImGui::EndChild();
  if (ui.is_narrow) return;
  ImGui::BeginChild("effects", {ImGui::GetContentRegionAvail().x - 20.0F * em, 0.0F}, true);
  draw_effects(ui.session);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("accuracy", {0.0F, 0.0F}, true);
  draw_accuracy(ui);
  ImGui::EndChild();
}

}  // namespace

void draw_all(Ui& ui, const std::function<void()>& catch_up) {
  ui.session.hold(ImGui::IsMouseDown(ImGuiMouseButton_Left));
  run_shortcuts(ui);
  draw_menus(ui);
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(viewport->WorkPos);
  ImGui::SetNextWindowSize(viewport->WorkSize);
  ImGui::Begin("dolp", nullptr, kFixed);
  ImGui::PushItemFlag(ImGuiItemFlags_NoTabStop, true);  // Tab stops only at text fields, which clear this flag
  const ImVec2 all = ImGui::GetContentRegionAvail();
  const float em = ImGui::GetFontSize();
  const float left = std::clamp(0.36F * all.x, 19.0F * em, 22.0F * em);
  ui.is_narrow = all.x - left < 46.0F * em;
  ImGui::BeginChild("controls", {left, all.y}, true);
  draw_fit(ui.session, ui.actions);
  draw_controls(ui.session, ui.controls);
  if (!ui.controls.wanted_file.empty()) ask_for_material(ui, std::exchange(ui.controls.wanted_file, ""));
  draw_pins(ui.session);
  draw_snapshots(ui.session);
  ImGui::EndChild();
  catch_up();
  ImGui::SameLine();
  ImGui::BeginChild("right", {0.0F, all.y});
  draw_right(ui, all.y);
  ImGui::EndChild();
  ImGui::PopItemFlag();
  ImGui::End();
  draw_help(ui);
  draw_about(ui);
  ui.dialog.draw();
}

}  // namespace dolp::explore
