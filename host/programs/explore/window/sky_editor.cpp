#include "explore/window/sky_editor.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "explore/parameters.hpp"
#include "explore/window/controls_panel.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kProfile = "surroundings.profile";
constexpr const char* kUniform = "surroundings.temperature_K";
constexpr double kUniform_K = 250.0;
constexpr float kColdest_K = 150.0F;  // of the sliders; typing reaches all
constexpr float kWarmest_K = 350.0F;

/// The last item's area.
Area item_area() { return {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()}; }

/// Why a temperature is refused; empty where it is not.
std::string refusal(const std::string& name, const std::string& text) {
  const Key& key = described(kUniform);
  const std::optional<double> typed = parse_number(text);
  if (typed && key.range.contains(*typed)) return {};
  return fmt::format("{} = {}: must be {} K", name, one_line(text), key.allowed());
}

}  // namespace

void SkyEditor::draw(Session& session, std::map<std::string, Area>& areas) {
  const std::string file = sky_file(session.scene()).string();
  if (file != file_) {
    file_ = file;
    try {
      pair_ = file.empty() ? std::nullopt : read_sky_pair(file);
    } catch (const InputError&) {
      pair_.reset();  // the scene keeps what it has read
    }
  }
  draw_list(session, areas);
  if (!pair_) return;
  draw_temperature(session, "zenith", &SkyPair::zenith_K, areas);
  draw_temperature(session, "horizon", &SkyPair::horizon_K, areas);
}

void SkyEditor::draw_list(Session& session, std::map<std::string, Area>& areas) {
  const std::string current = session.scene().word(kProfile).value_or("");
  const std::string opened = session.edits().opened().word(kProfile).value_or("");
  const auto file_name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  row_label("sky");
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::SetNextItemWidth(-1.0F);
  areas["sky"] = {corner, {corner.x + ImGui::CalcItemWidth(), corner.y + ImGui::GetFrameHeight()}};
  const bool is_file = !current.empty() && !sky_file(session.scene()).empty() && !pair_;
  const std::string name = current.empty() ? "uniform" : pair_ ? "zenith and horizon" : file_name(current);
  if (!ImGui::BeginCombo("##sky", name.c_str())) {
    tooltip(fmt::format("{}: {}{}", kProfile, described(kProfile).meaning, is_file ? "\n" + current : ""));
    return;
  }
  if (ImGui::Selectable("uniform", current.empty()) && !current.empty()) session.set(kUniform, kUniform_K);
  for (const char* sky : {"clear-sky", "overcast"}) {
    if (ImGui::Selectable(sky, current == sky)) session.set(kProfile, sky);
  }
  if (ImGui::Selectable("zenith and horizon", pair_.has_value()) && !pair_) session.set_sky({});
  // The file of the scene as opened stays among the choices.
  const bool has_file = !sky_file(session.edits().opened()).empty();
  if (has_file && ImGui::Selectable(file_name(opened).c_str(), current == opened)) session.set(kProfile, opened);
  ImGui::EndCombo();
}

void SkyEditor::draw_temperature(Session& session, const std::string& name, double SkyPair::*part,
                                 std::map<std::string, Area>& areas) {
  const std::string id = "sky " + name;
  const auto take = [&](double temperature_K) {
    SkyPair sky = *pair_;
    sky.*part = temperature_K;
    session.set_sky(sky);
  };
  row_label(fmt::format("T_{} [K]", name == "zenith" ? "zen" : "hor"));
  ImGui::PushID(id.c_str());
  ImGui::SetNextItemWidth(-5.2F * ImGui::GetFontSize() - ImGui::GetStyle().ItemSpacing.x);
  auto moved = std::clamp(static_cast<float>((*pair_).*part), kColdest_K, kWarmest_K);
  const bool is_moved = ImGui::SliderFloat("##slider", &moved, kColdest_K, kWarmest_K, "", ImGuiSliderFlags_NoInput);
  areas[id] = item_area();
  if (is_moved) take(std::round(10.0 * static_cast<double>(moved)) / 10.0);
  if (!ImGui::IsItemActive()) {
    tooltip(fmt::format("brightness temperature of the sky at the {}; a straight line in zenith between both", name));
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0F);
  fields_.draw(id, (*pair_).*part, [&](const std::string& text) {
    const std::string why = refusal(id, text);
    if (why.empty()) take(*parse_number(text));
    return why.empty() && session.message().is_error ? session.message().text : why;
  });
  areas["field " + id] = item_area();
  if (const std::string why = fields_.reason(id); !why.empty()) coloured_text(kErrorColour, why);
  ImGui::PopID();
}

}  // namespace dolp::explore
