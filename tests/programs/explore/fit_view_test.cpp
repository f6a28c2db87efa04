// Fits in the window: which minimum the window shows, how a user visits the other minima, and the texts about them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "explore_support.hpp"
#include "temporary_file.hpp"
#include "window_support.hpp"

namespace dolp::explore::fit_view_test {
namespace {

using namespace explore_test;

TEST(NearestMinimum, IsNearestByTheCoordinatesOfTheRanges) {
  Fit fit{{}, {}, true, paint().scene()};
  fit.minima = {{{1.5, 2.37}, 4.0}, {{1.5, 0.22}, 5.0}, {{9.0, 0.22}, 80.0}};
  for (const auto& [n, k, nearest] :
       {std::tuple{1.5, 0.1, 1U}, {1.5, 0.7, 1U}, {1.5, 0.8, 0U}, {1.4, 40.0, 0U}, {8.0, 0.1, 2U}}) {
    FitJob job{paint(), {}, {}};
    job.vary = {{"surface.n", 1.0, 40.0, n}, {"surface.k", 0.001, 100.0, k}};
    EXPECT_EQ(nearest_minimum(fit, job), nearest) << n << ' ' << k;
  }
}

struct MeasuredSession : Session {
  explicit MeasuredSession(const std::vector<std::string>& settings = {}) : Session(paint(settings)) {
    load_measured(TemporaryFile(".csv", "theta_deg,dolp\n60,0.05\n70,0.06\n").path());
  }
  double value(const std::string& key) const { return scene().number(key).value(); }
};

TEST(ExploreSession, Minimum_IsVisitedInTheSceneThatWasFitted) {
  MeasuredSession session;
  session.mark("surface.k", true);
  const FitJob job = session.fit_job().value();
  Fit fit{{.parameters = {{.key = "surface.k", .value = 2.0}}}, {}, true, job.edits.scene()};
  fit.minima = {{{2.0}, 4.0}, {{0.2}, 5.0}};
  EXPECT_EQ(session.take_fit(fit, job), 1U);
  EXPECT_EQ(session.view().panel, Panel::kFit);
  EXPECT_EQ(session.value("surface.k"), 0.2);
  EXPECT_EQ(session.minimum(), 1U);
  EXPECT_TRUE(contains(fit_text(fit, 1), "of 2 minima the nearest to the start, the lowest has χ² 4"));
  session.set("surface.sigma", 0.4);
  EXPECT_FALSE(session.minimum());
  session.hold(false);
  session.visit_minimum(0);
  EXPECT_EQ(session.value("surface.sigma"), 0.15);
  EXPECT_EQ(session.value("surface.k"), 2.0);
  EXPECT_EQ(session.minimum(), 0U);
  session.undo();
  EXPECT_EQ(session.value("surface.sigma"), 0.4);
}

TEST(ExploreSession, RangeOfAFit_IsTheSlidersAsFarAsTheSceneTakesIt_OrTyped) {
  // The range of k begins at 0.001 instead of 0, because fits search k on a logarithmic scale. The range of q begins at
  // 1.6, as the slider does, or at the scene's q if that is smaller.
  for (const auto& [key, value, low, high, start] : {std::tuple{"surface.k", 0.0, 0.001, 100.0, 0.001},
                                                     {"surface.k", 0.22, 0.001, 100.0, 0.22},
                                                     {"surface.k", 200.0, 0.001, 200.0, 200.0},
                                                     {"surface.q", 1.55, 1.55, 20.0, 1.55},
                                                     {"surface.q", 3.0, 1.6, 20.0, 3.0}}) {
    MeasuredSession session({"surface.masking=smith"});
    session.set(key, value);
    session.mark(key, true);
    const FitRange range = session.fit_job().value().vary.front();
    EXPECT_EQ(std::tuple(range.low, range.high, *range.start), std::tuple(low, high, start)) << key << ' ' << value;
    EXPECT_TRUE(range.is_logarithmic());
    EXPECT_NO_THROW(session.scene().with(key, range.low));
  }
  MeasuredSession session;
  session.set("surface.n", 1.5);
  EXPECT_EQ(session.set_fit_range("surface.n", "1.6", "3"), "");
  EXPECT_EQ(session.set_fit_range("surface.n", "3", "2"), "vary surface.n=3:2: LOW must be below HIGH");
  const FitRange range = session.fit_job().value().vary.front();
  EXPECT_EQ(std::tuple(range.low, range.high, *range.start), std::tuple(1.6, 3.0, 1.6));
  session.mark("surface.n", false);
  EXPECT_FALSE(session.fit_job());
}

TEST(FitText, Interval_HasItsEnds) {
  EXPECT_EQ(interval_text({.low = 1.25}), "1.25 to open");
  EXPECT_EQ(interval_text({.low = 0.1, .high = 3.0, .pieces = {{0.1, 0.2}, {2.0, 3.0}}}), "0.1 to 3");
}

class FitWindow : public Window {
 protected:
  /// Computes the DOLP of the scene with one changed setting, and loads the results as measured data.
  void measure(const std::string& setting) {
    put("points.csv", "theta_deg\n20\n30\n40\n50\n60\n70\n80\n");
    std::string csv = "theta_deg,dolp,uncertainty\n";
    const Columns truth = eval({"--set", setting, "--tolerance", "1e-5"});
    for (std::size_t i = 0; i < truth.at("dolp").size(); ++i)
      csv += fmt::format("{},{},0.002\n", truth.at("theta_deg")[i], truth.at("dolp")[i]);
    put("measured.csv", csv);
    session().load_measured(at("measured.csv").string());
    settle();
  }
  void fit() {
    keys("ctrl+f");
    settle();
  }
};

TEST_F(FitWindow, MarkedSliders_MoveToTheTruth_AndTheResultIsSaidUntilTheSceneChanges) {
  measure("surface.sigma=0.3");
  EXPECT_FALSE(session().fit_job());
  for (const char* key : {"surface.sigma", "surface.n", "surface.k", "surface.k"})  // the second click on k unmarks it
    click_control(std::string("vary ") + key);
  fit();
  for (const auto& [key, truth, tolerance] : {std::tuple{"surface.sigma", 0.3, 2e-3}, {"surface.n", 1.5, 0.01}}) {
    EXPECT_NEAR(*number(key), truth, tolerance);
    ASSERT_NE(session().fitted(key), nullptr) << key;
    const FitInterval& interval = session().fitted(key)->interval_95;
    EXPECT_TRUE(interval.low < truth && interval.high > truth) << key << ": " << interval_text(interval);
  }
  EXPECT_EQ(session().fitted("surface.k"), nullptr);
  EXPECT_TRUE(contains(session().message().text, "χ²"));
  click_control("emission.bracket");
  EXPECT_EQ(session().message().text, "");
  EXPECT_FALSE(session().minimum() || session().fitted("surface.n"));
}

TEST_F(FitWindow, RangeTypedBelowASlider_BoundsTheFit) {
  measure("surface.n=1.7");
  click_control("vary surface.n");
  enter("field fit surface.n 0", "1.2");
  enter("field fit surface.n 1", "1.6");
  fit();
  EXPECT_EQ(number("surface.n"), 1.6);  // upper end of the range, because the true value 1.7 is larger
}

TEST_F(FitWindow, CancelClicked_EndsTheFitAndLeavesTheScene) {
  measure("surface.k=0.22");
  for (const char* key : {"surface.n", "surface.k", "surface.sigma", "surface.q"})
    click_control(std::string("vary ") + key);
  const float top = area("surface.n").min.y;
  keys("ctrl+f");
  EXPECT_EQ(area("surface.n").min.y, top);
  click_control("cancel fit");
  settle();
  EXPECT_FALSE(session().last_fit());
  EXPECT_FALSE(session().edits().is_changed());
  EXPECT_EQ(session().message().text, "cancelled");
  EXPECT_EQ(area("surface.n").min.y, top);
}

}  // namespace
}  // namespace dolp::explore::fit_view_test
