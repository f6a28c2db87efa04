#include "explore/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <type_traits>

#include <toml++/toml.h>

#include "base/atomic_file.hpp"
#include "base/text.hpp"

namespace dolp::explore {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr const char* kVersionKey = "dolp_session";

struct Flag {
  const char* key;
  bool View::*flag;
};
constexpr std::array kFlags = {Flag{"log", &View::is_log}, Flag{"theta_log", &View::is_theta_log},
                               Flag{"overlay", &View::has_overlay}, Flag{"keep_all", &View::keeps_all}};

using Node = toml::node_view<const toml::node>;

toml::table read_toml(const std::string& path) {
  const std::string text = read_named_file(path, path + ": ");
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", path, error.source().begin.line, one_line(error.description())));
  }
}

void write_toml(const fs::path& path, const toml::table& table) {
  std::ostringstream text;
  text << table << '\n';
  write_text_atomically(path, text.str());
}

std::vector<std::string> texts_in(Node node) {  // empty if the node is no array
  std::vector<std::string> texts;
  const toml::array* const array = node.as_array();
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    if (const auto text = (*array)[i].value<std::string>()) texts.push_back(*text);
  }
  return texts;
}

template <class Values, class TextOf>
toml::array toml_array(const Values& values, const TextOf& to_text) {
  toml::array array;
  for (const auto& value : values) array.push_back(to_text(value));
  return array;
}

std::string mark_text(const FitMarks::value_type& mark) {  // "KEY=LOW:HIGH" if the user typed a range, otherwise "KEY"
  const auto& [key, range] = mark;
  return range ? fmt::format("{}={}:{}", key, format_number(range->low), format_number(range->high)) : key;
}

FitMarks marks_in(const std::vector<std::string>& texts, const std::string& location) {
  FitMarks marks;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    std::optional<FitRange>& range = marks[text.substr(0, equals)];
    try {
      if (equals != std::string::npos) range = FitRange::from_text(text);
    } catch (const InputError& error) {
      throw InputError(location + error.what());
    }
  }
  return marks;
}

toml::table state_table(const SceneEdits& edits, const std::string& name, const fs::path& session) {
  const auto text = [](const Setting& setting) { return setting.text(); };
  const Scene& opened = edits.opened();
  return toml::table{{"name", name},
                     {"file", fs::proximate(opened.name(), session.parent_path()).string()},
                     {"text", opened.text()},
                     {"opened_with", toml_array(opened.settings(), text)},
                     {"changes", toml_array(edits.changes(), text)}};
}

toml::table ranges_table(const View& view) {
  toml::table table;
  for (const auto& [axis, range] : view.ranges)
    table.insert(axis, toml::table{{"from", range.from}, {"to", range.to}, {"log", range.is_log}});
  return table;
}

toml::table view_table(const Session& session) {
  const View& view = session.view();
  toml::table table{{"quantity", described(view.quantity).name},
                    {"theta_max_deg", view.theta_max_deg},
                    {"map_x", view.map_x},
                    {"map_y", view.map_y},
                    {"panel", kPanelNames.at(static_cast<std::size_t>(view.panel))},
                    {"mueller_row", static_cast<int>(view.mueller_row)},
                    {"mueller_column", static_cast<int>(view.mueller_column)},
                    {"ranges", ranges_table(view)},
                    {"cursor_deg", session.theta_deg()}};
  for (const Flag& flag : kFlags) table.insert(flag.key, view.*flag.flag);
  return table;
}

/// The value of `node`. Errors: InputError, whose text begins with `location`.
template <class T>
T need(Node node, const std::string& location) {
  const std::optional<T> value = node ? node.value<T>() : std::nullopt;
  if (!value) throw InputError(location + (node ? " is of another kind" : " is missing"));
  if constexpr (std::is_same_v<T, double>) {
    if (!std::isfinite(*value)) throw InputError(fmt::format("{} = {}: must be a finite number", location, *value));
  }
  return *value;
}

/// The position in `choices` of the choice whose name is the text of `node`. Errors: InputError if there is none.
template <class Choices, class NameOf>
std::size_t need_choice(const Choices& choices, const NameOf& choice_name, Node node, const std::string& location) {
  const auto name = need<std::string>(node, location);
  const auto found = std::ranges::find(choices, name, choice_name);
  if (found == choices.end()) throw InputError(location + " \"" + name + "\" is unknown");
  return static_cast<std::size_t>(found - choices.begin());
}

SceneEdits state_in(Node node, const std::string& location, const fs::path& folder) {
  const auto file = folder / need<std::string>(node["file"], location + ".file");
  const auto settings = [&](const char* key) { return settings_from_text(texts_in(node[key])); };
  const Scene opened = Scene::from_text(need<std::string>(node["text"], location + ".text"), settings("opened_with"),
                                        file.lexically_normal().string());
  return {opened, settings("changes")};
}

Scale read_range(Node node, const std::string& location) {
  const Scale range{need<double>(node["from"], location + ".from"), need<double>(node["to"], location + ".to"),
                    need<bool>(node["log"], location + ".log")};
  if (const std::string refusal = range.refusal(); !refusal.empty()) throw InputError(location + ": " + refusal);
  return range;
}

void read_ranges(View& view, Node node, const std::string& location) {
  const toml::table* const table = node.as_table();
  if (!table) return;
  for (const auto& [axis, range] : *table)
    view.ranges[std::string(axis.str())] = read_range(Node(range), fmt::format("{}.{}", location, axis.str()));
}

std::size_t index_in(Node node, std::size_t count, const std::string& location) {  // 0 if the node is missing
  if (!node) return 0;
  const int index = need<int>(node, location);
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw InputError(fmt::format("{} = {}: must be in [0, {}]", location, index, count - 1));
  return static_cast<std::size_t>(index);
}

View view_in(Node node, const std::string& location) {
  View view;
  view.quantity = static_cast<Plotted>(
      need_choice(kAllPlotted, &PlottedDescription::name, node["quantity"], location + "quantity"));
  view.panel = static_cast<Panel>(need_choice(kPanelNames, std::identity(), node["panel"], location + "panel"));
  view.theta_max_deg = need<double>(node["theta_max_deg"], location + "theta_max_deg");
  view.map_x = need<std::string>(node["map_x"], location + "map_x");
  view.map_y = need<std::string>(node["map_y"], location + "map_y");
  for (const Flag& flag : kFlags) view.*flag.flag = need<bool>(node[flag.key], location + flag.key);
  view.mueller_row = index_in(node["mueller_row"], 4, location + "mueller_row");
  view.mueller_column = index_in(node["mueller_column"], 4, location + "mueller_column");
  read_ranges(view, node["ranges"], location + "ranges");
  return view;
}

SessionState session_in(const std::string& path, const toml::table& table) {
  const Node file(static_cast<const toml::node&>(table));
  const fs::path folder = fs::path(path).parent_path();
  const std::string location = path + ": ";
  if (need<int>(file[kVersionKey], location + kVersionKey) != kVersion)
    throw InputError(fmt::format("{}{} is not {}: the session of another version", location, kVersionKey, kVersion));
  SessionState saved{.edits = state_in(file["scene"], location + "scene", folder)};
  const auto for_each = [&](const char* key, const auto& use) {
    const toml::array* const array = file[key].as_array();
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      const std::string here = fmt::format("{}{}[{}]", location, key, i);
      use(Node((*array)[i]), need<std::string>(Node((*array)[i])["name"], here + ".name"), here);
    }
  };
  for_each("pins", [&](Node pin, const std::string& name, const std::string& here) {
    const std::size_t colour =
        pin["colour"] ? index_in(pin["colour"], Session::kMostPins, here + ".colour") : saved.pins.size();
    saved.pins.push_back(
        {name, colour, need<bool>(pin["visible"], here + ".visible"), Curve(state_in(pin, here, folder).scene())});
  });
  for_each("snapshots", [&](Node snapshot, const std::string& name, const std::string& here) {
    saved.snapshots.push_back({name, state_in(snapshot, here, folder)});
  });
  saved.view = view_in(file["view"], location + "view.");
  saved.theta_deg = need<double>(file["view"]["cursor_deg"], location + "view.cursor_deg");
  saved.marked = marks_in(texts_in(file["vary"]), location);
  return saved;
}

std::optional<MeasuredData> measured_in(const std::string& path, const toml::table& table) {
  const Node file(static_cast<const toml::node&>(table));
  if (!file["measured"]) return std::nullopt;
  const auto data = fs::path(path).parent_path() / need<std::string>(file["measured"], path + ": measured");
  return read_measured(data.lexically_normal().string());
}

}  // namespace

void save_session(const Session& session, const std::string& path) {
  const fs::path target = fs::absolute(path).lexically_normal();
  const auto state = [&](const SceneEdits& edits, const std::string& name) { return state_table(edits, name, target); };
  toml::table file{{kVersionKey, kVersion},
                   {"scene", state(session.edits(), "")},
                   {"view", view_table(session)},
                   {"vary", toml_array(session.marked(), mark_text)}};
  if (const auto& data = session.residuals().data())
    file.insert("measured", fs::proximate(data->name, target.parent_path()).string());
  toml::array pins, snapshots;
  for (const Pin& pin : session.pins()) {
    toml::table table = state(SceneEdits(pin.curve.scene()), pin.name);
    table.insert("visible", pin.is_visible);
    table.insert("colour", static_cast<int>(pin.colour));
    pins.push_back(std::move(table));
  }
  for (const Snapshot& snapshot : session.snapshots()) snapshots.push_back(state(snapshot.edits, snapshot.name));
  file.insert("pins", std::move(pins));
  file.insert("snapshots", std::move(snapshots));
  write_toml(path, file);
}

void save_scene(Session& session, const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  write_text_atomically(path, session.scene().toml(folder.empty() ? "." : folder));
  session.note_saved();
}

void save_curve(const Session& session, const std::string& path) {
  if (!session.curve().is_finished()) throw InputError("the curve is not finished yet");
  write_text_atomically(path, session.curve().finished().csv());
}

void save_sweep(const Session& session, const std::string& path) {
  if (!session.sweep().is_finished()) throw InputError("the curve of the view is not finished yet");
  write_text_atomically(path, session.sweep().csv());
}

bool is_session_file(const std::string& path) {
  std::error_code unknown;
  try {
    return fs::is_regular_file(path, unknown) && read_toml(path).contains(kVersionKey);
  } catch (const InputError&) {
    return false;
  }
}

void open_file(Session& session, const std::string& path) {
  if (lower_case(fs::path(path).extension().string()) == ".csv") return session.load_measured(path);
  const toml::table table = read_toml(path);
  if (table.contains(kVersionKey)) {
    session.restore(session_in(path, table), measured_in(path, table));
  } else {
    session.go_to(SceneEdits(Scene::from_file(path)));
  }
}

fs::path Preferences::default_path() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  if (config && *config != '\0') return fs::path(config) / "dolp/window.toml";
  return home && *home != '\0' ? fs::path(home) / ".config/dolp/window.toml" : "";
}

void Preferences::load(const fs::path& path) {
  path_ = path;
  std::error_code unknown;
  if (!fs::exists(path, unknown)) return;
  const toml::table table = read_toml(path.string());
  is_light = table["light"].value_or(false);
  zoom_by(table["zoom"].value_or(0));
  recent_ = texts_in(table["recent"]);
}

void Preferences::save() const {
  if (path_.empty()) return;
  std::error_code failure;
  fs::create_directories(path_.parent_path(), failure);
  if (failure) throw IoError(path_.parent_path().string() + ": " + failure.message());
  const auto same = [](const std::string& path) { return path; };
  write_toml(path_, toml::table{{"light", is_light}, {"zoom", zoom_steps_}, {"recent", toml_array(recent(), same)}});
}

void Preferences::remember(const fs::path& file) {
  const std::string path = fs::absolute(file).lexically_normal().string();
  std::erase(recent_, path);
  recent_.insert(recent_.begin(), path);
  recent_.resize(std::min(recent_.size(), kMostRecent));
}

std::vector<std::string> Preferences::recent() const {
  std::vector<std::string> found = recent_;
  std::error_code unknown;
  std::erase_if(found, [&](const std::string& path) { return !fs::exists(path, unknown); });
  return found;
}

}  // namespace dolp::explore
