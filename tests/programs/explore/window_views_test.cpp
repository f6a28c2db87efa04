// The views that a user can show instead of the map, and controls of films, wind and skies.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <numbers>

#include "explore/panels.hpp"
#include "explore/readout.hpp"
#include "explore_support.hpp"
#include "temporary_file.hpp"
#include "window_support.hpp"

namespace window_views_test {

using namespace dolp;
using namespace dolp::explore;
using namespace dolp::explore_test;

double projected(const Scene& scene) {
  const auto integrand = [&](double alpha) {
    const double density = slope_density(scene, alpha / kDegree) * std::sin(2.0 * alpha);
    return std::isfinite(density) ? std::numbers::pi * density : 0.0;
  };
  return boost::math::quadrature::tanh_sinh<double>().integrate(integrand, 0.0, 0.5 * std::numbers::pi);
}

TEST(ExplorePanels, SlopeDensity_IsNormalised_AndTheOtherOneHasTheSameD0) {
  constexpr double kRule = 1e-6;  // bound of the error of the quadrature
  for (const char* distribution : {"cauchy", "gaussian"}) {
    for (const double sigma : {0.05, 0.3, 1.0}) {
      const Scene scene = paint().scene().with({{"surface.distribution", distribution}, {"surface.sigma", sigma}});
      EXPECT_NEAR(projected(scene), 1.0, kRule) << distribution << ' ' << sigma;
      const Scene other = with_other_distribution(scene).value();
      EXPECT_NEAR(slope_density(other, 0.0) / slope_density(scene, 0.0), 1.0, 1e-12);
    }
  }
}

TEST(ExplorePanels, MaterialCurve_HasTheScenesIndex_FromEndToEnd) {
  const Scene water = paint({"surface.material=water 25C"}).scene();
  const MaterialCurve curve = material_curve(water, 50);
  ASSERT_EQ(curve.n.size(), 50U);
  for (std::size_t i = 0; i < curve.n.size(); i += 7)
    EXPECT_EQ((std::pair{curve.n[i], curve.k[i]}), water.refractive_index(curve.wavelength_um[i]));
  EXPECT_EQ(curve.wavelength_um.front(), built_in_material(water)->from_um);
  EXPECT_EQ(curve.wavelength_um.back(), built_in_material(water)->to_um);
  EXPECT_EQ(material_curve(paint().scene(), 5).n, std::vector<double>(5, 1.5));
}

/// Computes the points that a sweep asks for, gives them to the sweep, and returns them.
std::vector<Point> swept(Sweep& sweep) {
  sweep.take(done(sweep.wanted().value()));
  EXPECT_TRUE(sweep.is_finished());
  return sweep.points();
}

TEST(ExplorePanels, SmoothSurface_HasFresnelsReflectances_AndAQuarterWaveFilmReflectsNothing) {
  const Plotted kS = Plotted::kRhoS, kP = Plotted::kRhoP;
  const auto reflectance = [](Plotted quantity, const Point& at) { return described(quantity).value(at); };
  Sweep sweep;
  const Scene glass = smooth_scene(paint({"surface.k=0", "surface.specular=0.5"}).scene());
  const double brewster_deg = std::atan(1.5) * 180.0 / std::numbers::pi;
  sweep.follow({.key = "glass", .scene = glass, .list = points_at(glass, {0.0, brewster_deg})});
  const std::vector<Point> bare = swept(sweep);
  EXPECT_NEAR(reflectance(kS, bare[0]), 0.04, 1e-12);
  EXPECT_NEAR(reflectance(kP, bare[1]), 0.0, 1e-12);
  EXPECT_NEAR(reflectance(kS, bare[1]), std::pow((1.0 - 2.25) / (1.0 + 2.25), 2), 1e-12);
  // At normal incidence a film of index sqrt(n) reflects nothing if its thickness is 1/4 or 3/4 of the wavelength in
  // the film. A film with 1/2 of this wavelength has no effect.
  const double n = std::sqrt(1.5);
  const Scene coated = glass.with({coating_setting({{{"n", n}, {"thickness_um", 2.0}}})});
  PointList list = points_at(coated, {0.0, 0.0, 0.0});
  list["wavelength_um"] = {8.0 * n, 4.0 * n, 8.0 * n / 3.0};
  sweep.follow({.key = "coated", .scene = coated, .list = list}, "wavelength_um");
  const std::vector<Point> film = swept(sweep);
  for (const auto& [at, expected] : {std::pair{0U, 0.0}, {1U, 0.04}, {2U, 0.0}})
    EXPECT_NEAR(reflectance(kS, film[at]), expected, 1e-10) << at;
  EXPECT_EQ(sweep.at()[1], 4.0 * n);
}

TEST(ExplorePanels, SmoothSceneOfAWind_AndABandOfTheWindow_AreAccepted) {
  const Scene sea = paint({"surface.distribution=gaussian", "surface.wind_m_s=8", "spectrum.band_um=[8,14]"}).scene();
  EXPECT_EQ(smooth_scene(sea).number("surface.sigma"), 0.0);
  EXPECT_EQ(at_one_wavelength(sea).number("spectrum.wavelength_um"), 11.0);
}

TEST(ExplorePanels, Spectrum_IsTheCurveOverWavelengthAtTheCursor_AndIsComputedWhileItIsShown) {
  const SceneEdits water = paint({"surface.material=water 25C", "spectrum.band_um=[8,14]", "accuracy.tolerance=1e-2"});
  EXPECT_FALSE(Session(water).sweep().wanted());
  Driver session(water, {.panel = Panel::kSpectrum});
  session.set_theta(70.0);
  session.settle();
  ASSERT_TRUE(session.sweep().is_finished());
  // The band begins at 8 um, and the axis at half of this. The axis ends at the last wavelength of the material.
  EXPECT_EQ(session.sweep_axis().scale, (Scale{4.0, 20.0}));
  const Scene scene = session.sweep_scene().with("spectrum.wavelength_um", session.sweep().at()[40]);
  expect_agreement(session.sweep().points()[40], scene, 70.0);
  session.set("emission.temperature_K", 310.0);
  EXPECT_FALSE(session.sweep().is_finished());
}

TEST(ExplorePanels, ScatteringCut_HasItsLobeBeyondTheNormal_AndTheValuesOfMueller) {
  Evaluator evaluator(EvaluatorOptions{.evaluator = "cpu"});
  const Scene scene = paint().scene().with({{"surface.diffuse", 0.0}});
  const ScatteringCut cut = scattering_cut(evaluator, scene, 40.0, 181);
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
  Driver session(paint());
  const std::vector<Point>& curve = session.curve().points();
  ASSERT_LT(curve[120][Quantity::kQOverI], 0.0);
  const std::optional<ImagePolarisation> plate = polarisation_at(curve, 60.0, 30.0);
  ASSERT_TRUE(plate);
  EXPECT_DOUBLE_EQ(plate->dolp, -curve[120][Quantity::kQOverI]);
  EXPECT_NEAR(plate->angle_deg, 30.0, 1e-9);
  EXPECT_NEAR(polarisation_at(curve, 60.0, -150.0)->angle_deg, 30.0, 1e-9);
  std::vector<Point> s_polarised = curve;
  for (Point& point : s_polarised) point.values[Quantity::kQOverI] *= -1.0;
  EXPECT_NEAR(polarisation_at(s_polarised, 60.0, 30.0)->angle_deg, 120.0, 1e-9);
  const double between = polarisation_at(curve, 60.25, 0.0)->dolp;
  EXPECT_NEAR(between, -0.5 * (curve[120][Quantity::kQOverI] + curve[121][Quantity::kQOverI]), 1e-12);
}

TEST(ExplorePanels, Sky_OfABistaticScene_IsComputedWhileItIsShown) {
  const SceneEdits sun = paint({"geometry.mode=\"bistatic\"", "source.preset=\"sun\"", "geometry.view_zenith_deg=60"});
  EXPECT_TRUE(Session(sun).sky().field(Plotted::kDolp).values.empty());
  Driver session(sun, {.panel = Panel::kSky});
  const HeatMap& sky = session.sky();
  ASSERT_TRUE(sky.is_finished());
  EXPECT_EQ(sky.x().scale.to, 180.0);
  const MapField field = sky.field(Plotted::kDolp);
  const Scale azimuths{0.0, 180.0}, zeniths{0.0, 90.0};
  const Scene scene = session.scene().with("geometry.relative_azimuth_deg", azimuths.values(field.count)[90]);
  const Point exact = truth(scene, points_at(scene, {zeniths.values(field.count)[70]})).front();
  EXPECT_NEAR(field.values[70 * field.count + 90], exact[Quantity::kDolp], 2.0 * exact[Quantity::kErrorEstimate]);
  session.set("geometry.relative_azimuth_deg", 77.0);
  EXPECT_TRUE(sky.is_finished());
  session.set("surface.sigma", 0.3);
  EXPECT_FALSE(sky.is_finished());
  session.set(kSigmaCross, 0.45);
  EXPECT_EQ(sky.x().scale.to, 360.0);  // no half of the sky is the mirror image of the other
}

TEST(ExplorePanels, Camera_IsTheCurveOverTheViewZenith_WithTheSourceAtTheCursor) {
  Driver session(paint({"geometry.mode=bistatic", "source.irradiance=20"}), {.panel = Panel::kCamera});
  session.set_theta(35.0);
  session.settle();
  ASSERT_TRUE(session.sweep().is_finished());
  EXPECT_EQ(session.sweep().at()[100], 50.0);
  expect_agreement(session.sweep().points()[100], session.scene().with("geometry.view_zenith_deg", 50.0), 35.0);
  session.set_theta(36.0);
  EXPECT_FALSE(session.sweep().is_finished());
}

TEST(ExplorePanels, Azimuth_IsTheCurveOverTheSurfacesAzimuth_WithUAndTheRowsOfEval) {
  Driver session(paint({"surface.sigma_cross=0.3", "geometry.surface_azimuth_deg=30", "accuracy.tolerance=1e-2"}),
                 {.quantity = Plotted::kUOverI, .panel = Panel::kAzimuth});
  const Sweep& sweep = session.sweep();
  ASSERT_TRUE(sweep.is_finished());
  EXPECT_EQ(session.sweep_axis().label, "φ_w [°]");
  EXPECT_EQ(session.sweep_axis().scale, (Scale{0.0, 180.0}));
  EXPECT_EQ(sweep.at()[45], 45.0);
  const auto u_over_i = [&](std::size_t at) { return described(Plotted::kUOverI).value(sweep.points()[at]); };
  EXPECT_GT(std::abs(u_over_i(45)), 1e-3);
  EXPECT_NEAR(u_over_i(135), -u_over_i(45), 1e-12);
  PointList list = points_at(session.scene(), std::vector<double>(181, 60.0));
  list["surface_azimuth_deg"] = Scale{0.0, 180.0}.values(181);
  EXPECT_EQ(sweep.csv(), to_csv(list.columns(), on_the_cpu(session.scene(), list.columns())));
  const Point& shown = *session.at_cursor();
  EXPECT_EQ(shown[Quantity::kStokesU], sweep.points()[30][Quantity::kStokesU]);
  EXPECT_TRUE(contains(headline(session), fmt::format("AOLP {:.2f}°", shown[Quantity::kAolp])));
  // The results over all azimuths do not depend on the azimuth of the scene.
  session.set(kSurfaceAzimuth, 50.0);
  EXPECT_TRUE(session.sweep().is_finished());
  EXPECT_EQ(quantity_refusal(session.scene(), Plotted::kUOverI), "");
  EXPECT_NE(quantity_refusal(paint().scene(), Plotted::kUOverI), "");
}

TEST(ExplorePanels, EveryViewOfEveryScene_IsWanted_OrRefusedWithAReason) {
  const auto refused = [](const std::vector<std::string>& settings) {
    Session session(paint(settings));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kPanelNames.size(); ++i) {
      const auto panel = static_cast<Panel>(i);
      session.set_view(&View::panel, panel);
      if (!view_refusal(session, panel).empty()) names.push_back(kPanelNames[i]);
    }
    return names;
  };
  using Names = std::vector<std::string>;
  const TemporaryFile reflectances(".csv", "beta_deg,r_s,r_p\n0,0.04,0.04\n45,0.09,0.01\n90,1,1\n");
  EXPECT_EQ(refused({}), (Names{"sky", "camera", "azimuth", "fit"}));
  EXPECT_EQ(refused({"geometry.mode=bistatic"}), (Names{"sphere", "azimuth", "fit"}));
  EXPECT_EQ(refused({"surface.sigma=0"}), (Names{"slopes", "sky", "camera", "azimuth", "fit"}));
  EXPECT_EQ(refused({"surface.sigma_cross=0.3"}), (Names{"slopes", "sphere", "sky", "camera", "fit"}));
  EXPECT_EQ(refused({"surface.reflectance_file=" + reflectances.path(), "spectrum.band_um=[8,14]"}),
            (Names{"material", "pBRDF", "sky", "camera", "azimuth", "fit"}));
  EXPECT_EQ(refused({"surface.distribution=gaussian", "surface.wind_m_s=8", "surroundings.profile=clear-sky",
                     "surface.coating=[{n=1.3,thickness_um=2}]"}),
            (Names{"sky", "camera", "azimuth", "fit"}));
}

TEST_F(Window, Choices_ThatRemoveRows_MoveNoControl) {
  const auto place = [&](const char* control) { return area(control).min.y; };
  const float factor = place("surface.specular"), mode = place("geometry.mode"), sky = place("sky");
  session().set({{"surface.distribution", "gaussian"}, {"surface.material", "gold (Ordal)"}, {"surface.diffuse", 0.0}});
  session().set("spectrum.wavelength_um", 10.0);
  frames();
  EXPECT_EQ(place("surface.specular"), factor);
  EXPECT_EQ(place("geometry.mode"), mode);
  session().set("surroundings", Value());
  frames();
  EXPECT_EQ(place("sky"), sky);
  EXPECT_EQ(place("geometry.mode"), mode);
  EXPECT_NO_THROW(area("unused surface.q"));
}

TEST_F(Window, Panels_ClickedOneByOne_AreDrawn_AndTheMapIsComputedWhileItIsShown) {
  show_map();
  const Area map = area("panel map");
  const auto below = [&] { return pixels({{map.min.x, map.max.y + 8.0F}, {map.min.x + 300.0F, map.max.y + 208.0F}}); };
  std::vector<std::string> seen = {below()};
  for (std::size_t i = 1; i < kPanelNames.size(); ++i) {
    const Panel before = session().view().panel, panel = static_cast<Panel>(i);
    const bool is_refused = !view_refusal(session(), panel).empty();
    EXPECT_EQ(area(std::string("panel ") + kPanelNames[i]).min.y, map.min.y);  // all are in one line
    click_control(std::string("panel ") + kPanelNames[i]);
    EXPECT_EQ(session().view().panel, is_refused ? before : panel);
    settle();
    if (is_refused) continue;
    EXPECT_EQ(std::ranges::count(seen, below()), 0) << kPanelNames[i];
    seen.push_back(below());
  }
  const std::size_t version = session().map().version();
  click_control("emission.bracket");
  settle();
  EXPECT_EQ(session().map().version(), version);
  click_control("panel map");
  settle();
  EXPECT_NE(session().map().version(), version);
}

TEST_F(Window, Films_AreAddedOutside_ChangedAndRemoved) {
  const auto films = [&] { return scene_films(session().scene()); };
  session().set({coating_setting({{{"material", "PMMA acrylic"}, {"thickness_um", 2.0}}})});
  settle();
  click_control("add film");
  EXPECT_EQ(films().size(), 2U);
  EXPECT_EQ(word("surface.coating.2.material"), "PMMA acrylic");
  EXPECT_THROW(area("surface.coating.2.n"), std::out_of_range);
  drag_slider("surface.coating.1.thickness_um", kPartOfSlider);
  // The slider is logarithmic and has a range of 0.001 to 100 um.
  const double expected = std::pow(10.0, -3.0 + 5.0 * static_cast<double>(kPartOfSlider));
  EXPECT_NEAR(std::log10(*number("surface.coating.1.thickness_um") / expected), 0.0, 5.0 * kGrab / 2.0);
  const Scene before = session().scene();
  click_control("surface.coating.1.material");
  type("met gold ord");
  keys("Return");
  EXPECT_EQ(word("surface.coating.1.material"), "gold (Ordal)");
  EXPECT_EQ(number("surface.coating.1.thickness_um"), before.number("surface.coating.1.thickness_um"));
  keys("ctrl+z");
  EXPECT_EQ(session().scene().toml(), before.toml());
  put("own.csv", "wavelength_um,n,k\n5,1.4,0.01\n20,1.4,0.01\n");
  choose("surface.coating.1.material", "own file…");
  type("own.csv");
  keys("Return");
  EXPECT_EQ(word("surface.coating.1.material_file"), at("own.csv").string());
  keys("ctrl+z");
  EXPECT_EQ(session().scene().toml(), before.toml());
  click_control("remove surface.coating.2");
  EXPECT_EQ(films().size(), 1U);
  EXPECT_EQ(number("surface.coating.1.thickness_um"), before.number("surface.coating.1.thickness_um"));
  EXPECT_TRUE(contains(surface_name(before), "film PMMA acrylic 2 µm"));
}

TEST_F(Window, SceneWithAWind_HasItsSliderInsteadOfSigma_AndADirectionalOneAnAzimuth) {
  session().set({{"surface.distribution", "gaussian"}, {"surface.wind_m_s", 8.0}});
  settle();
  EXPECT_THROW(area("surface.sigma"), std::out_of_range);
  drag_slider("surface.wind_m_s", kPartOfSlider);
  EXPECT_NEAR(*number("surface.wind_m_s"), 30.0 * static_cast<double>(kPartOfSlider), 30.0 * kGrab);
  EXPECT_TRUE(contains(cursor_text(session()), "U = "));
  EXPECT_THROW(area(kSurfaceAzimuth), std::out_of_range);
  choose("surface.wind_model", "directional");
  drag_slider(kSurfaceAzimuth, kPartOfSlider);
  EXPECT_NEAR(*number(kSurfaceAzimuth), 180.0 * static_cast<double>(kPartOfSlider), 180.0 * kGrab);
  EXPECT_LT(session().curve().points()[120][Quantity::kStokesU], 0.0);
  click_control("panel azimuth");
  EXPECT_EQ(session().view().panel, Panel::kAzimuth);
}

TEST_F(Window, SkyOfTwoTemperatures_HasSliders_UntilACtrlClickRestoresTheSkyAsOpened) {
  choose("sky", "zenith and horizon");
  EXPECT_EQ(number(kZenithSky), 220.0);
  EXPECT_EQ(number(kHorizonSky), 285.0);
  drag_slider(kZenithSky, kPartOfSlider);
  EXPECT_NEAR(*number(kZenithSky), 150.0 + 200.0 * static_cast<double>(kPartOfSlider), 200.0 * kGrab);
  answer("ctrl+s");
  EXPECT_TRUE(contains(content("scene_scene.toml"), "horizon_temperature_K = 285"));
  ctrl_click(kZenithSky);
  EXPECT_EQ(number("surroundings.temperature_K"), 240.0);
}

TEST_F(Window, ListOfSkies_OffersUniformAndBuiltInSkies_AndTheFileOfTheSceneAsOpened) {
  for (const std::string name : {"clear-sky", "overcast", "uniform"}) {
    choose("sky", name);
    EXPECT_EQ(word("surroundings.profile").value_or("uniform"), name);
  }
  EXPECT_EQ(number("surroundings.temperature_K"), 240.0);  // the value of the scene as opened
  put("sky.csv", "zenith_deg,temperature_K\n0,220\n70,240\n90,285\n");
  open({{"surroundings.profile", "sky.csv"}});
  for (const std::string name : {"overcast", "sky.csv"}) {
    choose("sky", name);
    EXPECT_EQ(word("surroundings.profile"), name);
  }
  answer("ctrl+s");
  EXPECT_TRUE(contains(content("scene_scene.toml"), "profile = 'sky.csv'"));
}

}  // namespace window_views_test
