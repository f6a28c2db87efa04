#include "explore/session_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <utility>

#include "base/atomic_file.hpp"
#include "explore/toml_file.hpp"

namespace dolp::explore {
namespace {

constexpr int kVersion = 1;  // of the file
constexpr const char* kVersionKey = "dolp_session";

struct Flag {
  const char* key;
  bool View::*flag;
};
constexpr std::array kFlags = {Flag{"log", &View::is_log}, Flag{"overlay", &View::has_overlay},
                               Flag{"keep_all", &View::keeps_all}};

std::vector<std::string> texts_of(const std::vector<Setting>& settings) {
  std::vector<std::string> texts;
  for (const Setting& setting : settings) texts.push_back(setting.text());
  return texts;
}

class Writer {
 public:
  explicit Writer(const std::string& path) : folder_(std::filesystem::absolute(path).parent_path()) {}

  std::string path_text(const std::string& path) const { return std::filesystem::proximate(path, folder_).string(); }
  toml::table scene_table(const Scene& scene) const {
    return toml::table{
        {"file", path_text(scene.name())}, {"text", scene.text()}, {"changes", array_of(texts_of(scene.settings()))}};
  }
  toml::table edits_table(const SceneEdits& edits) const {
    toml::table table = scene_table(edits.scene());
    table.insert("opened_with", array_of(texts_of(edits.opened().settings())));
    return table;
  }

 private:
  std::filesystem::path folder_;
};

toml::table view_table(const Session& session) {
  const View& view = session.view();
  toml::table table{{"quantity", described(view.quantity).name},
                    {"theta_max_deg", view.theta_max_deg},
                    {"map", array_of({description_of(view.map_x).name, description_of(view.map_y).name})},
                    {"panel", kPanels.at(static_cast<std::size_t>(view.panel)).name},
                    {"cursor_deg", session.theta_deg()}};
  for (const Flag& flag : kFlags) table.insert(flag.key, view.*flag.flag);
  return table;
}

/// Values of a file, with messages that name their place.
class Reader {
 public:
  Reader(std::string path, const toml::table& table, std::string place = {})
      : path_(std::move(path)), place_(std::move(place)), table_(table) {}

  template <class T>
  T value(const char* key, const std::optional<T>& otherwise = std::nullopt) const {
    const toml::node* const node = table_.get(key);
    if (!node && otherwise) return *otherwise;
    const std::optional<T> found = node ? node->value<T>() : std::nullopt;
    return found ? *found : refuse<T>(key, node ? "is of another kind" : "is missing");
  }
  /// One of `choices`, by its name.
  template <class Choices, class Name>
  auto choice(const std::string& key, const std::string& text, const Choices& choices, const Name& name) const {
    const auto found = std::ranges::find_if(choices, [&](const auto& one) { return text == name(one); });
    if (found == choices.end()) refuse<int>(key, '"' + text + "\" is unknown");
    return *found;
  }
  std::vector<Reader> tables(const char* key) const {
    std::vector<Reader> found;
    const toml::array* const array = table_[key].as_array();
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      const toml::table* const table = (*array)[i].as_table();
      const std::string name = fmt::format("{}[{}]", key, i);
      if (!table) refuse<int>(name, "is no table");
      found.emplace_back(path_, *table, place_ + name + '.');
    }
    return found;
  }
  Reader table(const char* key) const {
    const toml::table* const table = table_[key].as_table();
    if (!table) refuse<int>(key, "is missing");
    return {path_, *table, place_ + key + '.'};
  }
  std::vector<std::string> strings(const char* key) const { return strings_in(table_, key); }
  std::string file(const char* key) const {
    const auto file = std::filesystem::path(path_).parent_path() / value<std::string>(key);
    return file.lexically_normal().string();
  }
  bool has(const char* key) const { return table_.contains(key); }
  Scene scene(const char* settings) const {
    return Scene::from_text(value<std::string>("text"), settings_from_text(strings(settings)), file("file"));
  }
  SceneEdits edits() const { return {scene("opened_with"), settings_from_text(strings("changes"))}; }

 private:
  template <class T>
  T refuse(const std::string& key, const std::string& why) const {
    throw InputError(path_ + ": " + place_ + key + ' ' + why);
  }

  std::string path_, place_;
  const toml::table& table_;
};

View view_in(const Reader& file) {
  View view;
  view.quantity = file.choice("quantity", file.value<std::string>("quantity"), kAllPlotted,
                              [](const auto& of) { return std::string(of.name); })
                      .quantity;
  view.panel = file.choice("panel", file.value<std::string>("panel"), kPanels,
                           [](const auto& of) { return std::string(of.name); })
                   .panel;
  view.theta_max_deg = file.value<double>("theta_max_deg", view.theta_max_deg);
  const std::vector<std::string> map = file.strings("map");
  const auto axis = [&](std::size_t i, Axis otherwise) {
    const auto name = [](Axis one) { return std::string(description_of(one).name); };
    return i < map.size() ? file.choice("map", map[i], kMapAxes, name) : otherwise;
  };
  view.map_x = axis(0, view.map_x);
  view.map_y = axis(1, view.map_y);
  for (const Flag& flag : kFlags) view.*flag.flag = file.value<bool>(flag.key, view.*flag.flag);
  return view;
}

SavedSession session_in(const std::string& path, const toml::table& table) {
  const Reader file(path, table);
  if (file.value<int>(kVersionKey) != kVersion)
    throw InputError(fmt::format("{}: {} is not {}: the session of another version", path, kVersionKey, kVersion));
  SavedSession saved{.edits = file.table("scene").edits()};
  for (const Reader& pin : file.tables("pins")) {
    saved.pins.push_back({pin.value<std::string>("name", ""), pin.value<bool>("visible", true), pin.scene("changes")});
  }
  for (const Reader& one : file.tables("snapshots"))
    saved.snapshots.push_back({one.value<std::string>("name"), one.edits()});
  const Reader view = file.table("view");
  saved.view = view_in(view);
  saved.theta_deg = view.value<double>("cursor_deg", saved.theta_deg);
  if (file.has("measured")) saved.measured = MeasuredData::read(file.file("measured"));
  saved.marked = file.strings("vary");
  return saved;
}

}  // namespace

void save_session(const Session& session, const std::string& path) {
  const Writer writer(path);
  toml::table file{{kVersionKey, kVersion},
                   {"scene", writer.edits_table(session.edits())},
                   {"view", view_table(session)},
                   {"vary", array_of(session.marked())}};
  if (const auto& data = session.residuals().data()) file.insert("measured", writer.path_text(data->name));
  toml::array pins, snapshots;
  for (const Pin& pin : session.pins()) {
    toml::table table = writer.scene_table(pin.curve.scene());
    table.insert("name", pin.name);
    table.insert("visible", pin.is_visible);
    pins.push_back(std::move(table));
  }
  for (const Snapshot& one : session.snapshots()) {
    toml::table table = writer.edits_table(one.edits);
    table.insert("name", one.name);
    snapshots.push_back(std::move(table));
  }
  file.insert("pins", std::move(pins));
  file.insert("snapshots", std::move(snapshots));
  std::ostringstream text;
  text << file << '\n';
  write_text_atomically(path, text.str());
}

bool is_session_file(const std::string& path) {
  std::error_code unknown;
  try {
    return std::filesystem::is_regular_file(path, unknown) && read_toml(path).contains(kVersionKey);
  } catch (const InputError&) {
    return false;
  }
}

void open_file(Session& session, const std::string& path) {
  if (std::filesystem::path(path).extension() == ".csv") return session.load_measured(path);
  const toml::table table = read_toml(path);
  if (table.contains(kVersionKey)) {
    session.restore(session_in(path, table));
  } else {
    session.go_to(SceneEdits(Scene::from_file(path)));
  }
}

}  // namespace dolp::explore
