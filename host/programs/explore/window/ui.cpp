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

/// Continues beside the last item, or in a new line if the free space is narrower than `width` font sizes.
void continue_row(float width) {
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < width * ImGui::GetFontSize()) ImGui::NewLine();
}

/// Draws the result of a task. While it runs, draws its progress and a button to cancel it.
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

/// Draws a title, and for each thing a row with a button that removes it. `id` distinguishes the rows of two lists.
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

}  // namespace

Ui::Ui(Session& session, Actions& actions, std::function<void()> catch_up)
    : session_(session), actions_(actions), catch_up_(std::move(catch_up)) {
  for (std::vector<Command>& commands : std::array{file_commands(), view_commands(), scene_commands()})
    std::ranges::move(commands, std::back_inserter(commands_));
}

void Ui::draw_view_controls() {
  View view = session_.view();
  const float width = 6.5F * ImGui::GetFontSize();
  label("show");
  std::vector<ListEntry> quantities;
  for (const PlottedDescription& quantity : kAllPlotted)
    quantities.push_back({fmt::format("{}: {}", quantity.name, quantity.meaning)});
  const auto position = static_cast<std::size_t>(view.quantity);
  if (const auto clicked = draw_list("quantity", width, described(view.quantity).name, "", position, quantities))
    view.quantity = kAllPlotted[*clicked].quantity;
  ImGui::SameLine();
  ImGui::Checkbox("log", &view.is_log);
  ImGui::SameLine();
  ImGui::Checkbox("overlay", &view.has_overlay);
  continue_row(18.0F);
  draw_map_axes(view);
  continue_row(14.0F);
  label("   θ up to");
  ImGui::SetNextItemWidth(0.5F * width);
  fields_.draw("theta max", view.theta_max_deg, [&](const std::string& text) -> std::string {
    const double typed = parse_number(text).value_or(-1.0);
    if (typed < Session::kLeastThetaMaxDeg || typed > 90.0)
      return fmt::format("θ up to = {}: must be a number in [{}, 90]", text, Session::kLeastThetaMaxDeg);
    view.theta_max_deg = typed;
    return {};
  });
  ImGui::SameLine();
  label("°  ");
  if (ImGui::Button("pin (Ctrl+P)")) session_.pin();
  if (view != session_.view()) session_.set_view(view);
  fields_.draw_reason("theta max");
}

void Ui::draw_map_axes(View& view) {
  label("   map over");
  const std::vector<MapAxis> axes = map_axes(session_.scene(), view.theta_max_deg);
  std::vector<ListEntry> entries;
  for (const MapAxis& axis : axes) entries.push_back({axis.label});
  const MapAxis &x = session_.map().x(), &y = session_.map().y();
  for (const auto& [id, axis, other] : {std::tuple{"map x", &x, &y}, {"map y", &y, &x}}) {
    const auto position = static_cast<std::size_t>(std::ranges::find(axes, axis->name, &MapAxis::name) - axes.begin());
    if (const auto clicked = draw_list(id, 5.5F * ImGui::GetFontSize(), axis->label, "", position, entries)) {
      // Swaps the axes if the other axis has this name.
      const std::string& name = axes[*clicked].name;
      const std::string& left = name == other->name ? axis->name : other->name;
      view.map_x = axis == &x ? name : left;
      view.map_y = axis == &x ? left : name;
    }
    if (axis == &x) ImGui::SameLine();
  }
}

void Ui::draw_fit() {
  if (!session_.residuals().data()) return;
  ImGui::Spacing();
  // The progress bar replaces the button, and the result is elsewhere, so that the sliders below do not move.
  if (actions_.fit_task().is_running()) return draw_task("fit", actions_.fit_task());
  const bool is_ready = session_.fit_job().has_value();
  ImGui::BeginDisabled(!is_ready);
  if (ImGui::Button("Fit (Ctrl+F)")) actions_.fit();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const std::string file = std::filesystem::path(session_.residuals().data()->name).filename().string();
  ImGui::TextDisabled("%s", shown(is_ready ? file : "mark what varies").c_str());
}

void Ui::draw_pins() {
  draw_removable("Pins", "pin", session_.pins(), [](Pin& pin, const std::string&) {
    ImGui::PushStyleColor(ImGuiCol_Text, pin_style(pin.colour).colour);
    const std::string name = shown(pin.name.empty() ? surface_name(pin.curve.shown_scene()) : pin.name);
    const float box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::Checkbox(in_lines(name, ImGui::GetContentRegionAvail().x - box).c_str(), &pin.is_visible);
    ImGui::PopStyleColor();
    if (const auto typed = typed_name(pin.name, name)) pin.name = *typed;
  });
}

void Ui::draw_snapshots() {
  std::optional<SceneEdits> clicked;
  draw_removable("Snapshots", "snapshot", session_.snapshots(), [&](Snapshot& snapshot, const std::string& id) {
    const std::string name = in_lines(shown(snapshot.name), ImGui::GetContentRegionAvail().x);
    const bool is_shown = snapshot.edits.is_same_scene(session_.edits());
    if (ImGui::Selectable((name + "###go").c_str(), is_shown)) clicked = snapshot.edits;
    name_item(id);
    tooltip("shows this state of the scene; Ctrl+Z goes back, a right click edits the name");
    if (const auto typed = typed_name(snapshot.name)) snapshot.name = *typed;
  });
  if (clicked) session_.go_to(*clicked);
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

void Ui::draw_accuracy() {
  draw_accuracy_controls(session_, fields_);
  for (const std::string& line : cost_lines(session_)) coloured_text(kTextColour, line);
  ImGui::BeginDisabled(!session_.curve().is_finished() || actions_.true_error_task().is_running());
  if (ImGui::Button("True error (Ctrl+K)")) actions_.find_true_error();
  ImGui::EndDisabled();
  draw_task("reference", actions_.true_error_task());
  if (actions_.is_true_error_old()) coloured_text(kDimColour, "The true error belongs to the scene before.");
  if (actions_.table_task().state() != BackgroundTask::State::kNone) {
    label("table");
    draw_task("table", actions_.table_task());
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

bool Ui::draw_tab(const std::string& name, bool is_shown) {
  const float width = ImGui::CalcTextSize(name.c_str()).x + 2.0F * ImGui::GetStyle().FramePadding.x;
  if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
  ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(is_shown ? ImGuiCol_TabActive : ImGuiCol_Tab));
  const bool is_clicked = ImGui::SmallButton(name.c_str());
  ImGui::PopStyleColor();
  name_item("panel " + name);
  ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
  return is_clicked;
}

void Ui::draw_panel_tabs() {
  for (std::size_t i = 0; i < kPanelNames.size(); ++i) {
    const auto panel = static_cast<Panel>(i);
    if (!draw_tab(kPanelNames[i], panel == session_.view().panel && (!is_narrow_ || page_.empty()))) continue;
    session_.set_view(&View::panel, panel);
    page_.clear();
  }
  ImGui::NewLine();
}

void Ui::draw_panel(ImVec2 size) {
  switch (session_.view().panel) {
    case Panel::kMap:
      return map_view_.draw(session_, size);
    case Panel::kSlopes:
      return draw_slopes(session_, size);
    case Panel::kMaterial:
      return draw_material(session_, size);
    case Panel::kSmooth:
      return sweep_views_.draw_smooth(session_, size);
    case Panel::kSpectrum:
      return sweep_views_.draw_spectrum(session_, size);
    case Panel::kScattering:
      return scattering_view_.draw(session_, size);
    case Panel::kShapes:
      return shape_view_.draw(session_, size);
    case Panel::kSky:
      return draw_sky(session_, size);
    case Panel::kFit:
      return draw_fit_result(session_);
  }
}

void Ui::draw_one_page() {
  for (const char* name : {"curve", "effects", "accuracy"}) {
    if (draw_tab(name, page_ == name)) page_ = name;
  }
  draw_panel_tabs();
  if (page_ == "effects") return draw_effects(session_);
  if (page_ == "accuracy") return draw_accuracy();
  if (page_ == "curve") return curve_view_.draw(session_, ImGui::GetContentRegionAvail());
  draw_panel(ImGui::GetContentRegionAvail());
}

void Ui::draw_bottom() {
  const float accuracy = 20.0F * ImGui::GetFontSize();
  ImGui::BeginChild("effects", {ImGui::GetContentRegionAvail().x - accuracy, 0.0F}, true);
  draw_effects(session_);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("accuracy", {0.0F, 0.0F}, true);
  draw_accuracy();
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
  ImGui::PushItemFlag(ImGuiItemFlags_NoTabStop, true);  // the Tab key goes to the text fields
  const ImVec2 all = ImGui::GetContentRegionAvail();
  const float em = ImGui::GetFontSize();
  const float left = std::clamp(0.36F * all.x, 19.0F * em, 22.0F * em);
  is_narrow_ = all.x - left < 46.0F * em;
  ImGui::BeginChild("controls", {left, all.y}, true);
  draw_fit();
  draw_controls(session_, fields_);
  draw_pins();
  draw_snapshots();
  ImGui::EndChild();
  catch_up_();
  ImGui::SameLine();
  ImGui::BeginChild("right", {0.0F, all.y});
  draw_right(all.y);
  ImGui::EndChild();
  ImGui::PopItemFlag();
  ImGui::End();
  draw_help();
  dialog_.draw();
}

void Ui::draw_right(float window_height) {
  draw_view_controls();
  const float em = ImGui::GetFontSize();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float readout = (room.x < 64.0F * em ? 4.8F : 3.8F) * ImGui::GetTextLineHeightWithSpacing();
  const float height = room.y - readout;
  if (is_narrow_) {
    ImGui::BeginChild("page", {room.x, height - ImGui::GetStyle().ItemSpacing.y});
    draw_one_page();
    ImGui::EndChild();
  } else {
    // The panels below can scroll. The plots keep more than half of the height.
    draw_plots({room.x, height - std::min(std::max(0.33F * window_height, 15.0F * ImGui::GetTextLineHeight()),
                                          0.45F * height)});
  }
  ImGui::BeginChild("readout", {0.0F, readout});
  draw_readout();
  ImGui::EndChild();
  if (!is_narrow_) draw_bottom();
}

}  // namespace dolp::explore
