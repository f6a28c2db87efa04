// Files of the window: sessions, what is kept from one start to the next.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "error_text.hpp"
#include "explore/plot_data.hpp"
#include "explore/preferences.hpp"
#include "explore/session_file.hpp"
#include "explore_support.hpp"
#include "program.hpp"

namespace dolp::explore {
namespace {

class ExploreFiles : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(at(name)) << text; }
  /// The one line that refuses a file; empty where it is taken.
  std::string refusal(const std::string& name, const std::string& text) const {
    put(name, text);
    Session session(paint());
    try {
      open_file(session, at(name));
    } catch (const InputError& error) {
      EXPECT_TRUE(session.edits().is_same_scene(paint()));
      return error.what();
    }
    return "";
  }

 private:
  TemporaryFolder folder_;
};

/// A session with something of everything that a file holds.
void fill(Session& session, const std::string& measured) {
  session.load_measured(measured);
  session.mark("surface.n", true);
  EXPECT_EQ(session.set_fit_range("surface.k", "0.01", "2"), "");
  session.pin();
  session.rename_pin(0, "as opened");
  session.set({{"surface.sigma", 0.3}, {"surface.masking", "smith"}, {"surroundings", Value()}});
  session.take_snapshot();
  session.set("surface.material", "gold (Ordal)");
  session.pin();
  session.show_pin(1, false);
  session.set_view({.quantity = Plotted::kRhoS,
                    .is_log = true,
                    .has_overlay = false,
                    .theta_max_deg = 80.0,
                    .map_x = Axis::kQ,
                    .panel = Panel::kSlopes,
                    .mueller_row = 1,
                    .mueller_column = 3});
  View view = session.view();
  view.curve_zoom = {Scale{20.0, 70.0}, Scale{0.01, 0.4, true}};
  view.map_ranges = {{"σ", {0.05, 0.5, true}}, {"θ [°]", {10.0, 60.0}}};
  view.map_colours = Scale{0.0, 0.3};
  session.set_view(view);
  session.set_theta(42.5);
}

TEST_F(ExploreFiles, Session_SavedAndOpened_IsTheSame) {
  put("points.csv", "theta_deg,dolp\n40,0.02\n60,0.05\n");
  Driver saved(paint({"surface.q=4"}));
  fill(saved.session, at("points.csv"));
  save_session(saved.session, at("all.toml"));
  Driver opened(paint());
  open_file(opened.session, at("all.toml"));
  ASSERT_FALSE(opened.session.message().is_error) << opened.session.message().text;
  saved.settle();
  opened.settle();
  const Session& a = saved.session;
  const Session& b = opened.session;
  EXPECT_EQ(b.scene().toml(), a.scene().toml());
  EXPECT_EQ(b.edits().opened().toml(), a.edits().opened().toml());
  EXPECT_TRUE(b.edits().is_changed());
  expect_same(b.curve().points(), a.curve().points());
  ASSERT_EQ(b.pins().size(), 2U);
  EXPECT_EQ(b.pins()[0].name, "as opened");
  EXPECT_FALSE(b.pins()[1].is_visible);
  for (std::size_t i = 0; i < 2; ++i) expect_same(b.pins()[i].curve.points(), a.pins()[i].curve.points());
  ASSERT_EQ(b.snapshots().size(), 1U);
  EXPECT_EQ(b.snapshots()[0].name, a.snapshots()[0].name);
  EXPECT_EQ(b.snapshots()[0].edits.scene().toml(), a.snapshots()[0].edits.scene().toml());
  EXPECT_EQ(b.residuals().residuals(), a.residuals().residuals());
  ASSERT_EQ(b.marked().size(), 2U);
  EXPECT_FALSE(b.marked().at("surface.n"));
  EXPECT_EQ(b.marked().at("surface.k")->low, 0.01);
  EXPECT_EQ(b.marked().at("surface.k")->high, 2.0);
  EXPECT_EQ(b.view().quantity, Plotted::kRhoS);
  EXPECT_TRUE(b.view().is_log && !b.view().has_overlay);
  EXPECT_EQ(b.view().theta_max_deg, 80.0);
  EXPECT_EQ(b.view().map_x, Axis::kQ);
  EXPECT_EQ(b.view().panel, Panel::kSlopes);
  EXPECT_EQ(b.view().mueller_row, 1U);
  EXPECT_EQ(b.view().mueller_column, 3U);
  EXPECT_EQ(b.view().curve_zoom, a.view().curve_zoom);
  EXPECT_TRUE(b.view().curve_zoom.x && b.view().curve_zoom.y);
  EXPECT_EQ(b.view().map_ranges, a.view().map_ranges);
  EXPECT_EQ(b.view().map_colours, (Scale{0.0, 0.3}));
  EXPECT_EQ(b.theta_deg(), 42.5);
  // The file names no folder of the machine, and saving it again changes nothing.
  const std::string text = read_file(at("all.toml"));
  EXPECT_EQ(text.find(at("")), std::string::npos) << text;
  save_session(opened.session, at("again.toml"));
  EXPECT_EQ(read_file(at("again.toml")), text);
}

TEST_F(ExploreFiles, Session_WithARangeOfAFitThatIsNone_IsRefusedByName) {
  Session saved(paint());
  saved.set_fit_range("surface.k", "0.01", "2");
  save_session(saved, at("all.toml"));
  std::string text = read_file(at("all.toml"));
  text.replace(text.find("surface.k=0.01:2"), 16, "surface.k=2:0.01");
  put("wrong.toml", text);
  EXPECT_EQ(error_text([&] { open_file(saved, at("wrong.toml")); }),
            at("wrong.toml") + ": vary surface.k=2:0.01: LOW must be below HIGH");
}

TEST_F(ExploreFiles, Session_OfWhichAPinWasRemoved_KeepsTheColoursOfTheOthers) {
  Session saved(paint());
  for (int i = 0; i < 3; ++i) saved.pin();
  saved.remove_pin(0);
  save_session(saved, at("all.toml"));
  Session opened(paint());
  open_file(opened, at("all.toml"));
  ASSERT_EQ(opened.pins().size(), 2U);
  EXPECT_EQ(opened.pins()[0].colour, 1U);
  EXPECT_EQ(opened.pins()[1].colour, 2U);
}

TEST_F(ExploreFiles, Session_WithSkiesOfTheWindow_ReadsBackWhenTheWindowIsGone) {
  constexpr SkyPair kDusk{231.5, 279.0}, kNoon{250.0, 300.0};
  std::filesystem::create_directories(at("scenes"));
  const Scene scene = Scene::from_text(kPaint, {}, at("scenes/paint.toml"));
  {
    Session saved{SceneEdits(scene)};
    saved.set("surroundings.profile", saved.skies().path(kDusk));
    saved.pin();
    saved.take_snapshot();
    saved.set("surroundings.profile", saved.skies().path(kNoon));
    save_session(saved, at("all.toml"));
    EXPECT_TRUE(saved.has_own_sky());
  }
  Session opened(paint());
  open_file(opened, at("all.toml"));
  ASSERT_FALSE(opened.message().is_error) << opened.message().text;
  EXPECT_EQ(read_sky_pair(sky_file(opened.scene())), kNoon);
  EXPECT_EQ(read_sky_pair(sky_file(opened.pins().at(0).curve.scene())), kDusk);
  EXPECT_EQ(read_sky_pair(sky_file(opened.snapshots().at(0).edits.scene())), kDusk);
  EXPECT_EQ(read_file(at("all_sky_231.5_279.csv")), kDusk.csv());
  EXPECT_EQ(read_file(at("all.toml")).find(at("")), std::string::npos);
}

struct BadFile {
  const char* name;
  const char* text;
  const char* part;  ///< of the line
};

const BadFile kBadFiles[] = {
    {"a.toml", "dolp_session = 1\nscene = [", "a.toml:2: "},
    {"a.toml", "dolp_session = 2\n", "a.toml: dolp_session is not 1: the session of another version"},
    {"a.toml", "dolp_session = 1\n", "a.toml: scene.file is missing"},
    {"a.toml", "dolp_session = 1\n[scene]\nfile = 3\ntext = ''\n", "a.toml: scene.file is of another kind"},
    {"a.toml", "dolp_session = 1\n[scene]\nfile = 'p.toml'\ntext = '[surface]'\n", "p.toml"},
    {"a.toml", "title = 3\n", "a.toml"},
    {"a.toml", "\0", "a.toml"},
};

TEST_F(ExploreFiles, BadFile_IsRefusedInOneLine_AndChangesNothing) {
  for (const BadFile& bad : kBadFiles) {
    const std::string line = refusal(bad.name, bad.text);
    EXPECT_NE(line.find(bad.part), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  Session session(paint());
  EXPECT_THROW(open_file(session, at("missing.toml")), InputError);
}

TEST_F(ExploreFiles, BadPlaceInASession_IsNamed) {
  put("points.csv", "theta_deg,dolp\n40,0.02\n");
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  Session session(paint());
  fill(session, at("points.csv"));
  save_session(session, at("all.toml"));
  session.load_measured(at("pipe"));
  EXPECT_NE(session.message().text.find("pipe: is not a regular file"), std::string::npos) << session.message().text;
  const std::string text = read_file(at("all.toml"));
  const struct {
    std::string from, to, part;
  } kChanges[] = {{"panel = 'slopes'", "panel = 'slope'", "all.toml: view.panel \"slope\" is unknown"},
                  {"log = true", "log = 'yes'", "all.toml: view.log is of another kind"},
                  {"name = 'as opened'", "name = 3", "all.toml: pins[0].name is of another kind"},
                  {"'surface.n'", "'surface.n'", ""},
                  {"mueller_row = 1", "mueller_row = 4", "all.toml: view.mueller_row = 4: must be in [0, 3]"},
                  {"from = 20.0", "from = 80.0", "all.toml: view.ranges.curve zenith: must be from < to"},
                  {"to = 70.0", "to = 20.000000000000004", "view.ranges.curve zenith: must differ by more than"},
                  {"to = 70.0", "to = inf", "all.toml: view.ranges.curve zenith.to = inf: must be a finite number"},
                  {"cursor_deg = 42.5", "cursor_deg = nan", "all.toml: view.cursor_deg = nan: must be a finite number"},
                  {"'points.csv'", "'pipe'", "pipe: is not a regular file"},
                  {"'points.csv'", "'gone.csv'", "gone.csv"}};
  for (const auto& change : kChanges) {
    std::string changed = text;
    const std::size_t place = changed.find(change.from);
    ASSERT_NE(place, std::string::npos) << change.from << " in\n" << text;
    changed.replace(place, change.from.size(), change.to);
    const std::string line = refusal("all.toml", changed);
    EXPECT_EQ(line.empty(), change.part.empty()) << line;
    EXPECT_NE(line.find(change.part), std::string::npos) << line;
  }
}

TEST_F(ExploreFiles, AnotherScene_IsOpenedAsOne_AndUndone) {
  put("other.toml", "title = \"Other\"\n" + kPaint.substr(kPaint.find('\n') + 1));
  Driver driver(paint());
  driver.session.set("surface.sigma", 0.3);
  driver.session.hold(false);
  driver.session.pin();
  open_file(driver.session, at("other.toml"));
  driver.settle();
  EXPECT_EQ(driver.session.scene().title(), "Other");
  EXPECT_FALSE(driver.session.edits().is_changed());
  EXPECT_EQ(driver.session.scene().number("surface.sigma"), 0.15);
  EXPECT_EQ(driver.session.pins()[0].curve.scene().title(), "Paint");
  expect_same(driver.session.curve().points(), truth(driver.session.scene(), driver.session.curve().points()));
  driver.session.undo();
  EXPECT_EQ(driver.session.scene().title(), "Paint");
  EXPECT_EQ(driver.session.scene().number("surface.sigma"), 0.3);
  EXPECT_TRUE(driver.session.edits().is_changed());
  driver.session.redo();
  EXPECT_EQ(driver.session.scene().title(), "Other");
}

TEST(ExploreSnapshots, GoneTo_AreStepsOfUndo) {
  Session session(paint());
  session.set("surface.sigma", 0.3);
  session.hold(false);
  session.take_snapshot();
  session.set("surface.sigma", 0.4);
  session.hold(false);
  session.go_to(session.snapshots()[0].edits);
  session.hold(false);
  EXPECT_EQ(session.scene().number("surface.sigma"), 0.3);
  session.undo();
  EXPECT_EQ(session.scene().number("surface.sigma"), 0.4);
  session.rename_snapshot(0, "rough");
  EXPECT_EQ(session.snapshots()[0].name, "rough");
  session.remove_snapshot(0);
  EXPECT_TRUE(session.snapshots().empty());
}

TEST(ExplorePlots, Json_HasTheVisibleCurvesAndTheMap) {
  Driver driver(paint({"emission.bracket=true"}));
  driver.session.pin();
  driver.session.rename_pin(0, "first");
  driver.session.set("surface.sigma", 0.3);
  driver.session.pin();
  driver.session.show_pin(1, false);
  driver.settle();
  const auto plots = nlohmann::json::parse(plot_json(driver.session, {0.0, 90.0}, {0.01, 20.0, true}));
  EXPECT_EQ(plots["title"], "Paint");
  EXPECT_EQ(plots["y"]["label"], "DOLP [%]");
  EXPECT_TRUE(plots["y"]["is_log"]);
  ASSERT_EQ(plots["curves"].size(), 3U);
  EXPECT_EQ(plots["curves"][1]["name"], "first");
  const auto& curve = plots["curves"][2];
  EXPECT_EQ(curve["style"], "curve");
  const std::vector<Point> points = driver.session.curve().drawn();
  ASSERT_EQ(curve["values"].size(), points.size());
  EXPECT_EQ(curve["values"][100], 100.0 * points[100][Quantity::kDolp]);
  EXPECT_EQ(curve["low"][100], 100.0 * points[100][Quantity::kDolpLow]);
  EXPECT_TRUE(plots["curves"][0]["low"][100].is_null());
  EXPECT_EQ(plots["map"]["rows"].size(), driver.session.map().field(Plotted::kDolp).count);
  EXPECT_TRUE(plots["map"]["colours"].is_null() && !plots["map"]["is_signed"]);
  View view = driver.session.view();
  view.map_colours = Scale{0.01, 0.08};
  driver.session.set_view(view);
  EXPECT_EQ(nlohmann::json::parse(plot_json(driver.session, {}, {}))["map"]["colours"]["to"], 8.0);
  driver.session.set_view({.panel = Panel::kSlopes});
  EXPECT_TRUE(nlohmann::json::parse(plot_json(driver.session, {}, {}))["map"].is_null());
}

TEST(ExplorePlots, Pin_OfTheSameSurface_IsNamedByItsRadiation) {
  Driver driver(paint());
  driver.session.pin();
  driver.session.set("emission.temperature_K", 310.0);
  driver.settle();
  const auto plots = nlohmann::json::parse(plot_json(driver.session, {0.0, 90.0}, {0.0, 20.0}));
  const std::string name = plots["curves"][1]["name"];
  EXPECT_TRUE(name.ends_with(", T 290 K")) << name;
}

TEST_F(ExploreFiles, Preferences_KeepThemeZoomAndRecentFilesThatAreThere) {
  Preferences first;
  first.load(at("config/dolp/window.toml"));
  EXPECT_EQ(first.zoom(), 1.0);
  first.is_light = true;
  first.zoom_by(2);
  for (std::size_t i = 0; i < Preferences::kMostRecent + 3; ++i) {
    const std::string name = std::to_string(i) + ".toml";
    put(name, "");
    first.remember(at(name));
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
  second.zoom_by(100);
  EXPECT_LT(second.zoom(), 2.2);
  second.zoom_by(-100);
  EXPECT_GT(second.zoom(), 0.45);
}

TEST_F(ExploreFiles, Preferences_WithoutAFile_AreKeptNowhere) {
  Preferences none;
  none.load("");
  none.remember(at("a.toml"));
  EXPECT_NO_THROW(none.save());
  put("bad.toml", "light = [\n");
  EXPECT_THROW(none.load(at("bad.toml")), InputError);
}

TEST(Preferences, DefaultPath_FollowsTheEnvironment) {
  const auto restore = [name = std::string("XDG_CONFIG_HOME"), old = std::getenv("XDG_CONFIG_HOME")] {
    old ? ::setenv(name.c_str(), old, 1) : ::unsetenv(name.c_str());
  };
  ::setenv("XDG_CONFIG_HOME", "/configuration", 1);
  EXPECT_EQ(Preferences::default_path(), "/configuration/dolp/window.toml");
  ::unsetenv("XDG_CONFIG_HOME");
  if (const char* home = std::getenv("HOME")) {
    EXPECT_EQ(Preferences::default_path(), std::string(home) + "/.config/dolp/window.toml");
  }
  restore();
}

}  // namespace
}  // namespace dolp::explore
