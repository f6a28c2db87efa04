#include "explore/session_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <type_traits>
#include <utility>

#include "base/atomic_file.hpp"
#include "base/text.hpp"
#include "explore/toml_file.hpp"

namespace dolp::explore {
namespace {

constexpr int kVersion = 1;  // of the file
constexpr const char* kVersionKey = "dolp_session";

struct Flag {
  const char* key;
  bool View::*flag;
};
constexpr std::array kFlags = {Flag{"log", &View::is_log}, Flag{"theta_log", &View::is_theta_log},
                               Flag{"overlay", &View::has_overlay}, Flag{"keep_all", &View::keeps_all}};

// Ranges in a file, but for those of the map's axes, which have their labels.
constexpr const char* kZenithRange = "curve zenith";
constexpr const char* kValueRange = "curve values";
constexpr const char* kColourRange = "map colours";

using Node = toml::node_view<const toml::node>;

toml::array texts_of(const std::vector<Setting>& settings) {
  toml::array texts;
  for (const Setting& setting : settings) texts.push_back(setting.text());
  return texts;
}

/// "KEY", or "KEY=LOW:HIGH" with a range that was typed.
std::vector<std::string> texts_of(const FitMarks& marks) {
  std::vector<std::string> texts;
  for (const auto& [key, own] : marks)
    texts.push_back(own ? fmt::format("{}={}:{}", key, format_number(own->low), format_number(own->high)) : key);
  return texts;
}

FitMarks marks_in(const std::vector<std::string>& texts, const std::string& place) {
  FitMarks marks;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    std::optional<FitRange>& own = marks[text.substr(0, equals)];
    try {
      if (equals != std::string::npos) own = FitRange::from_text(text);
    } catch (const InputError& error) {
      throw InputError(place + error.what());
    }
  }
  return marks;
}

/// Writes states of scenes for the file of a session.
class StateWriter {
 public:
  StateWriter(const SkyFiles& skies, const std::filesystem::path& file)
      : skies_(skies), file_(std::filesystem::absolute(file).lexically_normal()) {}

  /// A scene as it was opened, with its changes and a name.
  toml::table table(const SceneEdits& edits, const std::string& name) const {
    const Scene& opened = edits.opened();
    return toml::table{{"name", name},
                       {"file", std::filesystem::proximate(opened.name(), file_.parent_path()).string()},
                       {"text", opened.text()},
                       {"opened_with", texts_of(lasting(opened.settings(), opened))},
                       {"changes", texts_of(lasting(edits.changes(), opened))}};
  }

 private:
  /// Settings that name a copy beside the session's file instead of a sky's file that goes with the window.
  std::vector<Setting> lasting(std::vector<Setting> settings, const Scene& scene) const {
    for (Setting& setting : settings) {
      if (setting.key != "surroundings.profile" || !skies_.hold(word_of(setting.value))) continue;
      const std::filesystem::path sky = word_of(setting.value);
      const std::filesystem::path copy = file_.parent_path() / (file_.stem().string() + "_" + sky.filename().string());
      write_text_atomically(copy, read_named_file(sky.string(), sky.string() + ": "));
      const std::filesystem::path folder = std::filesystem::absolute(scene.name()).parent_path();
      setting.value = copy.lexically_relative(folder.lexically_normal()).string();
    }
    return settings;
  }

  const SkyFiles& skies_;
  std::filesystem::path file_;
};

toml::table range_table(const Scale& range) {
  return toml::table{{"from", range.from}, {"to", range.to}, {"log", range.is_log}};
}

toml::table ranges_table(const View& view) {
  toml::table table;
  if (view.curve_zoom.x) table.insert(kZenithRange, range_table(*view.curve_zoom.x));
  if (view.curve_zoom.y) table.insert(kValueRange, range_table(*view.curve_zoom.y));
  if (view.map_colours) table.insert(kColourRange, range_table(*view.map_colours));
  for (const auto& [label, range] : view.map_ranges) table.insert(label, range_table(range));
  return table;
}

toml::table view_table(const Session& session) {
  const View& view = session.view();
  toml::table table{{"quantity", described(view.quantity).name},
                    {"theta_max_deg", view.theta_max_deg},
                    {"map_x", description_of(view.map_x).name},
                    {"map_y", description_of(view.map_y).name},
                    {"panel", kPanels.at(static_cast<std::size_t>(view.panel)).name},
                    {"mueller_row", static_cast<int>(view.mueller_row)},
                    {"mueller_column", static_cast<int>(view.mueller_column)},
                    {"ranges", ranges_table(view)},
                    {"cursor_deg", session.theta_deg()}};
  for (const Flag& flag : kFlags) table.insert(flag.key, view.*flag.flag);
  return table;
}

/// A value of a file; `place` begins messages. Errors: InputError.
template <class T>
T need(Node node, const std::string& place) {
  const std::optional<T> value = node ? node.value<T>() : std::nullopt;
  if (!value) throw InputError(place + (node ? " is of another kind" : " is missing"));
  if constexpr (std::is_same_v<T, double>) {
    if (!std::isfinite(*value)) throw InputError(fmt::format("{} = {}: must be a finite number", place, *value));
  }
  return *value;
}

/// The one of `choices` that has the name in the file. Errors: InputError.
template <class Choices, class NameOf>
auto need_one_of(const Choices& choices, const NameOf& name_of, Node node, const std::string& place) {
  const auto name = need<std::string>(node, place);
  const auto found = std::ranges::find_if(choices, [&](const auto& one) { return name == name_of(one); });
  if (found == choices.end()) throw InputError(place + " \"" + name + "\" is unknown");
  return *found;
}

SceneEdits state_in(Node node, const std::string& place, const std::filesystem::path& folder) {
  const auto file = folder / need<std::string>(node["file"], place + ".file");
  const auto settings = [&](const char* key) { return settings_from_text(texts_in(node[key])); };
  const Scene opened = Scene::from_text(need<std::string>(node["text"], place + ".text"), settings("opened_with"),
                                        file.lexically_normal().string());
  return {opened, settings("changes")};
}

Scale range_in(Node node, const std::string& place) {
  const Scale range{need<double>(node["from"], place + ".from"), need<double>(node["to"], place + ".to"),
                    need<bool>(node["log"], place + ".log")};
  if (const std::string refusal = range.refusal(); !refusal.empty()) throw InputError(place + ": " + refusal);
  return range;
}

/// Ranges that are missing are automatic.
void read_ranges(View& view, Node node, const std::string& place) {
  const toml::table* const table = node.as_table();
  if (!table) return;
  for (const auto& [name, one] : *table) {
    const std::string key(name.str());
    const Scale range = range_in(Node(one), place + "." + key);
    if (key == kZenithRange) {
      view.curve_zoom.x = range;
    } else if (key == kValueRange) {
      view.curve_zoom.y = range;
    } else if (key == kColourRange) {
      view.map_colours = range;
    } else {
      view.map_ranges[key] = range;
    }
  }
}

/// A number below `count`, 0 where it is missing.
std::size_t index_in(Node node, std::size_t count, const std::string& place) {
  if (!node) return 0;
  const int index = need<int>(node, place);
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw InputError(fmt::format("{} = {}: must be in [0, {}]", place, index, count - 1));
  return static_cast<std::size_t>(index);
}

View view_in(Node node, const std::string& place) {
  const auto name_of = [](const auto& one) { return one.name; };
  const auto axis = [&](const char* key) {
    return need_one_of(
        kMapAxes, [](Axis of) { return description_of(of).name; }, node[key], place + key);
  };
  View view;
  view.quantity = need_one_of(kAllPlotted, name_of, node["quantity"], place + "quantity").quantity;
  view.panel = need_one_of(kPanels, name_of, node["panel"], place + "panel").panel;
  view.theta_max_deg = need<double>(node["theta_max_deg"], place + "theta_max_deg");
  view.map_x = axis("map_x");
  view.map_y = axis("map_y");
  for (const Flag& flag : kFlags) view.*flag.flag = need<bool>(node[flag.key], place + flag.key);
  view.mueller_row = index_in(node["mueller_row"], 4, place + "mueller_row");
  view.mueller_column = index_in(node["mueller_column"], 4, place + "mueller_column");
  read_ranges(view, node["ranges"], place + "ranges");
  return view;
}

SavedSession session_in(const std::string& path, const toml::table& table) {
  const Node file(static_cast<const toml::node&>(table));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::string place = path + ": ";
  if (need<int>(file[kVersionKey], place + kVersionKey) != kVersion)
    throw InputError(fmt::format("{}{} is not {}: the session of another version", place, kVersionKey, kVersion));
  SavedSession saved{.edits = state_in(file["scene"], place + "scene", folder)};
  const auto for_each = [&](const char* key, const auto& use) {
    const toml::array* const array = file[key].as_array();
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      const std::string here = fmt::format("{}{}[{}]", place, key, i);
      use(Node((*array)[i]), need<std::string>(Node((*array)[i])["name"], here + ".name"), here);
    }
  };
  for_each("pins", [&](Node pin, const std::string& name, const std::string& here) {
    const std::size_t colour =
        pin["colour"] ? index_in(pin["colour"], Session::kMostPins, here + ".colour") : saved.pins.size();
    saved.pins.push_back(
        {name, colour, need<bool>(pin["visible"], here + ".visible"), state_in(pin, here, folder).scene()});
  });
  for_each("snapshots", [&](Node one, const std::string& name, const std::string& here) {
    saved.snapshots.push_back({name, state_in(one, here, folder)});
  });
  saved.view = view_in(file["view"], place + "view.");
  saved.theta_deg = need<double>(file["view"]["cursor_deg"], place + "view.cursor_deg");
  if (file["measured"]) {
    const auto data = folder / need<std::string>(file["measured"], place + "measured");
    saved.measured = read_measured(data.lexically_normal().string());
  }
  saved.marked = marks_in(texts_in(file["vary"]), place);
  return saved;
}

}  // namespace

void save_session(const Session& session, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const StateWriter states(session.skies(), path);
  toml::table file{{kVersionKey, kVersion},
                   {"scene", states.table(session.edits(), "")},
                   {"view", view_table(session)},
                   {"vary", array_of(texts_of(session.marked()))}};
  if (const auto& data = session.residuals().data())
    file.insert("measured", std::filesystem::proximate(data->name, folder).string());
  toml::array pins, snapshots;
  for (const Pin& pin : session.pins()) {
    toml::table table = states.table(SceneEdits(pin.curve.scene()), pin.name);
    table.insert("visible", pin.is_visible);
    table.insert("colour", static_cast<int>(pin.colour));
    pins.push_back(std::move(table));
  }
  for (const Snapshot& one : session.snapshots()) snapshots.push_back(states.table(one.edits, one.name));
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
