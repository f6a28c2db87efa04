// dolp-calibrate: how large the kernel's errors, doubts and estimates are at reference points, which the numbers of
// plan/rule.cpp are tuned and checked with.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "calibrate/calibration.hpp"
#include "calibrate/calibration_report.hpp"
#include "scene/number_range.hpp"

namespace {

enum ExitStatus { kDone = 0, kUsage = 2, kFile = 4, kInternal = 5 };

struct Arguments {
  std::vector<std::string> files;
  std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
  std::string precision = "double";
  std::size_t worst = 0;
  bool json = false;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("FILE", arguments.files, "CSV files that dolp-reference-values wrote")->required();
  app.add_option("--tolerance", arguments.tolerances,
                 "tolerance of the rules, repeatable, in " + dolp::kToleranceRange.text())
      ->check([](const std::string& text) {
        double value = 0.0;
        const bool is_allowed = CLI::detail::lexical_cast(text, value) && dolp::kToleranceRange.contains(value);
        return is_allowed ? std::string() : text + " must be a number in " + dolp::kToleranceRange.text();
      })
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--precision", arguments.precision, "arithmetic of the kernel")
      ->check(CLI::IsMember({"float", "double"}))
      ->capture_default_str();
  app.add_option("--worst", arguments.worst, "list this many points of each group, those that need the largest factor")
      ->capture_default_str();
  app.add_flag("--json", arguments.json, "the report as JSON");
}

void run(const Arguments& arguments) {
  dolp::CalibrationReport report;
  report.precision = arguments.precision;
  report.worst = arguments.worst;
  for (const std::string& file : arguments.files) {
    for (const dolp::StoredCase& stored : dolp::read_stored_cases(file)) {
      if (dolp::is_calibration_case(stored)) report.cases.push_back(stored);
    }
  }
  if (report.cases.empty()) {
    throw dolp::InputError(arguments.files.front() + ": no point to calibrate with; sigma and r_i must be above 0");
  }
  for (const double tolerance : arguments.tolerances) {
    for (dolp::GroupCalibration& group : dolp::calibrate(report.cases, tolerance, report.precision == "double")) {
      report.groups.push_back(std::move(group));
    }
  }
  const std::string text =
      arguments.json ? dolp::calibration_json(report).dump(2) + "\n" : dolp::calibration_text(report);
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    throw dolp::IoError("cannot write to standard output");
  }
}

int fail(const std::exception& error, ExitStatus status) {
  std::fprintf(stderr, "dolp-calibrate: %s\n", error.what());
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the kernel's errors, doubts and estimates with reference moments.");
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
    run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  } catch (const dolp::InputError& error) {
    return fail(error, kUsage);
  } catch (const dolp::IoError& error) {
    return fail(error, kFile);
  } catch (const std::exception& error) {
    return fail(error, kInternal);
  }
  return kDone;
}
