// Data files as instruments, archives and other programs write them: n and k, responses and diffuse reflectances.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp::data_files_test {
namespace {

const Spectrum kCo2Line{10.6, 10.6};
constexpr double kRounding = 1e-12;  // a few roundings, also of the conversion of units, of numbers near 1

std::string sample(const std::string& name) { return fmt::format("{}/index_files/{}", DOLP_TEST_DATA_DIR, name); }

OpticalConstants index_in(const std::string& text, const std::string& name = "e.dat") {
  const TemporaryFile file(name, text);
  return read_material_file(file.path(), kCo2Line, "").constant;
}

std::string refusal_of(const std::string& path) { return error_of(kMinimal, {"surface.material_file=" + path}); }

TEST(IndexFile_SamplesOfOtherData, AreRefusedWithTheWayOut) {
  const std::string reflectance = "a diffuse reflectance goes in surface.diffuse_file";
  for (const auto& [name, expected] : {
           std::pair("opac_refr.dat",
                     "opac_refr.dat:1: the columns must be named first, in a line such as \"wavelength_um n k\""),
           {"hitran.dat",
            "hitran.dat:2: column \"n\" appears twice; if the file has several materials, copy the columns "
            "of one of them into a file of its own"},
           {"ecostress_like.spectrum.txt", reflectance.c_str()},
           {"spec_alb.dat", reflectance.c_str()},
       }) {
    EXPECT_TRUE(contains(refusal_of(sample(name)), expected));
  }
}

TEST(IndexFile_OfEachForm, HasTheSameValues) {
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"commas.csv", "wavelength_um,n,k\n10.6,1.87,0.69\n"},
           {"semicolons.csv", "wavelength_um;n;k\n10.6;1.87;0.69\n"},
           {"tabs.txt", "wavelength_um\tn\tk\r\n10.6\t1.87\t0.69\r\n"},
           {"blanks.txt", "  wavelength_um   n    k\n   10.6   1.87   0.69\n"},
           {"names by commas.csv", "wavelength_um, n, k\n10.6 1.87 0.69\n"},
           {"names by blanks.csv", "wavelength_um n k\n10.6, 1.87, 0.69\n"},
           {"quoted.csv", "\"wavelength_um\",\"n\",\"k\"\n\"10.6\",\"1.87\",\"0.69\"\n"},
           {"comments.csv", "! one\n% two\n# three\nwavelength_um,n,k\n# four\n10.6,1.87,0.69\n"},
           {"name in a comment.txt",
            "# a rock, Wavelength (micron) n k of which follow\n#Wavelength (micron)\tn  k\n"
            "10.6 1.87 0.69\n"},
           {"no unit.dat", "#Data points: 1\n#wavelength  n  k\n10.6\t1.87\t0.69\n"},
           {"name above other comments.ri", "#FORMAT=WAVL N K\n#SUBSTANCE=Basalt\n10.6 1.87 0.69\n"},
           {"ARIA in wavenumbers.ri", "#FORMAT=WAVN N K\n900 1.87 0.69\n1000 1.87 0.69\n"},
           {"units.csv", "Wavelength [nm], n (-), k (-)\n10600,1.87,0.69\n"},
           {"lambda.csv", "lambda_um,n,k\n10.6,1.87,0.69\n"},
           {"micro.csv", "wavelength (\xC2\xB5m),n,k\n10.6,1.87,0.69\n"},
           {"nanometres.csv", "wavelength_nm,n,k\n10600,1.87,0.69\n"},
           {"wavenumber.csv", "n,k,wavenumber_cm\n1.87,0.69,900\n1.87,0.69,1000\n"},
           {"energy.csv", "energy_eV,n,k\n0.11,1.87,0.69\n0.12,1.87,0.69\n"},
           {"permittivity.csv", "wavelength_um,eps_1,eps_2\n10.6,3.0208,2.5806\n"},
           {"conjugate.csv", "wavelength_um,eps_1,eps_2\n10.6,3.0208,-2.5806\n"},
           {"names and units.dat", "wavelength  n  k\n   (um)    -  -\n10.6 1.87 0.69\n"},
           {"both.dat", "wavelength wavenumber n k\n(um) (cm-1) - -\n10.6 943.4 1.87 0.69\n"},
           {"both in one line.csv", "n,wavelength_um,wavenumber_cm,k\n1.87,10.6,943.4,0.69\n"},
           {"named.lnk", "# lambda[um] n k\n1 3.3\n10.6 1.87 0.69\n"},
           {"bare.LNK", "10.6 1.87 0.69\n"},
       }) {
    const OpticalConstants index = index_in(text, name);
    EXPECT_NEAR(index.n, 1.87, kRounding) << name;
    EXPECT_NEAR(index.k, 0.69, kRounding) << name;
  }
}

// Rows at 12.5 and 25 um in each unit. 1 eV is 8065.543937 cm-1, CODATA 2018.
TEST(IndexFile_Units, AreConverted) {
  constexpr double kDigitsOfConstant = 1e-9;
  for (const auto& [header, first, second] : {std::tuple("wavelength_um", 12.5, 25.0),
                                              {"wavelength_nm", 12500.0, 25000.0},
                                              {"wavenumber_cm-1", 800.0, 400.0},
                                              {"energy [eV]", 800.0 / 8065.543937, 400.0 / 8065.543937}}) {
    const TemporaryFile file("e.csv", fmt::format("{},n\n{},1.5\n{},2.5\n", header, first, second));
    EXPECT_NEAR(read_material_file(file.path(), {15.0, 15.0}, "").constant.n, 1.7, kDigitsOfConstant) << header;
  }
}

TEST(IndexFile_WithNegativeK, GivesNMinusIk) {
  const TemporaryFile file("e.csv", "wavelength_um,n,k\n8,1.5,-0.1\n12,1.5,0\n");
  const Material material = read_material_file(file.path(), {8.0, 12.0}, "");
  EXPECT_TRUE(material.is_conjugate);
  EXPECT_EQ(material.at(8.0).k, 0.1);
  EXPECT_EQ(material.least_k, 0.0);
}

TEST(IndexFile_WithNan, HoldsWhereTheSpectrumHasNone) {
  const TemporaryFile file("e.csv", "wavelength_um,n,k\n8,1.5,0.1\n9,NaN,nan\n10,1.5,0.3\n12,1.5,0.5\n");
  EXPECT_EQ(read_material_file(file.path(), {10.0, 12.0}, "").unknown_um, std::vector<double>{9.0});
  const std::string set = "surface.material_file=" + file.path();
  EXPECT_EQ(error_of(kMinimal, {set}), "no error");
  EXPECT_EQ(error_of(kMinimal, {set, "grid.wavelength_um=[8, 10]", "spectrum.wavelength_um=8"}), "no error");
  for (const std::string spectrum : {"spectrum.wavelength_um=9", "spectrum.band_um=[8, 10]"})
    EXPECT_TRUE(contains(error_of(kMinimal, {set, spectrum}), "\"e.csv\" has NaN at 9 um")) << spectrum;
  EXPECT_TRUE(
      contains(error_of(kMinimal, {set, "grid.wavelength_um=[8, 9]", "spectrum.wavelength_um=8"}), "has NaN at 9"));
}

TEST(IndexFile_Wrong, NamesFileAndLine) {
  for (const auto& [name, text, expected] :
       {std::tuple("e.csv", "wl,n,k\n8,1.5,-0.1\n12,1.5,0.1\n",
                   "e.csv:2: k = -0.1: out of range; must be a number in [-1e-05, 1e6], or negative in all rows"),
        {"e.csv", "wavelength_nm,n\n-8,1\n",
         "e.csv:2: wavelength_nm = -8: is -0.008 um, and must be a number in (0, inf)"},
        {"e.csv", "wavelength_um,wavelength_nm,n\n8,8020,1\n9,10000,1\n",
         "e.csv:3: wavelength_nm = 10000: is 10 um, but wavelength_um is another wavelength; leave out one of both "
         "columns"},
        {"e.csv", "wavelength,n\n8,1\n",
         "e.csv:1: column \"wavelength\" is unknown; the nearest known is wavelength_um"},
        {"e.csv", "wavelength_um,eps_1\n8,1\n", "e.csv:1: eps_1 and eps_2 must be given together"},
        {"e.csv", "wavelength_um,eps_1,eps_2,n\n8,1,1,1\n", "e.csv:1: eps_1 and eps_2 cannot be combined with n and k"},
        {"e.csv", "wavelength_um,eps_1,eps_2\n8,-1,0\n",
         "e.csv:2: eps_1 = -1 and eps_2 = 0: n = 0; must be in (0, 1e6]"},
        {"e.csv", "wavelength_um;n\n8;1,5\n",
         "e.csv:2: n = 1,5: not a number; must be a number in (0, 1e6]; numbers must"},
        {"e.csv", "wavelength_um\tn\n8\t\n", "e.csv:2: n: the value is missing"},
        {"e.csv", "# n k\n8 1 1\n", "e.csv:2: the columns must be named first"},
        {"e.lnk", "2 3.3\n8 1 1\n", "e.lnk:2: ends after 1 of 2 rows"},
        {"e.csv", "wavelength_um,reflectance\n8,0.1\n", "column \"reflectance\" is unknown"},
        {"e.csv", "wavelength_um,reflectance\n8,0.1\n", "a diffuse reflectance goes in surface.diffuse"},
        {"e.txt", " splib07a Record=5: Asphalt\n 0.1\n 0.2\n", "a diffuse reflectance goes in surface.diffuse"},
        {"e.txt", "8.0 0.1\n9.0 0.2\n", "a diffuse reflectance goes in surface.diffuse"}}) {
    const TemporaryFile file(name, text);
    EXPECT_TRUE(contains(refusal_of(file.path()), expected));
  }
}

// 120,000 rows of 40 bytes, 4.8 MB.
TEST(IndexFile_OfManyRows, IsRead) {
  constexpr int kRows = 120'000;
  std::string rows;
  for (int i = 0; i < kRows; ++i) rows += fmt::format("        {:.7f} 1.50000000 0.1000000000\n", 8.0 + 5e-5 * i);
  const TemporaryFile record("long.yml", "DATA:\n  - type: tabulated nk\n    data: |\n" + rows);
  const TemporaryFile table("long.txt", "wavelength_um n k\n" + rows);
  for (const std::string& path : {record.path(), table.path()}) {
    const Material material = read_material_file(path, {9.0, 12.0}, "");
    EXPECT_EQ(material.n.wavelength_um.size(), std::size_t{kRows}) << path;
    EXPECT_EQ(material.at(10.0), (OpticalConstants{1.5, 0.1})) << path;
  }
}

TEST(DataFiles_OfOtherKinds, HaveTheSameForms) {
  const TemporaryFile irradiance("e.txt", "! W m-2 um-1\n# wavelength_nm irradiance\n9000 1\n12000 4\n");
  EXPECT_NEAR(parse(kMinimal, {"source.file=" + irradiance.path()}).source->table->at(10.0), 2.0, kRounding);
  const TemporaryFile sky("s.txt", "zenith_deg;temperature_K\n0;240\n90;280\n");
  EXPECT_EQ(error_of(kMinimal, {"surroundings.profile=" + sky.path()}), "no error");
  const TemporaryFile curve("r.txt", "%beta_deg\tr_s\tr_p\n0\t0.1\t0.1\n90\t1\t1\n");
  EXPECT_EQ(error_of(kMinimal, {"surface.n=none", "surface.reflectance_file=" + curve.path()}), "no error");
}

// ---- Responses of cameras, and diffuse reflectances ----------------------------------------------------------------

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
            "r.csv:2: response = 0 in all rows: must be at least 1e-100 in one row");
  for (const char* rows : {"8,1\n10,1\n9,1\n", "8,1\n10,1\n10,0\n", "14,1\n10,1\n12,1\n"})
    EXPECT_TRUE(contains(response_error(header + rows), "r.csv:4: wavelength_um = ")) << rows;
}

TEST(ResponseFile_InOtherUnitsAndDirections, HasTheSameSpectrum) {
  for (const char* text :
       {"wavelength_um,response\n7,0\n8,0\n10,2\n12.5,0\n", "12.5 0\n10 2\n8 0\n7 0\n",
        "wavenumber_cm;response\n800;0\n1000;2\n1250;0\n", "response\twavelength_nm\n0\t8000\n2\t10000\n0\t12500\n"}) {
    const Spectrum spectrum = response_spectrum(parse_response(text, "r.csv"), ResponsePer::kPhoton);
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
}  // namespace dolp::data_files_test
