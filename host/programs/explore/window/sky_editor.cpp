// The sky of a scene in the panel of controls: uniform, built-in, between two temperatures, or a file.
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "base/text.hpp"
#include "explore/window/controls_panel.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kProfile = "surroundings.profile";
constexpr const char* kUniform = "surroundings.temperature_K";
constexpr double kUniform_K = 250.0;    // where the scene as opened has none
constexpr Scale kSlider{150.0, 350.0};  // K; typing reaches all

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace

void ControlsPanel::draw_sky(Session& session) {
  const std::string file = sky_file(session.scene()).string();
  if (file != sky_file_) sky_ = read_sky_pair(file);
  sky_file_ = file;
  draw_sky_list(session);
  if (sky_) draw_sky_temperature(session, "zenith", &SkyPair::zenith_K);
  if (sky_) draw_sky_temperature(session, "horizon", &SkyPair::horizon_K);
}

void ControlsPanel::draw_sky_list(Session& session) {
  const std::string current = session.scene().word(kProfile).value_or("");
  const std::string opened = session.edits().opened().word(kProfile).value_or("");
  row_label("sky");
  ImGui::SetNextItemWidth(-1.0F);
  const ImVec2 corner = ImGui::GetCursorScreenPos();  // an open list is an item of its own
  areas_["sky"] = {corner, {corner.x + ImGui::CalcItemWidth(), corner.y + ImGui::GetFrameHeight()}};
  const std::string name = current.empty() ? "uniform" : sky_ ? "zenith and horizon" : file_name(current);
  if (!ImGui::BeginCombo("##sky", name.c_str())) {
    tooltip(fmt::format("{} {}: {}", kProfile, current, described(kProfile).meaning));
    return;
  }
  if (ImGui::Selectable("uniform", current.empty()) && !current.empty())
    session.set(kUniform, session.edits().opened().number(kUniform).value_or(kUniform_K));
  for (const char* built_in : {"clear-sky", "overcast"}) {
    if (ImGui::Selectable(built_in, current == built_in)) session.set(kProfile, built_in);
  }
  if (ImGui::Selectable("zenith and horizon", sky_.has_value()) && !sky_)
    session.set(kProfile, session.skies().path({}));
  // The file of the scene as opened stays among the choices.
  const bool has_file = !sky_file(session.edits().opened()).empty();
  if (has_file && ImGui::Selectable(file_name(opened).c_str(), current == opened)) session.set(kProfile, opened);
  ImGui::EndCombo();
}

void ControlsPanel::draw_sky_temperature(Session& session, const std::string& name, double SkyPair::*part) {
  const std::string id = "sky " + name;
  SkyPair sky = *sky_;
  const double before_K = sky.*part;
  const auto with = [&](double temperature_K) {
    sky.*part = temperature_K;
    return Setting{kProfile, session.skies().path(sky)};
  };
  row_label(fmt::format("T_{} [K]", name.substr(0, 3)));
  ImGui::SetNextItemWidth(-5.2F * ImGui::GetFontSize() - ImGui::GetStyle().ItemSpacing.x);
  auto position = static_cast<float>(kSlider.position(kSlider.clamp(before_K)));
  const std::string slider = "##slider " + name;
  const bool is_moved = ImGui::SliderFloat(slider.c_str(), &position, 0.0F, 1.0F, "", ImGuiSliderFlags_NoInput);
  remember_area(id);
  const bool is_ctrl = ImGui::GetIO().KeyCtrl;
  if (ImGui::IsItemClicked() && is_ctrl) session.reset(kProfile);
  if (is_moved && !is_ctrl) session.set({with(std::round(10.0 * kSlider.value(static_cast<double>(position))) / 10.0)});
  if (!ImGui::IsItemActive())
    tooltip(fmt::format("brightness temperature at the {}; a straight line in zenith between both", name));
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0F);
  draw_field(session, id, before_K, [&](const std::string& text) {
    const std::optional<double> typed = parse_number(text);
    // Text that is no temperature is refused in the words for that of a uniform sky.
    return typed && described(kUniform).range.contains(*typed) ? with(*typed) : Setting{kUniform, TomlText{text}};
  });
  show_reason(id);
}

}  // namespace dolp::explore
