// Files of n and k as instruments, archives and other programs write them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/material_data.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp {
namespace {

const Spectrum kCo2Line{10.6, 10.6};
constexpr double kRounding = 1e-12;  // a few roundings of numbers near 1

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
    EXPECT_TRUE(contains(refusal_of(sample(name)), expected)) << refusal_of(sample(name));
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
  struct Case {
    const char* header;
    double first, second;
  };
  constexpr double kDigitsOfConstant = 1e-9;
  for (const auto& [header, first, second] :
       {Case{"wavelength_um", 12.5, 25.0}, Case{"wavelength_nm", 12500.0, 25000.0},
        Case{"wavenumber_cm-1", 800.0, 400.0}, Case{"energy [eV]", 800.0 / 8065.543937, 400.0 / 8065.543937}}) {
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
  for (const std::string spectrum : {"spectrum.wavelength_um=9", "spectrum.band_um=[8, 10]"}) {
    EXPECT_TRUE(contains(error_of(kMinimal, {set, spectrum}), "\"e.csv\" has NaN at 9 um")) << spectrum;
  }
  EXPECT_TRUE(
      contains(error_of(kMinimal, {set, "grid.wavelength_um=[8, 9]", "spectrum.wavelength_um=8"}), "has NaN at 9"));
}

TEST(IndexFile_Wrong, NamesFileAndLine) {
  struct Case {
    const char* name;
    const char* text;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"e.csv", "wl,n,k\n8,1.5,-0.1\n12,1.5,0.1\n",
       "e.csv:2: k = -0.1: out of range; must be a number in [-1e-05, 1e6], or negative in all rows"},
      {"e.csv", "wavelength_nm,n\n-8,1\n",
       "e.csv:2: wavelength_nm = -8: is -0.008 um, and must be a number in (0, inf)"},
      {"e.csv", "wavelength,n\n8,1\n", "e.csv:1: column \"wavelength\" is unknown; the nearest known is wavelength_um"},
      {"e.csv", "wavelength_um,eps_1\n8,1\n", "e.csv:1: eps_1 and eps_2 must be given together"},
      {"e.csv", "wavelength_um,eps_1,eps_2,n\n8,1,1,1\n", "e.csv:1: eps_1 and eps_2 cannot be combined with n and k"},
      {"e.csv", "wavelength_um,eps_1,eps_2\n8,-1,0\n", "e.csv:2: eps_1 = -1 and eps_2 = 0: n = 0; must be in (0, 1e6]"},
      {"e.csv", "wavelength_um;n\n8;1,5\n",
       "e.csv:2: n = 1,5: not a number; must be a number in (0, 1e6]; numbers must"},
      {"e.csv", "wavelength_um\tn\n8\t\n", "e.csv:2: n: the value is missing"},
      {"e.csv", "# n k\n8 1 1\n", "e.csv:2: the columns must be named first"},
      {"e.lnk", "2 3.3\n8 1 1\n", "e.lnk:2: ends after 1 of 2 rows"},
      {"e.csv", "wavelength_um,reflectance\n8,0.1\n", "column \"reflectance\" is unknown"},
      {"e.csv", "wavelength_um,reflectance\n8,0.1\n", "a diffuse reflectance goes in surface.diffuse"},
      {"e.txt", " splib07a Record=5: Asphalt\n 0.1\n 0.2\n", "a diffuse reflectance goes in surface.diffuse"},
      {"e.txt", "8.0 0.1\n9.0 0.2\n", "a diffuse reflectance goes in surface.diffuse"},
  };
  for (const auto& [name, text, expected] : cases) {
    const TemporaryFile file(name, text);
    EXPECT_TRUE(contains(refusal_of(file.path()), expected)) << refusal_of(file.path()) << "\nwithout: " << expected;
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
  EXPECT_NEAR(parse(kMinimal, {"source.file=" + irradiance.path()}).source->table.at(10.0), 2.0, kRounding);
  const TemporaryFile sky("s.txt", "zenith_deg;temperature_K\n0;240\n90;280\n");
  EXPECT_EQ(error_of(kMinimal, {"surroundings.profile=" + sky.path()}), "no error");
  const TemporaryFile curve("r.txt", "%beta_deg\tr_s\tr_p\n0\t0.1\t0.1\n90\t1\t1\n");
  EXPECT_EQ(error_of(kMinimal, {"surface.n=none", "surface.reflectance_file=" + curve.path()}), "no error");
}

}  // namespace
}  // namespace dolp
