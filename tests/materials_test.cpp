// Materials, the sun and the data files a scene can name.
#include <gtest/gtest.h>

#include <cmath>

#include "error.hpp"
#include "scene/material_data.hpp"
#include "scene/scene_reader.hpp"
#include "scene/spectral_data.hpp"
#include "tests/temporary_file.hpp"

namespace dolp {
namespace {

/// A valid scene at 10.6 um, for errors that only a scene can give a place to.
const std::string kScene =
    "[surface]\n"
    "n = 1.5\n"
    "sigma = 0.3\n"
    "[emission]\n"
    "temperature_K = 300\n"
    "[spectrum]\n"
    "wavelength_um = 10.6\n";

std::string error_of(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr Spectrum kCo2Line{10.6, 10.6};

TEST(Material_BuiltIn, AllAreUsableAt10p6) {
  EXPECT_EQ(material_names().size(), 24U);
  for (const std::string& name : material_names()) {
    const Material material = find_material(name, kCo2Line, "");
    EXPECT_EQ(material.name, name);
    EXPECT_FALSE(material.source.empty());
    EXPECT_TRUE(material.is_constant());
  }
}

TEST(Material_BuiltIn, HasTheValuesOfTheFile) {
  EXPECT_EQ(find_material("iron", kCo2Line, "").constant, (OpticalConstants{7.3703, 29.487}));
  EXPECT_EQ(find_material("sapphire o", kCo2Line, "").constant, (OpticalConstants{0.61457, 0.12658}));
  EXPECT_EQ(find_material("silicon", kCo2Line, "").constant, (OpticalConstants{3.4189, 0.00012525}));
  EXPECT_EQ(find_material("iron", kCo2Line, "").source, "Ordal et al. 1988, Appl. Opt. 27, 1203 (Al,Fe,Ti,Ta,W,Mo)");
}

TEST(Material_Name, IgnoresCaseAndMayBeCutAtABlank) {
  EXPECT_EQ(find_material("IRON", kCo2Line, "").name, "iron");
  EXPECT_EQ(find_material(" water", kCo2Line, "").name, "water 25C");
  EXPECT_EQ(find_material("Aluminium (rakic)", kCo2Line, "").name, "aluminium (Rakic)");
}

TEST(Material_NameUnknown, NamesTheNearest) {
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material=irom"}), "--set surface.material=irom: unknown material"));
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material=irom"}), "known: iron"));
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material=aluminium"}), "aluminium (Rakic), aluminium (Ordal)"));
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material="}), "unknown material"));
}

TEST(Material_OfOneWavelength, IsRefusedFarFromIt) {
  EXPECT_EQ(error_of(kScene, {"surface.material=iron", "spectrum.wavelength_um=10.591"}), "no error");
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material=iron", "spectrum.wavelength_um=10.5"}),
                       "known at 10.6 um, and the spectrum is 10.5 um"));
  EXPECT_TRUE(contains(error_of(kScene, {"surface.material=iron", "spectrum.band_um=[10.595, 10.605]"}),
                       "known at 10.6 um, and the spectrum is 10.595 to 10.605 um"));
}

const std::string kDatabaseRecord =
    "# a comment\n"
    "REFERENCES: \"someone: a paper\"\n"
    "COMMENTS: |\n"
    "    - type: not data\n"
    "DATA:\n"
    "  - type: tabulated nk\n"
    "    data: |\n"
    "        8.0 1.5 0.1\n"
    "        10.0 2.0 0.3\n"
    "        14.0 1.0 0.5\n"
    "SPECS:\n"
    "    temperature: 298\n";

TEST(MaterialFile_DatabaseRecord, IsInterpolatedLinearly) {
  const TemporaryFile file("Xx.yml", kDatabaseRecord);
  const Material material = read_material_file(file.path(), {8.0, 14.0}, "");
  EXPECT_FALSE(material.is_constant());
  EXPECT_EQ(material.name, "Xx.yml");
  EXPECT_EQ(material.at(8.0), (OpticalConstants{1.5, 0.1}));
  EXPECT_EQ(material.at(14.0), (OpticalConstants{1.0, 0.5}));
  EXPECT_DOUBLE_EQ(material.at(9.0).n, 1.75);
  EXPECT_DOUBLE_EQ(material.at(9.0).k, 0.2);
}

TEST(MaterialFile_TwoTables, AreJoined) {
  const TemporaryFile yaml("a.yml",
                           "DATA:\n  - type: tabulated n\n    data: |\n      8 1.5\n      12 2.5\n"
                           "  - type: \"tabulated k\"\n    data: |\n      9 0.5\n      10 0.5\n      14 1.5\n");
  const TemporaryFile csv("a.csv", "wl,n\r\n8,1.5\r\n12,2.5\r\n\r\nwl,k\r\n9,0.5\r\n10,0.5\r\n14,1.5\r\n");
  for (const std::string& path : {yaml.path(), csv.path()}) {
    const Material material = read_material_file(path, {9.0, 12.0}, "");
    EXPECT_EQ(material.at(10.0), (OpticalConstants{2.0, 0.5})) << path;
    try {
      read_material_file(path, {8.0, 12.0}, "here: ");
      ADD_FAILURE() << path;
    } catch (const InputError& error) {
      EXPECT_TRUE(contains(error.what(), "here: ") && contains(error.what(), "known at 9 to 12 um")) << error.what();
    }
  }
}

TEST(MaterialFile_WithoutK, HasNone) {
  const TemporaryFile file("n.csv", "# mine\nwavelength_um,n\n8,1.5\n12,2.5\n");
  EXPECT_EQ(read_material_file(file.path(), {8.0, 12.0}, "").at(10.0), (OpticalConstants{2.0, 0.0}));
}

TEST(MaterialFile_Wrong, NamesFileAndLine) {
  struct Case {
    const char* name;
    std::string text;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"e.csv", "", "e.csv:1: no values of n"},
      {"e.csv", "8,1.5,0\n", "e.csv:1: 8,1.5,0: the columns must be named first"},
      {"e.csv", "wl,n,k\n8,1.5\n", "e.csv:2: 8,1.5: 2 values; 3 are expected"},
      {"e.csv", "wl,n,k\n8,x,1\n", "e.csv:2: n = x: not a number"},
      {"e.csv", "wl,n,k\n8,0,1\n", "e.csv:2: n = 0: must be in (0, 1e6]"},
      {"e.csv", "wl,n,k\n8,1,-1\n", "e.csv:2: k = -1: must be in [0, 1e6]"},
      {"e.csv", "wl,n,k\n8,1,1\n8,1,1\n", "e.csv:3: wavelength_um = 8: must be greater than 8"},
      {"e.csv", "wl,n,k\n0.01,1,1\n", "e.csv:2: wavelength_um = 0.01: must be in [0.1, 1e4]"},
      {"e.csv", "wl,k\n8,1\n", "e.csv:1: no values of n"},
      {"e.yml", "DATA:\n  - type: formula 1\n", "e.yml:2: type = formula 1: must be tabulated nk"},
      {"e.yml", "DATA:\n  - type: tabulated n\n    data: |\n        8 1 1\n",
       "e.yml:4: 8 1 1: 3 values; 2 are expected"},
      {"e.yml", "DATA:\n  - type: tabulated n\n    rows: 1\n",
       "e.yml:3: rows: 1: a DATA item has the keys type and data"},
      {"e.yml", "n: 1\n", "e.yml:1: no values of n"},
  };
  for (const Case& row : cases) {
    const TemporaryFile file(row.name, row.text);
    const std::string error = error_of(kScene, {"surface.material_file=" + file.path()});
    EXPECT_TRUE(contains(error, row.expected)) << error << "\nwithout: " << row.expected;
  }
}

TEST(Sun_At10p6, IsTheReferenceSpectrum) {
  // host/sun.csv: 0.179 to three digits.
  constexpr double kThreeDigits = 0.01;
  EXPECT_NEAR(sun_irradiance().at(10.6), 0.179, 0.179 * kThreeDigits);
}

TEST(Sun_AtItsNodes, HasTheValuesOfTheFile) {
  const SpectralTable sun = sun_irradiance();
  EXPECT_EQ(sun.at(2.0), 115.9);
  EXPECT_EQ(sun.at(10.0), 0.2272);
  EXPECT_EQ(sun.at(30.0), 0.002760);
}

TEST(Sun_BetweenNodes, IsAPowerOfWavelength) {
  const SpectralTable sun = sun_irradiance();
  const double middle_um = std::sqrt(10.0 * 11.0);
  // One log, one pow and a few products.
  constexpr double kRounding = 1e-14;
  EXPECT_NEAR(sun.at(middle_um) / std::sqrt(0.2272 * 0.1540), 1.0, kRounding);
}

TEST(Sun_OutsideItsTable, IsRefused) {
  EXPECT_TRUE(contains(error_of(kScene + "[source]\npreset = \"sun\"\n", {"spectrum.wavelength_um=1"}),
                       "s.toml:9: source.preset = \"sun\": known at 2 to 30 um, and the spectrum is 1 um"));
}

TEST(IrradianceFile_Wrong, NamesFileAndLine) {
  struct Case {
    const char* text;
    const char* expected;
  };
  const std::vector<Case> cases = {
      {"", "e.csv:1: no rows"},
      {"# only\nwavelength,irradiance\n", "e.csv:1: no rows"},
      {"wavelength,irradiance\nother,names\n", "e.csv:2: wavelength_um = other: not a number"},
      {"8,1,2\n", "e.csv:1: 8,1,2: 3 columns"},
      {"8,1\n9\n", "e.csv:2: 9: 1 columns"},
      {"8,-1\n", "e.csv:1: irradiance = -1: must be in [0, inf)"},
      {"8,nan\n", "e.csv:1: irradiance = nan: not a number"},
      {"9,1\n8,1\n", "e.csv:2: wavelength_um = 8: must be greater than 9"},
      {"8,1\n10,1\n", "known at 8 to 10 um, and the spectrum is 10.6 um"},
  };
  for (const Case& row : cases) {
    const TemporaryFile file("e.csv", row.text);
    const std::string error = error_of(kScene, {"source.file=" + file.path()});
    EXPECT_TRUE(contains(error, row.expected)) << error << "\nwithout: " << row.expected;
  }
}

TEST(IrradianceFile_WithZeros, IsInterpolatedLinearly) {
  const TemporaryFile file("e.csv", "\xEF\xBB\xBFwavelength_um, irradiance\r\n10, 0\r\n11, 2\r\n");
  const SpectralTable table = read_irradiance_file(file.path(), "");
  EXPECT_EQ(table.at(10.0), 0.0);
  EXPECT_EQ(table.at(10.5), 1.0);
}

}  // namespace
}  // namespace dolp
