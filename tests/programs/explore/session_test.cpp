// A session with all that the window shows: curve, map, maximum, pins, cursor, effects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "explore/readout.hpp"
#include "explore_support.hpp"
#include "temporary_file.hpp"

namespace dolp::explore::session_test {
namespace {

bool says_stale(const std::string& text) { return text.find("the scene before") != std::string::npos; }

TEST(ExploreSession, Results_AreStaleUntilTheSceneIsComputed_AndKeepTheirParameters) {
  Driver session(paint());
  const std::string name = curve_name(session);
  const std::string overlay = overlay_name(session);
  const std::string cursor = cursor_text(session);
  const double influence = session.effects().front().influence.value();
  EXPECT_FALSE(says_stale(name + overlay + cursor));
  session.set({{"surface.sigma", 0.4}, {"surface.n", 1.7}});
  EXPECT_TRUE(session.curve().is_stale());
  EXPECT_TRUE(session.overlay()->is_stale());
  EXPECT_TRUE(session.map().is_stale());
  EXPECT_EQ(session.curve().shown_scene().number("surface.sigma"), 0.15);
  EXPECT_EQ(curve_name(session), name + ", the scene before");
  EXPECT_EQ(overlay_name(session), overlay + ", the scene before");
  EXPECT_EQ(cursor_text(session), "Cursor, the scene before" + cursor.substr(std::string("Cursor").size()));
  EXPECT_EQ(session.effects().front().influence, influence);
  EXPECT_EQ(cost_lines(session).front(), "time …");
  session.settle();
  EXPECT_FALSE(session.curve().is_stale() || session.overlay()->is_stale() || session.map().is_stale());
  EXPECT_FALSE(says_stale(curve_name(session) + overlay_name(session) + cursor_text(session)));
  EXPECT_TRUE(contains(cursor_text(session), "σ = 0.4, q = 3:"));
  EXPECT_EQ(session.curve().points().size(), Curve::kFineCount);
  expect_same(session.curve().points(), truth(session.scene(), session.curve().finished().list));
  EXPECT_LE(session.curve().worst_error(), 1e-3);
  EXPECT_GT(session.curve().worst_error(), 0.0);
  // The overlay is a second curve with a Gaussian slope distribution if the scene has Cauchy slopes, and the reverse.
  // Its sigma gives the same density D(0) of horizontal facets as the sigma of the scene.
  EXPECT_EQ(session.overlay()->scene().word("surface.distribution"), "gaussian");
  EXPECT_DOUBLE_EQ(*session.overlay()->scene().number("surface.sigma"), 0.4 / std::sqrt(2.0));
  session.set("surface.distribution", "gaussian");
  session.settle();
  EXPECT_EQ(session.overlay()->scene().word("surface.distribution"), "cauchy");
  EXPECT_TRUE(contains(cursor_text(session), "σ = 0.4:"));
}

/// Compares one point of a curve with an accurate result for the scene that the curve shows.
void expect_point_of(const Curve& curve, std::size_t position) {
  if (curve.points().empty()) return;
  const Point& shown = curve.points()[position % curve.points().size()];
  expect_agreement(shown, curve.shown_scene(), shown.theta_deg);
}

/// Does one random action of a user.
void act(Session& session, std::mt19937_64& random) {
  const double share = std::generate_canonical<double, 53>(random);
  const bool is_even = share < 0.5;
  const std::function<void()> acts[] = {[&] { session.set("surface.sigma", 0.05 + share); },
                                        [&] { session.set("surface.q", 1.6 + 5.0 * share); },
                                        [&] { session.set("surface.n", 1.1 + 2.0 * share); },
                                        [&] { session.set("surface.masking", is_even ? "v-cavity" : "none"); },
                                        [&] { session.set("surface.distribution", is_even ? "gaussian" : "cauchy"); },
                                        [&] { session.set("surroundings.temperature_K", 200.0 + 100.0 * share); },
                                        [&] { session.undo(); },
                                        [&] { session.redo(); },
                                        [&] { session.pins().size() < 2 ? session.pin() : session.pins().pop_front(); },
                                        [&] { session.set_theta(90.0 * share); },
                                        [&] { session.hold(is_even); },
                                        [] {}};
  acts[random() % std::size(acts)]();
}

// At 16 frames per second, 480 frames are half a minute of use.
TEST(ExploreSession, RandomUse_NamesAndCurvesAgreeInEveryFrame) {
  constexpr int kFrames = 480;
  std::mt19937_64 random(20261124);
  Driver session(paint());
  for (int i = 0; i < kFrames && !testing::Test::HasFailure(); ++i) {
    if (random() % 4 == 0) act(session, random);
    i % 20 == 0 ? session.settle() : void(session.frame());
    const Curve& curve = session.curve();
    const std::size_t position = random();
    EXPECT_EQ(curve_name(session), surface_name(curve.shown_scene()) + remark(session, curve));
    EXPECT_TRUE(curve.is_finished() || *remark(session, curve) != 0);
    expect_point_of(curve, position);
    if (session.overlay()) expect_point_of(*session.overlay(), position);
    for (const Pin& pin : session.pins()) expect_point_of(pin.curve, position);
  }
}

TEST(ExploreSession, Drag_GetsCoarseResultsInTurn_AndSaysSoOnce) {
  Driver session(paint());
  session.set_view({.map_y = "q"});
  session.settle();
  session.hold(true);
  std::size_t maps = session.map().version();
  for (const double sigma : {0.2, 0.25, 0.3, 0.35}) {
    session.set("surface.sigma", sigma);
    EXPECT_FALSE(says_stale(curve_name(session) + overlay_name(session) + cursor_text(session)));
    for (const Job& job : session.wanted()) EXPECT_GE(job.tolerance, Curve::kCoarseTolerance);
    session.settle();
    EXPECT_FALSE(session.curve().is_stale() || session.overlay()->is_stale() || session.map().is_stale());
    EXPECT_EQ(session.curve().points().size(), Curve::kCoarseCount);
    EXPECT_TRUE(curve_name(session).ends_with(", coarse"));
    EXPECT_NE(std::exchange(maps, session.map().version()), session.map().version());
  }
  // In a drag the map or the overlay is computed after each result of the curve, even if the curve has changed again.
  session.set("surface.sigma", 0.4);
  std::vector<Job> jobs = session.wanted();
  const Job& curve = *std::ranges::find_if(jobs, [](const Job& job) { return job.key.starts_with("coarse curve"); });
  session.take({done(curve)});
  session.set("surface.sigma", 0.41);
  EXPECT_FALSE(session.wanted().front().key.starts_with("coarse curve"));
  session.hold(false);
  session.settle();
  EXPECT_TRUE(session.curve().is_finished());
  EXPECT_FALSE(curve_name(session).ends_with(", coarse"));
  session.take({done(curve)});  // a late result for an earlier scene, which must not appear
  EXPECT_EQ(session.curve().shown_scene().number("surface.sigma"), 0.41);
}

TEST(ExploreSession, Map_InADrag_GoesFromOneCompleteMapToTheNext) {
  Driver session(paint());
  session.hold(true);
  session.set("surface.n", 1.6);
  const auto map_job = [&] {
    const std::vector<Job> jobs = session.wanted();
    return *std::ranges::find_if(jobs, [](const Job& job) { return job.key.starts_with("map"); });
  };
  for (int i = 0; i < 8; ++i) {
    if (i > 0) session.set("surface.n", 1.6 + 0.01 * i);
    const Job job = map_job();
    EXPECT_EQ(job.scene.number("surface.n"), 1.6);
    session.take({done(job)});
  }
  EXPECT_EQ(session.map().finished_count(), 16U);
  EXPECT_EQ(map_job().scene.number("surface.n"), session.scene().number("surface.n"));
}

TEST(ExploreSession, UndoAndRedo_GoThroughGestures_AndASavedSceneIsUnchanged) {
  Session session(paint());
  const Scene opened = session.scene();
  const auto sigma = [&] { return *session.scene().number("surface.sigma"); };
  for (const double dragged : {0.2, 0.25, 0.3}) session.set("surface.sigma", dragged);
  session.hold(false);
  session.note_saved();
  EXPECT_FALSE(session.edits().is_changed());
  session.set("surface.sigma", -1.0);  // refused, so undo must not count this value
  session.hold(false);
  session.set("surroundings", Value{});
  EXPECT_TRUE(session.edits().is_changed());
  session.undo();
  EXPECT_TRUE(session.scene().number("surroundings.temperature_K"));
  EXPECT_EQ(sigma(), 0.3);
  EXPECT_FALSE(session.edits().is_changed());
  session.undo();
  EXPECT_EQ(session.scene().toml(), opened.toml());
  session.redo();
  EXPECT_EQ(sigma(), 0.3);
  session.set("surface.sigma", 0.4);
  session.redo();
  EXPECT_EQ(session.message().text, "nothing to redo");
  EXPECT_EQ(sigma(), 0.4);
  session.undo();
  EXPECT_EQ(sigma(), 0.3);
}

TEST(ExploreSession, PinNames_HaveTheWordsThatDiffer_AndTheMaterial) {
  Driver session(paint());
  session.pin();
  const auto name = [&] { return pin_name(session, session.pins()[0]); };
  EXPECT_EQ(name(), "the same surface, n 1.5 k 0.1");
  session.set({{"emission.temperature_K", 300.0}, {"surroundings.profile", "clear-sky"}});
  session.settle();
  EXPECT_EQ(name(), "T 290 K, T_surr 240 K, n 1.5 k 0.1");
  session.set({{"surface.sigma", 0.4}, {"surface.masking", "smith"}});
  session.settle();
  EXPECT_EQ(name(), "σ 0.15, v-cavity, n 1.5 k 0.1");
  session.set("surface.material", "gold (Ordal)");
  session.settle();
  EXPECT_EQ(name(), "σ 0.15, v-cavity, n 1.5 k 0.1");
  session.pins()[0].name = "before";
  EXPECT_EQ(name(), "before");
}

TEST(ExploreSession, PinsAndPointsOfAnotherScene_AreKnown_AndMissingResidualsHaveAReason) {
  Driver session(paint());
  session.pin();
  session.load_measured(TemporaryFile(".csv", "theta_deg,q_over_i\n50,-0.05\n60,-0.06\n").path());
  session.settle();
  const auto reason = [&](double to_deg) { return no_residuals_text(session, {0.0, to_deg}); };
  EXPECT_EQ(reason(90.0), "measured: Q/I; choose it above");
  session.set_view(&View::quantity, Plotted::kSignedDolp);
  session.settle();
  EXPECT_EQ(reason(90.0), "");
  EXPECT_EQ(reason(30.0), "no measured point is at these zeniths");
  session.set("surface.n", 1.7);
  EXPECT_EQ(reason(90.0), "…");
  EXPECT_FALSE(session.is_foreign(session.residuals().loaded_for()));
  session.go_to(SceneEdits(Scene::from_text(kPaint, {}, "other.toml")));
  EXPECT_TRUE(session.is_foreign(session.residuals().loaded_for()));
  EXPECT_TRUE(contains(pin_name(session, session.pins()[0]), ", another scene"));
  session.undo();
  EXPECT_FALSE(session.is_foreign(session.pins()[0].curve.scene()));
}

TEST(FigureTitle, HasWhatChanged_UntilATitleIsTyped_WhichComputesNothingAgain) {
  const auto title = [](const std::string& scene_title, const std::vector<std::string>& changes) {
    const std::string rest = kPaint.substr(std::string("title = \"Paint").size());
    SceneEdits edits(Scene::from_text("title = \"" + scene_title + rest));
    edits.set(settings_from_text(changes));
    return figure_title(edits);
  };
  EXPECT_EQ(title("Paint, 10 um", {}), "Paint, 10 um");
  EXPECT_EQ(title("Paint, 10 um", {"accuracy.tolerance=1e-2", "grid.theta_deg=[0,1]"}), "Paint, 10 um");
  EXPECT_EQ(title("Paint, 10 um", {"surface.sigma=0.3", "surface.masking=none"}),
            "Paint, 10 um with σ 0.3, masking none");
  EXPECT_EQ(title("Paint, 10 um", {"surface.n=1.7", "surface.k=0.2", "spectrum.band_um=[8,14]"}),
            "Paint with n 1.7 k 0.2, λ 8 to 14 µm");
  EXPECT_EQ(title("Paint", {"surface.coating=[{n=1.4,thickness_um=2}]", "surface.coating.1.k=0.1"}),
            "Paint with n 1.5 k 0.1, film n 1.4 k 0.1 2 µm");
  EXPECT_EQ(title("Paint", {"surroundings=none"}), "Paint without surroundings");
  EXPECT_EQ(title("Paint", {"surface.sigma=0.3", "title=Mine"}), "Mine");
  Driver session(paint());
  session.set("title", "Mine");
  EXPECT_TRUE(session.wanted().empty());
  EXPECT_EQ(figure_title(session.edits()), "Mine");
  session.undo();
  EXPECT_EQ(figure_title(session.edits()), "Paint");
}

TEST(ExploreSession, TableCommand_IsQuotedForAShell) {
  Session session(SceneEdits(Scene::from_text(paint().opened().text(), {}, "a plate's scene.toml")));
  session.set("surface.sigma", 0.2);
  EXPECT_EQ(table_command(session.edits()),
            "dolp table 'a plate'\\''s scene.toml' --set 'surface.sigma=0.2' -o table.nc");
}

TEST(ExploreSession, Bracket_IsReadAtTheCursor) {
  Driver session(paint({"surface.sigma=0.4"}));
  for (const Point& r : session.curve().points()) EXPECT_FALSE(r.has_bracket());
  EXPECT_FALSE(contains(cursor_text(session), "all bounces"));
  session.set({{"emission.bracket", true}});
  session.settle();
  const Point& at = *session.at_cursor();
  EXPECT_GT(at[Quantity::kDolpHigh], 1.1 * at[Quantity::kDolpLow]);
  const std::string text =
      fmt::format("all bounces {:.3f} to {:.3f} %", 100.0 * at[Quantity::kDolpLow], 100.0 * at[Quantity::kDolpHigh]);
  EXPECT_TRUE(contains(cursor_text(session), text));
}

TEST(ExploreSession, AllBounces_PeakIsComparedWithSingleScattering) {
  Driver session(paint({"surface.scattering=multiple", "surface.sigma=0.4"}));
  const Peak& peak = session.peak();
  ASSERT_TRUE(peak.is_complete());
  const auto named = [&](const std::string& name) {
    return std::ranges::find(peak.without(), name, &WithoutEffect::effect);
  };
  // The scene cannot be computed without its masking, because multiple scattering needs v-cavity.
  EXPECT_EQ(named("masking"), peak.without().end());
  ASSERT_NE(named("scattering"), peak.without().end());
  const Point& result = named("scattering")->at_peak.value();
  const Scene& scene = session.scene();
  const Scene single = scene.with("surface.scattering", "single");
  const PointList list = points_at(single, {peak.answer()->at.theta_deg, 60.0});
  EXPECT_EQ(result[Quantity::kDolp], truth(single, list)[0][Quantity::kDolp]);
  EXPECT_EQ(surface_name(scene), "cauchy σ 0.4 q 3, v-cavity, all bounces, n 1.5 k 0.1");
  const auto sentence = [](const Point& with, const Point& without) {
    const double left = 100.0 * without[Quantity::kQOverI], change = left - 100.0 * with[Quantity::kQOverI];
    return fmt::format("scattering it is {:+.2f} %, a change of {:+.2f} points", left, change);
  };
  const std::string words = without_words(session, "scattering");
  EXPECT_TRUE(contains(words, sentence(peak.answer()->at, result)));
  const Point& at_60 = *session.at_cursor();
  EXPECT_TRUE(contains(words, sentence(at_60, truth(single, list)[1])));
  EXPECT_EQ(without_text(session, "scattering"), fmt::format("{:+.2f} → {:+.2f} %", 100.0 * at_60[Quantity::kQOverI],
                                                             100.0 * truth(single, list)[1][Quantity::kQOverI]));
  EXPECT_EQ(without_text(session, "masking") + without_words(session, "masking"), "");
}

/// A finished curve with these DOLPs and status bits, one zenith after the other in steps of a degree.
Curve finished_curve(const std::vector<std::pair<double, std::uint32_t>>& values) {
  const Scene scene = paint().scene();
  Curve curve(scene);
  curve.follow("key", scene, false);
  JobResult result{.key = curve.wanted(Curve::Stage::kFine).value().key, .scene = scene};
  for (const auto& [dolp, status] : values) {
    Point point;
    point.theta_deg = static_cast<double>(result.points.size());
    point.values[Quantity::kDolp] = dolp;
    point.values[Quantity::kErrorEstimate] = 1e-4;
    point.status = status;
    result.points.push_back(point);
  }
  curve.take(result);
  return curve;
}

TEST(ExplorePeak, IsAmongPointsWithoutAStatus_IfThereAreSome) {
  const auto job_for = [](const std::vector<std::pair<double, std::uint32_t>>& values) {
    Peak peak(paint().scene());
    peak.follow(finished_curve(values), 90.0);
    return peak.wanted().empty() ? std::vector<double>{} : peak.wanted().front().list.values.front().second;
  };
  const std::vector<double> near_1 = job_for({{0.1, 0}, {0.2, kRhoToleranceNotMet}, {0.1, 0}, {0.4, kModelInaccurate}});
  EXPECT_EQ(near_1.front(), 0.0);
  EXPECT_EQ(near_1.back(), 2.0);
  const std::uint32_t both = kModelInaccurate | kToleranceNotMet;
  const std::vector<double> near_2 = job_for({{0.1, both}, {0.2, both}, {0.3, both}, {0.4, kIntensityNotPositive}});
  EXPECT_EQ(near_2.front(), 1.0);
  EXPECT_EQ(near_2.back(), 3.0);
  EXPECT_TRUE(job_for({{0.1, kOutsideModelDomain}, {0.2, kIntensityNotPositive}}).empty());
}

TEST(About, HasVersionCommitAndDevice) {
  Driver session(paint());
  const std::vector<std::string> lines = about_lines(session);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "version  " + version());
  EXPECT_EQ(lines[1], "commit   " + commit());
  EXPECT_GT(lines[2].size(), std::string("device   …").size());
}

TEST(ExploreSession, Headline_HasTheCursorFirst_ThenTheMaximum) {
  Driver session(paint({"surface.sigma=0.2"}));
  const Point& at = *session.at_cursor();
  const std::string text = headline(session);
  EXPECT_TRUE(text.starts_with(fmt::format("At the cursor, θ = 60.0°: DOLP {:.3f} % ± ", 100.0 * at[Quantity::kDolp])))
      << text;
  EXPECT_TRUE(contains(text, ". " + peak_text(session)));
  const std::string cause = cause_text(session);
  EXPECT_TRUE(cause.ends_with(fmt::format("sum {:+.2f}.", 100.0 * at[Quantity::kQOverI]))) << cause;
  session.set_theta(20.0);
  EXPECT_EQ(cause_text(session), "Cause: …");
  session.settle();
  EXPECT_NE(cause_text(session), "Cause: …");
  EXPECT_EQ(session.peak().cursor().theta_deg, 20.0);
}

TEST(ExploreSession, Peak_IsTheLargestOfTheCurve_IsDrawn_AndItsCausesAddUp) {
  Driver session(paint());
  session.pin();
  const Peak& peak = session.peak();
  ASSERT_TRUE(peak.is_complete());
  const Point at = peak.answer()->at;
  double sum = 0.0;
  for (const WithoutEffect& part : peak.without())
    sum += part.radiates ? WithoutEffect::contribution(at, *part.at_peak) : 0.0;
  // The contributions of emission and surroundings add up to Q/I, except for the errors of the computed results.
  EXPECT_NEAR(sum, at[Quantity::kQOverI], 2e-3);
  for (const Point& result : session.curve().points()) {
    if (!result.is_good()) continue;
    EXPECT_LE(result[Quantity::kDolp], at[Quantity::kDolp] + result[Quantity::kErrorEstimate]);
  }
  EXPECT_LE(peak.answer()->theta_low_deg, at.theta_deg);
  EXPECT_GE(peak.answer()->theta_high_deg, at.theta_deg);
  EXPECT_TRUE(contains(cause_text(session), "emission -"));
  EXPECT_TRUE(contains(cause_text(session), "against it: surroundings +"));
  for (const std::vector<Point>& drawn : {session.curve().drawn(), session.pins()[0].curve.drawn()}) {
    EXPECT_TRUE(std::ranges::is_sorted(drawn, {}, &Point::theta_deg));
    const auto top = std::ranges::find(drawn, at.theta_deg, &Point::theta_deg);
    ASSERT_NE(top, drawn.end());
    EXPECT_EQ((*top)[Quantity::kDolp], at[Quantity::kDolp]);
  }
  session.set("surface.sigma", 0.3);
  EXPECT_EQ(session.curve().drawn().size(), session.curve().points().size());
}

TEST(ExploreSession, ThetaMax_BoundsMapCursorAndPeak) {
  Driver session(paint());
  session.set_view(&View::theta_max_deg, 50.0);
  session.settle();
  EXPECT_EQ(session.map().x().scale.to, 50.0);
  EXPECT_EQ(session.theta_deg(), 50.0);
  ASSERT_TRUE(session.peak().answer());
  EXPECT_EQ(session.peak().answer()->at.theta_deg, 50.0);
  EXPECT_TRUE(session.peak().answer()->is_at_end);
}

TEST(ExploreSession, FlatCurve_HasARival) {
  Driver session(paint({"surroundings=none", "source.irradiance=1e-9", "geometry.mode=bistatic"}));
  ASSERT_TRUE(session.peak().answer());
  EXPECT_TRUE(session.peak().answer()->rival_deg);
  EXPECT_TRUE(contains(peak_text(session), "also elsewhere"));
}

TEST(ExploreSession, Effects_HaveTheirInfluenceAtTheCursor) {
  Driver session(paint());
  const auto influence_at = [&](double theta_deg) {
    session.set_theta(theta_deg);
    return std::ranges::find(session.effects(), "surroundings", &Effect::name)->influence.value();
  };
  EXPECT_GT(influence_at(20.0), 0.0);
  EXPECT_GT(influence_at(60.0), influence_at(20.0));
}

TEST(ExploreSession, RhoThatThePlanDrops_IsComputedWhenItIsShown) {
  Driver session(paint({"surroundings.temperature_K=290"}));
  EXPECT_TRUE(std::isnan(session.curve().points()[50][Quantity::kRhoI]));
  session.set_view(&View::quantity, Plotted::kRhoS);
  session.settle();
  EXPECT_TRUE(std::isfinite(session.curve().points()[50][Quantity::kRhoI]));
}

}  // namespace
}  // namespace dolp::explore::session_test
