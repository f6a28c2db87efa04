#pragma once

#include <dolp/dolp.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "explore/scale.hpp"

namespace dolp::explore {

/// The control of a scene key in the window: a slider for a number, a list for a word, a check box for a flag.
struct Control {
  /// What a scene needs to use a key. By default every scene that has the key uses it.
  struct Need {
    bool (*is_met)(const Scene& scene) = nullptr;
    const char* text = "";
  };

  const Key* key;
  std::string label;     ///< symbol of a number, or name of a choice, in UTF-8
  const char* equation;  ///< formula or explanation for a tooltip, in UTF-8
  Scale slider = {};     ///< range of the slider; the user can also type other values
  Need need = {};
  /// The value, or the key of another number, that replaces an omitted number. Empty: then no number is used.
  std::string standard = {};

  /// The scene's number; empty for words, and if the scene does not use the key.
  std::optional<double> value(const Scene& scene) const;
  /// The position of the scene's word in Key::words; empty for numbers, and if the scene does not use the key.
  std::optional<std::size_t> word(const Scene& scene) const;
  std::string label_with_unit() const;    ///< for a number with a unit: "λ [µm]"
  std::string text(double number) const;  ///< "λ 10 µm"
  bool may_apply(const Scene& scene) const { return !need.is_met || need.is_met(scene); }
  bool applies(const Scene& scene) const { return value(scene) || word(scene); }
  bool is_number() const { return key->type == Key::Type::kNumber; }
};

const Key& described(const std::string& key);  ///< description of a scene key, which must exist

/// The controls of all keys that the window can change. The keys of the films (n, k, thickness) come last.
const std::vector<Control>& controls();

const Control& control(std::string_view key);  ///< the control of a scene key, which must have one
/// The part of the slider's range that the masking allows, and the scene's other slope width if there is one.
Scale range_in(const Scene& scene, const Control& control);
std::string parent_table(const std::string& key);  ///< "surface.coating.1" of "surface.coating.1.n"
std::string unit_text(const Key& key);             ///< unit for display: "°" for "degree", "" for "1"
bool is_bistatic(const Scene& scene);

/// The rows of controls in the panel of the scene. A row that was once shown stays in its place, greyed, until another
/// scene is opened. So a choice never moves the controls below it by removing rows.
class ControlRows {
 public:
  void follow(const Scene& opened);  ///< forgets all rows if `opened` is another scene file
  bool has(const std::string& row) const { return shown_.contains(row); }
  void note(const std::string& row) { shown_.insert(row); }
  /// True if the scene does not use the control but its row was shown before, and no alternative to it has a row.
  bool stays(const Scene& scene, const Control& control) const;

 private:
  std::string opened_;
  std::set<std::string> shown_;
};

std::string unused_text(const Scene& scene, const Control& control);  ///< why the scene does not use the control

/// The surface of a scene in few words: "cauchy σ 0.15 q 3, smith, n 1.5 k 0.1". If `other` is given, omits each word
/// before the material that is the same for `other`. If the surfaces are equal, adds what else differs: "T 300 K".
std::string surface_name(const Scene& scene, const Scene* other = nullptr);

std::string slopes_name(const Scene& scene);    ///< the slope distribution: "cauchy σ 0.15 q 3"
std::string material_name(const Scene& scene);  ///< the material of the surface, and its films

inline constexpr const char* kSigmaCross = "surface.sigma_cross";
inline constexpr const char* kSurfaceAzimuth = "geometry.surface_azimuth_deg";

/// A scene file with changes. `dolp eval` computes the same results from the file if --set makes the same changes.
class SceneEdits {
 public:
  explicit SceneEdits(const Scene& opened) : opened_(opened), scene_(opened), saved_(opened.settings()) {}
  SceneEdits(const Scene& opened, const std::vector<Setting>& changes) : SceneEdits(opened) { become(changes); }

  /// Sets keys. A new key removes its alternatives: `material` removes n and k. An empty value for the name of a table,
  /// such as "source", removes the table. Errors: InputError; the scene then stays unchanged.
  void set(const std::vector<Setting>& changes);

  /// Restores a key or a whole table of the opened scene. Errors: the errors of set().
  void reset(const std::string& key);
  void reset_all() { scene_ = opened_; }

  const Scene& scene() const { return scene_; }
  const Scene& opened() const { return opened_; }
  bool is_changed() const { return changes() != saved_; }
  void note_saved() { saved_ = changes(); }  ///< makes is_changed() false until the next change
  /// Becomes a copy of `other`. If both have the same scene file, keeps the changes that note_saved() stored.
  void go_to(const SceneEdits& other);
  bool is_same_scene(const SceneEdits& other) const { return is_same_file(other) && changes() == other.changes(); }
  const std::vector<Setting>& changes() const { return scene_.settings(); }  ///< initially opened().settings()
  std::vector<Setting> changes_without(const std::vector<std::string>& keys) const;

 private:
  bool is_same_file(const SceneEdits& other) const;
  void become(const std::vector<Setting>& changes) {
    scene_ = Scene::from_text(opened_.text(), changes, opened_.name());
  }

  Scene opened_;
  Scene scene_;
  std::vector<Setting> saved_;
};

/// The settings of a film: first n and k, or material, or material_file; then thickness_um.
using Film = std::vector<Setting>;
std::vector<Film> scene_films(const Scene& scene);        ///< the outermost film first
Setting coating_setting(const std::vector<Film>& films);  ///< setting that gives a scene these films
/// The settings that give the surface, or the film whose keys are in `table`, another medium, such as {{"material",
/// "iron"}}.
std::vector<Setting> medium_change(const Scene& scene, const std::string& table, const std::vector<Setting>& medium);
inline constexpr const char* kZenithSky = "surroundings.zenith_temperature_K";
inline constexpr const char* kHorizonSky = "surroundings.horizon_temperature_K";
bool has_sky_profile(const Scene& scene);  ///< the radiance of the surroundings depends on the zenith
/// True if the scene has the part of the radiation in `table`: "emission", "source", "surroundings" or "path".
bool has_effect(const Scene& scene, const std::string& table);
std::optional<BuiltInMaterial> built_in_material(const Scene& scene);  ///< material of the surface, if it is built in
std::vector<BuiltInMaterial> sorted_materials();  ///< the materials of one kind after the other, each kind by name
/// True if `text` contains each word of `search`. Ignores case.
bool has_words(const std::string& text, const std::string& search);
std::string plain_text(const Value& value);  ///< text of a value, without quotes

/// Applies `change`. If it conflicts with earlier choices in the scene, also replaces those that must be replaced, and
/// returns their new values. Errors: InputError if the scene refuses `change` all the same; `edits` is then unchanged.
std::vector<Setting> change_with_needed(SceneEdits& edits, const std::function<void(SceneEdits&)>& change);

}  // namespace dolp::explore
