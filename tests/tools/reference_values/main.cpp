// dolp-reference-values: writes reference moments of hard cases and random points, with which tests compare evaluators.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <dolp/errors.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "model/choices.hpp"
#include "reference/moments.hpp"
#include "reference/reference_evaluator.hpp"
#include "reference_values/reference_cases.hpp"

namespace {

using dolp::Distribution;
using dolp::Masking;
using dolp::Moments;
using dolp::to_name;
using dolp::reference::Case;
using dolp::reference::Group;

// Smallest divisor of a relative error, as a share of the albedo. The usual divisor r_i is 0 for n = 1 and k = 0.
constexpr double kNegligible = 1e-12;
// Relative rounding error of a closed form, which has fewer than 16 operations.
constexpr double kClosedFormRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// Two settings of the reference evaluator, which computes each case twice. If a moment has no closed form, the program
/// writes the value computed with `fine`. The error in the file is at least the difference of the two values.
struct Refinements {
  dolp::reference::Refinement coarse;
  dolp::reference::Refinement fine;
};
// Finer settings would not help: the results with these two settings differ only by rounding in double.
constexpr Refinements kForHardCases{{.relative_tolerance = 3e-13, .subdivisions = 1},
                                    {.relative_tolerance = 1e-13, .subdivisions = 2}};
// The tolerance of `fine` is a thousandth of 1e-9, the tightest tolerance of the tests with random points.
constexpr Refinements kForRandomPoints{{.relative_tolerance = 1e-11, .subdivisions = 1},
                                       {.relative_tolerance = 1e-12, .subdivisions = 2}};

struct Row {
  Group group;
  Case input;
  Moments moments;
  std::string origin;
};

dolp::MomentsRequest request_of(const Group& group, const std::vector<Case>& cases) {
  dolp::MomentsRequest request;
  request.distribution = group.distribution;
  request.masking = group.masking;
  request.tolerance = 0.0;
  for (const Case& c : cases) {
    request.append({c.theta_deg, c.shape, c.index});
  }
  return request;
}

/// The result of `fine`. Its errors are made at least as large as its difference from the result of `coarse`.
Moments compared(const Moments& coarse, const Moments& fine) {
  Moments result = fine;
  result.r_i_error = std::max(fine.r_i_error, std::abs(coarse.r_i - fine.r_i));
  result.r_q_error = std::max(fine.r_q_error, std::abs(coarse.r_q - fine.r_q));
  result.albedo_error = std::max(fine.albedo_error, std::abs(coarse.albedo - fine.albedo));
  result.deficit_error = std::max(fine.deficit_error, std::abs(coarse.deficit - fine.deficit));
  return result;
}

void replace(double& value, double& error, double exact) {
  value = exact;
  error = kClosedFormRounding * std::abs(exact);
}

/// Replaces the albedo A at theta = 0 by its closed form. Without masking A is 1 - (m^2/(1 + m^2))^(q - 1) for cauchy
/// and 1 - exp(-1/m^2) for gaussian. Here m^2 is 2 sigma^2. For cauchy with smith masking, q = 2 and
/// sigma = 1/sqrt(2), A is 1 - ln 2. Returns false if there is no closed form.
bool put_normal_albedo(const Row& row, Moments& moments) {
  const double m2 = 2.0 * row.input.shape.sigma * row.input.shape.sigma;
  const double q = row.input.shape.q;
  const bool is_cauchy = row.group.distribution == Distribution::kCauchy;
  if (row.group.masking == Masking::kNone) {
    const double exact = is_cauchy ? -std::expm1((1.0 - q) * std::log1p(1.0 / m2)) : -std::expm1(-1.0 / m2);
    replace(moments.albedo, moments.albedo_error, exact);
    return true;
  }
  const bool is_ln2 = is_cauchy && row.group.masking == Masking::kSmith && row.input.name == "normal-albedo";
  if (is_ln2) replace(moments.albedo, moments.albedo_error, 1.0 - std::numbers::ln2);
  return is_ln2;
}

/// Replaces each moment that has a closed form by the value of this form. Row::origin states the origin of the values.
void put_closed_forms(Row& row) {
  Moments& moments = row.moments;
  if (row.input.shape.sigma == 0.0) {
    row.origin = "closed form: Fresnel reflection of the mirror";
    return;
  }
  row.origin = "adaptive quadrature in two refinements";
  if (row.input.index.n == 1.0 && row.input.index.k == 0.0) {
    replace(moments.r_i, moments.r_i_error, 0.0);
    replace(moments.r_q, moments.r_q_error, 0.0);
    replace(moments.deficit, moments.deficit_error, dolp::reference::zenith_from_deg(row.input.theta_deg).cos);
    row.origin += "; r_i r_q deficit closed form: n = 1";
  }
  if (row.input.theta_deg != 0.0) return;
  replace(moments.r_q, moments.r_q_error, 0.0);
  row.origin +=
      put_normal_albedo(row, moments) ? "; r_q albedo closed form: theta = 0" : "; r_q closed form: theta = 0";
}

/// The larger of the errors of r_i and r_q, divided by r_i.
double relative_error(const Moments& moments) {
  const double scale = std::max(moments.r_i, kNegligible * moments.albedo);
  return scale > 0.0 ? std::max(moments.r_i_error, moments.r_q_error) / scale : 0.0;
}

std::vector<Row> rows_of(const Group& group, const std::vector<Case>& cases, const Refinements& refinements) {
  const dolp::MomentsRequest request = request_of(group, cases);
  dolp::ReferenceEvaluator coarse(refinements.coarse);
  dolp::ReferenceEvaluator fine(refinements.fine);
  const std::vector<Moments> a = coarse.evaluate(request, {});
  const std::vector<Moments> b = fine.evaluate(request, {});
  std::vector<Row> rows;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    rows.push_back({group, cases[i], compared(a[i], b[i]), {}});
    put_closed_forms(rows.back());
  }
  std::vector<Row> sorted = rows;
  std::ranges::sort(sorted, std::greater{}, [](const Row& row) { return relative_error(row.moments); });
  std::fprintf(stderr, "%s %s: %zu cases, %.1f s and %.1f s; largest bounds over r_i:", to_name(group.distribution),
               to_name(group.masking), cases.size(), coarse.report().kernel_s, fine.report().kernel_s);
  for (std::size_t i = 0; i < std::min<std::size_t>(6, sorted.size()); ++i) {
    std::fprintf(stderr, " %.1e %s,", relative_error(sorted[i].moments), sorted[i].input.name.c_str());
  }
  std::fprintf(stderr, " median %.1e\n", relative_error(sorted[sorted.size() / 2].moments));
  return rows;
}

std::string csv_line(const Row& row) {
  const Case& c = row.input;
  const Moments& m = row.moments;
  std::string line = std::string(to_name(row.group.distribution)) + "," + to_name(row.group.masking);
  for (const double value :
       {c.theta_deg, c.shape.sigma, c.shape.q, c.index.n, c.index.k, m.r_i, m.r_q, m.albedo, m.deficit}) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), ",%.17g", value);
    line += text.data();
  }
  for (const double error : {m.r_i_error, m.r_q_error, m.albedo_error, m.deficit_error}) {
    std::array<char, 32> text{};
    // the text has three digits; because of the factor 1.01 rounding does not make the error smaller
    std::snprintf(text.data(), text.size(), ",%.2e", 1.01 * error);
    line += text.data();
  }
  return line + "," + c.name + "," + row.origin + "\n";
}

// Writes to a temporary file and renames it to `path`. So other programs find either the old or the complete new file.
void write(const std::filesystem::path& path, const std::string& command, const std::vector<Row>& rows) {
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream file(part);
  file << "# " << command << "\n"
       << "distribution,masking,theta_deg,sigma,q,n,k,r_i,r_q,albedo,deficit,r_i_error,r_q_error,albedo_error,"
          "deficit_error,case,origin\n";
  for (const Row& row : rows) file << csv_line(row);
  file.close();
  if (!file) throw dolp::IoError("cannot write " + part.string());
  std::filesystem::rename(part, path);
}

using CasesOf = std::function<std::vector<Case>(std::size_t group)>;

void write_all(const std::string& path, const std::string& command, const Refinements& refinements,
               const CasesOf& cases_of) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < dolp::reference::kGroups.size(); ++i) {
    const std::vector<Row> more = rows_of(dolp::reference::kGroups[i], cases_of(i), refinements);
    rows.insert(rows.end(), more.begin(), more.end());
    write(path, command, rows);
  }
}

struct Arguments {
  std::string hard;
  std::string random;
  std::uint64_t seed = 20261121;
  std::size_t count_a = 188;
  std::size_t count_b = 62;
};

void run(const Arguments& arguments) {
  const auto file_name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  if (!arguments.hard.empty()) {
    write_all(arguments.hard, "dolp-reference-values --hard " + file_name(arguments.hard), kForHardCases,
              [](std::size_t group) { return hard_cases(dolp::reference::kGroups[group]); });
  }
  if (arguments.random.empty()) return;
  const std::string command = "dolp-reference-values --random " + file_name(arguments.random) + " --seed " +
                              std::to_string(arguments.seed) + " --count-a " + std::to_string(arguments.count_a) +
                              " --count-b " + std::to_string(arguments.count_b);
  write_all(arguments.random, command, kForRandomPoints, [&](std::size_t group) {
    return random_cases(dolp::reference::kGroups[group], arguments.seed + group, arguments.count_a, arguments.count_b);
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Writes reference moments of the hard cases and of random points by the independent reference evaluator.");
  Arguments arguments;
  app.add_option("--hard", arguments.hard,
                 "CSV file of the hard cases, written anew after each distribution and masking");
  app.add_option("--random", arguments.random, "likewise, of the random points");
  app.add_option("--seed", arguments.seed, "seed of the random points")->capture_default_str();
  app.add_option("--count-a", arguments.count_a, "points of domain A for each distribution and masking")
      ->capture_default_str();
  app.add_option("--count-b", arguments.count_b, "points of domain B, likewise")->capture_default_str();
  app.require_option(1, 5);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dolp-reference-values: %s\n", error.what());
    return 4;
  }
  return 0;
}
