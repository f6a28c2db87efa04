#include "explore/window/controls_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "explore/parameters.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

void heading(const char* text) {
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Text, kHeadingColour);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  ImGui::Separator();
}

std::string fallback_text(const Parameter& parameter, const Session& session) {
  const std::optional<double> opened = parameter.value(session.edits().opened());
  return opened ? fmt::format("\nCtrl-click: {:.6g}, as opened", *opened) : "";
}

/// The last fit's intervals of a parameter.
std::string intervals_text(const Parameter& parameter, const Session& session) {
  const FitParameter* const found = session.fitted(parameter.key->key);
  if (!found) return {};
  return fmt::format("\n68 %: {}\n95 %: {}", interval_text(found->interval_68), interval_text(found->interval_95));
}

/// The pieces of the interval as bars at the foot of the slider that was drawn last; an open end goes to the slider's.
void draw_interval(const Parameter& parameter, const FitInterval& interval) {
  const ImVec2 corner = ImGui::GetItemRectMin();
  const ImVec2 end = ImGui::GetItemRectMax();
  const auto at = [&](const std::optional<double>& value, double otherwise) {
    const double position = value ? parameter.slider_position(*value) : otherwise;
    return corner.x + static_cast<float>(position) * (end.x - corner.x);
  };
  constexpr float kThickness = 3.0F;
  for (const auto& [low, high] : interval.pieces) {
    ImGui::GetWindowDrawList()->AddRectFilled({at(low, 0.0), end.y - kThickness}, {at(high, 1.0), end.y},
                                              kIntervalColour);
  }
}

std::string description_of(const Parameter& p, const Session& session) {
  const Key& key = *p.key;
  return fmt::format("{} = {}\n{}\nallowed: {} {}{}{}", key.key, key.meaning, p.equation, key.allowed(), unit_text(key),
                     fallback_text(p, session), intervals_text(p, session));
}

std::string description_of(const Choice& choice) {
  return choice.key->key + ": " + choice.key->meaning + "\n" + choice.equation;
}

/// A line for each built-in material; those without n and k over the spectrum are grey.
void draw_built_in_materials(Session& session, const std::string& current) {
  const auto [from_um, to_um] = spectrum_um(session.scene());
  for (const BuiltInMaterial& known : materials()) {
    const bool is_known = known.from_um <= from_um && to_um <= known.to_um;
    const std::string text = fmt::format("{}, {:g} to {:g} µm", known.name, known.from_um, known.to_um);
    const auto flags = is_known ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
    if (ImGui::Selectable(shown(text).c_str(), known.name == current, flags)) {
      session.set({{"surface.material", known.name}});
    }
    tooltip(known.source + (is_known ? "" : "\nnot known over the spectrum of this scene"));
  }
}

void draw_material(Session& session) {
  const Scene& scene = session.scene();
  const bool is_own = scene.number("surface.n").has_value();
  row_label("material");
  ImGui::SetNextItemWidth(-1.0F);
  constexpr const char* kOwn = "n and k as below";
  const std::string current = is_own ? kOwn : scene.word("surface.material").value_or("file");
  if (!ImGui::BeginCombo("##material", current.c_str(), ImGuiComboFlags_HeightLarge)) {
    tooltip(is_own ? "a built-in material, or n and k of your own" : "N = n + ik of " + surface_name(scene));
    return;
  }
  if (ImGui::Selectable(kOwn, is_own) && !is_own) {
    const auto [n, k] = scene.refractive_index(spectrum_um(scene).first);
    session.set({{"surface.n", n}, {"surface.k", k}});
  }
  draw_built_in_materials(session, current);
  ImGui::EndCombo();
}

void draw_source_kind(Session& session) {
  struct Kind {
    const char* name;
    Setting change;
  };
  static const std::array<Kind, 3> kinds = {{{"E0 as below", {"source.irradiance", 1.0}},
                                             {"e = E0/(πB(T)) as below", {"source.relative_irradiance", 0.6}},
                                             {"the sun", {"source.preset", "sun"}}}};
  const Scene& scene = session.scene();
  const std::size_t now = scene.number("source.irradiance") ? 0 : scene.number("source.relative_irradiance") ? 1 : 2;
  row_label("kind");
  ImGui::SetNextItemWidth(-1.0F);
  if (!ImGui::BeginCombo("##source kind", shown(kinds[now].name).c_str())) return;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (ImGui::Selectable(shown(kinds[i].name).c_str(), i == now) && i != now) session.set({kinds[i].change});
  }
  ImGui::EndCombo();
}

bool has_effect(const Scene& scene, const std::string& table) {
  if (table == "source") return scene.number("source.scale").has_value();
  if (table == "path") return scene.number("path.transmittance").has_value();
  if (table == "surroundings" && scene.word("surroundings.profile")) return true;
  return scene.number(table + ".temperature_K").has_value();
}

/// A box that takes an effect out of the scene, and back in as it was or with values to begin with.
void draw_effect_box(Session& session, const std::string& table) {
  bool wanted = has_effect(session.scene(), table);
  if (!ImGui::Checkbox(table.c_str(), &wanted)) return;
  if (!wanted) {
    session.set({{table, Value()}});
    return;
  }
  session.reset(table);
  if (has_effect(session.scene(), table)) return;
  if (table == "emission") session.set({{"emission.temperature_K", 300.0}});
  if (table == "source") session.set({{"source.preset", "sun"}});
  if (table == "surroundings") session.set({{"surroundings.temperature_K", 250.0}});
  if (table == "path") session.set({{"path.transmittance", 0.9}, {"path.temperature_K", 280.0}});
}

/// The text typed, as a value; the scene refuses text that is no number, and says what is allowed.
Value value_of(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number ? Value(*number) : Value(TomlText{text});
}

}  // namespace

void row_label(const std::string& text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown(text).c_str());
  // The column is as wide as the longest text that is not cut.
  const float longest = ImGui::CalcTextSize(shown("λ1, λ2 [µm]").c_str()).x;
  ImGui::SameLine(std::max(6.2F * ImGui::GetTextLineHeight(), longest + 2.0F * ImGui::GetStyle().ItemSpacing.x));
}

void ControlsPanel::remember_area(const std::string& key) {
  areas_[key] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
}

void ControlsPanel::draw_field(Session& session, const std::string& id, double value,
                               const std::function<Setting(const std::string& text)>& change) {
  draw_taken_field(session, id, value, [&](const std::string& text) {
    session.set({change(text)});
    return session.message().is_error ? session.message().text : "";
  });
}

void ControlsPanel::draw_taken_field(Session& session, const std::string& id, double value,
                                     const NumberFields::Take& take) {
  const std::string before = fields_.reason(id);
  fields_.draw(id, value, take);
  // The message about a text goes when the text is taken back.
  if (!before.empty() && fields_.reason(id).empty() && session.message().text == before) session.tell("");
  remember_area("field " + id);
}

void ControlsPanel::draw_spectrum(Session& session) {
  constexpr const char* kKey = "spectrum.band_um";
  bool is_band = !session.scene().numbers(kKey).empty();
  if (ImGui::Checkbox("band", &is_band)) {
    if (is_band) session.set({{kKey, {8.0, 14.0}}});
    if (!is_band) session.set({{"spectrum.wavelength_um", 10.6}});
  }
  const std::vector<double> ends = session.scene().numbers(kKey);
  if (ends.empty()) return;
  row_label("λ1, λ2 [µm]");
  draw_ends(session, kKey, {ends[0], ends[1]}, [&](const std::string& low, const std::string& high) {
    session.set({{kKey, TomlText{fmt::format("[{}, {}]", low, high)}}});
    return session.message().is_error ? session.message().text : "";
  });
}

void ControlsPanel::draw_ends(Session& session, const std::string& id, const std::array<double, 2>& ends,
                              const std::function<std::string(const std::string&, const std::string&)>& take) {
  const std::array<std::string, 2> ids = {id + " 0", id + " 1"};
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float width = 0.5F * (ImGui::GetContentRegionAvail().x - gap);
  for (std::size_t i = 0; i < 2; ++i) {
    if (i > 0) ImGui::SameLine(0.0F, gap);
    ImGui::SetNextItemWidth(width);
    draw_taken_field(session, ids[i], ends[i], [&](const std::string& text) {
      const std::string typed = fields_.text(ids[1 - i]);
      const std::string other = typed.empty() ? format_number(ends[1 - i]) : typed;
      return i == 0 ? take(text, other) : take(other, text);
    });
  }
  for (const std::string& one : ids) show_reason(one);
}

void ControlsPanel::show_reason(const std::string& id) const {
  if (const std::string reason = fields_.reason(id); !reason.empty()) coloured_text(kErrorColour, reason);
}

void ControlsPanel::draw_choice(Session& session, const Choice& choice, std::size_t word) {
  const std::string& key = choice.key->key;
  const std::vector<std::string>& words = choice.key->words;
  row_label(choice.label);
  const std::string id = "##" + key;
  if (choice.is_flag()) {
    bool is_set = word != 0;
    if (ImGui::Checkbox(id.c_str(), &is_set)) session.set({{key, is_set}});
    remember_area(key);
    tooltip(description_of(choice));
    return;
  }
  ImGui::SetNextItemWidth(-1.0F);
  const ImVec2 corner = ImGui::GetCursorScreenPos();  // an open list is an item of its own
  areas_[key] = {corner, {corner.x + ImGui::CalcItemWidth(), corner.y + ImGui::GetFrameHeight()}};
  if (!ImGui::BeginCombo(id.c_str(), words[word].c_str())) {
    tooltip(description_of(choice));
    return;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (ImGui::Selectable(words[i].c_str(), i == word)) session.set({{key, TomlText{words[i]}}});
  }
  ImGui::EndCombo();
}

void ControlsPanel::draw_choices(Session& session, const std::string& table) {
  for (const Choice& choice : choices()) {
    if (table_of(choice.key->key) != table) continue;
    if (const auto word = choice.word(session.scene())) draw_choice(session, choice, *word);
  }
}

void ControlsPanel::draw_fit_box(Session& session, const Parameter& parameter) {
  const std::string& key = parameter.key->key;
  bool varies = session.varies(key);
  if (ImGui::Checkbox("##vary", &varies)) session.mark(key, varies);
  remember_area("vary " + key);
  tooltip("varies in a fit to the measured points, over the range below its slider");
  ImGui::SameLine();
}

void ControlsPanel::draw_fit_range(Session& session, const Parameter& parameter, double value) {
  const std::string& key = parameter.key->key;
  if (!session.residuals().data() || !session.varies(key)) return;
  const FitRange range = session.fit_range(parameter, value);
  row_label("  fit from, to");
  draw_ends(session, "fit " + key, {range.low, range.high},
            [&](const std::string& low, const std::string& high) { return session.set_fit_range(key, low, high); });
}

void ControlsPanel::draw_parameter(Session& session, const Parameter& parameter, double value) {
  const Key& key = *parameter.key;
  const std::string unit = unit_text(key);
  row_label(unit.empty() ? parameter.symbol : fmt::format("{} [{}]", parameter.symbol, unit));
  ImGui::PushID(key.key.c_str());
  if (session.residuals().data() && !key.key.starts_with("accuracy.")) draw_fit_box(session, parameter);
  const float typed_width = 5.2F * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(-typed_width - ImGui::GetStyle().ItemSpacing.x);
  auto position = static_cast<float>(parameter.slider_position(value));
  const bool is_moved = ImGui::SliderFloat("##slider", &position, 0.0F, 1.0F, "", ImGuiSliderFlags_NoInput);
  remember_area(key.key);
  if (const FitParameter* found = session.fitted(key.key)) draw_interval(parameter, found->interval_68);
  const bool is_ctrl = ImGui::GetIO().KeyCtrl;
  if (ImGui::IsItemClicked() && is_ctrl) session.reset(key.key);
  if (is_moved && !is_ctrl) session.set(key.key, parameter.slider_value(static_cast<double>(position)));
  if (!ImGui::IsItemActive()) tooltip(description_of(parameter, session));
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1.0F);
  draw_field(session, key.key, value, [&](const std::string& text) { return Setting{key.key, value_of(text)}; });
  show_reason(key.key);
  draw_fit_range(session, parameter, value);
  ImGui::PopID();
}

void ControlsPanel::draw_table(Session& session, const std::string& table) {
  for (const Parameter& parameter : parameters()) {
    if (table_of(parameter.key->key) != table) continue;
    // Again from the scene for each, because the one before may have changed it.
    if (const auto value = parameter.value(session.scene())) draw_parameter(session, parameter, *value);
  }
}

void ControlsPanel::draw(Session& session) {
  areas_.clear();
  heading("Surface");
  draw_material(session);
  draw_choices(session, "surface");
  draw_table(session, "surface");
  heading("Radiation");
  draw_effect_box(session, "emission");
  draw_choices(session, "emission");
  draw_table(session, "emission");
  draw_effect_box(session, "source");
  if (has_effect(session.scene(), "source")) draw_source_kind(session);
  draw_table(session, "source");
  draw_effect_box(session, "surroundings");
  if (has_effect(session.scene(), "surroundings")) draw_sky(session);
  draw_table(session, "surroundings");
  draw_effect_box(session, "path");
  draw_table(session, "path");
  heading("Spectrum and geometry");
  draw_spectrum(session);
  draw_table(session, "spectrum");
  draw_choices(session, "geometry");
  draw_table(session, "geometry");
}

void ControlsPanel::draw_accuracy(Session& session) {
  draw_table(session, "accuracy");
  draw_choices(session, "accuracy");
}

}  // namespace dolp::explore
