// Files that the window writes and reads: sessions, plots, and preferences.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "explore/files.hpp"
#include "explore/readout.hpp"
#include "explore_support.hpp"
#include "in_folder.hpp"

namespace dolp::explore::files_test {
namespace {

class ExploreFiles : public InFolder {
 protected:
  std::string at(const std::string& name) const { return InFolder::at(name).string(); }
  /// The message with which a file is refused, or nothing if it can be opened.
  std::string refusal(const std::string& name) const {
    Session session(paint());
    try {
      open_file(session, at(name));
    } catch (const InputError& error) {
      EXPECT_TRUE(session.edits().is_same_scene(paint()));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "";
  }
};

/// Gives a session measured data, a fit range, pins, a snapshot and a view: all that a session file stores.
void fill(Session& session, const std::string& measured) {
  session.load_measured(measured);
  session.mark("surface.n", true);
  EXPECT_EQ(session.set_fit_range("surface.k", "0.01", "2"), "");
  session.pin();
  session.pin();
  session.pins().pop_front();  // the pin that remains must keep its colour
  session.pins()[0].name = "as opened";
  session.set({{"surface.sigma", 0.3}, {"surface.masking", "smith"}, {"surroundings", Value()}});
  session.take_snapshot();
  session.set("surface.material", "gold (Ordal)");
  session.pin();
  session.pins()[1].is_visible = false;
  View view{.quantity = Plotted::kRhoS,
            .is_log = true,
            .has_overlay = false,
            .theta_max_deg = 80.0,
            .map_x = "q",
            .panel = Panel::kSlopes,
            .mueller_row = 1,
            .mueller_column = 3};
  session.set_view(view);  // a new quantity resets all ranges, so the test sets the ranges afterwards
  view.ranges = {{View::kZeniths, {20.0, 70.0}},
                 {View::kValues, {0.01, 0.4, true}},
                 {View::kColours, {0.0, 0.3}},
                 {"σ", {0.05, 0.5, true}},
                 {"θ [°]", {10.0, 60.0}}};
  session.set_view(view);
  EXPECT_EQ(session.view(), view);
  session.set_theta(42.5);
}

TEST_F(ExploreFiles, Session_SavedAndOpened_IsTheSame) {
  put("points.csv", "theta_deg,dolp\n40,0.02\n60,0.05\n");
  Driver saved(paint({"surface.q=4"}));
  fill(saved, at("points.csv"));
  save_session(saved, at("all.toml"));
  Driver opened(paint());
  open_file(opened, at("all.toml"));
  ASSERT_FALSE(opened.message().is_error) << opened.message().text;
  saved.settle();
  opened.settle();
  EXPECT_EQ(opened.scene().toml(), saved.scene().toml());
  EXPECT_EQ(opened.edits().opened().toml(), saved.edits().opened().toml());
  EXPECT_TRUE(opened.edits().is_changed());
  expect_same(opened.curve().points(), saved.curve().points());
  ASSERT_EQ(opened.pins().size(), 2U);
  EXPECT_EQ(opened.pins()[0].name, "as opened");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(opened.pins()[i].is_visible, i == 0);
    EXPECT_EQ(opened.pins()[i].colour, 1 - i);
    expect_same(opened.pins()[i].curve.points(), saved.pins()[i].curve.points());
  }
  ASSERT_EQ(opened.snapshots().size(), 1U);
  EXPECT_EQ(opened.snapshots()[0].name, saved.snapshots()[0].name);
  EXPECT_EQ(opened.snapshots()[0].edits.scene().toml(), saved.snapshots()[0].edits.scene().toml());
  ASSERT_EQ(opened.residuals().residuals(Plotted::kDolp).size(), 2U);
  EXPECT_EQ(opened.residuals().residuals(Plotted::kDolp)[1].value,
            saved.residuals().residuals(Plotted::kDolp)[1].value);
  EXPECT_TRUE(opened.varies("surface.n") && opened.varies("surface.k"));
  EXPECT_FALSE(opened.marked().at("surface.n"));
  EXPECT_EQ(opened.marked().at("surface.k")->high, 2.0);
  EXPECT_EQ(opened.view(), saved.view());
  EXPECT_EQ(opened.theta_deg(), 42.5);
  // The file must not contain a path of this machine. A session that is opened and saved again gives the same text.
  const std::string text = content("all.toml");
  EXPECT_FALSE(contains(text, at("")));
  save_session(opened, at("again.toml"));
  EXPECT_EQ(content("again.toml"), text);
}

TEST_F(ExploreFiles, BadFile_IsRefusedInOneLine_AndChangesNothing) {
  for (const auto& [text, part] :
       {std::pair{"dolp_session = 1\nscene = [", "a.toml:2: "},
        {"dolp_session = 2\n", "a.toml: dolp_session is not 1: the session of another version"},
        {"dolp_session = 1\n", "a.toml: scene.file is missing"},
        {"dolp_session = 1\n[scene]\nfile = 3\ntext = ''\n", "a.toml: scene.file is of another kind"},
        {"dolp_session = 1\n[scene]\nfile = 'p.toml'\ntext = '[surface]'\n", "p.toml"},
        {"title = 3\n", "a.toml"},
        {"", "a.toml"}}) {
    put("a.toml", text);
    EXPECT_TRUE(contains(refusal("a.toml"), part));
  }
  EXPECT_NE(refusal("missing.toml"), "");
}

TEST_F(ExploreFiles, BadValueInASession_IsNamed) {
  put("points.csv", "theta_deg,dolp\n40,0.02\n");
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  Session session(paint());
  fill(session, at("points.csv"));
  save_session(session, at("all.toml"));
  const std::string text = content("all.toml");
  for (const auto& [from, to, part] :
       {std::tuple{"panel = 'slopes'", "panel = 'slope'", "all.toml: view.panel \"slope\" is unknown"},
        {"log = true", "log = 'yes'", "all.toml: view.log is of another kind"},
        {"name = 'as opened'", "name = 3", "all.toml: pins[0].name is of another kind"},
        {"'surface.n'", "'surface.n'", ""},
        {"surface.k=0.01:2", "surface.k=2:0.01", "all.toml: vary surface.k=2:0.01: LOW must be below HIGH"},
        {"mueller_row = 1", "mueller_row = 4", "all.toml: view.mueller_row = 4: must be in [0, 3]"},
        {"from = 20.0", "from = 80.0", "all.toml: view.ranges.curve zenith: must be from < to"},
        {"to = 70.0", "to = 20.000000000000004", "view.ranges.curve zenith: must differ by more than"},
        {"to = 70.0", "to = inf", "all.toml: view.ranges.curve zenith.to = inf: must be a finite number"},
        {"cursor_deg = 42.5", "cursor_deg = nan", "all.toml: view.cursor_deg = nan: must be a finite number"},
        {"'points.csv'", "'pipe'", "pipe: is not a regular file"},
        {"'points.csv'", "'gone.csv'", "gone.csv"}}) {
    std::string changed = text;
    const std::size_t position = changed.find(from);
    ASSERT_NE(position, std::string::npos) << from << " in\n" << text;
    put("all.toml", changed.replace(position, std::string_view(from).size(), to));
    const std::string line = refusal("all.toml");
    EXPECT_EQ(line.empty(), *part == '\0') << line;
    EXPECT_TRUE(contains(line, part));
  }
}

TEST(ExplorePlots, Json_HasTheVisibleCurvesAndTheMap) {
  Driver session(paint({"emission.bracket=true"}));
  session.pin();
  session.pins()[0].name = "first";
  session.set("surface.sigma", 0.3);
  session.pin();
  session.pins()[1].is_visible = false;
  session.settle();
  const auto json = [&] { return nlohmann::json::parse(plot_json(session, {0.0, 90.0}, {0.01, 20.0, true})); };
  const nlohmann::json plots = json();
  EXPECT_EQ(plots["title"], "Paint with σ 0.3");
  EXPECT_EQ(plots["y"]["label"], "DOLP [%]");
  EXPECT_TRUE(plots["y"]["is_log"]);
  ASSERT_EQ(plots["curves"].size(), 3U);
  EXPECT_EQ(plots["curves"][2]["name"], "first");
  const auto& curve = plots["curves"][0];
  EXPECT_EQ(curve["style"], "curve");
  const std::vector<Point> points = session.curve().drawn();
  ASSERT_EQ(curve["values"].size(), points.size());
  EXPECT_EQ(curve["values"][100], 100.0 * points[100][Quantity::kDolp]);
  EXPECT_EQ(curve["low"][100], 100.0 * points[100][Quantity::kDolpLow]);
  EXPECT_TRUE(plots["curves"][1]["low"][100].is_null());
  const MapField field = session.map().field(Plotted::kDolp);
  EXPECT_EQ(field.count, 128U);
  EXPECT_EQ(plots["map"]["rows"].size(), field.count);
  EXPECT_EQ(plots["map"]["rows"][2][5], 100.0 * field.values[2 * field.count + 5]);
  EXPECT_TRUE(plots["map"]["colours"].is_null() && !plots["map"]["is_signed"]);
  // The name of a pinned curve states how its surface differs from the surface of the main curve. From now on both
  // surfaces are equal. So the name states the temperature, in which the scenes differ.
  session.pins()[0].name = "";
  session.set({{"surface.sigma", 0.15}, {"emission.temperature_K", 310.0}});
  session.settle();
  const std::string name = json()["curves"][2]["name"];
  EXPECT_EQ(name, "T 290 K, n 1.5 k 0.1");
  session.set_view(&View::ranges, {{View::kColours, {0.01, 0.08}}});
  EXPECT_EQ(json()["map"]["colours"]["to"], 8.0);
  EXPECT_TRUE(json()["sweep"].is_null());
  session.set_view({.panel = Panel::kSpectrum});
  session.settle();
  EXPECT_TRUE(json()["map"].is_null());
  const auto sweep = json()["sweep"];
  EXPECT_EQ(sweep["x"]["label"], "λ [µm]");
  EXPECT_EQ(sweep["curves"][0]["name"], "θ = 60°");
  EXPECT_EQ(sweep["curves"][0]["at"], session.sweep().at());
}

TEST_F(ExploreFiles, Preferences_KeepThemeZoomAndRecentFilesThatExist) {
  Preferences first;
  first.load(at("config/dolp/window.toml"));
  EXPECT_EQ(first.zoom(), 1.0);
  first.is_light = true;
  first.zoom_by(2);
  for (std::size_t i = 0; i < Preferences::kMostRecent + 3; ++i) {
    put(std::to_string(i) + ".toml", "");
    first.remember(at(std::to_string(i) + ".toml"));
  }
  first.remember(at("5.toml"));
  first.save();
  std::filesystem::remove(at("11.toml"));
  Preferences second;
  second.load(at("config/dolp/window.toml"));
  EXPECT_TRUE(second.is_light);
  EXPECT_NEAR(second.zoom(), 1.21, 1e-12);
  const std::vector<std::string> recent = second.recent();
  ASSERT_EQ(recent.size(), Preferences::kMostRecent - 1);
  EXPECT_EQ(recent[0], at("5.toml"));
  EXPECT_EQ(recent[1], at("12.toml"));
  EXPECT_EQ(recent[2], at("10.toml"));
  second.load("");
  EXPECT_NO_THROW(second.save());
  put("bad.toml", "light = [\n");
  EXPECT_THROW(second.load(at("bad.toml")), InputError);
}

TEST(Preferences, DefaultPath_FollowsTheEnvironment) {
  const char* const old = std::getenv("XDG_CONFIG_HOME");
  const std::string kept = old ? old : "";
  ::setenv("XDG_CONFIG_HOME", "/configuration", 1);
  EXPECT_EQ(Preferences::default_path(), "/configuration/dolp/window.toml");
  ::unsetenv("XDG_CONFIG_HOME");
  if (const char* home = std::getenv("HOME")) {
    EXPECT_EQ(Preferences::default_path(), std::string(home) + "/.config/dolp/window.toml");
  }
  if (old) ::setenv("XDG_CONFIG_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace dolp::explore::files_test
