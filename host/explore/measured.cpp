#include "explore/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"

namespace dolp::explore {
namespace {

constexpr NumberRange kDolpRange{-1.0, 1.0};

/// A column that the file must have.
struct Column {
  const char* name;
  NumberRange range;
  std::size_t position = 0;
};

void find_column(Column& column, const std::vector<std::string_view>& header, const std::string& name) {
  const auto found = std::ranges::find_if(header, [&](std::string_view cell) { return trim(cell) == column.name; });
  if (found == header.end()) {
    throw InputError(
        fmt::format("{}:1: column \"{}\" is missing, a number in {}", name, column.name, column.range.text()));
  }
  column.position = static_cast<std::size_t>(found - header.begin());
}

double read_cell(const Column& column, const std::vector<std::string_view>& cells, const std::string& where) {
  const std::string_view cell = column.position < cells.size() ? trim(cells[column.position]) : std::string_view{};
  const std::optional<double> value = parse_number(cell);
  if (value && column.range.contains(*value)) return *value;
  const char* what = cell.empty() ? "the value is missing" : value ? "out of range" : "not a number";
  throw InputError(
      fmt::format("{}{} = {}: {}, a number in {}", where, column.name, one_line(cell), what, column.range.text()));
}

}  // namespace

MeasuredPoints parse_measured(const std::string& text, const std::string& path_name) {
  const std::string name = input_name(path_name);
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.empty()) throw InputError(name + ":1: the file is empty; columns theta_deg and dolp are expected");
  const std::vector<std::string_view> header = split(lines[0], ',');
  Column theta{"theta_deg", kZenithDegRange};
  Column dolp{"dolp", kDolpRange};
  find_column(theta, header, name);
  find_column(dolp, header, name);
  MeasuredPoints points;
  points.name = name;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string_view> cells = split(lines[i], ',');
    const std::string where = fmt::format("{}:{}: ", name, i + 1);
    points.theta_deg.push_back(read_cell(theta, cells, where));
    points.dolp.push_back(read_cell(dolp, cells, where));
  }
  return points;
}

MeasuredPoints read_measured(const std::string& path) {
  return parse_measured(read_text(path, input_name(path) + ": "), path);
}

void Residuals::load(MeasuredPoints points) {
  points_ = std::move(points);
  ++loads_;
}

void Residuals::follow(const std::string& key, const Scene& scene) {
  key_ = key;
  scene_ = scene;
}

std::string Residuals::job_key() const { return fmt::format("measured {} {}", loads_, key_); }

std::optional<Job> Residuals::wanted() const {
  if (!points_ || points_->theta_deg.empty() || known_ == job_key()) return std::nullopt;
  Job job;
  job.key = job_key();
  job.scene = scene_;
  job.entries = entries_at(scene_, points_->theta_deg);
  return job;
}

bool Residuals::take(const News& news) {
  if (!points_ || news.key != job_key()) return false;
  known_ = news.key;
  results_ = news.results;
  return true;
}

std::vector<double> Residuals::residuals() const {
  std::vector<double> residuals;
  if (!points_ || known_ != job_key()) return residuals;
  for (std::size_t i = 0; i < results_.size(); ++i) residuals.push_back(points_->dolp[i] - results_[i].dolp);
  return residuals;
}

std::optional<double> Residuals::rms() const {
  double sum = 0.0;
  double count = 0.0;
  for (const double residual : residuals()) {
    if (!std::isfinite(residual)) continue;
    sum += residual * residual;
    count += 1.0;
  }
  return count > 0.0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

}  // namespace dolp::explore
