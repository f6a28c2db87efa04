// Materials, the sun, and the data files of a scene.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "error_text.hpp"
#include "scene/csv.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"
#include "scene/spectral_data.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp::materials_test {
namespace {

const Spectrum kCo2Line{10.6, 10.6};
// Accuracy of the expected values below, which were copied by hand.
constexpr double kDigits = 1e-9;

void expect_near(const OpticalConstants& index, const OpticalConstants& expected, const std::string& what) {
  EXPECT_NEAR(index.n, expected.n, kDigits) << what;
  EXPECT_NEAR(index.k, expected.k, kDigits) << what;
}

TEST(Material_BuiltIn, HasTheRowsThatItsSourceCounts) {
  const std::vector<Material>& materials = built_in_materials();
  ASSERT_EQ(materials.size(), 41U);
  CsvReader row(embedded_materials_sources_csv(), "sources");
  row.next();
  ASSERT_EQ(row.cells()[2], "from_um");
  ASSERT_EQ(row.cells()[5], "points_kept");
  for (const Material& material : materials) {
    ASSERT_TRUE(row.next());
    EXPECT_EQ(material.name, row.cells()[0]);
    EXPECT_FALSE(material.source.empty() || material.source.front() == '"') << material.source;
    EXPECT_EQ(static_cast<double>(material.n.wavelength_um.size()), row.number(5, "points_kept")) << material.name;
    EXPECT_EQ(material.n.wavelength_um, material.k.wavelength_um) << material.name;
    EXPECT_EQ(known_range(material).min_um, row.number(2, "from_um")) << material.name;
    EXPECT_EQ(known_range(material).max_um, row.number(3, "to_um")) << material.name;
    EXPECT_EQ(material.kind, row.cells()[7]);
  }
  EXPECT_FALSE(row.next());
}

TEST(Material_BuiltIn, IsWithinTheThinningOfTheWholeRecord) {
  // host/data/materials.csv omits rows of the database. This changes N = n + ik by at most kThinning |N|.
  constexpr double kThinning = 1e-3;
  // n and k at 10.6 um, interpolated by hand in the complete records of the database, to five digits.
  for (const auto& [name, n, k] : {std::tuple("iron", 7.3703, 29.487),
                                   {"iron (Querry)", 5.5281, 30.891},
                                   {"chromium", 8.1627, 34.703},
                                   {"gold evaporated (Olmon)", 12.053, 69.463},
                                   {"copper (Querry ingot)", 7.9376, 61.880},
                                   {"silver", 11.180, 72.941},
                                   {"silicon", 3.4189, 0.00012525},
                                   {"SiO2 fused silica", 2.0331, 0.02096},
                                   {"BK7 borosilicate", 2.4080, 0.65976},
                                   {"oxidised Al mirror", 42.666, 65.844},
                                   {"water 25C", 1.1786, 0.07232},
                                   {"Ge germanium", 4.0036, 0.0},
                                   {"Si3N4 silicon nitride film", 1.9402, 1.5458},
                                   {"ZnS sulfide", 2.1895, 0.002},
                                   {"CaF2 calcium fluoride (Li)", 1.2811, 0.0},
                                   {"CaF2 calcium fluoride (Kaiser)", 1.286, 0.003597},
                                   {"kaolinite pellet", 1.5555, 0.46781},
                                   {"montmorillonite pellet", 1.8812, 0.18479}}) {
    const OpticalConstants index = find_material(name, kCo2Line, "").at(10.6);
    EXPECT_LE(std::hypot(index.n - n, index.k - k), kThinning * std::hypot(n, k)) << name;
  }
}

TEST(Material_OverABand, HasItsTable) {
  const Material iron = find_material("iron", {2.0, 20.0}, "");
  EXPECT_FALSE(iron.is_constant());
  EXPECT_EQ(iron.at(8.0), (OpticalConstants{6.1662033, 22.672232}));
  expect_near(iron.at(9.0), {6.6174306, 25.2869875}, "half way from 8 to 10");
  EXPECT_EQ(error_of(kMinimal, {"surface.material=Kapton", "spectrum.band_um=[3, 5]"}), "no error");
}

TEST(Material_OutsideItsTable, IsRefusedWithTheRange) {
  for (const auto& [name, spectrum, expected] :
       {std::tuple("iron", "wavelength_um = 1.99", "\"iron\" are known at 2 to 20 um, and the spectrum is 1.99 um"),
        {"iron", "wavelength_um = 20.1", "\"iron\" are known at 2 to 20 um, and the spectrum is 20.1 um"},
        {"iron", "band_um = [1, 5]", "\"iron\" are known at 2 to 20 um, and the spectrum is 1 to 5 um"},
        {"iron", "band_um = [15, 21]", "\"iron\" are known at 2 to 20 um, and the spectrum is 15 to 21 um"},
        {"water", "band_um = [1, 30]", "\"water 25C\" are known at 2 to 20 um, and the spectrum is 1 to 30 um"},
        {"oxidised", "wavelength_um = 13",
         "\"oxidised Al mirror\" are known at 2 to 12.5 um, and the spectrum is 13 um"}}) {
    const std::string text = fmt::format(
        "[surface]\nsigma = 0.3\nmaterial = \"{}\"\n[emission]\ntemperature_K = 300\n[spectrum]\n{}\n", name, spectrum);
    EXPECT_EQ(error_of(text), fmt::format("s.toml:3: surface.material = \"{}\": n and k of {}", name, expected));
  }
}

TEST(Material_Name, IgnoresCaseAndMayBeSomeOfItsWords) {
  EXPECT_EQ(find_material("IRON", kCo2Line, "").name, "iron");
  EXPECT_EQ(find_material(" water", kCo2Line, "").name, "water 25C");
  EXPECT_EQ(find_material("zinc", kCo2Line, "").name, "zinc selenide");
  EXPECT_EQ(find_material("Aluminium (rakic)", kCo2Line, "").name, "aluminium (Rakic)");
  EXPECT_EQ(find_material("quartz", kCo2Line, "").name, "SiO2 amorphous quartz");
  EXPECT_EQ(find_material("acrylic", kCo2Line, "").name, "PMMA acrylic");
}

TEST(Material_NameUnknown, NamesTheNearest) {
  for (const auto& [name, part] : {std::pair("irom", "--set surface.material=irom: unknown material"),
                                   {"irom", "known: iron"},
                                   {"aluminium", "aluminium (Rakic), aluminium (Ordal)"},
                                   {"sea water", "known: water 25C"},
                                   {"kaolinit", "known: kaolinite pellet"},
                                   {"zinc sulfide", "known: zinc selenide, ZnS sulfide"}})
    EXPECT_TRUE(contains(error_of(kMinimal, {std::string("surface.material=") + name}), part));
}

TEST(Material_NameOfNoBuiltIn, SaysHowToGiveNAndK) {
  for (const std::string name : {"asphalt", "paint", "steel", "stainless steel", "concrete", ""})
    EXPECT_TRUE(contains(error_of(kMinimal, {"surface.material=" + name}),
                         "is not one of the 41 built-in materials, which dolp materials lists; give its n and k as "
                         "numbers, or as a file by material_file"));
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
    const std::string message = error_text([&] { read_material_file(path, {8.0, 12.0}, "here: "); });
    EXPECT_TRUE(contains(message, "here: ") && contains(message, "known at 9 to 12 um")) << message;
  }
}

TEST(MaterialFile_WithoutK, HasNone) {
  const TemporaryFile file("n.csv", "# mine\nwavelength_um,n\n8,1.5\n12,2.5\n");
  EXPECT_EQ(read_material_file(file.path(), {8.0, 12.0}, "").at(10.0), (OpticalConstants{2.0, 0.0}));
}

TEST(MaterialFile_OfOneRow, HoldsAtItsWavelengthOnly) {
  const TemporaryFile file("paint.csv", "wavelength_um,n,k\n10.6,1.5,0.1\n");
  EXPECT_EQ(read_material_file(file.path(), kCo2Line, "").constant, (OpticalConstants{1.5, 0.1}));
  for (const char* spectrum : {"spectrum.wavelength_um=10.5", "spectrum.band_um=[10.5, 10.7]"})
    EXPECT_TRUE(contains(error_of(kMinimal, {"surface.material_file=" + file.path(), spectrum}),
                         "\"paint.csv\" are known at 10.6 um, and the spectrum is 10.5 "));
}

std::string formula(const std::string& range, const std::string& coefficients, int number = 1) {
  return "DATA:\n  - type: formula " + std::to_string(number) + "\n    wavelength_range: " + range +
         "\n    coefficients: " + coefficients + "\n";
}

// Coefficients from publications. The comments name the material and, if published, its index at the wavelength.
TEST(Dispersion_Formulas, HaveThePublishedValues) {
  constexpr double kShownDigits = 1e-7;  // the indices below have seven decimals
  for (const auto& [number, coefficients, um, n] :
       {// fused silica, Malitson 1965: 1.4504
        std::tuple(1, "0 0.6961663 0.0684043 0.4079426 0.1162414 0.8974794 9.896161", 1.0, 1.4504174),
        // ZnSe, Connolly 1979: 2.4028
        {1, "0 4.45813734 0.200859853 0.467216334 0.391371166 2.89566290 47.1362108", 10.6, 2.4027809},
        // NaCl, Li 1976: 1.4947
        {1, "0.00055 0.198 0.05 0.48398 0.1 0.38696 0.128 0.25998 0.158 0.08796 40.5 3.17064 60.98 0.30038 120.34",
         10.0, 1.4947343},
        // Ge, Burnett 2016: 4.0036
        {2, "0 0.4886331 1.393959 14.5142535 0.1626427 0.0091224 752.190", 10.6, 4.0035563},
        // BK7: n_d = 1.51680, in two notations
        {2, "0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653", 0.5875618, 1.5168000},
        {3, "2.2718929 -0.010108077 2 0.010592509 -2 2.0816965e-4 -4 -7.6472538e-6 -6 4.9240991e-7 -8", 0.5875618,
         1.5167997},
        // LiB3O5, Chen 1989: 1.5656; TiO2, DeVore 1951: 2.613
        {4, "2.4542 0.01125 0 0.01135 1 0 0 0 1 -0.01388 2", 1.0, 1.5657903},
        {4, "5.913 0.2441 0 0.0803 1", 0.5893, 2.6129140},
        // BK7 with textbook coefficients
        {5, "1.5046 0.0042 -2", 0.5893, 1.5166942},
        // air, Ciddor 1996: 1.000277
        {6, "0 0.05792105 238.0185 0.00167917 57.362", 0.5893, 1.0002771},
        // Si, Edwards 1980: 3.42
        {7, "3.41983 0.159906 -0.123109 1.26878e-6 -1.95104e-9", 10.0, 3.4215246},
        // AgBr, Schröter 1931
        {8, "0.452505 0.09939 0.070537 -0.0015", 0.5893, 2.2555035},
        // urea, Rosker 1985
        {9, "2.51527 0.0240 0.0300 0.0202 1.52 0.8771", 0.5893, 1.6062783}}) {
    const std::string range = std::to_string(0.99 * um) + " " + std::to_string(1.01 * um);
    const TemporaryFile file("f.yml", formula(range, coefficients, number));
    const Material material = read_material_file(file.path(), {um, um}, "");
    EXPECT_NEAR(material.at(um).n, n, kShownDigits) << number << ": " << coefficients;
    EXPECT_EQ(material.at(um).k, 0.0);
  }
}

TEST(MaterialFile_FormulaAndTable, AreJoined) {
  const TemporaryFile file("f.yml",
                           formula("0.5 18", "0 4.45813734 0.200859853 0.467216334 0.391371166 2.8956629 47.1362108") +
                               "  - type: tabulated k\n    data: |\n      9 0.5\n      12 1.0\n");
  const Material material = read_material_file(file.path(), {9.0, 12.0}, "");
  EXPECT_FALSE(material.is_constant());
  EXPECT_NEAR(material.at(10.6).n, 2.4027809, 1e-7);
  EXPECT_DOUBLE_EQ(material.at(10.5).k, 0.75);
}

TEST(MaterialFile_Wrong, NamesFileAndLine) {
  using Row = std::tuple<const char*, std::string, const char*>;
  for (const auto& [name, text, expected] : std::vector<Row>{
           {"e.csv", "", "e.csv:1: no values of n"},
           {"e.csv", "8,1.5,0\n", "e.csv:1: the columns must be named first"},
           {"e.csv", "wl,n,k\n8,0,1\n", "e.csv:2: n = 0: out of range; must be a number in (0, 1e6]"},
           {"e.csv", "wl,n,k\n8,1,-1\n9,1,1\n", "e.csv:2: k = -1: out of range; must be a number in [-1e-05, 1e6]"},
           {"e.csv", "wl,n,k\n8,1,1\n7,2,1\n8,1.5,1\n", "e.csv:4: wavelength_um = 8: has n = 1 and 1.5"},
           {"e.csv", "wl,n\n8,1\nwl,n\n7,1\n", "e.csv:4: wavelength_um = 7: must be greater than 8"},
           {"e.csv", "wl,n,k\n8,1,-2e6\n", "e.csv:2: k = -2e6: out of range"},
           {"e.csv", "wl,n,k\n0.01,1,1\n", "e.csv:1: no values of n at wavelengths in [0.1, 1e4] um"},
           {"e.csv", "wl,n,k\n-8,1,1\n", "e.csv:2: wavelength_um = -8: out of range"},
           {"e.csv", "wavelength_mm,n,k\n8,1,1\n",
            "column \"wavelength_mm\" is unknown; the nearest known is wavelength_um"},
           {"e.txt", "# a record\nDATA:\n  - type: tabulated n\n",
            "e.txt:1: is a YAML record; the name must end in .yml"},
           {"e.csv", "wl,k\n8,1\n", "e.csv:1: no values of n, only of k"},
           {"e.yml", "DATA:\n  - type: formula 10\n", "e.yml:2: type = formula 10: must be tabulated nk"},
           {"e.yml", "DATA:\n  - type: formula 1\n    coefficients: 0 1 0.1\n", "e.yml:2: wavelength_range: missing"},
           {"e.yml", formula("8 14", ""), "e.yml:2: coefficients: missing; a DATA item must have it"},
           {"e.yml", formula("8 14", "0 1"), "e.yml:4: coefficients = 0 1: 2 numbers; formula 1 takes 1, 3, 5,"},
           {"e.yml", formula("8 14", "0 1 x"), "e.yml:4: coefficients = x: not a number"},
           {"e.yml", formula("8", "0 1 0.1"), "e.yml:3: wavelength_range = 8: must be two numbers, in um"},
           {"e.yml", formula("8 14", "-3 1 0.1"), "e.yml:4: n is in (0, 1e6] nowhere in the range of the formula"},
           {"e.yml", formula("8 20", "0 1 11"), "n and k of \"e.yml\" are known at 11.01"},
           {"e.yml", formula("8 14", "0 0.5 11"), "n = nan of \"e.yml\" at 10.6 um: the formula has a pole there"},
           {"e.yml", formula("1 5", "0 1 0.1"), "known at 1 to 5 um, and the spectrum is 10.6 um"},
           {"e.yml", formula("8 14", "0 1 0.1") + "  - type: tabulated n\n    data: 20 1\n",
            "e.yml:5: type = tabulated n: n is given twice"},
           {"e.yml", "DATA: 1\n", "e.yml:1: DATA: must be a list of items"},
           {"e.yml", "DATA:\n  - 1\n", "e.yml:2: a DATA item has the keys type and data"},
           {"e.yml", "DATA:\n  - type: [1]\n", "e.yml:2: type: missing"},
           {"e.yml", "DATA:\n  - {type\n", "not valid YAML: "},
           {"e.yml", "a: *b\n", "e.yml:1: not valid YAML: "},
           {"e.yml", std::string(1U << 20U, '['), "e.yml:1: nested too deeply"},
           {"e.yml", "a: &a [*a]\nDATA: *a\n", "a DATA item has the keys type and data"},
           {"e.yml", std::string(5U << 20U, 'x'), "e.yml: is longer than 4194304 bytes without its rows of numbers"},
           {"e.yml", "DATA:\n  - type: tabulated n\n    data: |\n        8 1 1\n",
            "e.yml:4: 1: one value too many after column n, the last"},
           {"e.yml", "DATA:\n  - type: tabulated n\n    rows: 1\n",
            "e.yml:3: rows: 1: a DATA item has the keys type and data"},
           {"e.yml", "n: 1\n", "e.yml:1: no values of n: it has no list DATA"},
           {"e.yml", "- SHELF: main\n", "e.yml:1: no values of n: it is a catalogue"},
           {"e.yml", "ABOUT: a metal\n", "e.yml:1: no values of n: it describes a material"},
           {"e.yml", "wl,n\n8,1\n", "e.yml:1: no values of n: it has no keys; a CSV must have another name"},
           {"e.yml", "DATA:\n  - type: tabulated k\n    data: 8 1\n",
            "e.yml:1: no values of n, only of k, at wavelengths in [0.1, 1e4] um"}}) {
    const TemporaryFile file(name, text);
    EXPECT_TRUE(contains(error_of(kMinimal, {"surface.material_file=" + file.path()}), expected));
  }
}

// Ways in which a file may differ from tidy.yml. All these files must give the same material.
TEST(MaterialFile_UntidyRecord, IsTheTidyOne) {
  const OpticalConstants half_way{1.75, 0.2};
  const std::string nk = "DATA:\n  - type: tabulated nk\n    data: |\n";
  const std::string rows = "      8 1.5 0.1\n      10 2 0.3\n";
  const std::string n = "DATA:\n  - type: tabulated n\n    data: |\n      8 1.5\n      10 2\n";
  for (const auto& [name, text] : {
           std::pair("tidy.yml", nk + rows),
           {"x-rays.yml", nk + "      1.033E-05 0 -1\n" + rows + "      2e4 9 9\n"},
           {"repeated.yml", nk + rows + "      10 2 0.3\n"},
           {"unsorted.yml", nk + "      10 2 0.3\n      8 1.5 0.1\n"},
           {"range.yml", nk + rows + "    wavelength_range: 8 10\n"},
           {"long.yml", "COMMENTS: " + std::string(3U << 20U, 'x') + "\n" + nk + rows},
           {"k below.yml", n + "  - type: tabulated k\n    data: |\n      7 -2e-7\n      8 0.1\n      10 0.3\n"},
           {"descending.csv", "wavelength_um,n,k\n10,2,0.3\n8,1.5,0.1\n,,\n"},
           {"by name.csv", "K,N,WL\n0.1,1.5,8\n0.3,2,10\n"},
       }) {
    const TemporaryFile file(name, text);
    expect_near(read_material_file(file.path(), {9.0, 9.0}, "").constant, half_way, name);
  }
}

TEST(MaterialFile_KBelowZeroByNoise, CountsAsZero) {
  const TemporaryFile file("n.csv", "wl,n,k\n8,1.5,-2e-7\n12,2.5,0\n");
  const Material material = read_material_file(file.path(), {8.0, 12.0}, "");
  EXPECT_EQ(material.at(8.0), (OpticalConstants{1.5, 0.0}));
  EXPECT_EQ(material.least_k, -2e-7);
}

// At a wavelength of L um, n^2 = 1 + 0.5 L^2 / (L^2 - 11^2), with a pole at 11 um. From 8.98 um to 11 um n is not real.
TEST(MaterialFile_FormulaWithAPole, HoldsWhereTheSpectrumHasNone) {
  const TemporaryFile file("f.yml", formula("20 0.05", "0 0.5 11"));
  const std::string set = "surface.material_file=" + file.path();
  EXPECT_NEAR(read_material_file(file.path(), {8.0, 8.0}, "").at(8.0).n, std::sqrt(1.0 - 32.0 / 57.0), kDigits);
  EXPECT_EQ(error_of(kMinimal, {set, "grid.wavelength_um=[8, 12]", "spectrum.wavelength_um=8"}), "no error");
  for (const char* spectrum : {"grid.wavelength_um=[8, 10, 12]", "spectrum.band_um=[8, 12]"})
    EXPECT_TRUE(contains(error_of(kMinimal, {set, spectrum}), " um: the formula has a pole there"));
}

TEST(Sun_Irradiance, HasTheValuesOfTheFile_AndIsAPowerOfWavelengthBetweenThem) {
  const SpectralTable sun = sun_irradiance();
  EXPECT_EQ(sun.at(2.0), 115.9);
  EXPECT_EQ(sun.at(10.0), 0.2272);
  EXPECT_EQ(sun.at(30.0), 0.002760);
  const double middle_um = std::sqrt(10.0 * 11.0);
  // rounding of a logarithm, a power and a few products
  constexpr double kRounding = 1e-14;
  EXPECT_NEAR(sun.at(middle_um) / std::sqrt(0.2272 * 0.1540), 1.0, kRounding);
}

TEST(AtWavelength, SourceAndMaterial_AreThoseOfTheirTablesThere) {
  const SceneValues scene = parse(kMinimal, {"source.preset=sun", "surface.material=iron"});
  for (const double um : {4.0, 8.3}) {
    const SceneModel at = at_wavelength(scene, um);
    EXPECT_EQ(at.source->irradiance, sun_irradiance().at(um));
    EXPECT_EQ(at.surface.material.constant, find_material("iron", {um, um}, "").constant);
  }
}

TEST(Sun_OutsideItsTable, IsRefused) {
  EXPECT_TRUE(contains(error_of(kMinimal + "[source]\npreset = \"sun\"\n", {"spectrum.wavelength_um=1"}),
                       "s.toml:9: source.preset = \"sun\": known at 2 to 30 um, and the spectrum is 1 um"));
}

TEST(IrradianceFile_Wrong, NamesFileAndLine) {
  for (const auto& [text, expected] :
       {std::pair("", "e.csv:1: no rows"),
        {"# only\nwavelength_um,irradiance\n", "e.csv:1: no rows"},
        {"wavelength_um,irradiance\nother,names\n", "e.csv:2: wavelength_um = other: not a number"},
        {"wavelength_um,irradiance_W_m2_nm\n8,1\n",
         "column \"irradiance_W_m2_nm\" is unknown; the nearest known is irradiance, allowed are wavelength_um (or "
         "wavelength_nm, wavenumber_cm, energy_eV), irradiance (W m-2 um-1)"},
        {"wavelength_um\n8\n", "e.csv:1: column \"irradiance\" is missing, a number in [0, inf)"},
        {"8,-1\n", "e.csv:1: irradiance = -1: out of range; must be a number in [0, inf)"},
        {"9,1\n8,1\n9,2\n", "e.csv:3: wavelength_um = 9: has irradiance = 1 and 2"},
        {"8,1\n10,1\n", "known at 8 to 10 um, and the spectrum is 10.6 um"}}) {
    const TemporaryFile file("e.csv", text);
    EXPECT_TRUE(contains(error_of(kMinimal, {"source.file=" + file.path()}), expected));
  }
}

TEST(NamedFile_ThatIsNoRegularFile, IsRefused) {
  const TemporaryFile beside("beside", "");
  const std::string pipe = beside.path() + ".pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string key : {"surface.material_file", "source.file"}) {
    for (const std::string& path : {pipe, std::string("/dev/zero"), std::string("-")})
      EXPECT_TRUE(error_of(kMinimal, {key + "=" + path}).ends_with(": is not a regular file")) << key << " = " << path;
  }
}

TEST(IrradianceFile_Columns, AreFoundByName) {
  for (const char* text :
       {"10,1\n11,3\n", "wavelength_um,irradiance\n10,1\n11,3\n", "irradiance,wavelength_um\n1,10\n3,11\n",
        "wavelength_um,irradiance_W_m2_um\n11,3\n10,1\n,\n", "0.01,9\n10,1\n10,1\n11,3\n"}) {
    EXPECT_EQ(parse_irradiance(text, "e.csv").at(10.5), 2.0) << text;
  }
}

TEST(IrradianceFile_WithZeros, IsInterpolatedLinearly) {
  const SpectralTable table = parse_irradiance("\xEF\xBB\xBFwavelength_um, irradiance\r\n10, 0\r\n11, 2\r\n", "e.csv");
  EXPECT_EQ(table.at(10.0), 0.0);
  EXPECT_EQ(table.at(10.5), 1.0);
}

}  // namespace
}  // namespace dolp::materials_test
