// `dolp fit` as a user runs it: report, fitted scene, comparison of models, and messages.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "cli_support.hpp"

namespace fit_test {

using namespace dolp;
using nlohmann::json;

class FitProgram : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    std::string points = "theta_deg\n";
    for (int theta = 20; theta <= 75; theta += 5) points += std::to_string(theta) + '\n';
    put("points.csv", points);
    measure("data.csv", "theta_deg", {"dolp"}, {});
  }
  /// Writes noise-free measured data: the model's `columns` for sigma = 0.2 and the settings. The file states an
  /// uncertainty of 0.001.
  void measure(const std::string& name, const std::string& zenith, const std::vector<std::string>& columns,
               const Words& settings) const {
    const Columns exact = eval(joined("--set surface.sigma=0.2 --tolerance 1e-7 --evaluator cpu", settings));
    std::ostringstream data;
    data.precision(12);
    data << zenith;
    for (const std::string& column : columns) data << ',' << column;
    data << ",uncertainty\n";
    for (std::size_t i = 0; i < exact.at("theta_deg").size(); ++i) {
      data << exact.at("theta_deg")[i];
      for (const std::string& column : columns) data << ',' << exact.at(column)[i];
      data << ",0.001\n";
    }
    put(name, data.str());
  }
  /// Fits sigma and n with additional options. Expects the sigma and n from which the data were computed.
  void expect_truth(const Words& options) const {
    const json report = fit_json(joined("--vary surface.sigma=0.02:1 --vary surface.n=1.1:3", options));
    const double truth[] = {0.2, 1.5};
    for (std::size_t j = 0; j < 2; ++j) {
      const json& one = report["parameters"][j];
      EXPECT_NEAR(one["value"].get<double>(), truth[j], 0.05 * one["standard_error"].get<double>());
    }
    EXPECT_LT(report["chi_square"].get<double>(), 0.01);
  }
  Outcome fit(const Words& options) const {
    return dolp(joined(joined("fit scene.toml --evaluator cpu", starts_), options));
  }
  json fit_json(const Words& options) const { return printed_json(fit(joined(options, "--json"))); }
  /// Results of the scene that a fit wrote, at the ends of the measured zeniths.
  Columns fitted_ends(const std::string& setting) const {
    put("points.csv", "theta_deg\n20\n75\n");
    const Words start = "eval fitted.toml --points points.csv -o - --quiet --evaluator cpu --set";
    return parse_csv(succeeded(dolp(joined(start, {setting}))).out);
  }
  void expect_message(const Words& options, const std::string& message) const { expect_refused(fit(options), message); }

  Words starts_ = "--starts 4";  // enough for data with one valley of chi^2
};

TEST_F(FitProgram, Json_HasAllNames_AndTheFittedSceneRuns) {
  const json report = fit_json("--data data.csv --vary surface.sigma=0.02:1 -o fitted.toml");
  for (const char* name : {"parameters", "correlation", "chi_square", "degrees_of_freedom", "reduced_chi_square",
                           "p_value", "evaluations", "starts", "minima", "numerical_error", "residuals"}) {
    EXPECT_TRUE(report.contains(name)) << name;
  }
  const json& sigma = report["parameters"][0];
  EXPECT_EQ(sigma["key"], "surface.sigma");
  EXPECT_NEAR(sigma["value"].get<double>(), 0.2, 0.02 * sigma["standard_error"].get<double>());
  for (const char* interval : {"interval_68", "interval_95"}) {
    EXPECT_LT(sigma[interval][0].get<double>(), 0.2);
    EXPECT_GT(sigma[interval][1].get<double>(), 0.2);
  }
  EXPECT_EQ(sigma["at_bound"], false);
  EXPECT_EQ(report["degrees_of_freedom"], 11);
  EXPECT_EQ(report["residuals"].size(), 12U);
  double sum = 0.0;
  for (const json& residual : report["residuals"]) sum += std::pow(residual.get<double>(), 2);
  EXPECT_NEAR(sum, report["chi_square"].get<double>(), 1e-9);
  succeeded(dolp("table fitted.toml -o t.csv --quiet --evaluator cpu"));
}

TEST_F(FitProgram, Compare_RanksTheTrueModelFirst_AndOfModelsAlikeGivesTheRangesOverAll) {
  const Words options =
      "--data uncertain.csv --vary surface.sigma=0.02:1 --vary surface.n=1.1:3 --compare "
      "surface.masking=none,integral,v-cavity";
  const auto fitted_with = [&](const std::string& uncertainty) {
    put("uncertain.csv", std::regex_replace(content("data.csv"), std::regex(",0\\.001\n"), "," + uncertainty + "\n"));
    return fit_json(options);
  };
  const json apart = fitted_with("0.00002");
  ASSERT_EQ(apart["models"].size(), 3U);
  EXPECT_EQ(apart["models"][0]["overrides"][0], "surface.masking=integral");
  EXPECT_LT(apart["models"][0]["aic"].get<double>(), apart["models"][1]["aic"].get<double>());
  EXPECT_TRUE(apart["alike"].empty()) << apart["alike"];
  EXPECT_EQ(apart["ranges"][0]["models"], 1);
  const json alike = fitted_with("0.02");
  ASSERT_EQ(alike["alike"].size(), 3U) << alike["models"];
  EXPECT_EQ(alike["alike"][0], alike["models"][0]["overrides"]);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_EQ(alike["ranges"][j]["models"], 3);
    for (const char* interval : {"interval_68", "interval_95"}) {
      json hull = alike["models"][0]["parameters"][j][interval];
      for (const json& model : alike["models"]) {
        EXPECT_LT(model["delta_aic"].get<double>(), 1.3);
        const json& one = model["parameters"][j][interval];
        const auto is_open = [&](int end) { return hull[end].is_null() || one[end].is_null(); };
        hull[0] = is_open(0) ? json() : std::min(hull[0], one[0]);
        hull[1] = is_open(1) ? json() : std::max(hull[1], one[1]);
      }
      EXPECT_EQ(alike["ranges"][j][interval], hull) << interval;
    }
  }
  EXPECT_TRUE(contains(fit(options).out, "alike      the data cannot tell the first 3 models apart"));
}

TEST_F(FitProgram, KeyThatTakesThePlaceOfAnother_IsSaid) {
  const Words options = "--data data.csv --vary surface.n=1.1:3 --set surface.material=iron";
  EXPECT_TRUE(contains(fit(options).err, "fit: surface.n takes the place of the scene's surface.material"));
}

TEST_F(FitProgram, Quality_IsOneOfThreeWords) {
  const Words options = "--data data.csv --vary surface.sigma=0.02:1";
  for (const auto& [n, word] : {std::pair("1.5", "good"), {"1.8", "doubtful"}, {"2", "bad"}}) {
    const Words with_n = joined(options, {"--set", std::string("surface.n=") + n});
    const json report = fit_json(with_n);
    EXPECT_EQ(report["fit_quality"], word) << report["p_value"];
    EXPECT_EQ(report["parameters"][0].contains("scaled_68"), std::string(word) != "good");
    const std::string text = fit(with_n).out;
    EXPECT_TRUE(contains(text, std::string(": ") + word));
    EXPECT_EQ(bool{contains(text, "scaled     surface.sigma: uncertainties ")}, std::string(word) != "good");
  }
}

TEST_F(FitProgram, ModelOfSingleScatteringThatFails_IsSaidUnlessItsBracketIsUsed) {
  const Words settings = "--set surface.masking=smith --set surface.q=3 --set surface.k=8";
  measure("metal.csv", "theta_deg", {"dolp"}, settings);
  const Words options = joined(settings, "--data metal.csv --vary surface.sigma=0.1:0.4");
  const Outcome ignored = fit(options);
  EXPECT_TRUE(contains(ignored.out, "status     32 at some point: light that single scattering loses"));
  EXPECT_TRUE(contains(ignored.out, "uncertainties) from the fit: the fit is at most doubtful"));
  EXPECT_TRUE(contains(ignored.err, "which the intervals ignore; --model-error bracket includes it"));
  EXPECT_EQ(fit_json(options)["fit_quality"], "doubtful");
  const Outcome included = fit(joined(options, "--model-error bracket"));
  EXPECT_EQ(included.err, "");
  EXPECT_FALSE(contains(included.out, "status     32"));
  EXPECT_TRUE(contains(included.out, R"(surface.masking "v-cavity" with surface.scattering "multiple" follows all)"));
}

TEST_F(FitProgram, ZenithOfTheSource_IsFittedInBistaticScenes) {
  const Words settings =
      "--set geometry.mode=bistatic --set geometry.view_zenith_deg=40 --set source.relative_irradiance=20";
  measure("bistatic.csv", "theta_i_deg", {"dolp"}, settings);
  expect_truth(joined(settings, "--data bistatic.csv"));
  expect_message("--data bistatic.csv --vary surface.sigma=0.1:1",
                 "\"theta_i_deg\" needs geometry.mode = \"bistatic\"");
}

TEST_F(FitProgram, DataSets_HaveKeysOfTheirOwn) {
  measure("cold.csv", "theta_deg", {"dolp"}, "--set emission.temperature_K=260 --set spectrum.wavelength_um=4");
  expect_truth("--data data.csv --data cold.csv:emission.temperature_K=260,spectrum.wavelength_um=4");
}

TEST_F(FitProgram, Emissivities_AreFittedTogether) {
  measure("emissivity.csv", "theta_deg", {"emissivity_s", "emissivity_p"}, {});
  expect_truth("--data emissivity.csv");
}

TEST_F(FitProgram, BadData_AreOneLineThatNamesThePlace) {
  put("bad.csv", "theta_deg,dolp\n95,0.1\n");
  expect_message("--data bad.csv --vary surface.sigma=0.1:1", "bad.csv:2: theta_deg = 95: out of range");
  put("bad.csv", std::string("\0\1", 2));
  expect_message("--data bad.csv --vary surface.sigma=0.1:1", "bad.csv: is not a text");
  put("bad.csv", "theta_deg,emissivity_s\n20,0.9\n30,0.9\n");
  expect_message("--data bad.csv --vary surface.sigma=0.1:1 --set emission=none",
                 "emissivities need the table [emission]");
}

TEST_F(FitProgram, Plot_IsAPng) {
  starts_ = {};
  const json report = fit_json("--data data.csv --vary surface.sigma=0.02:1 --vary surface.n=1.1:3 --plot fit.png");
  const json& contours = report["contours"];
  EXPECT_EQ(contours["levels"].size(), 2U);
  EXPECT_GT(contours["growth"].size(), 10U);
  for (const char* name : {"x", "y"}) EXPECT_EQ(contours[name].size(), contours["growth"].size());
  EXPECT_LE(contours["evaluations"], report["evaluations"]);
  EXPECT_EQ(report["curves"].size(), 1U);
  EXPECT_GT(report["curves"][0]["model"].size(), report["points"].size());
  EXPECT_EQ(report["brackets"].size(), 1U);
  EXPECT_TRUE(content("fit.png").starts_with("\x89PNG"));
}

TEST_F(FitProgram, Pictures_OnAFullDisk_StayAsTheyWere) {
  const std::string in_full_disk =
      "mkdir -p target && mount -t tmpfs -o size=64k none target || exit 77; echo kept > target/p.png; "
      "cat /dev/zero > target/filled 2> none; \"$@\"; status=$?; test \"$(cat target/p.png)\" = kept && "
      "test \"$(ls -A target)\" = \"$(printf 'filled\\np.png')\" && exit $status; exit 99";
  succeeded(dolp("table scene.toml -o t.nc --evaluator cpu"));
  const Words fit = DOLP_PROGRAM
      " fit scene.toml --evaluator cpu --starts 1 --data data.csv --vary surface.sigma=0.02:1 --plot target/p.png";
  const Words plot = "/usr/bin/python3 " DOLP_HOST_DIR "/plot_table.py t.nc target/p.png";
  for (const Words& command : {fit, plot}) {
    const Words start = {"unshare", "--user", "--map-root-user", "--mount", "sh", "-c", in_full_disk, "sh"};
    const Outcome outcome = run({.arguments = joined(start, command), .folder = at("")});
    if (outcome.status == 77) GTEST_SKIP() << "a user may not mount here";
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "No space left on device"));
  }
}

TEST_F(FitProgram, Plot_WithoutContours_SaysWhy) {
  put("same.csv", "theta_deg,dolp,uncertainty\n0,0,0.01\n0,0,0.01\n0,0,0.01\n");
  put("flat.csv", "theta_deg,dolp,uncertainty\n20,0.005,0.9\n40,0.01,0.9\n60,0.03,0.9\n70,0.05,0.9\n");
  const Words sigma = "--vary surface.sigma=0.02:1";
  const std::vector<std::pair<Words, std::string>> cases = {
      {joined(sigma, "--data data.csv --vary surface.n=1.1:1.4"), "surface.n: it is at its bound"},
      {joined(sigma, "--data same.csv --vary surface.n=1.1:3"), "surface.n: the data do not determine it"},
      {"--data flat.csv --vary surface.n=1:20 --vary surface.k=0:60", "grows by less than 2.30"},
      {joined(sigma, "--data data.csv"), ""}};
  for (const auto& [options, reason] : cases) {
    const json report = fit_json(joined(options, "--plot fit.svg"));
    EXPECT_FALSE(report.contains("contours"));
    EXPECT_EQ(report.contains("no_contours"), !reason.empty());
    const auto& named = report["degeneracies"];
    EXPECT_EQ(std::set<std::string>(named.begin(), named.end()).size(), named.size()) << named;
    EXPECT_TRUE(contains(report.value("no_contours", ""), reason)) << report["no_contours"];
    EXPECT_TRUE(contains(content("fit.svg"), "<svg"));
  }
  const Outcome text = fit(cases.front().first);
  EXPECT_TRUE(contains(text.out, "no error   surface.n: it is at its bound"));
  EXPECT_TRUE(contains(text.out, "errors     hold with surface.n kept at the bound"));
}

TEST_F(FitProgram, Plot_OfSignedData_HasTheBracketOfQOverI) {
  const Words settings = "--set surface.masking=smith --set surface.q=3";
  measure("signed.csv", "theta_deg", {"q_over_i"}, settings);
  const Words options = "--data signed.csv --vary surface.sigma=0.02:1 --plot fit.png -o fitted.toml";
  const json bracket = fit_json(joined(settings, options))["brackets"][0];
  for (const std::string model : {"moments", "direct"}) {
    const double end = fitted_ends("emission.model=" + model).at("q_over_i").back();
    const double distance = std::min(std::abs(bracket["low"].back().get<double>() - end),
                                     std::abs(bracket["high"].back().get<double>() - end));
    EXPECT_LT(distance, 1e-3) << bracket["low"].back() << ' ' << bracket["high"].back() << ' ' << end;
  }
}

TEST_F(FitProgram, Plot_OfDataWithWavelengths_HasACurveForEachAndNoBracket) {
  const Words settings = "--set surface.masking=v-cavity --set surface.material=water";
  measure("alone.csv", "theta_deg", {"dolp"}, settings);
  std::string wavelengths = "wavelength_um,theta_deg,dolp\n";
  for (const std::string wavelength : {"4", "10"}) {
    for (const std::string zenith : {"20", "50", "75"})
      wavelengths.append(wavelength).append(",").append(zenith).append(",0.02\n");
  }
  put("wavelengths.csv", wavelengths);
  const auto plotted = [&](const std::string& data) {
    const Words options = "--vary surface.sigma=0.02:1 --plot fit.png -o fitted.toml --data " + data;
    return fit_json(joined(settings, options));
  };
  EXPECT_FALSE(plotted("alone.csv")["brackets"][0].is_null());
  const json report = plotted("wavelengths.csv");
  EXPECT_TRUE(report["brackets"][0].is_null()) << report["brackets"];
  EXPECT_GT(report["model_gap"].get<double>(), 0.0);
  ASSERT_EQ(report["curves"].size(), 2U);
  for (const json& curve : report["curves"]) {
    const std::string wavelength = "spectrum.wavelength_um=" + curve["wavelength_um"].dump();
    const std::vector<double> ends = fitted_ends(wavelength).at("dolp");
    EXPECT_NEAR(curve["model"].front().get<double>(), ends.front(), 1e-3);
    EXPECT_NEAR(curve["model"].back().get<double>(), ends.back(), 1e-3);
  }
}

TEST_F(FitProgram, Spectrum_SharesItsPasses_AndIsDrawnOverWavelength) {
  constexpr int kWavelengths = 12;
  std::string points = "theta_deg,wavelength_um\n";
  for (int i = 0; i < kWavelengths; ++i) {
    for (const char* zenith : {"40", "60", "75"}) points += fmt::format("{},{}\n", zenith, 8.0 + 0.4 * i);
  }
  put("points.csv", points);
  const Words water = "--set surface.material=water --set surface.sigma=0.2";
  const Columns exact = eval(joined(water, "--tolerance 1e-6 --evaluator cpu --set accuracy.interpolation=off"));
  std::string data = "theta_deg,wavelength_um,q_over_i,uncertainty\n";
  for (std::size_t i = 0; i < exact.at("dolp").size(); ++i) {
    data += fmt::format("{},{},{:.12g},0.001\n", exact.at("theta_deg")[i], exact.at("wavelength_um")[i],
                        exact.at("stokes_q")[i] / exact.at("stokes_i")[i]);
  }
  put("data.csv", data);
  const Outcome outcome =
      succeeded(fit("--set surface.material=water --data data.csv --vary surface.sigma=0.02:1 --vary "
                    "emission.temperature_K=280:320 --plot fit.png --json"));
  EXPECT_EQ(outcome.err, "");
  const json report = json::parse(outcome.out);
  EXPECT_NEAR(report["parameters"][0]["value"].get<double>(), 0.2, 1e-3);
  EXPECT_NEAR(report["parameters"][1]["value"].get<double>(), 300.0, 0.3);
  EXPECT_LT(report["chi_square"].get<double>(), 0.1);
  // One dispatch computes all wavelengths. So an evaluation of the model takes far fewer dispatches than wavelengths.
  EXPECT_LT(report["dispatches"].get<int>(), kWavelengths / 4 * report["evaluations"].get<int>());
}

TEST_F(FitProgram, BadInput_IsOneLineThatSaysWhatIsAllowed) {
  starts_ = {};
  const Words good = "--data data.csv --vary surface.sigma=0.02:1";
  const auto with = [&](const Words& more) { return joined(good, more); };
  expect_message(with("--vary surface.m=1:2"), "surface.m is no number of a scene that can vary");
  expect_message(with("--vary surface.n=3:2"), "LOW must be below HIGH");
  expect_message(with("--vary surface.n=1:2:3"), "START must lie in LOW:HIGH");
  expect_message(with("--vary surface.n=-1:2"), "-1 is out of range, surface.n in (0, 1e6]");
  expect_message(with("--vary surface.sigma=0.1:1"), "surface.sigma: varies twice");
  expect_message(with("--loss least"), "--loss");
  expect_message(with("--plot fit.jpg"), "plot fit.jpg: must end in .png, .pdf or .svg");
  expect_message(with("--starts 0"), "--starts");
  expect_message(with("--model-error half"), "--model-error");
  expect_message(with("--loss huber --model-error bracket"), "loss huber: cannot be combined");
  expect_message("--data data.csv:surface.sigma=1 --vary surface.sigma=0.1:1", "cannot be fixed too");
  expect_message(with("--compare surface.masking"), "must be KEY=WORD,WORD,...");
  expect_message(with("--compare surface.masking=some,other"), "must be one of none, v-cavity, integral, smith");
  expect_message(with("--compare surface.sigma=0.1,0.2"), "surface.sigma: varies and cannot be compared too");
  expect_message(with("--compare surface.masking=none --compare surface.masking=smith"),
                 "surface.masking: is compared twice; give all of its values at once");
  expect_message(with("--compare surface.masking=smith,none,smith"), "surface.masking = smith: is compared twice");
  expect_message("--data none.csv --vary surface.sigma=0.1:1", "none.csv: cannot be read");
  put("one.csv", "theta_deg,dolp\n30,0.1\n");
  expect_message("--data one.csv --vary surface.sigma=0.1:1 --vary surface.n=1:2",
                 "2 parameters and 1 measured points");
  expect_message("--data one.csv --data data.csv --vary surface.n=1:2", "all data sets have it, or none");
}

}  // namespace fit_test
