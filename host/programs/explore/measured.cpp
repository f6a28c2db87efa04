#include "explore/measured.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace dolp::explore {
namespace {

Plotted quantity_of(const std::string& column) {
  if (column == "q_over_i") return Plotted::kSignedDolp;
  if (column == "emissivity_s") return Plotted::kEmissivityS;
  if (column == "emissivity_p") return Plotted::kEmissivityP;
  return Plotted::kDolp;
}

}  // namespace

MeasuredPoints points_of(MeasuredData data) {
  if (!data.settings.empty()) {
    throw InputError(data.name + ": measured points take the window's scene; KEY=VALUE beside them is for dolp fit");
  }
  MeasuredPoints all;
  for (const Measurement& one : data.measurements) {
    all.points.push_back({quantity_of(name_of(one.observable)), one.theta_deg, one.value, one.uncertainty});
    if (one.wavelength_um) all.wavelength_um.push_back(*one.wavelength_um);
  }
  all.data = std::move(data);
  return all;
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
  if (!points_ || known_ == job_key()) return std::nullopt;
  std::vector<double> theta_deg;
  for (const MeasuredPoint& point : points_->points) theta_deg.push_back(point.theta_deg);
  PointList list = points_at(scene_, std::move(theta_deg));
  list.wavelength_um = points_->wavelength_um;
  return Job{.key = job_key(), .scene = scene_, .parts = {std::move(list)}, .keep_all = true};
}

bool Residuals::take(const JobPart& news) {
  if (!points_ || news.key != job_key()) return false;
  known_ = news.key;
  model_ = news.points;
  return true;
}

std::vector<double> Residuals::residuals() const {
  std::vector<double> residuals;
  if (!points_ || known_ != job_key()) return residuals;
  for (std::size_t i = 0; i < model_.size(); ++i) {
    const MeasuredPoint& point = points_->points[i];
    residuals.push_back(point.value - value_of(point.quantity, model_[i]));
  }
  return residuals;
}

std::optional<double> Residuals::rms(Plotted quantity) const {
  const std::vector<double> all = residuals();
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (points_->points[i].quantity != quantity || !std::isfinite(all[i])) continue;
    sum += all[i] * all[i];
    count += 1.0;
  }
  return count > 0.0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

}  // namespace dolp::explore
