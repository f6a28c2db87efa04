#include "explore/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "scene/csv.hpp"
#include "scene/number_range.hpp"

namespace dolp::explore {
namespace {

constexpr NumberRange kDolpRange{-1.0, 1.0};
constexpr NumberRange kUncertaintyRange{0.0, 1.0, NumberRange::Ends::kOpenBelow};

}  // namespace

MeasuredPoints parse_measured(const std::string& text, const std::string& path_name) {
  MeasuredPoints points;
  points.name = input_name(path_name);
  CsvReader row(text, points.name, {.has_blank_lines = false});
  if (!row.next()) row.fail("the file is empty; columns theta_deg and dolp are expected");
  const std::size_t theta = row.position("theta_deg", kZenithDegRange);
  const std::size_t dolp = row.position("dolp", kDolpRange);
  const bool has_uncertainties = std::ranges::count(row.cells(), "uncertainty") > 0;
  const std::size_t uncertainty = has_uncertainties ? row.position("uncertainty", kUncertaintyRange) : 0;
  while (row.next()) {
    points.theta_deg.push_back(row.number(theta, "theta_deg", &kZenithDegRange));
    points.dolp.push_back(row.number(dolp, "dolp", &kDolpRange));
    if (!has_uncertainties) continue;
    points.uncertainty.push_back(row.number(uncertainty, "uncertainty", &kUncertaintyRange));
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

bool Residuals::take(const JobPart& news) {
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
