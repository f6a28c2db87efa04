// Files of the response of a camera and of diffuse reflectances, and the keys that name them.
#include <gtest/gtest.h>

#include "scene/spectral_data.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp {
namespace {

std::string response_error(const std::string& text) {
  return error_text([&] { parse_response(text, "r.csv"); });
}

TEST(ResponseFile_WithAFault, IsRefusedWithFileLineAndValue) {
  const std::string header = "wavelength_um,response\n";
  EXPECT_EQ(response_error(header + "8,1\n9,-0.1\n"),
            "r.csv:3: response = -0.1: out of range; must be a number in [0, 1e100]");
  EXPECT_EQ(response_error(header + "8,1\n9,1e308\n"),
            "r.csv:3: response = 1e308: out of range; must be a number in [0, 1e100]");
  EXPECT_EQ(response_error(header + "8,1\n9,nan\n"),
            "r.csv:3: response = nan: not a number; must be a number in [0, 1e100]");
  EXPECT_EQ(response_error(header + "8,1\n"), "r.csv:1: 1 rows; a response has at least 2 rows");
  EXPECT_EQ(response_error(header + "8,0\n9,0\n"),
            "r.csv:2: response = 0 in all rows: must be greater than 0 in one row");
  for (const char* rows : {"8,1\n10,1\n9,1\n", "8,1\n10,1\n10,0\n", "14,1\n10,1\n12,1\n"})
    EXPECT_TRUE(contains(response_error(header + rows), "r.csv:4: wavelength_um = ")) << rows;
}

TEST(ResponseFile_InOtherUnitsAndDirections, HasTheSameSpectrum) {
  for (const char* text :
       {"wavelength_um,response\n7,0\n8,0\n10,2\n12.5,0\n", "12.5 0\n10 2\n8 0\n7 0\n",
        "wavenumber_cm;response\n800;0\n1000;2\n1250;0\n", "response\twavelength_nm\n0\t8000\n2\t10000\n0\t12500\n"}) {
    const Spectrum spectrum = response_spectrum(parse_response(text, "r.csv"), ResponsePer::kPhoton);
    constexpr double kRounding = 1e-12;  // of the conversion of units
    EXPECT_NEAR(spectrum.min_um, 8.0, kRounding) << text;
    EXPECT_NEAR(spectrum.max_um, 12.5, kRounding) << text;
    EXPECT_NEAR(spectrum.weight(9.0), 1.0 * 0.9, kRounding) << text;
    EXPECT_NEAR(spectrum.weight(11.25), 1.0 * 1.125, kRounding) << text;
  }
}

TEST(ResponseFile_BesideOtherSpectra, IsRefused) {
  const TemporaryFile file("r.csv", "8,1\n14,1\n");
  const std::string response = "response_file = \"" + file.path() + "\"\n";
  EXPECT_TRUE(contains(error_of(kMinimal + response), "spectrum.response_file = "));
  EXPECT_TRUE(contains(error_of(kMinimal + response), "cannot be combined with spectrum.wavelength_um"));
  const std::vector<std::string> file_setting = {"spectrum.response_file=" + file.path()};
  const SceneValues scene = parse(kMinimal, file_setting);
  EXPECT_EQ(scene.spectrum.label(), "8-14");
  EXPECT_TRUE(contains(error_of(kMinimal + "response_per = \"photon\"\n"), "needs spectrum.response_file beside it"));
  const std::string other = kMinimal.substr(0, kMinimal.find("wavelength_um"));  // ends with the line [spectrum]
  EXPECT_TRUE(contains(error_of(other + response + "[grid]\nband_um = [[8, 9]]\n"), "cannot be combined with"));
  EXPECT_TRUE(contains(error_of(other + response + "band_um = [8, 9]\n"), "cannot be combined with"));
  EXPECT_FALSE(with_settings(scene, {{"spectrum.band_um", {8.0, 9.0}}}).spectrum.response);
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.material=iron", "spectrum.response_file=nowhere.csv"}),
                       "spectrum.response_file"));
}

TEST(DiffuseFile_OfEcostress, HasThePercentOfItsRowsAsFractions) {
  const std::string text = read_file(DOLP_TEST_DATA_DIR "/index_files/ecostress_like.spectrum.txt");
  const SpectralTable table = parse_diffuse(text, "e.txt");
  EXPECT_EQ(table.wavelength_um, (std::vector<double>{8.0, 10.6, 14.0}));
  EXPECT_DOUBLE_EQ(table.value[1], 0.062);
  const SpectralTable csv = parse_diffuse("wavelength_um,reflectance\n8,0.05\n10.6,0.062\n14,0.041\n", "e.csv");
  EXPECT_DOUBLE_EQ(csv.at(9.0), table.at(9.0));
  const auto changed = [&](const std::string& old, const std::string& replacement) {
    std::string other = text;
    return error_text([&] { parse_diffuse(other.replace(other.find(old), old.size(), replacement), "e.txt"); });
  };
  EXPECT_EQ(changed("made up", "made up, with grains of\n75 micrometers"), "no error");
  EXPECT_EQ(changed("Reflectance (percent)", "Reflectance (percentage)"), "no error");
  EXPECT_EQ(changed("Reflectance (percent)", "Transmittance (percent)"),
            "e.txt:16: Y Units: Transmittance (percent): must be Reflectance (percent)");
  EXPECT_TRUE(contains(changed("10.6000\t6.2", "10.6000\t106.2"), "e.txt:23: reflectance = 106.2: out of range"));
}

TEST(DiffuseFile_BesideOtherKeys, IsRefused) {
  const TemporaryFile file("d.csv", "wavelength_um,reflectance\n8,0.1\n14,0.3\n");
  const std::vector<std::string> with = {"surface.diffuse_file=" + file.path()};
  EXPECT_DOUBLE_EQ(parse(kMinimal, with).surface.diffuse, 0.1 + 0.2 * 2.6 / 6.0);
  EXPECT_EQ(parse(kMinimal, with).surface.diffuse_exponent, 0.0);
  const std::string surface = "surface = { n = 1.5, sigma = 0.3, ";
  const std::string rest =
      "diffuse_file = \"" + file.path() + "\" }\nemission.temperature_K = 300\nspectrum.band_um = [8, 14]\n";
  EXPECT_EQ(parse(surface + rest).surface.diffuse, 0.3);
  EXPECT_TRUE(contains(error_of(surface + "diffuse = 0.1, " + rest), "cannot be combined with surface.diffuse"));
  EXPECT_TRUE(contains(error_of(surface + "diffuse_exponent = -0.3, " + rest),
                       "must be 0, or absent, beside surface.diffuse_file"));
  EXPECT_TRUE(contains(error_of(surface + "diffuse_polarisation = \"transmission\", " + rest),
                       "needs no surface.diffuse_file"));
  EXPECT_TRUE(contains(error_of(kMinimal, {with[0], "spectrum.wavelength_um=20"}), "known at 8 to 14 um"));
  EXPECT_FALSE(parse(surface + rest, {"surface.diffuse=0.2"}).surface.diffuse_table);
}

}  // namespace
}  // namespace dolp
