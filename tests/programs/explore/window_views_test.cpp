// The views beside the map, and the window while a slider is dragged.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "explore/panels.hpp"
#include "explore/readout.hpp"
#include "explore_support.hpp"
#include "window_support.hpp"

namespace {

using namespace dolp;
using namespace dolp::explore_test;
using explore::Area;
using explore::paint;

double projected(const Scene& scene) {
  // Midpoint rule in tan(alpha) = m t / (1 - t), which takes steep facets in; the integrand is smooth there.
  constexpr int kCount = 200'000;
  const double m = std::numbers::sqrt2 * *scene.number("surface.sigma");
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double t = (i + 0.5) / kCount;
    const double slope = m * t / (1.0 - t);
    const double alpha = std::atan(slope);
    const double width = m / ((1.0 - t) * (1.0 - t)) / kCount;
    const double density = explore::slope_density(scene, alpha * 180.0 / std::numbers::pi);
    if (std::isfinite(density)) sum += 2.0 * std::numbers::pi * density * std::pow(std::cos(alpha), 4) * slope * width;
  }
  return sum;
}

TEST(ExplorePanels, SlopeDensity_IsNormalised_AndTheOtherOneHasTheSameD0) {
  constexpr double kRule = 1e-6;  // error of the rule: twice as many points change less
  for (const char* distribution : {"cauchy", "gaussian"}) {
    for (const double sigma : {0.05, 0.3, 1.0}) {
      const Scene scene = paint().scene().with({{"surface.distribution", distribution}, {"surface.sigma", sigma}});
      EXPECT_NEAR(projected(scene), 1.0, kRule) << distribution << ' ' << sigma;
      const Scene other = scene.with(explore::other_distribution(scene));
      EXPECT_NEAR(explore::slope_density(other, 0.0) / explore::slope_density(scene, 0.0), 1.0, 1e-12);
    }
  }
}

TEST(ExplorePanels, MaterialCurve_HasTheScenesIndex_FromEndToEnd) {
  const Scene water = paint().scene().with({{"surface.material", "water 25C"}});
  const explore::MaterialCurve curve = explore::material_curve(water, 50);
  ASSERT_EQ(curve.n.size(), 50U);
  for (std::size_t i = 0; i < curve.n.size(); i += 7) {
    EXPECT_EQ((std::pair{curve.n[i], curve.k[i]}), water.refractive_index(curve.wavelength_um[i]));
  }
  const auto known = materials();
  const auto water_25 = std::ranges::find(known, "water 25C", &BuiltInMaterial::name);
  EXPECT_EQ(curve.wavelength_um.front(), water_25->from_um);
  EXPECT_EQ(curve.wavelength_um.back(), water_25->to_um);
  EXPECT_EQ(explore::material_curve(paint().scene(), 5).n, std::vector<double>(5, 1.5));
}

TEST(ExplorePanels, ScatteringCut_HasItsLobeBeyondTheNormal_AndTheValuesOfMueller) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  const Scene scene = paint().scene().with({{"surface.diffuse", 0.0}});
  const explore::ScatteringCut cut = explore::scattering_cut(evaluator, scene, 40.0, 181);
  std::size_t largest = 0;
  for (std::size_t i = 0; i < cut.matrices.size(); ++i) {
    if (cut.matrices[i][0] > cut.matrices[largest][0]) largest = i;
  }
  EXPECT_NEAR(cut.theta_r_deg[largest], 40.0, 10.0);
  const std::array theta_i = {40.0}, theta_r = {30.0}, back = {0.0};
  const MuellerMatrix truth =
      evaluator.mueller(scene, {{"theta_i_deg", theta_i}, {"theta_r_deg", theta_r}, {"delta_phi_deg", back}})[0];
  EXPECT_EQ(cut.theta_r_deg[60], -30.0);
  EXPECT_EQ(cut.matrices[60], truth);
}

TEST(ExplorePanels, SphereOfASurface_ShowsPAlongTheTiltAndSAcross) {
  explore::Driver driver(paint());
  const std::vector<explore::Point>& curve = driver.session.curve().points();
  ASSERT_LT(curve[120][Quantity::kQOverI], 0.0);
  const std::optional<explore::ImagePolarisation> plate = explore::polarisation_at(curve, 60.0, 30.0);
  ASSERT_TRUE(plate);
  EXPECT_DOUBLE_EQ(plate->dolp, -curve[120][Quantity::kQOverI]);
  EXPECT_NEAR(plate->angle_deg, 30.0, 1e-9);
  EXPECT_NEAR(explore::polarisation_at(curve, 60.0, -150.0)->angle_deg, 30.0, 1e-9);
  std::vector<explore::Point> s_polarised = curve;
  for (explore::Point& point : s_polarised) point.values[Quantity::kQOverI] *= -1.0;
  EXPECT_NEAR(explore::polarisation_at(s_polarised, 60.0, 30.0)->angle_deg, 120.0, 1e-9);
  const double between = explore::polarisation_at(curve, 60.25, 0.0)->dolp;
  EXPECT_NEAR(between, -0.5 * (curve[120][Quantity::kQOverI] + curve[121][Quantity::kQOverI]), 1e-12);
}

TEST(ExplorePanels, Sky_OfABistaticScene_IsComputedWhileItIsShown) {
  explore::Driver driver(paint({"geometry.mode=\"bistatic\"", "source.preset=\"sun\"", "geometry.view_zenith_deg=60"}));
  explore::Session& session = driver.session;
  EXPECT_FALSE(session.source_sky().is_finished());
  session.set_view(&explore::View::panel, explore::Panel::kSky);
  driver.settle();
  ASSERT_TRUE(session.source_sky().is_finished());
  const std::size_t azimuth = 12;
  const Scene scene = session.scene().with({{"geometry.relative_azimuth_deg", explore::SourceSky::azimuth_deg(azimuth)},
                                            {"accuracy.tolerance", explore::Curve::kCoarseTolerance}});
  explore::expect_same(session.source_sky().at(azimuth), explore::truth(scene, session.source_sky().at(azimuth)));
  session.set("geometry.relative_azimuth_deg", 77.0);
  EXPECT_TRUE(session.source_sky().is_finished());
  session.set("surface.sigma", 0.3);
  EXPECT_FALSE(session.source_sky().is_finished());
}

TEST_F(Window, Panels_ClickedOneByOne_AreDrawn_AndTheMapIsComputedWhileItIsShown) {
  const Area map = app_->control_area("panel map");
  const auto below = [&] {
    return display_.pixels(static_cast<std::size_t>(map.min.x), static_cast<std::size_t>(map.max.y) + 8, 300, 200);
  };
  std::vector<std::string> seen = {below()};
  for (std::size_t i = 1; i < explore::kPanelNames.size(); ++i) {
    click_control(std::string("panel ") + explore::kPanelNames[i]);
    EXPECT_EQ(app_->session().view().panel, static_cast<explore::Panel>(i));
    app_->settle();
    frames();
    EXPECT_EQ(std::ranges::count(seen, below()), 0) << explore::kPanelNames[i];
    seen.push_back(below());
  }
  const std::size_t version = app_->session().map().version();
  click_control("emission.bracket");
  app_->settle();
  EXPECT_EQ(app_->session().map().version(), version);
  click_control("panel map");
  app_->settle();
  EXPECT_NE(app_->session().map().version(), version);
}

TEST_F(Window, SceneWithAWind_HasItsSliderAndItsAxis_InsteadOfSigma) {
  app_->session().set({{"surface.distribution", "gaussian"}, {"surface.wind_m_s", 8.0}});
  app_->settle();
  frames();
  EXPECT_THROW(app_->control_area("surface.sigma"), std::out_of_range);
  drag_slider("surface.wind_m_s", kPartOfSlider);
  const explore::Session& session = app_->session();
  const double wind = *number("surface.wind_m_s");
  EXPECT_NEAR(wind, 30.0 * static_cast<double>(kPartOfSlider), 30.0 * kGrab);
  ASSERT_TRUE(session.curve().is_finished());
  const Columns truth = evaluated();
  for (std::size_t i = 0; i < truth.at("dolp").size(); i += 10) {
    EXPECT_EQ(session.curve().points()[i][Quantity::kDolp], truth.at("dolp")[i]) << i;
  }
  EXPECT_EQ(session.map().y().label(), std::string("U [m/s]"));
  EXPECT_NE(explore::cursor_text(session).find("U = "), std::string::npos);
  click(app_->map_view().area().at(0.5F, 0.5F));
  app_->settle();
  EXPECT_NE(session.scene().number("surface.wind_m_s"), wind);
  EXPECT_EQ(session.curve().points()[0].sigma, session.scene().number("surface.wind_m_s"));
}

}  // namespace
