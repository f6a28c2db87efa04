// The scenes in host/scenes state values of DOLP in comments. The tests compute these values again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include <regex>
#include <string>
#include <vector>

#include "scene/scene_reader.hpp"
#include "scene_run_support.hpp"

namespace dolp::shipped_scenes_test {
namespace {

using namespace scene_run_support;

std::string scene_path(const std::string& name) { return DOLP_HOST_DIR "/scenes/" + name + ".toml"; }

/// Statements in the comment of a scene: DOLP in percent, the polarisation (`side`: s or p), and for each effect the
/// change of DOLP in percentage points without this effect.
struct Statement {
  std::vector<std::string> overrides;  ///< settings that the comment assumes
  double theta_deg = 0.0;
  std::string dolp;
  std::string side;
  std::map<std::string, std::string> changes;
};

std::string comment_of(const std::string& name) {
  std::ifstream file(scene_path(name));
  std::string text;
  for (std::string line; std::getline(file, line) && line.starts_with("#");) text += line.substr(1);
  return text;
}

std::vector<Statement> statements_of(const std::string& name) {
  static const std::regex kStatement(
      R"((?:With specular = ([0-9.]+), )?DOLP at (\d+) degrees: ([0-9.]+)% ([ps])\.([^.]*: )((?:[a-z]+ [+-]\d+\.\d+,? *)*))");
  static const std::regex kChange(R"(([a-z]+) ([+-]\d+\.\d+))");
  const std::string text = comment_of(name);
  std::vector<Statement> statements;
  for (std::sregex_iterator match(text.begin(), text.end(), kStatement), end; match != end; ++match) {
    Statement statement;
    if ((*match)[1].matched) statement.overrides.push_back("surface.specular=" + (*match)[1].str());
    statement.theta_deg = std::stod((*match)[2]);
    statement.dolp = (*match)[3];
    statement.side = (*match)[4];
    const std::string changes = (*match)[6];
    for (std::sregex_iterator change(changes.begin(), changes.end(), kChange); change != end; ++change) {
      statement.changes[(*change)[1]] = (*change)[2];
    }
    statements.push_back(statement);
  }
  return statements;
}

PointResult result_at(const std::string& name, double theta_deg, std::vector<std::string> overrides) {
  overrides.push_back("accuracy.tolerance=1e-6");
  const SceneValues scene = read_scene(scene_path(name), settings_from_text(overrides));
  return run_one(scene, theta_deg, {scene.surface.sigma, scene.surface.q}, Evaluator::kDouble);
}

std::size_t decimals(const std::string& number) { return number.size() - number.find('.') - 1; }

std::string without(const std::string& effect) {
  static const std::map<std::string, std::string> kOverrides = {{"source", "source=none"},
                                                                {"surroundings", "surroundings=none"},
                                                                {"path", "path=none"},
                                                                {"roughness", "surface.sigma=0"},
                                                                {"diffuse", "surface.diffuse=0"}};
  return kOverrides.at(effect);
}

class ShippedScene : public testing::TestWithParam<std::pair<const char*, std::size_t>> {};

TEST_P(ShippedScene, Comment_StatesTheDolpToItsDigits) {
  const auto [name, statement_count] = GetParam();
  const std::vector<Statement> statements = statements_of(name);
  ASSERT_EQ(statements.size(), statement_count) << comment_of(name);
  for (const Statement& statement : statements) {
    const PointResult whole = result_at(name, statement.theta_deg, statement.overrides);
    EXPECT_EQ(fmt::format("{:.{}f}", 100.0 * whole[Quantity::kDolp], decimals(statement.dolp)), statement.dolp);
    EXPECT_EQ(whole[Quantity::kStokesQ] < 0.0 ? "p" : "s", statement.side);
    EXPECT_GE(statement.changes.size(), 2U);
    for (const auto& [effect, change] : statement.changes) {
      std::vector<std::string> overrides = statement.overrides;
      overrides.push_back(without(effect));
      const double dropped = result_at(name, statement.theta_deg, overrides)[Quantity::kDolp];
      EXPECT_EQ(fmt::format("{:+.{}f}", 100.0 * (dropped - whole[Quantity::kDolp]), decimals(change)), change)
          << effect;
    }
  }
}

TEST(RoughMetalScene, Comment_StatesTheEmissivities) {
  const auto emissivity = [](const std::vector<std::string>& overrides) {
    const PointResult result = result_at("rough_metal", 75.0, overrides);
    return fmt::format("{:.3f}", 0.5 * (result[Quantity::kEmissivityS] + result[Quantity::kEmissivityP]));
  };
  const std::string statement = fmt::format("Emissivity at 75 degrees: {}, with scattering = \"single\" {}.",
                                            emissivity({}), emissivity({"surface.scattering=single"}));
  EXPECT_NE(comment_of("rough_metal").find(statement), std::string::npos) << statement;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene,
                         testing::Values(std::pair{"night_paint", 1U}, std::pair{"overcast", 1U}, std::pair{"far", 1U},
                                         std::pair{"water", 2U}, std::pair{"bare_aluminium", 2U}, std::pair{"day", 1U},
                                         std::pair{"glint", 1U}, std::pair{"mwir_glint", 1U}),
                         [](const auto& test) { return std::string(test.param.first); });

}  // namespace
}  // namespace dolp::shipped_scenes_test
