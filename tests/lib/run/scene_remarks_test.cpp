// Remarks on scenes: values that are probably in another unit, and data that files lack.
#include "run/scene_remarks.hpp"

#include <gtest/gtest.h>

#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp::scene_remarks_test {
namespace {

std::vector<std::string> remarks_of(const std::vector<std::string>& settings) {
  return remarks_on(parse(kMinimal, settings));
}

TEST(SceneRemarks, ProbablyMeantOtherwise_IsOneLineThatNamesKeyAndUnit) {
  const TemporaryFile celsius("sky.csv", "zenith_deg,temperature_K\n0,5\n90,200\n");
  const TemporaryFile hot("sky.csv", "zenith_deg,temperature_K\n0,200\n90,601\n");
  const TemporaryFile microflick("sky.csv", "zenith_deg,radiance\n0,300\n90,900\n");
  const std::string profile = "surroundings.profile=";
  for (const auto& [settings, remark] : {
           std::pair(std::vector<std::string>{"emission.temperature_K=59"},
                     "59 K is cold; were degrees Celsius meant?"),
           {{"surroundings.temperature_K=20"}, "20 K is cold; were degrees Celsius meant?"},
           {{"path.transmittance=0.9", "path.temperature_K=20"}, "20 K is cold; were degrees Celsius meant?"},
           {{profile + celsius.path()}, "5 K is cold; were degrees Celsius meant?"},
           {{"surroundings.temperature_K=601"}, "is hotter than twice the surface, 300 K; are both in kelvins?"},
           {{profile + hot.path()}, "is hotter than twice the surface, 300 K; are both in kelvins?"},
           {{profile + microflick.path()},
            "is hotter than twice the surface, 300 K; radiance is in W m-2 sr-1 um-1, of which a microflick is 0.01"},
           {{"spectrum.wavelength_um=8000"}, "is in micrometres; were nanometres or wavenumbers meant?"},
           {{"spectrum.band_um=[3000, 5000]"}, "is in micrometres; were nanometres or wavenumbers meant?"},
           {{"spectrum.band_um=[8, 1250]"}, "is in micrometres; were nanometres or wavenumbers meant?"},
           {{"surface.diffuse_polarisation=transmission"},
            "has no effect: the surface has no diffuse part; surface.diffuse gives it one"},
           {{"grid.wavelength_um=[3000, 5000]"}, "is in micrometres; were nanometres or wavenumbers meant?"},
           {{"surface.coating=[{n=1.5,thickness_um=1}]", "surface.coating.1.thickness_um=500"},
            "is in micrometres; were nanometres meant?"},
           {{profile + "clear-sky", "spectrum.wavelength_um=6.3"},
            "is known at 8-14 um; beyond, the air gets the mean emittance 0.3 in the vertical, but real air is opaque "
            "near 6.3 and 15 um and clearer near 4 um"},
           {{profile + "overcast", "spectrum.band_um=[7.5, 13.5]"},
            "is known at 8-14 um; beyond, the air gets the mean emittance 0.13 in the vertical, but real air is opaque "
            "near 6.3 and 15 um and clearer near 4 um"},
           {{"geometry.mode=bistatic"}, "without [source] nothing depends on theta, the zenith of the source"},
           {{"source.preset=sun"},
            "mode hemispherical adds the light that the surface reflects from the source into all directions; a camera "
            "needs geometry.mode = \"bistatic\""},
           {{"geometry.view_zenith_deg=60"},
            "has no effect: mode hemispherical has its view at grid.theta_deg; mode bistatic uses it"},
           {{"grid.theta_deg=[0, 0.5, 1, 1.5]"}, "is at most 1.5 degrees; is it in radians?"},
           {{"grid.theta_deg=[0, 60, 30]"},
            "neither ascends nor descends; the table has the values in ascending order"},
           {{"surface.sigma=3"}, "3 is a slope of 72 degrees, not a height; real surfaces have less than 2"},
           {{"grid.sigma=[0.1, 3]"}, "3 is a slope of 72 degrees, not a height; real surfaces have less than 2"},
       }) {
    const std::vector<std::string> remarks = remarks_of(settings);
    ASSERT_EQ(remarks.size(), 1U) << settings.back();
    EXPECT_TRUE(remarks[0].starts_with("--set ") && remarks[0].ends_with(std::string(": ") + remark)) << remarks[0];
  }
}

TEST(SceneRemarks, OrdinaryScenes_HaveNone) {
  for (const std::vector<std::string>& settings : {std::vector<std::string>{},
                                                   {"emission.temperature_K=60"},
                                                   {"surroundings.temperature_K=600"},
                                                   {"surroundings.profile=clear-sky"},
                                                   {"grid.wavelength_um=[900, 1000]"},
                                                   {"surface.material=iron"},
                                                   {"geometry.mode=bistatic", "source.irradiance=1"},
                                                   {"geometry.mode=bistatic", "source.preset=sun"},
                                                   {"grid.theta_deg=[0, 0.5, 1]"},
                                                   {"grid.theta_deg=[0, 0.1, 0.2, 0.3]"},
                                                   {"surface.sigma=2"}}) {
    EXPECT_TRUE(remarks_of(settings).empty()) << settings.size() << remarks_of(settings)[0];
  }
}

TEST(SceneRemarks, FileThatLacksDataOrRows_IsSaid) {
  const std::string no_k = "the file has no k, so that k = 0";
  const std::string noise = "k is down to -2e-07 in the file; below 0 it counts as 0";
  const auto gap = [](const std::string& ends) {
    return "the file has no row between " + ends + " um; a straight line bridges the gap";
  };
  const std::string coarse = "wl,n,k\n8,1.5,0\n10,2,0\n12,1.5,0\n";  // R: 0.04, 0.1111, 0.04
  const std::string of_lines =
      "the rows of n and k are coarse near 10 um: straight lines between them change the smooth surface's reflectance "
      "or absorptance by about 16 %";
  const std::string dense = "wl,n,k\n3,1,1\n3.1,1,1\n3.2,1,1\n3.3,1,1\n3.4,1,1\n10.6,2,1\n11,2,1\n";
  struct Case {
    std::string text;
    std::string spectrum;
    std::vector<std::string> remarks;
  };
  for (const Case& row : {
           Case{"wl,n,k\n8,1.5,0.1\n14,1.5,0.1\n", "wavelength_um=10", {}},  // no gap, because 14 / 8 is below 2
           {"wl,n\n8,1.5\n14,1.5\n", "wavelength_um=10", {no_k}},
           {"wl,n,k\n8,1.5,-2e-7\n14,1.5,0.1\n", "wavelength_um=10", {noise}},
           {dense, "wavelength_um=8", {gap("3.4 and 10.6")}},
           {dense, "wavelength_um=10.6", {}},
           {dense, "band_um=[3, 3.4]", {}},
           {dense, "band_um=[3.3, 3.5]", {gap("3.4 and 10.6")}},
           {coarse, "band_um=[8.5, 9]", {of_lines}},
           {coarse, "wavelength_um=11.9", {of_lines}},
           {coarse, "wavelength_um=10", {}},
           {"wl,n,k\n3.39,1.5,0\n10.6,1.5,0\n", "wavelength_um=8", {gap("3.39 and 10.6")}},
           {"wl,n\n3,1\n12,2\nwl,k\n4,0\n12,0\n", "wavelength_um=8", {gap("3 and 12"), gap("4 and 12")}},
       }) {
    const TemporaryFile file("m.csv", row.text);
    const std::string set = "--set surface.material_file=" + file.path() + ": ";
    std::vector<std::string> expected = row.remarks;
    for (std::string& remark : expected) remark.insert(0, set);
    EXPECT_EQ(remarks_of({set.substr(6, set.size() - 8), "spectrum." + row.spectrum}), expected) << row.text;
  }
  const std::vector<std::string> of_axis =
      remarks_of({"grid.material=[\"iron\", \"soda-lime glass\"]", "spectrum.band_um=[8, 14]"});
  ASSERT_EQ(of_axis.size(), 1U);
  EXPECT_NE(of_axis[0].find("soda-lime glass: the rows of n and k are coarse near 8.2 um"), std::string::npos);
  const TemporaryFile source("e.csv", "3,1\n12,2\n");
  EXPECT_TRUE(remarks_of({"source.file=" + source.path()}).at(0).ends_with(gap("3 and 12")));
}

TEST(SceneRemarks, NameTheLineOfTheKey_AlsoAfterSettings) {
  const SceneValues scene =
      parse_scene(std::string(kMinimal) + "\n[grid]\nsigma = 0.1\ntheta_deg = [3, 1, 2]\n", "s.toml");
  const std::size_t line = 1 + static_cast<std::size_t>(std::ranges::count(scene.text, '\n') - 1);
  for (const SceneValues& changed : {scene, with_settings(scene, {{"title", "b"}})}) {
    const std::vector<std::string> remarks = remarks_on(changed);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_TRUE(remarks[0].starts_with(fmt::format("s.toml:{}: grid.theta_deg = [", line))) << remarks[0];
  }
}

TEST(SceneRemarks, OnPoints_NameTheirColumnAndTheLineOfTheValue) {
  const auto remarks_of_points = [](const std::string& text, const std::vector<std::string>& settings = {}) {
    return remarks_on(parse(kMinimal, settings), parse_points(text, "p.csv", PointsKind::kDirections));
  };
  for (const auto& [text, remark] : {
           std::pair("theta_deg\n0\n0.5\n1\n1.2\n1.5\n",
                     "p.csv:1: theta_deg: is at most 1.5 degrees; is it in radians?"),
           {"sigma\n5\n", "p.csv:2: sigma: 5 is a slope of 79 degrees, not a height; real surfaces have less than 2"},
           {"wavelength_um\n9\n4000\n",
            "p.csv:3: wavelength_um: is in micrometres; were nanometres or wavenumbers meant?"},
           {"temperature_K\n300\n20\n", "p.csv:3: temperature_K: 20 K is cold; were degrees Celsius meant?"},
           {"surface.coating.1.thickness_um\n1\n500\n",
            "p.csv:3: surface.coating.1.thickness_um: is in micrometres; were nanometres meant?"},
           {"surface_azimuth_deg\n30\n",
            "p.csv:1: surface_azimuth_deg: has no effect where slopes are equal along and across; give "
            "surface.sigma_cross or surface.wind_model"},
       }) {
    EXPECT_EQ(remarks_of_points(text), std::vector<std::string>{remark});
  }
  EXPECT_EQ(remarks_of_points("wavelength_um\n15\n", {"surroundings.profile=clear-sky"}).size(), 1U);
  EXPECT_TRUE(remarks_of_points("theta_deg,sigma_cross,surface_azimuth_deg\n40,0.2,30\n").empty());
}

}  // namespace
}  // namespace dolp::scene_remarks_test
