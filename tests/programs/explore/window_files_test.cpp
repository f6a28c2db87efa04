// Files that a user opens, saves and reopens in the window.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "window_support.hpp"

namespace window_files_test {

using namespace dolp;
using namespace dolp::explore;
using namespace dolp::explore_test;

class WindowFiles : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    std::filesystem::create_directory(at("folder"));
    put("folder/other.toml", paint({"title=Other"}).scene().toml());
    put("folder/notes.txt", "");
  }
  /// Opens a file from the list of the dialog: the first click selects the file, the second click opens it.
  void open_listed(const std::string& folder, const std::string& file) {
    keys("ctrl+o");
    frames();
    if (!folder.empty()) click_control(folder);
    click_control(file);
    click_control(file);
    settle();
  }
  std::string title() const { return session().scene().title(); }
};

TEST_F(WindowFiles, SceneOfTheList_IsOpened_IsUndone_AndIsAmongTheRecentOnes) {
  drag_slider("surface.sigma", kPartOfSlider);
  keys("ctrl+p");
  keys("ctrl+o");
  frames();
  EXPECT_NO_THROW(area("scene.toml"));
  click_control("folder/");
  EXPECT_THROW(area("notes.txt"), std::out_of_range);
  click_control("other.toml");
  EXPECT_EQ(title(), "Paint");
  click_control("other.toml");
  settle();
  EXPECT_EQ(title(), "Other");
  EXPECT_EQ(number("surface.sigma"), 0.15);
  EXPECT_FALSE(session().edits().is_changed());
  EXPECT_EQ(session().pins()[0].curve.scene().title(), "Paint");
  EXPECT_EQ(session().curve().shown_scene().title(), "Other");
  EXPECT_TRUE(contains(content("config/dolp/window.toml"), "folder/other.toml"));
  keys("ctrl+z");
  EXPECT_EQ(title(), "Paint");
  EXPECT_NE(number("surface.sigma"), 0.15);
  click_control("menu File");
  click_control("recent");
  click_control("recent " + at("folder/other.toml").string());
  EXPECT_EQ(title(), "Other");
}

TEST_F(WindowFiles, OpenDialog_TakesAPathByKeyboard_AndRefusesAMissingOne) {
  keys("ctrl+o");
  click_control("folder/");
  click_control("../");
  EXPECT_NO_THROW(area("scene.toml"));
  keys("Escape");
  answer("ctrl+o", "folder/missing.toml");
  EXPECT_EQ(title(), "Paint");
  type("folder");
  keys("Return");
  EXPECT_NO_THROW(area("other.toml"));
  type("other.toml");
  keys("Return");
  settle();
  EXPECT_EQ(title(), "Other");
  session().go_to(SceneEdits(Scene::from_text(kPaint, {}, "built-in")));
  keys("ctrl+o");
  EXPECT_NO_THROW(area("../"));
  keys("Escape");
  EXPECT_FALSE(session().message().is_error);
  put("bad.toml", "[surface]\nsigma = -1\n");
  answer("ctrl+o", at("bad.toml").string());
  EXPECT_EQ(title(), "Paint");
  EXPECT_TRUE(session().message().is_error);
  EXPECT_TRUE(contains(session().message().text, "bad.toml"));
}

TEST_F(WindowFiles, SaveDialogs_BeginBesideTheScene_ThenInTheLastFolder) {
  open_listed("folder/", "other.toml");
  answer("ctrl+e");
  EXPECT_FALSE(content("folder/other_curve.csv").empty());
  answer("ctrl+e", at("chosen.csv").string());
  answer("ctrl+s");
  EXPECT_FALSE(content("other_scene.toml").empty());
}

TEST_F(WindowFiles, Plots_SavedByShortcut_AreLinesAndTextOfWhatIsShown) {
  put("measured.csv", "theta_deg,dolp,uncertainty\n40,0.02,0.001\n60,0.05,0.001\n");
  show_map();
  session().load_measured(at("measured.csv").string());
  keys("ctrl+p");
  drag_slider("surface.sigma", kPartOfSlider);
  const auto save = [&](const std::string& name) {
    answer("ctrl+shift+e", at(name).string());
    const auto is_drawing = [&] { return session().message().text.starts_with("drawing"); };
    for (int i = 0; i < 3000 && is_drawing(); ++i) {
      app_->frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return session().message();
  };
  EXPECT_EQ(save("plot.svg").text, "saved " + at("plot.svg").string());
  const std::string svg = content("plot.svg");
  const std::string pinned = surface_name(session().pins()[0].curve.shown_scene());
  for (const std::string& text : std::vector<std::string>{"Paint", curve_name(session()), overlay_name(session()),
                                                          pinned, "measured", "DOLP [%]", "zenith θ [°]"})
    EXPECT_TRUE(contains(svg, text));
  session().set_view(&View::panel, Panel::kSpectrum);
  settle();
  EXPECT_EQ(save("spectrum.svg").text, "saved " + at("spectrum.svg").string());
  EXPECT_TRUE(contains(content("spectrum.svg"), "λ [µm]"));
  EXPECT_EQ(save("plot.pdf").text, "saved " + at("plot.pdf").string());
  EXPECT_TRUE(content("plot.pdf").starts_with("%PDF"));
  EXPECT_TRUE(save("plot.docx").is_error);
  EXPECT_TRUE(save("missing/plot.svg").is_error);
}

TEST_F(WindowFiles, ExportMenu_HasTwoEntries_WhoseFormatGivesTheName) {
  click_control("menu Export");
  EXPECT_NO_THROW(area("Figure…"));
  click_control("Data…");
  frames();
  click_control("format the table of the scene's grid, CSV");
  keys("Return");
  for (int i = 0; i < 2000 && !std::filesystem::exists(at("scene_table.csv")); ++i) app_->frame();
  EXPECT_TRUE(content("scene_table.csv").starts_with("theta_deg"));
}

TEST_F(WindowFiles, TitleClicked_TakesATypedOne_WhichUndoTakesBack) {
  enter("title", "Mine");
  frames();
  EXPECT_EQ(title(), "Mine");
  keys("ctrl+z");
  EXPECT_EQ(title(), "Paint");
}

TEST_F(WindowFiles, Snapshot_Clicked_RestoresTheState_AndTakesATypedName) {
  open({{"surface.masking", "smith"}});  // leaves more room for snapshots, because the panel has no sigma_cross
  keys("ctrl+p");
  keys("ctrl+b");
  drag_slider("surface.sigma", kPartOfSlider);
  click_control("snapshot 0");
  settle();
  EXPECT_EQ(number("surface.sigma"), 0.15);
  keys("ctrl+z");
  EXPECT_NE(number("surface.sigma"), 0.15);
  move_to(area("snapshot 0").at(0.5F, 0.5F));
  send({"click", "3"});
  type("dry");
  EXPECT_TRUE(session().snapshots()[0].name.ends_with("dry")) << session().snapshots()[0].name;
  EXPECT_EQ(session().pins()[0].name, "");
}

TEST_F(WindowFiles, SceneAndSession_SavedByShortcut_AreOpenedAsTheyWere) {
  keys("ctrl+p");
  drag_slider("surface.sigma", kPartOfSlider);
  const auto sigma = number("surface.sigma");
  EXPECT_TRUE(session().edits().is_changed());
  answer("ctrl+s");
  EXPECT_FALSE(session().edits().is_changed());
  EXPECT_EQ(Scene::from_file(at("scene_scene.toml")).number("surface.sigma"), sigma);
  answer("ctrl+shift+s");
  keys("ctrl+r");
  EXPECT_TRUE(session().edits().is_changed());
  session().pins().pop_front();
  open_listed("", "scene_session.toml");
  EXPECT_EQ(number("surface.sigma"), sigma);
  ASSERT_EQ(session().pins().size(), 1U);
  EXPECT_TRUE(session().pins()[0].curve.is_finished());
}

}  // namespace window_files_test
