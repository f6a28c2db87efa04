// `dolp verify`: its choice of entries, its comparison, and the command as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "error_text.hpp"
#include "run/table_scene.hpp"
#include "scene/scene_reader.hpp"
#include "table/table_file.hpp"
#include "verify/table_check.hpp"

namespace dolp::verify_test {
namespace {

enum Status { kDone = 0, kAccuracy = 1, kInput = 2, kDevice = 3 };

// ---- Parts ---------------------------------------------------------------------------------------------------------

TEST(Overrides, AnyValues_SurviveTheAttribute) {
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{},
        {"surface.masking=smith"},
        {"title=a = b", "emission=none", "grid.q=[2,\n3]"},
        {"grid.theta_deg={from=0,\nto=80,\ncount=3}", "grid.theta_deg.count=5", "surface.n=2"}}) {
    std::vector<std::string> again;
    for (const Setting& setting : override_settings(settings_text(settings_from_text(overrides))))
      again.push_back(setting.text());
    EXPECT_EQ(again, overrides);
  }
}

TEST(Overrides, ALineLikeASetting_StaysAPartOfItsValue) {
  const std::string text = settings_text(settings_from_text({"title=\"\"\"a\nsurface.n=2\"\"\"", "grid.q=[2,\n3]"}));
  EXPECT_EQ(text, "title=\"a\\nsurface.n=2\"\ngrid.q=[2,\n3]");
  const std::vector<Setting> settings = override_settings(text);
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[0].value.text(), "\"a\\nsurface.n=2\"");
}

TableValues small_table() {
  TableValues table;
  table.axes[Axis::kTheta] = {60.0};
  table.axes[Axis::kSigma] = {0.3};
  table.axes[Axis::kQ] = {2.0};
  return table;
}

std::string refusal(const TableValues& table, const std::string& scene_text) {
  return error_text([&] { check_table({table, {0}}, parse_scene(scene_text, "scene.toml", {}), "t.nc", {}); });
}

TEST(CheckTable, NothingToCompare_IsRefused) {
  TableValues table = small_table();
  table[Quantity::kAlbedo] = {1.0};
  table[Quantity::kDolp] = {0.1};  // without error_estimate DOLP is not compared
  EXPECT_TRUE(contains(refusal(table, kScene), "t.nc: has nothing to compare"));
}

TEST(CheckTable, AxisOutOfRange_IsRefused) {
  TableValues table = small_table();
  table[Quantity::kDolp] = table[Quantity::kErrorEstimate] = {0.1};
  table.axes[Axis::kTheta] = {90.5};
  EXPECT_TRUE(contains(refusal(table, kScene), "t.nc: axis theta: 90.5 is out of range"));
  table.axes[Axis::kTheta] = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_TRUE(contains(refusal(table, kScene), "axis theta: nan"));
}

TEST(CheckTable, EmptyStatusAndNoEstimates_PromiseNothing) {
  TableValues table = small_table();
  table[Quantity::kRhoI] = {0.3};
  table[Quantity::kRhoErrorEstimate] = {std::numeric_limits<double>::infinity()};
  const TableCheck check = check_table({table, {0}}, parse_scene(kScene, "scene.toml", {}), "t.nc", {});
  EXPECT_TRUE(check.passed());
  ASSERT_EQ(check.quantities.size(), 1U);
  EXPECT_EQ(check.quantities.front().unstated, 1U);
}

// ---- The program ---------------------------------------------------------------------------------------------------

void put_value(const std::filesystem::path& path, Quantity quantity, std::size_t position, double value) {
  TableValues table = read_table(path);
  table[quantity].at(position) = value;
  write_table(table, path);
}

void put_attribute(const std::filesystem::path& path, const std::string& name, const std::string& text) {
  TableValues table = read_table(path);
  const auto found = std::ranges::find(table.attributes, name, &Attribute::name);
  ASSERT_NE(found, table.attributes.end()) << name;
  found->value = text;
  write_table(table, path);
}

/// Masking for which the reference is fast. The masking of scene.toml, `integral`, is slow.
const Words kFastMasking = "--set surface.masking=v-cavity";
/// A grid of one entry. The reference takes most of the time of `dolp verify`, for each entry.
const Words kOneEntry = "--set grid.theta_deg=60 --set grid.sigma=0.1 --set grid.q=3.5";
/// A grid of four entries: two zeniths and two q.
const Words kFourEntries = "--set grid.theta_deg=[30,60] --set grid.sigma=0.1 --set grid.q=[2,3.5]";

class Verify : public CommandLine {
 protected:
  /// Makes a table of the grid in scene.toml: 16 entries.
  TableValues make_table(const Words& options = {}) const {
    succeeded(dolp(joined("table scene.toml -o t.nc --quiet --evaluator cpu", options)));
    return read_table(at("t.nc"));
  }
  nlohmann::json verify_json(Status expected, const Words& options = {}) const {
    const Outcome outcome = dolp(joined("verify t.nc --json", options));
    EXPECT_EQ(outcome.status, expected) << outcome.out << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
};

// Where the error of DOLP exceeds DOLP, as at normal incidence, the angle of polarisation has no meaning.
TEST_F(Verify, AngleOfUnpolarisedLight_IsNotAFailure) {
  succeeded(dolp("table " DOLP_HOST_DIR "/scenes/night_paint.toml -o t.nc --quiet --set grid.theta_deg=[0,0.001,0.01] "
                 "--set grid.sigma=[0.1,0.3,1] --tolerance 1e-3"));
  EXPECT_EQ(verify_json(kDone)["passed"], true);
}

// Near 90 degrees the reference of a band with fringes is less accurate than the closed form of a smooth surface.
TEST_F(Verify, ErrorsThatTheReferenceCannotSee_AreUndecided) {
  succeeded(dolp("table " DOLP_HOST_DIR "/scenes/paint_on_metal.toml -o t.nc --quiet --set emission.model=fresnel "
                 "--set surroundings=none --set surface.sigma=0 --set grid.theta_deg=90"));
  const nlohmann::json json = verify_json(kDone);
  EXPECT_EQ(json["quantities"][0]["undecided"], 1);
  EXPECT_TRUE(contains(json["verdict"].get<std::string>(), "values are undecided, because the reference"));
}

TEST_F(Verify, GoodTable_Exit0AndEveryQuantityIsCompared) {
  make_table();
  const nlohmann::json json = verify_json(kDone);
  EXPECT_EQ(json["entries"], 16);
  EXPECT_EQ(json["checked"], 16);
  EXPECT_EQ(json["passed"], true);
  std::set<std::string> names;
  for (const auto& quantity : json["quantities"]) {
    names.insert(quantity["name"]);
    EXPECT_EQ(quantity["compared"], 16) << quantity;
  }
  EXPECT_EQ(names, (std::set<std::string>{"dolp", "q_over_i", "aolp_deg", "rho_i", "rho_q", "stokes_i", "stokes_q",
                                          "stokes_u", "stokes_v", "albedo", "emissivity_s", "emissivity_p"}));
  EXPECT_TRUE(contains(succeeded(dolp("verify t.nc --samples 1")).out, "verdict    passed: 1 of 16 entries"));
  EXPECT_EQ(dolp("verify t.nc --samples 1 --quiet").out, "");
}

TEST_F(Verify, AlbedoAndEmissivitiesOffByThreeBounds_AreFoundInEveryEntry) {
  for (const char* masking : {"none", "v-cavity", "integral", "smith"}) {
    const TableValues table = make_table(joined(kFourEntries, {"--set", std::string("surface.masking=") + masking}));
    for (const Quantity quantity : {Quantity::kAlbedo, Quantity::kEmissivityS, Quantity::kEmissivityP}) {
      TableValues wrong = table;
      for (std::size_t i = 0; i < table.size(); ++i) {
        const double of_rho = 2.0 * table[Quantity::kRhoErrorEstimate][i] * table[Quantity::kRhoI][i];
        const double of_albedo = table[Quantity::kRhoErrorEstimate][i] * table[Quantity::kAlbedo][i];
        // The value in the table errs by at most one bound, so the changed value errs by at least two.
        wrong[quantity][i] += 3.0 * (quantity == Quantity::kAlbedo ? of_albedo : of_rho);
      }
      write_table(wrong, at("t.nc"));
      EXPECT_EQ(verify_json(kAccuracy)["failures"].size(), table.size()) << masking << ' ' << describe(quantity).name;
    }
  }
}

// The bound of rho is relative to rho_I, which is mostly diffuse here. The albedo is that of the specular part.
TEST_F(Verify, AlbedoBesideAStrongDiffusePart_HasItsOwnBound) {
  make_table(joined(kOneEntry,
                    "--set surface.masking=v-cavity --set surface.diffuse=1 --set surface.diffuse_exponent=-0.9 --set "
                    "grid.theta_deg=89.99 --set surface.n=3 --set surface.k=90 --set grid.sigma=0.06"));
  EXPECT_EQ(verify_json(kDone)["passed"], true);
}

TEST_F(Verify, RadiationWithoutPolarisation_HasABoundFromRho) {
  const TableValues table = make_table("--set grid.theta_deg=0");
  ASSERT_LT(table[Quantity::kDolp][0], 1e-8);  // the bound of DOLP divided by DOLP is useless
  // The bound is rho_error_estimate * rho_I times the emitted and the incident radiation. Both are at most this one.
  const double most = table[Quantity::kStokesI][0] / (1.0 - table[Quantity::kRhoI][0]);
  const double bound = 2.0 * most * table[Quantity::kRhoErrorEstimate][0] * table[Quantity::kRhoI][0];
  verify_json(kDone);
  put_value(at("t.nc"), Quantity::kStokesI, 0, table[Quantity::kStokesI][0] + 3.0 * bound);
  const nlohmann::json failures = verify_json(kAccuracy)["failures"];
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0]["quantity"], "stokes_i");
}

TEST_F(Verify, RadiationThatTheRunDropped_IsNoError) {
  // Diffuse light is unpolarised, so the surroundings change no DOLP, and the table lacks their light.
  make_table(joined(kFastMasking, "--set surface.specular=0 --set surface.diffuse=0.3"));
  EXPECT_EQ(verify_json(kDone)["checked"], 16);
}

TEST_F(Verify, Samples_AreThoseOfTheSeed) {
  make_table(kFastMasking);
  EXPECT_EQ(verify_json(kDone, "--samples 3")["checked"], 3);
  nlohmann::json first = verify_json(kDone, "--samples 3 --seed 5");
  nlohmann::json again = verify_json(kDone, "--samples 3 --seed 5");
  first.erase("wall_s");
  again.erase("wall_s");
  EXPECT_EQ(first, again);
}

TEST_F(Verify, Overrides_BelongToTheScene) {
  make_table({"--set", "surface.masking=smith", "--set", "grid.q=[2.5,\n 4]", "--set", "surroundings=none",
              "--tolerance", "1e-3"});
  const nlohmann::json json = verify_json(kDone);
  EXPECT_EQ(json["checked"], 16);
  EXPECT_EQ(json["tolerance"], 1e-3);
}

TEST_F(Verify, EveryKindOfScene_Passes) {
  for (const char* options :
       {"--set geometry.mode=bistatic --set source.irradiance=1",
        "--set spectrum.band_um=[8,12] --set emission.model=fresnel",
        "--set emission.bracket=true --set surface.masking=smith",
        "--set emission.model=direct --set surface.masking=v-cavity --set grid.theta_deg=[0,50]",
        "--set surroundings.profile=clear-sky --set grid.theta_deg=40 --set grid.sigma=0.2",
        "--set surface.distribution=gaussian --set surface.diffuse=0.1 --set path.transmittance=0.5",
        "--set grid.sigma=[0,0.4]"}) {
    make_table(joined(kFourEntries, options));
    EXPECT_EQ(verify_json(kDone)["passed"], true) << options;
  }
}

TEST_F(Verify, RightAngle_IsTheReferencesLimit) {
  for (const char* masking : {"smith", "v-cavity"}) {
    make_table({"--set", std::string("surface.masking=") + masking, "--set", "grid.theta_deg=[89.99, 90]"});
    EXPECT_EQ(verify_json(kDone)["checked"], 8) << masking;
  }
}

TEST_F(Verify, OneCorruptedValue_Exit1AndIsNamed) {
  const TableValues table =
      make_table(joined(kFourEntries, "--set surface.masking=v-cavity --set emission.bracket=true"));
  const std::size_t at_entry = table.position(1, 0, 1);  // theta 60, sigma 0.1, q 3.5
  for (const Quantity quantity :
       {Quantity::kDolp, Quantity::kDolpLow, Quantity::kDolpHigh, Quantity::kQOverI, Quantity::kRhoI, Quantity::kRhoQ,
        Quantity::kStokesQ, Quantity::kStokesU, Quantity::kStokesV, Quantity::kStokesI}) {
    const std::string name = describe(quantity).name;
    double bound = name.starts_with("rho")
                       ? table[Quantity::kRhoErrorEstimate][at_entry] * table[Quantity::kRhoI][at_entry]
                       : table[Quantity::kErrorEstimate][at_entry];
    if (name.starts_with("stokes")) bound *= table[Quantity::kStokesI][at_entry];
    if (quantity == Quantity::kStokesI) bound /= table[Quantity::kDolp][at_entry];
    // The value in the table has an error of at most `bound`. After the change the error is at least two bounds.
    TableValues wrong = table;
    wrong[quantity][at_entry] += 3.0 * bound;
    write_table(wrong, at("t.nc"));
    const nlohmann::json json = verify_json(kAccuracy);
    EXPECT_EQ(json["passed"], false);
    ASSERT_EQ(json["failures"].size(), 1U) << json["failures"];
    const nlohmann::json& failure = json["failures"][0];
    EXPECT_EQ(failure["quantity"], name);
    EXPECT_EQ(failure["theta_deg"], 60.0);
    EXPECT_EQ(failure["sigma"], 0.1);
    EXPECT_EQ(failure["q"], 3.5);
    const Outcome text = dolp("verify t.nc");
    EXPECT_EQ(text.status, kAccuracy);
    EXPECT_TRUE(contains(text.out, name + " at theta 60, sigma 0.1, q 3.5"));
    EXPECT_TRUE(contains(text.out, "verdict    failed: 1 values"));
  }
}

TEST_F(Verify, EstimateBeyondTheToleranceWithoutStatus2_IsFoundByTheTolerance) {
  const TableValues table = make_table(joined(kFourEntries, kFastMasking));
  const std::size_t at_entry = table.position(1, 0, 1);
  put_value(at("t.nc"), Quantity::kErrorEstimate, at_entry, 1.0);
  put_value(at("t.nc"), Quantity::kDolp, at_entry, table[Quantity::kDolp][at_entry] + 2e-4);  // twice the tolerance
  const nlohmann::json json = verify_json(kAccuracy);
  ASSERT_EQ(json["failures"].size(), 1U) << json["failures"];
  EXPECT_EQ(json["failures"][0]["complaint"], "misses the tolerance without the status that says so");
  TableValues honest = read_table(at("t.nc"));
  honest.status[at_entry] = 2;
  write_table(honest, at("t.nc"));
  EXPECT_EQ(verify_json(kDone)["missed_tolerance"], 1);
}

TEST_F(Verify, EntriesThatAreNan_AreComparedAsSuch) {
  // Without masking rho diverges at 90 degrees. It is NaN there, and the status has the bits with the values 1 and 4.
  const TableValues table = make_table("--set surface.masking=none --set grid.theta_deg=[30,90]");
  const std::size_t diverges = table.position(1, 0, 0);
  ASSERT_TRUE(std::isnan(table[Quantity::kRhoI][diverges]));
  verify_json(kDone);
  put_value(at("t.nc"), Quantity::kRhoI, diverges, 0.5);
  EXPECT_EQ(verify_json(kAccuracy)["failures"].size(), 1U);
  put_value(at("t.nc"), Quantity::kRhoI, diverges, std::nan(""));
  put_value(at("t.nc"), Quantity::kRhoQ, 0, std::nan(""));
  const nlohmann::json failures = verify_json(kAccuracy)["failures"];
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0]["complaint"], "is NaN in the table");
  EXPECT_TRUE(failures[0]["stored"].is_null());
}

TEST_F(Verify, IntensityThatOverflows_IsNotWrong) {
  put("sky.csv", "zenith_deg,radiance\n0,1e308\n90,9e307\n");
  const TableValues table =
      make_table(joined(joined(kFourEntries, kFastMasking), "--set surroundings.profile=sky.csv"));
  EXPECT_EQ(table.status, std::vector<std::uint32_t>(4, 4));
  EXPECT_EQ(table[Quantity::kStokesU], std::vector<double>(4, 0.0));
  EXPECT_EQ(verify_json(kDone)["passed"], true);
  put_value(at("t.nc"), Quantity::kRhoI, 3, table[Quantity::kRhoI][3] * 1.01);
  EXPECT_EQ(verify_json(kAccuracy)["failures"].size(), 1U);
}

TEST_F(Verify, ReducedVariables_AreComparedAsFarAsTheyAreThere) {
  TableValues table = make_table(kOneEntry);
  for (const Quantity quantity :
       {Quantity::kRhoI, Quantity::kRhoQ, Quantity::kRhoErrorEstimate, Quantity::kStokesU, Quantity::kStokesV}) {
    table[quantity].clear();
  }
  write_table(table, at("t.nc"));
  // These are dolp, q_over_i, aolp_deg, stokes_i, stokes_q, albedo, emissivity_s and emissivity_p.
  EXPECT_EQ(verify_json(kDone)["quantities"].size(), 8U);
}

TEST_F(Verify, ChangedScene_IsRefused) {
  make_table();
  std::string scene = kScene;
  put_attribute(at("t.nc"), "scene", scene.replace(scene.find("sigma = 0.3"), 11, "sigma = 0.4"));
  expect_refused(dolp("verify t.nc"), "t.nc: attribute \"scene_hash\"");
  put_attribute(at("t.nc"), "scene", "[surface");
  expect_refused(dolp("verify t.nc"), "t.nc: attribute \"scene\": scene.toml:1: not valid TOML");
}

TEST_F(Verify, FilesOfTheScene_AreFoundFromWhereTheTableWasMade) {
  std::filesystem::create_directory(at("folder"));
  put("folder/index.csv", "wavelength_um,n,k\n9,1.4,0.1\n11,1.6,0.1\n");
  std::string scene = kScene;
  scene.replace(scene.find("n = 1.5\nk = 0.1"), 15, "material_file = \"index.csv\"");
  put("folder/scene.toml", scene);
  succeeded(dolp("table folder/scene.toml -o t.nc --quiet --evaluator cpu"));
  verify_json(kDone, "--named-files --samples 1");
  std::filesystem::remove(at("folder/index.csv"));
  expect_refused(dolp("verify t.nc --named-files"), "surface.material_file = \"index.csv\": cannot be read");
}

TEST_F(Verify, TheTableAlone_IsSufficient) {
  put("index.csv", "wavelength_um,n,k\n7,1.4,0.1\n9,1.5,0.1\n13,1.6,0.1\n");
  put("formula.yml", "DATA:\n  - type: formula 5\n    wavelength_range: 7 13\n    coefficients: 1.5 0.01 1\n");
  put("light.csv", "7,1\n9,3\n13,2\n");
  for (const char* options :
       {"--set surface.material_file=index.csv",
        "--set surface.material_file=formula.yml --set spectrum.band_um=[8,12] --set source.file=light.csv",
        "--set surface.material=iron --set source.preset=sun"}) {
    put("index.csv", "wavelength_um,n,k\n7,1.4,0.1\n9,1.5,0.1\n13,1.6,0.1\n");
    const TableValues table = make_table(joined(kFastMasking, options));
    EXPECT_FALSE(table.index_n.values.empty());
    const nlohmann::json before = verify_json(kDone, "--named-files --samples 1")["quantities"];
    put("index.csv", "wavelength_um,n,k\n7,2.4,0.1\n13,2.6,0.1\n");
    EXPECT_EQ(verify_json(kDone, "--samples 1")["quantities"], before) << options;
  }
  TableValues old = make_table("--set surface.material_file=index.csv");
  old.index_n = {};
  write_table(old, at("t.nc"));
  expect_refused(dolp("verify t.nc"), "is not in the table; dolp verify --named-files");
}

TEST_F(Verify, FilesThatATableNames_AreNotQuoted) {
  const std::string index = "wavelength_um,n,k\n7,1.4,0.1\n13,1.6,0.1\n";
  const std::string light = "7,1\n13,2\n";
  const std::string record = "DATA:\n  - type: formula 5\n    wavelength_range: 7 13\n    coefficients: 1.5 0.01 1\n";
  for (const auto& [name, secrets] : std::map<std::string, std::vector<std::string>>{
           {"index.csv", {"secret\n", "wavelength_um,n,k\nsecret,1,2\n", "wavelength_um,n,k\n7,secret\n"}},
           {"light.csv", {"secret\n", "secret,1\n7,secret\n", "7,secret\n"}},
           {"record.yml",
            {"secret: [", "DATA: secret\n", "DATA:\n  - type: secret\n    data: 1\n",
             "DATA:\n  - type: tabulated nk\n    data: secret\n",
             "DATA:\n  - secret: secret\n    type: tabulated n\n    data: 7 1\n"}}}) {
    put("index.csv", index);
    put("light.csv", light);
    put("record.yml", record);
    const std::string key = name == "light.csv" ? "source.file" : "surface.material_file";
    make_table(joined(kFastMasking, "--set " + key + "=" + name));
    for (const std::string& secret : secrets) {
      put(name, secret);
      const Outcome outcome = dolp("verify t.nc --named-files");
      EXPECT_FALSE(contains(outcome.err, "secret"));
      expect_refused(outcome, name);
    }
  }
}

TEST_F(Verify, WrongFiles_Exit2InOneLine) {
  make_table();
  TableValues foreign = small_table();
  foreign[Quantity::kDolp] = {0.1};
  write_table(foreign, at("foreign.nc"));
  put("table.csv", "theta_deg,sigma,q\n");
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"verify", "name a TABLE, or --hard-cases"},
      {"verify none.nc", "none.nc: there is no such file"},
      {"verify scene.toml", "scene.toml: is not a NetCDF table of dolp"},
      {"verify table.csv", "table.csv: only a table written as .nc"},
      {"verify foreign.nc", "foreign.nc: has no attribute \"scene\""},
      {"verify t.nc --hard-cases", "--hard-cases"},
      {"verify t.nc --samples 0", "--samples"},
      {"verify t.nc --tolerance 1e-3", "--tolerance"},
      {"verify --hard-cases --samples 3", "--samples"},
      {"verify --hard-cases --tolerance much", "--tolerance much: must be a number in [1e-10, 0.01]"},
      {"verify --hard-cases --tolerance 1", "tolerance 1: must be a number in [1e-10, 0.01]"},
      {"verify --hard-cases --evaluator reference", "reference"},
      {"verify --hard-cases --precision half", "half"}};
  for (const auto& [arguments, message] : mistakes) {
    SCOPED_TRACE(message);
    expect_refused(dolp(arguments), message);
  }
}

TEST_F(Verify, HardCases_OneLinePerModelAndAllRowsOnRequest) {
  const Words command = "verify --hard-cases --evaluator cpu --precision double";
  const Outcome outcome = dolp(joined(command, "--json"));
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["precisions"].size(), 1U);
  const nlohmann::json& rows = json["precisions"][0]["cases"];
  EXPECT_EQ(rows.size(), json["cases"]);
  EXPECT_GT(rows.size(), 500U);
  EXPECT_EQ(outcome.status, json["failures"] == 0 ? kDone : kAccuracy);
  const auto failed = std::ranges::count_if(rows, [](const nlohmann::json& row) { return row["ok"] == false; });
  EXPECT_EQ(json["failures"], failed);
  const auto lines = [&](const Words& arguments) {
    const std::string out = dolp(arguments).out;
    return static_cast<std::size_t>(std::ranges::count(out, '\n'));
  };
  // 3 lines for title, device and verdict, and a line for each of the 8 pairs of distribution and masking.
  constexpr std::size_t kFrame = 3 + 8;
  EXPECT_EQ(lines(command), kFrame + static_cast<std::size_t>(failed));
  EXPECT_EQ(lines(joined(command, "--all")), kFrame + rows.size());
}

TEST_F(Verify, Devices_AreNamedAndMeasuredInEachPrecision) {
  const nlohmann::json devices = report("devices")["devices"];
  EXPECT_TRUE(std::ranges::any_of(devices, [](const auto& device) { return device["usable"] == true; })) << devices;
  for (const nlohmann::json& device : devices) {
    const nlohmann::json& in_float = device["quality"]["float"];
    if (device["usable"] == false) {
      EXPECT_TRUE(in_float.contains("why_not"));
      continue;
    }
    EXPECT_EQ(in_float["cases"], 56) << device;
    EXPECT_LE(in_float["worst_rho_error"], 1e-4) << device;
    const nlohmann::json& in_double = device["quality"]["double"];
    EXPECT_EQ(in_double.contains("worst_rho_error"), device["float64"] == true) << device;
  }
}

}  // namespace
}  // namespace dolp::verify_test
