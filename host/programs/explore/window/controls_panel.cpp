#include "explore/window/views.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "base/text.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kSkyProfile = "surroundings.profile";
constexpr const char* kUniformSky = "surroundings.temperature_K";
constexpr double kUniformSky_K = 250.0;  // temperature of a new uniform sky

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

void heading(const char* text) {
  ImGui::Spacing();
  coloured_text(kHeadingColour, text);
  ImGui::Separator();
}

/// Marks a fitted interval at the lower edge of the slider drawn last. Draws an open end at the slider's end.
void draw_interval(const Scale& slider, const FitInterval& interval) {
  const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  const auto at = [&](const std::optional<double>& value, double otherwise) {
    const double position = value ? slider.position(slider.clamp(*value)) : otherwise;
    return corner.x + static_cast<float>(position) * (end.x - corner.x);
  };
  constexpr float kThickness = 3.0F;
  for (const auto& [low, high] : interval.pieces) {
    ImGui::GetWindowDrawList()->AddRectFilled({at(low, 0.0), end.y - kThickness}, {at(high, 1.0), end.y},
                                              kIntervalColour);
  }
}

std::string note_on(const Control& control, const Session& session) {
  const Key& key = *control.key;
  std::string note =
      fmt::format("{} = {}\n{}\nallowed: {} {}", key.key, key.meaning, control.equation, key.allowed(), unit_text(key));
  const bool has_other_films =
      key.layer > 0 && std::ranges::count(session.edits().changes(), "surface.coating", &Setting::key) > 0;
  const std::optional<double> opened = control.value(session.edits().opened());
  if (opened && !has_other_films) note += fmt::format("\nCtrl-click: {:.6g}, as opened", *opened);
  if (const FitParameter* const found = session.fitted(key.key))
    note += fmt::format("\n68 %: {}\n95 %: {}", interval_text(found->interval_68), interval_text(found->interval_95));
  return note;
}

/// n and k of the surface or film whose keys are in `table`, at the first wavelength of the scene's spectrum.
std::pair<double, double> material_index(const Scene& scene, const std::string& table) {
  Scene bare = scene.without("surface.coating");
  for (const char* name : {"material", "material_file"}) {
    if (const auto word = scene.word(table + '.' + name)) bare = bare.with(std::string("surface.") + name, *word);
  }
  return bare.refractive_index(spectrum_um(scene).first);
}

/// The number in a typed text. If the text is not a number, returns a value that the scene will refuse with a reason.
Value parse_value(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number ? Value(*number) : Value(TomlText{text});
}

struct Controls {
  Session& session;
  ControlState& state;
  NumberFields& fields = state.fields;
  ControlRows& rows = state.rows;

  std::string set(const Setting& change) {  // returns the reason if the change is refused
    session.set({change});
    return session.message().is_error ? session.message().text : "";
  }

  /// Calls `draw`. If the field `id` then no longer has an error, also removes this error from the session's message.
  void draw_fields(const std::string& id, const std::function<void()>& draw) {
    const std::string before = fields.reason(id);
    draw();
    if (!before.empty() && fields.reason(id).empty() && session.message().text == before) session.tell("");
  }

  void draw_ends(const std::string& id, const std::array<double, 2>& ends, const NumberFields::ApplyEnds& apply) {
    const std::array<std::string, 2> ids = {id + " 0", id + " 1"};
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = 0.5F * (ImGui::GetContentRegionAvail().x - gap);
    for (const std::size_t end : {0U, 1U}) {
      if (end > 0) ImGui::SameLine(0.0F, gap);
      ImGui::SetNextItemWidth(width);
      draw_fields(ids[end], [&] { fields.draw_end(id, end, ends, apply); });
    }
    for (const std::string& field : ids) fields.draw_reason(field);
  }

  /// Draws a slider with a text field beside it, and below it the range for a fit.
  void draw_number(const Control& control, double value) {
    const std::string& key = control.key->key;
    const Scale scale = range_in(session.scene(), control);
    row_label(control.label_with_unit());
    if (bool varies = session.varies(key); session.residuals().data() && !key.starts_with("accuracy.")) {
      if (ImGui::Checkbox(("##vary " + key).c_str(), &varies)) session.mark(key, varies);
      name_item("vary " + key);
      tooltip("varies in a fit to the measured points, over the range below its slider");
      ImGui::SameLine();
    }
    ImGui::SetNextItemWidth(-5.2F * ImGui::GetFontSize() - ImGui::GetStyle().ItemSpacing.x);
    auto position = static_cast<float>(scale.position(scale.clamp(value)));
    const std::string id = "##slider " + key;
    const bool is_moved = ImGui::SliderFloat(id.c_str(), &position, 0.0F, 1.0F, "", ImGuiSliderFlags_NoInput);
    name_item(key);
    if (const FitParameter* found = session.fitted(key)) draw_interval(scale, found->interval_68);
    const bool is_ctrl = ImGui::GetIO().KeyCtrl;
    if (ImGui::IsItemClicked() && is_ctrl) session.reset(key);
    if (is_moved && !is_ctrl)
      session.set(key, parse_value(format_number(scale.rounded(static_cast<double>(position)))));
    if (!ImGui::IsItemActive()) tooltip(note_on(control, session));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0F);
    draw_fields(key, [&] {
      fields.draw(key, value, [&](const std::string& text) { return set({key, parse_value(text)}); });
    });
    fields.draw_reason(key);
    const std::string fit_row = "fit " + key;
    if (session.varies(key)) rows.note(fit_row);
    if (!session.residuals().data() || !rows.has(fit_row)) return;
    ImGui::BeginDisabled(!session.varies(key));
    const FitRange range = fit_range(session.marked(), session.scene(), control, value);
    row_label("  fit from, to");
    draw_ends(fit_row, {range.low, range.high},
              [&](const std::string& low, const std::string& high) { return session.set_fit_range(key, low, high); });
    ImGui::EndDisabled();
  }

  void draw_choice(const Control& control, std::size_t position) {
    const std::string& key = control.key->key;
    const std::vector<std::string>& words = control.key->words;
    const std::string note = key + ": " + control.key->meaning + "\n" + control.equation;
    row_label(control.label);
    if (bool is_set = position != 0; control.key->type == Key::Type::kFlag) {
      if (ImGui::Checkbox(("##" + key).c_str(), &is_set)) session.set(key, is_set);
      name_item(key);
      tooltip(note);
    } else if (const auto clicked =
                   draw_list({key, -1.0F, words[position], note, position, {words.begin(), words.end()}})) {
      session.set(key, TomlText{words[*clicked]});
    }
  }

  /// The value of a control that the scene does not use: n or k of the surface's material, otherwise "".
  std::string unused_value(const Control& control) const {
    const bool is_n = control.key->key == "surface.n", is_k = control.key->key == "surface.k";
    if ((!is_n && !is_k) || !control.may_apply(session.scene())) return "";
    try {
      const double at_um = spectrum_um(session.scene()).first;
      const auto [n, k] = session.scene().refractive_index(at_um);
      return fmt::format("{:.4g} at {:.4g} µm", is_n ? n : k, at_um);
    } catch (const InputError&) {
      return "";  // the file of the material has no value at this wavelength
    }
  }

  /// Draws a greyed row in the place of a control that the scene no longer uses.
  void draw_unused(const Control& control) {
    ImGui::BeginDisabled();
    row_label(control.label_with_unit());
    ImGui::SetNextItemWidth(-1.0F);
    std::string text = shown(unused_value(control));
    ImGui::InputText(("##unused " + control.key->key).c_str(), &text, ImGuiInputTextFlags_ReadOnly);
    ImGui::EndDisabled();
    name_item("unused " + control.key->key);
    tooltip(unused_text(session.scene(), control));
  }

  /// Draws a control with its value, or its greyed row if the scene does not use it and the row stays.
  void draw(const Control& control) {
    const Scene& scene = session.scene();  // as it is now: an earlier control may have changed it
    if (control.applies(scene)) rows.note(control.key->key);
    if (const auto number = control.value(scene)) return draw_number(control, *number);
    if (const auto word = control.word(scene)) return draw_choice(control, *word);
    if (rows.stays(scene, control)) draw_unused(control);
  }

  void draw_table(const std::string& table) {
    for (const Control& control : controls()) {
      if (parent_table(control.key->key) == table) draw(control);
    }
  }

  /// Draws the list of materials for the surface or a film. Returns the settings that give it the material that the
  /// user chooses.
  std::vector<Setting> draw_material(const std::string& table) {
    static const std::vector<BuiltInMaterial> known = sorted_materials();
    constexpr std::size_t kTyped = 0, kFile = 1, kBuiltIn = 2;  // positions in the list
    const Scene& scene = session.scene();
    const bool is_typed = control(table + ".n").value(scene).has_value();
    const std::string file = file_name(scene.word(table + ".material_file").value_or("own file"));
    const std::string current = is_typed ? "n and k as below" : scene.word(table + ".material").value_or(file);
    const auto now = std::ranges::find(known, current, &BuiltInMaterial::name);
    std::optional<std::size_t> chosen;
    if (is_typed) chosen = kTyped;
    if (now != known.end()) chosen = static_cast<std::size_t>(now - known.begin()) + kBuiltIn;
    const auto [from_um, to_um] = spectrum_um(scene);
    std::vector<ListEntry> entries = {{"n and k as below"}, {"own file…", "a file of n and k over the wavelength"}};
    for (const BuiltInMaterial& material : known) {
      const bool is_known = material.from_um <= from_um && to_um <= material.to_um;
      entries.push_back({fmt::format("{}, {:g} to {:g} µm", material.name, material.from_um, material.to_um),
                         material.source + (is_known ? "" : "\nnot known over the spectrum of this scene"), is_known,
                         material.kind});
    }
    row_label("material");
    const std::string note = is_typed ? "a built-in material, or your n and k" : "N = n + ik of " + surface_name(scene);
    const auto clicked = draw_list({table + ".material", -1.0F, current, note, chosen, entries}, &state.search);
    if (!clicked) return {};
    if (*clicked == kFile) state.wanted_file = table;
    if (*clicked == kFile) return {};
    if (*clicked >= kBuiltIn) return medium_change(scene, table, {{"material", known[*clicked - kBuiltIn].name}});
    const auto [n, k] = material_index(scene, table);
    return medium_change(scene, table, {{"n", n}, {"k", k}});
  }

  void draw_coating() {
    heading("Coating, from the outside in");
    std::vector<Film> films = scene_films(session.scene());
    const bool is_added = ImGui::Button("Add a film outside");
    name_item("add film");
    if (is_added) films.insert(films.begin(), {{"n", 1.5}, {"k", 0.0}, {"thickness_um", 1.0}});
    if (is_added) return session.set({coating_setting(films)});
    for (std::size_t layer = 1; layer <= films.size(); ++layer) {
      const std::string film = fmt::format("surface.coating.{}", layer);
      const bool is_removed = ImGui::SmallButton(("x##" + film).c_str());
      name_item("remove " + film);
      ImGui::SameLine();
      coloured_text(kTextColour, fmt::format("film {}", layer));
      const std::vector<Setting> chosen = draw_material(film);
      if (is_removed) films.erase(films.begin() + static_cast<std::ptrdiff_t>(layer) - 1);
      if (is_removed) return session.set({coating_setting(films)});
      if (!chosen.empty()) return session.set(chosen);
      draw_table(film);
    }
  }

  void draw_source_kind() {
    const Scene& scene = session.scene();
    const std::size_t now = scene.number("source.irradiance") ? 0 : scene.number("source.relative_irradiance") ? 1 : 2;
    const std::vector<ListEntry> kinds = {{"E0 as below"}, {"e = E0/(πB(T)) as below"}, {"the sun"}};
    const std::array<Setting, 3> changes = {
        {{"source.irradiance", 1.0}, {"source.relative_irradiance", 0.6}, {"source.preset", "sun"}}};
    row_label("kind");
    if (const auto clicked = draw_list({"source kind", -1.0F, kinds[now].text, "", now, kinds})) set(changes[*clicked]);
  }

  /// Draws a check box that removes an effect, or restores it from the opened scene or with default values.
  void draw_effect_box(const std::string& table) {
    bool wanted = has_effect(session.scene(), table);
    if (!ImGui::Checkbox(table.c_str(), &wanted)) return;
    if (!wanted) return session.set({{table, Value()}});
    session.reset(table);
    if (has_effect(session.scene(), table)) return;
    if (table == "emission") session.set({{"emission.temperature_K", 300.0}});
    if (table == "source") session.set({{"source.preset", "sun"}});
    if (table == "surroundings") session.set({{"surroundings.temperature_K", 250.0}});
    if (table == "path") session.set({{"path.transmittance", 0.9}, {"path.temperature_K", 280.0}});
  }

  void draw_sky() {
    const std::string opened = session.edits().opened().word(kSkyProfile).value_or("");
    std::vector<ListEntry> skies = {{"uniform"}, {"clear-sky"}, {"overcast"}, {"zenith and horizon"}};
    if (!opened.empty() && std::ranges::count(skies, opened, &ListEntry::text) == 0)
      skies.push_back({file_name(opened)});
    const std::string current = session.scene().word(kSkyProfile).value_or("");
    const std::string name = !current.empty()                   ? file_name(current)
                             : has_sky_profile(session.scene()) ? "zenith and horizon"
                                                                : "uniform";
    const auto position = static_cast<std::size_t>(std::ranges::find(skies, name, &ListEntry::text) - skies.begin());
    row_label("sky");
    const auto clicked =
        draw_list({"sky", -1.0F, name, fmt::format("{} {}: {}", kSkyProfile, current, described(kSkyProfile).meaning),
                   position, skies});
    if (!clicked) return;
    if (*clicked == 0) {
      session.set(kUniformSky, session.edits().opened().number(kUniformSky).value_or(kUniformSky_K));
    } else if (*clicked == 3) {
      session.set({{kZenithSky, 220.0}, {kHorizonSky, 285.0}});
    } else {
      session.set(kSkyProfile, *clicked < 3 ? skies[*clicked].text : opened);
    }
  }

  void draw_spectrum() {
    constexpr const char* kKey = "spectrum.band_um";
    bool is_band = !session.scene().numbers(kKey).empty();
    if (ImGui::Checkbox("band", &is_band))
      set(is_band ? Setting{kKey, {8.0, 14.0}} : Setting{"spectrum.wavelength_um", 10.6});
    const std::vector<double> ends = session.scene().numbers(kKey);
    if (ends.empty()) return draw(control("spectrum.wavelength_um"));
    row_label("λ1, λ2 [µm]");
    draw_ends(kKey, {ends[0], ends[1]}, [&](const std::string& low, const std::string& high) {
      return set({kKey, TomlText{fmt::format("[{}, {}]", low, high)}});
    });
  }

  void draw_response() {
    const std::string file = session.scene().word("spectrum.response_file").value_or("");
    draw(control("spectrum.response_per"));
    if (!rows.has("spectrum.response_per")) return;
    coloured_text(kDimColour, file.empty() ? "no response of the camera"
                                           : file_name(file) + "; a change of λ1 or λ2 makes it a band");
  }

  void draw_all() {
    rows.follow(session.edits().opened());
    heading("Surface");
    if (const std::vector<Setting> chosen = draw_material("surface"); !chosen.empty()) session.set(chosen);
    draw_table("surface");
    draw_coating();
    heading("Radiation");
    for (const char* effect : {"emission", "source", "surroundings", "path"}) {
      draw_effect_box(effect);
      const bool is_there = has_effect(session.scene(), effect);
      if (is_there) rows.note(effect);
      if (!rows.has(effect)) continue;
      ImGui::BeginDisabled(!is_there);
      if (effect == std::string_view("source")) draw_source_kind();
      if (effect == std::string_view("surroundings")) draw_sky();
      ImGui::EndDisabled();
      draw_table(effect);
    }
    heading("Spectrum and geometry");
    draw_spectrum();
    draw_response();
    draw_table("geometry");
  }
};

}  // namespace

void draw_controls(Session& session, ControlState& state) { Controls{session, state}.draw_all(); }
void draw_accuracy_controls(Session& session, ControlState& state) { Controls{session, state}.draw_table("accuracy"); }

}  // namespace dolp::explore
