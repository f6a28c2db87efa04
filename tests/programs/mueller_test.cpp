// `dolp mueller` as a user runs it: columns, row order, evaluators, report, and files after an error.
#include <gtest/gtest.h>

#include <cmath>

#include "cli_support.hpp"

namespace mueller_test {

using namespace dolp;
using nlohmann::json;

const std::string kGeometries =
    "delta_phi_deg,theta_i_deg , theta_r_deg,sigma\n150,30,40,0.2\n-150.0,30,40,0.2\n0,1e-3,40,0.3\n180,20,20.5,0.1\n";
const std::string kElements = "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33";

class Mueller : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    put("points.csv", kGeometries);
  }
  Outcome mueller(const Words& options, const std::string& output = "out.csv") const {
    return dolp(joined("mueller scene.toml --points points.csv -o " + output, options));
  }
  Columns columns(const Words& options) const {
    return parse_csv(succeeded(mueller(joined(options, "--quiet"), "-")).out);
  }
};

std::vector<std::string> element_names() { return split_at(kElements, ','); }

TEST_F(Mueller, Points_RepeatedInOrderWithAllElements) {
  const Outcome outcome = succeeded(mueller("--quiet", "-"));
  EXPECT_EQ(outcome.err, "");
  const std::vector<std::string> lines = data_lines(outcome.out);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[0], "delta_phi_deg,theta_i_deg,theta_r_deg,sigma," + kElements);
  EXPECT_TRUE(lines[1].starts_with("150,30,40,0.2,"));
  EXPECT_TRUE(lines[2].starts_with("-150.0,30,40,0.2,"));
  EXPECT_TRUE(lines[3].starts_with("0,1e-3,40,0.3,"));
  EXPECT_TRUE(lines[4].starts_with("180,20,20.5,0.1,"));
  const Columns f = parse_csv(outcome.out);
  EXPECT_EQ(f.at("m00")[0], f.at("m00")[1]);
  EXPECT_EQ(f.at("m02")[0], -f.at("m02")[1]);
  EXPECT_NE(f.at("m02")[0], 0.0);
  EXPECT_GT(f.at("m00")[3], f.at("m00")[2]);  // row 3 is near the mirror direction, row 2 is not
}

TEST_F(Mueller, Evaluators_AgreeWithinTheirStatedErrors) {
  const Columns reference = columns("--evaluator reference");
  const auto worst = [&](const Words& options) {
    const Columns f = columns(options);
    double error = 0.0;
    for (const std::string& name : element_names()) {
      for (std::size_t i = 0; i < 4; ++i)
        error = std::max(error, std::abs(f.at(name)[i] - reference.at(name)[i]) / reference.at("m00")[i]);
    }
    return error;
  };
  for (const char* evaluator : {"vulkan", "cpu"}) {
    const double error = worst({"--evaluator", evaluator});
    EXPECT_LE(error, 1e-11);
    EXPECT_GT(error, 0.0);  // the reference uses other formulas, so rounding differs
  }
}

TEST_F(Mueller, SetAndColumns_SayTheSame) {
  put("points.csv", "theta_i_deg,theta_r_deg,delta_phi_deg,sigma,q,n,k\n30,40,100,0.4,2.5,3,1\n");
  const Columns by_columns = columns({});
  put("points.csv", "theta_i_deg,theta_r_deg,delta_phi_deg\n30,40,100\n");
  const Columns by_scene =
      columns("--set surface.sigma=0.4 --set surface.q=2.5 --set surface.n=3 --set surface.k=1 --set grid.sigma=[0.1]");
  for (const std::string& name : element_names()) EXPECT_EQ(by_columns.at(name), by_scene.at(name)) << name;
  EXPECT_NE(by_scene.at("m00"), columns({}).at("m00"));
}

TEST_F(Mueller, Json_SaysWhatRan) {
  put("points.csv", "theta_i_deg,theta_r_deg,delta_phi_deg\n30,40,100\n90,40,100\n");
  const json report = printed_json(mueller("--json"));
  EXPECT_EQ(report["title"], "Sixteen entries");
  EXPECT_EQ(report["output"], "out.csv");
  EXPECT_EQ(report["entries"], 2);
  EXPECT_EQ(report["without_value"], 1);
  EXPECT_EQ(report["evaluator"], "cpu");  // beams need no device
  EXPECT_EQ(report["precision"], "double");
  EXPECT_EQ(report["worst_error_estimate"], 1e-11);
  for (const char* key : {"device", "wall_s", "beams_s", "tolerance"}) EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_TRUE(std::isnan(parse_csv(content("out.csv")).at("m33").at(1)));
}

TEST_F(Mueller, HeaderWithoutRows_HeaderWithoutRows) {
  put("points.csv", "theta_i_deg,theta_r_deg,delta_phi_deg\n");
  succeeded(mueller({}));
  EXPECT_EQ(content("out.csv"), "theta_i_deg,theta_r_deg,delta_phi_deg," + kElements + "\n");
}

TEST_F(Mueller, WithoutADevice_Computes) {
  succeeded(without_device("mueller scene.toml --points points.csv -o out.csv --strict"));
  EXPECT_EQ(parse_csv(content("out.csv")).at("m00").size(), 4U);
}

TEST_F(Mueller, Mistake_OneLineAndNothingWritten) {
  const std::string header = "theta_i_deg,theta_r_deg,delta_phi_deg";
  for (const auto& [points, options, message] :
       {std::tuple(header + ",q\n1,2,3,1.4\n", "--set surface.masking=smith", "points.csv:2: q = 1.4"),
        {header + ",q\n1,2,3,1.4\n", "--set surface.masking=smith", "smith"},
        {header + "\n1,2,3\n", "--keep-all", "--keep-all"}}) {
    put("points.csv", points);
    expect_refused(mueller(options), message);
    EXPECT_EQ(names(), (std::vector<std::string>{"points.csv", "scene.toml"}));
  }
}

TEST_F(Mueller, OutputThatIsAnInput_Refused) {
  const Outcome outcome = mueller({}, "points.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(content("points.csv"), kGeometries);
}

}  // namespace mueller_test
