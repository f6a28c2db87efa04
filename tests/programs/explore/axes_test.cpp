// The axes of the plots: ends that a user types, logarithmic axes, and the colours of the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "explore/window/style.hpp"
#include "explore_support.hpp"
#include "window_support.hpp"

namespace dolp::explore::axes_test {
namespace {

using namespace explore_test;

TEST(Scale, WithLogAndTicks_BeginAboveZero_AndAreRound) {
  EXPECT_EQ((Scale{0.0, 90.0}.with_log(true)), (Scale{0.5, 90.0, true}));
  EXPECT_EQ((Scale{2.0, 50.0}.with_log(true)), (Scale{2.0, 50.0, true}));
  EXPECT_EQ((Scale{2.0, 50.0, true}.with_log(false)), (Scale{2.0, 50.0}));
  EXPECT_EQ((Scale{8.0, 14.0, true}.ticks(5)), (std::vector<double>{8.0, 10.0, 12.0, 14.0}));
  EXPECT_EQ((Scale{1.0, 10.0, true}.ticks(5)), (std::vector<double>{1.0, 2.0, 5.0, 10.0}));
}

TEST(Scale, RangesThatCannotBeDrawn_AreRefused_AndHaveFewTicks) {
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [range, part] : {std::pair{Scale{1.0, std::nextafter(1.0, 2.0)}, "differ by more"},
                                    {Scale{1e15, std::nextafter(1e15, 2e15), true}, "differ by more"},
                                    {Scale{-kMost, kMost}, "finite"},
                                    {Scale{kNaN, 1.0}, "finite"},
                                    {Scale{1.0, 1.0}, "from < to"},
                                    {Scale{0.0, 1.0, true}, "above 0"},
                                    {Scale{0.0, 1e-300}, ""},
                                    {Scale{1e15, 1.00001e15}, ""}}) {
    const std::string refusal = range.refusal();
    EXPECT_EQ(refusal.empty(), *part == '\0') << refusal;
    EXPECT_TRUE(contains(refusal, part));
    if (range.from > 0.0) {
      EXPECT_LE(range.ticks(8).size(), 8U) << range.from;
    }
  }
}

TEST(ExploreSession, TypedRangeOfTheMap_IsTakenIfTheSceneTakesIt) {
  Session session(paint({"surface.masking=smith"}));
  for (const auto& [name, range, is_refused] : {std::tuple{"theta", Scale{20.0, 70.0}, false},
                                                {"theta", Scale{20.0, 95.0}, true},
                                                {"sigma", Scale{0.0, 0.3}, false},
                                                {"sigma", Scale{0.1, 11.0}, true},
                                                {"q", Scale{2.0, 8.0, true}, false},
                                                {"q", Scale{1.2, 8.0, true}, true},
                                                {"temperature", Scale{250.0, 310.0}, false}}) {
    const std::vector<MapAxis> axes = map_axes(session.scene(), 90.0);
    const MapAxis axis = *std::ranges::find(axes, name, &MapAxis::name);
    EXPECT_EQ(!refusal(session.scene(), axis, range).empty(), is_refused) << axis.label << ' ' << range.from;
    View view = session.view();
    view.map_x = name;
    view.map_y = axis.key.empty() ? "sigma" : "theta";
    view.ranges = {{axis.label, range}};
    session.set_view(view);
    EXPECT_EQ(session.map().x().scale == range, !is_refused) << axis.label << ' ' << range.from;
  }
}

TEST(HeatMap, EachPairOfAxes_HasTheValuesOfTheScene) {
  const SceneEdits oxide = paint({"surface.coating=[{n=1.3,k=0.1,thickness_um=1},{n=2,thickness_um=0.5}]"});
  const SceneEdits many = paint({"grid.material=[\"PET\", \"gold (Ordal)\"]", "grid.temperature_K=[280, 300]"});
  const SceneEdits glint =
      paint({"geometry.mode=bistatic", "source.irradiance=20", "grid.view_zenith_deg=[20, 70]", "grid.theta_deg=40"});
  const SceneEdits brushed = paint({"surface.sigma_cross=0.3", "grid.surface_azimuth_deg=[0, 90]"});
  const SceneEdits direct = paint({"surface.masking=smith", "emission.model=direct", "surroundings=none"});
  for (const auto& [x, y, edits] : {std::tuple("theta", "sigma", oxide),
                                    {"sigma", "theta", oxide},
                                    {"theta", "temperature", oxide},
                                    {"temperature", "film 1", oxide},
                                    {"film 2", "theta", oxide},
                                    {"film 1", "film 2", oxide},
                                    {"wavelength", "temperature", oxide},
                                    {"n", "k", oxide},
                                    {"q", "wavelength", oxide},
                                    {"view zenith", "azimuth", glint},
                                    {"theta", "view zenith", glint},
                                    {"theta", "surface azimuth", brushed},
                                    {"surface azimuth", "sigma cross", brushed},
                                    {"theta", "sigma cross", direct},
                                    {"theta", "sigma", many},
                                    {"temperature", "theta", many}}) {
    SCOPED_TRACE(std::string(x) + ' ' + y);
    Session session(edits);
    session.set_view({.map_x = x, .map_y = y});
    for (const Job& job : session.wanted()) {
      if (job.key.starts_with("map 16 ")) session.take({done(job)});
    }
    const HeatMap& map = session.map();
    ASSERT_EQ(map.finished_count(), 16U);
    for (const auto& [column, row] : {std::pair{3U, 7U}, {11U, 2U}, {14U, 14U}}) {
      Scene scene = session.scene();
      double theta_deg = session.theta_deg();
      for (const auto& [axis, position] : {std::pair{&map.x(), column}, {&map.y(), row}}) {
        const double value = axis->scale.value(position / 15.0);
        if (axis->key.empty()) theta_deg = value;
        if (!axis->key.empty()) scene = scene.with(axis->key, value);
      }
      const Point exact = truth(scene, points_at(scene, {theta_deg})).front();
      const double shown = map.field(Plotted::kDolp).values[column + row * 16];
      EXPECT_NEAR(shown, exact[Quantity::kDolp], 2.0 * exact[Quantity::kErrorEstimate]) << column << ' ' << row;
    }
  }
}

TEST(HeatMap, Jobs_HaveFewTemperatures) {
  for (const auto& [x, y] : {std::pair("theta", "temperature"), {"temperature", "theta"}}) {
    Session session(paint());
    session.set_view({.map_x = x, .map_y = y});
    std::size_t most = 0;
    for (Job& job : session.wanted()) {
      const std::vector<double>& all_K = job.list["temperature_K"];
      most = std::max(most, std::set<double>(all_K.begin(), all_K.end()).size());
    }
    EXPECT_EQ(most, HeatMap::kLevels[0].batch) << x;
  }
}

TEST(HeatMap, JobsThatArrived_StayWhileAnotherMapIsWanted) {
  const Scene scene = paint().scene();
  const MapAxis sigma{.name = "sigma", .label = "σ", .key = "surface.sigma", .scale = {0.1, 1.0}};
  HeatMap map(scene);
  map.follow("one", scene, false, {}, sigma, 0.0);
  const std::vector<Job> jobs = map.wanted(0);
  EXPECT_TRUE(map.take(done(jobs[0])));
  map.follow("another", scene, false, {}, sigma, 0.0);
  EXPECT_FALSE(map.is_arriving());
  map.follow("one", scene, false, {}, sigma, 0.0);
  EXPECT_EQ(map.wanted(0).front().key, jobs[1].key);
  EXPECT_TRUE(map.take(done(jobs[1])));
}

TEST(HeatMap, Axes_FollowTheScene) {
  Session session(paint({"surface.distribution=gaussian", "surface.wind_m_s=8", "grid.wind_m_s=[2,10]"}));
  EXPECT_EQ(session.map().y().label, "U [m/s]");
  EXPECT_EQ(session.map().y().scale, (Scale{2.0, 10.0}));
  session.set("surface.wind_m_s", 14.0);
  EXPECT_EQ(session.map().y().scale, (Scale{2.0, 14.0}));
  EXPECT_EQ(session.map_cursor(session.map().y()), 1.0);
  session.set({coating_setting({{{"n", 1.5}, {"thickness_um", 2.0}}})});
  session.set_view(&View::map_y, "film 1");
  EXPECT_EQ(session.map().y().label, "d_1 [µm]");
  session.set({coating_setting({})});
  EXPECT_EQ(session.map().y().label, "U [m/s]");
  session.set_view(&View::map_x, "n");
  session.set("surface.material", "water 25C");
  EXPECT_EQ(session.map().x().label, "θ [°]");
  session.set_view(&View::map_x, "wavelength");
  session.set("surface.material", "oxidised Al mirror");
  EXPECT_EQ(session.map().x().scale, (Scale{2.0, 12.5}));
}

class Axes : public Window {
 protected:
  /// Types both ends of an axis. Empty text leaves an end as it is.
  void type_ends(ImVec2 numbers, const std::string& from, const std::string& to) {
    double_click(numbers);
    if (!from.empty()) type(from);
    send({"key", "Tab"});  // not keys(), which holds a key long enough to move on by two fields
    if (!to.empty()) type(to);
    keys("Return");
    settle();
  }
  ImVec2 below_curve() const {
    const ImVec2 at = area("plot curve").at(0.5F, 1.0F);
    return {at.x, at.y + ImGui::GetTextLineHeight()};
  }
};

TEST_F(Axes, NumbersDoubleClicked_TakeTypedEnds_AndCloseAfterARefusedEndIsTakenBack) {
  const CurveView& curves = app_->ui().curves;
  double_click(below_curve());
  type("95");
  keys("Return");
  keys("Escape");
  EXPECT_TRUE(app_->ui().axis_editor.is_open());
  keys("Escape");
  EXPECT_FALSE(app_->ui().axis_editor.is_open());
  double_click(below_curve());
  click(area("logarithmic").at(0.1F, 0.5F));
  EXPECT_EQ(curves.x(), (Scale{0.5, 90.0, true}));
  click(area("logarithmic").at(0.1F, 0.5F));
  keys("Escape");
  type_ends(below_curve(), "20", "70");
  EXPECT_EQ(curves.x(), (Scale{20.0, 70.0}));
  type_ends(below_curve(), "", "95");
  EXPECT_EQ(curves.x(), (Scale{20.0, 70.0}));
  const ImVec2 left = area("plot curve").at(0.0F, 0.5F);
  type_ends({left.x - ImGui::GetTextLineHeight(), left.y}, "1", "4");
  EXPECT_EQ(curves.y(), (Scale{1.0, 4.0}));
}

TEST_F(Axes, DragOfASlider_GivesCoarseCurves_AndHoldsZenithsAndColours_WhichCanBeTyped) {
  show_map();
  const MapView& map = app_->ui().map;
  session().set_view(&View::quantity, Plotted::kSignedDolp);
  settle();
  const Scale colours = map.colours(), zeniths = app_->ui().curves.x();
  EXPECT_EQ(colours.from, -colours.to);
  const Area slider = area("surface.n");
  move_to(slider.at(0.3F, 0.5F));
  send({"mousedown", "1"});
  for (const float part : {0.4F, 0.5F}) {
    move_to(slider.at(part, 0.5F));
    settle();
    EXPECT_TRUE(session().is_dragged());
    EXPECT_EQ(session().curve().points().size(), Curve::kCoarseCount);
    EXPECT_TRUE(curve_name(session()).ends_with(", coarse"));
    EXPECT_EQ(app_->ui().curves.x(), zeniths);
    EXPECT_EQ(map.colours(), colours);
  }
  send({"mouseup", "1"});
  settle();
  EXPECT_TRUE(session().curve().is_finished());
  EXPECT_NE(map.colours(), colours);
  const ImVec2 right = area("plot map").at(1.0F, 0.5F);
  type_ends({right.x + 3.0F * ImGui::GetTextLineHeight(), right.y}, "-8", "8");
  EXPECT_EQ(map.colours(), (Scale{-0.08, 0.08}));
}

}  // namespace
}  // namespace dolp::explore::axes_test
