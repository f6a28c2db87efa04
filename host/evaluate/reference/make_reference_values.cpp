// dolp-reference-values: writes the file of reference moments that the tests compare every evaluator with.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "error.hpp"
#include "evaluate/reference/reference_evaluator.hpp"

namespace {

using dolp::Distribution;
using dolp::Masking;
using dolp::Moments;
using dolp::OpticalConstants;
using dolp::SlopeShape;

struct Case {
  std::string name;
  double theta_deg = 60.0;
  SlopeShape shape{0.3, 2.0};
  OpticalConstants index{1.508, 0.0};
};

struct Group {
  Distribution distribution;
  Masking masking;
};
constexpr std::array<Group, 8> kGroups{{{Distribution::kCauchy, Masking::kNone},
                                        {Distribution::kCauchy, Masking::kIntegral},
                                        {Distribution::kGaussian, Masking::kNone},
                                        {Distribution::kGaussian, Masking::kIntegral},
                                        {Distribution::kCauchy, Masking::kVCavity},
                                        {Distribution::kCauchy, Masking::kSmith},
                                        {Distribution::kGaussian, Masking::kVCavity},
                                        {Distribution::kGaussian, Masking::kSmith}}};
// Below it smith masking with the cauchy distribution is left out of the random cases; it exists above 1.5 only.
constexpr double kSmallestSmithQ = 1.53;

// Reflection below this share of the albedo is rounding: N = 1.
constexpr double kNegligible = 1e-12;

const char* name_of(Distribution distribution) { return distribution == Distribution::kCauchy ? "cauchy" : "gaussian"; }

const char* name_of(Masking masking) {
  constexpr std::array<const char*, 4> kNames{"none", "v-cavity", "integral", "smith"};
  return kNames[static_cast<std::size_t>(masking)];
}

// Random numbers that are the same with every standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

 private:
  std::mt19937_64 engine_;
};

/// The ranges of one domain of random cases.
struct Domain {
  const char* name;
  double sigma_min, sigma_max, q_min, q_max, theta_max_deg;
};
constexpr Domain kDomainA{"random-a", 0.01, 1.2, 1.06, 13.0, 89.5};
constexpr Domain kDomainB{"random-b", 0.001, 5.0, 1.01, 45.0, 89.9};

OpticalConstants random_index(Draw& draw) {
  const double kind = draw.uniform(0.0, 3.0);
  if (kind < 1.0) return {draw.uniform(1.3, 4.0), 0.0};
  if (kind < 2.0) return {draw.uniform(1.3, 4.0), draw.log_uniform(1e-3, 1.0)};
  return {draw.log_uniform(0.2, 27.0), draw.log_uniform(1.0, 90.0)};
}

// One in five is near grazing.
Case random_case(const Domain& domain, const Group& group, Draw& draw) {
  const bool is_grazing = draw.uniform(0.0, 1.0) < 0.2;
  Case result{domain.name};
  result.theta_deg = draw.uniform(is_grazing ? 85.0 : 0.0, domain.theta_max_deg);
  result.shape.sigma = draw.log_uniform(domain.sigma_min, domain.sigma_max);
  const bool is_smith = group.masking == Masking::kSmith;
  const double q_min = is_smith ? kSmallestSmithQ : domain.q_min;
  const double q = 1.0 + draw.log_uniform(q_min - 1.0, domain.q_max - 1.0);
  if (group.distribution == Distribution::kCauchy) result.shape.q = q;
  result.index = random_index(draw);
  return result;
}

double brewster_deg(double n) { return std::atan(n) * 180.0 / std::numbers::pi; }

std::vector<Case> hard_geometry_and_roughness() {
  return {{.name = "normal", .theta_deg = 0.0},
          {.name = "normal-smooth", .theta_deg = 0.0, .shape = {1e-3, 2.0}},
          {.name = "almost-normal", .theta_deg = 1e-6},
          {.name = "almost-normal-smooth", .theta_deg = 1e-6, .shape = {1e-4, 2.0}},
          {.name = "almost-grazing", .theta_deg = 89.99},
          {.name = "almost-grazing-smooth", .theta_deg = 89.99, .shape = {1e-3, 2.0}},
          {.name = "grazing", .theta_deg = 90.0},
          {.name = "grazing-smooth", .theta_deg = 90.0, .shape = {1e-2, 2.0}},
          {.name = "brewster", .theta_deg = brewster_deg(1.508)},
          {.name = "brewster-smooth", .theta_deg = brewster_deg(1.508), .shape = {1e-2, 2.0}},
          {.name = "brewster-mirror", .theta_deg = brewster_deg(1.508), .shape = {0.0, 2.0}},
          {.name = "mirror", .shape = {0.0, 2.0}},
          {.name = "sigma-1e-4", .shape = {1e-4, 2.0}},
          {.name = "sigma-1e-3", .shape = {1e-3, 2.0}},
          {.name = "sigma-1e-2", .shape = {1e-2, 2.0}},
          {.name = "sigma-1e-2-grazing", .theta_deg = 89.0, .shape = {1e-2, 2.0}},
          {.name = "sigma-5", .shape = {5.0, 2.0}},
          {.name = "sigma-5-grazing", .theta_deg = 89.0, .shape = {5.0, 2.0}},
          {.name = "sigma-10", .shape = {10.0, 2.0}}};
}

std::vector<Case> hard_exponents() {
  return {{.name = "q-1.001", .shape = {0.3, 1.001}},
          {.name = "q-1.001-smooth", .shape = {0.01, 1.001}},
          {.name = "q-1.001-grazing", .theta_deg = 89.0, .shape = {0.3, 1.001}},
          {.name = "q-1.07-grazing", .theta_deg = 89.0, .shape = {0.3, 1.07}},
          {.name = "q-1.6-at-90", .theta_deg = 90.0, .shape = {0.3, 1.6}},
          {.name = "q-1.5-below", .shape = {0.3, 1.5 - 1e-9}},
          {.name = "q-1.5", .shape = {0.3, 1.5}},
          {.name = "q-1.5-above", .shape = {0.3, 1.5 + 1e-9}},
          {.name = "q-50", .shape = {0.3, 50.0}},
          {.name = "q-1000", .shape = {0.3, 1000.0}},
          {.name = "q-1000-rough", .shape = {5.0, 1000.0}},
          {.name = "q-1000-grazing", .theta_deg = 89.0, .shape = {0.3, 1000.0}},
          {.name = "q-10000", .shape = {0.3, 10000.0}}};
}

std::vector<Case> hard_indices() {
  return {{.name = "vacuum", .index = {1.0, 0.0}},
          {.name = "almost-vacuum", .index = {1.0001, 0.0}},
          {.name = "total-reflection", .index = {0.5, 0.0}},
          {.name = "total-reflection-normal", .theta_deg = 0.0, .index = {0.5, 0.0}},
          {.name = "total-reflection-critical", .theta_deg = 30.0, .shape = {0.05, 2.0}, .index = {0.5, 0.0}},
          {.name = "index-0.9", .theta_deg = 80.0, .index = {0.9, 1e-3}},
          {.name = "index-0.2-3", .index = {0.2, 3.0}},
          {.name = "index-4-grazing", .theta_deg = 89.0, .index = {4.0, 0.0}},
          {.name = "index-27-90", .index = {27.0, 90.0}},
          {.name = "index-27-90-smooth", .shape = {0.05, 3.0}, .index = {27.0, 90.0}},
          {.name = "index-27-90-grazing", .theta_deg = 89.0, .index = {27.0, 90.0}},
          {.name = "index-1000-1000", .index = {1000.0, 1000.0}},
          {.name = "index-1000-1000-grazing", .theta_deg = 89.9, .index = {1000.0, 1000.0}}};
}

std::vector<Case> cases_of(const Group& group, std::uint64_t seed, std::size_t count) {
  Draw draw(seed);
  std::vector<Case> cases;
  for (std::size_t i = 0; i < count; ++i) cases.push_back(random_case(kDomainA, group, draw));
  for (std::size_t i = 0; i < count / 3; ++i) cases.push_back(random_case(kDomainB, group, draw));
  const auto append = [&](const std::vector<Case>& more) { cases.insert(cases.end(), more.begin(), more.end()); };
  append(hard_geometry_and_roughness());
  append(hard_indices());
  if (group.distribution == Distribution::kCauchy) append(hard_exponents());
  const bool needs_mean_slope = group.distribution == Distribution::kCauchy && group.masking == Masking::kSmith;
  std::erase_if(cases, [&](const Case& c) { return needs_mean_slope && c.shape.q <= 1.5; });
  return cases;
}

dolp::MomentsRequest request_of(const Group& group, const std::vector<Case>& cases) {
  dolp::MomentsRequest request;
  request.distribution = group.distribution;
  request.masking = group.masking;
  request.tolerance = 0.0;
  for (const Case& c : cases) {
    const auto position = static_cast<std::uint32_t>(request.theta_deg.size());
    request.theta_deg.push_back(c.theta_deg);
    request.shapes.push_back(c.shape);
    request.indices.push_back(c.index);
    request.entries.push_back({position, position, position});
  }
  return request;
}

/// The finer of two quadratures of one case, its errors no less than the distance between the two.
struct Row {
  Group group;
  Case input;
  Moments moments;
};

std::vector<Row> rows_of(const Group& group, const std::vector<Case>& cases) {
  const dolp::MomentsRequest request = request_of(group, cases);
  dolp::ReferenceEvaluator coarse({.relative_tolerance = 1e-9, .subdivisions = 1});
  dolp::ReferenceEvaluator fine({.relative_tolerance = 1e-10, .subdivisions = 2});
  const std::vector<Moments> a = coarse.evaluate(request, {});
  const std::vector<Moments> b = fine.evaluate(request, {});
  std::vector<Row> rows;
  double worst = 0.0;
  std::string worst_name = "none";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double distance_i = std::abs(a[i].r_i - b[i].r_i);
    const double distance_q = std::abs(a[i].r_q - b[i].r_q);
    Row row{group, cases[i], b[i]};
    row.moments.r_i_error = std::max(b[i].r_i_error, distance_i);
    row.moments.r_q_error = std::max(b[i].r_q_error, distance_q);
    rows.push_back(row);
    const double scale = std::max(b[i].r_i, kNegligible * b[i].albedo);
    const double relative = scale > 0.0 ? std::max(distance_i, distance_q) / scale : 0.0;
    if (relative > worst) {
      worst = relative;
      worst_name = cases[i].name;
    }
  }
  std::fprintf(stderr, "%s %s: %zu cases, %.1f s and %.1f s, largest distance %.1e of r_i (%s)\n",
               name_of(group.distribution), name_of(group.masking), cases.size(), coarse.report().kernel_s,
               fine.report().kernel_s, worst, worst_name.c_str());
  return rows;
}

std::string csv_line(const Row& row) {
  const Case& c = row.input;
  std::string line = std::string(name_of(row.group.distribution)) + "," + name_of(row.group.masking);
  for (const double value :
       {c.theta_deg, c.shape.sigma, c.shape.q, c.index.n, c.index.k, row.moments.r_i, row.moments.r_q,
        row.moments.albedo, row.moments.deficit, row.moments.r_i_error, row.moments.r_q_error}) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), ",%.17g", value);
    line += text.data();
  }
  return line + "," + c.name + "\n";
}

// A reader never sees half a file.
void write(const std::filesystem::path& path, const std::string& command, const std::vector<Row>& rows) {
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream file(part);
  file << "# " << command << "\n"
       << "distribution,masking,theta_deg,sigma,q,n,k,r_i,r_q,albedo,deficit,r_i_error,r_q_error,case\n";
  for (const Row& row : rows) file << csv_line(row);
  file.close();
  if (!file) throw dolp::IoError("cannot write " + part.string());
  std::filesystem::rename(part, path);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Writes reference moments for the tests, from the independent reference evaluator.");
  std::string out;
  std::uint64_t seed = 20250804;
  std::size_t count = 60;
  app.add_option("OUT", out, "CSV file, written anew after each distribution and masking")->required();
  app.add_option("--seed", seed, "seed of the random cases")->capture_default_str();
  app.add_option("--count", count, "random cases of domain A for each distribution and masking; a third as many of B")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::string command = "dolp-reference-values " + std::filesystem::path(out).filename().string() + " --seed " +
                                std::to_string(seed) + " --count " + std::to_string(count);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < kGroups.size(); ++i) {
      const std::vector<Row> more = rows_of(kGroups[i], cases_of(kGroups[i], seed + i, count));
      rows.insert(rows.end(), more.begin(), more.end());
      write(out, command, rows);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dolp-reference-values: %s\n", error.what());
    return 4;
  }
  return 0;
}
