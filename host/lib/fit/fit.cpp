#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <iterator>
#include <utility>

#include <dolp/number_range.hpp>
#include "base/numbers.hpp"
#include "base/text.hpp"
#include "fit/constants.hpp"
#include "fit/curve.hpp"
#include "fit/search.hpp"

namespace dolp::fit {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLevel68 = 0.682689492137086;
constexpr double kLevel95 = 0.95;

double least_uncertainty(const Model& model) {
  double least = model.has_uncertainties() ? std::numeric_limits<double>::infinity() : kAssumedUncertainty;
  for (const MeasuredData& data : model.data()) {
    for (const Measurement& measurement : data.measurements)
      least = std::min(least, measurement.uncertainty.value_or(least));
  }
  return least;
}

double fine_tolerance(const Model& model) {
  return std::min(model.scene().accuracy.tolerance,
                  std::max(kFineShare * least_uncertainty(model), kToleranceRange.min));
}

double coarse_tolerance(const Model& model) {
  return std::max(fine_tolerance(model), std::min(kCoarseShare * least_uncertainty(model), kMostTolerance));
}

bool is_at_bound(double coordinate) { return coordinate < kAtBound || coordinate > 1.0 - kAtBound; }

/// An undetermined combination of parameters, as a direction in the space of coordinates. Its largest component is +-1.
struct Direction {
  Eigen::VectorXd along;
  /// True: no residual changes along the direction. False: residuals change, but by less than one standard deviation.
  bool is_null = false;
};

struct Covariance {
  Eigen::MatrixXd matrix;
  std::vector<Direction> unconstrained;
  std::size_t rank = 0;
};

Covariance estimate_covariance(const Minimum& minimum, double scale) {
  constexpr double kNullShare = 1e-4;  // singular values below this share of the largest belong to null directions
  // Ignores a parameter whose whole range changes the residuals by less than this many standard deviations.
  constexpr double kLeastDeviations = 1e-3;
  Eigen::MatrixXd jacobian = minimum.where.weights.asDiagonal() * minimum.where.jacobian;
  const Eigen::Index count = jacobian.cols();
  Eigen::VectorXd norms = jacobian.colwise().norm();
  const double least_norm = std::max(kNullShare * kNullShare * norms.maxCoeff(), kLeastDeviations * std::sqrt(scale));
  for (Eigen::Index j = 0; j < count; ++j) {
    const bool is_seen = norms[j] > least_norm;
    if (!is_seen) norms[j] = 1.0;
    jacobian.col(j) *= is_seen && !is_at_bound(minimum.where.at[j]) ? 1.0 / norms[j] : 0.0;
  }
  const PrincipalAxes axes = principal_axes(jacobian.transpose() * jacobian);
  Covariance result{Eigen::MatrixXd::Zero(count, count), {}, 0};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd axis = axes.directions.col(i);
    const double singular = std::sqrt(axes.values[i]);
    const Eigen::VectorXd along = axis.cwiseQuotient(norms);
    const double length = along.cwiseAbs().maxCoeff();
    Eigen::Index first = 0;
    const double largest = axis.cwiseAbs().maxCoeff(&first);
    const bool is_null = singular <= kNullShare * std::sqrt(axes.values[0]);
    if (is_null && is_at_bound(minimum.where.at[first])) continue;
    if (is_null || singular < length * std::sqrt(scale)) result.unconstrained.push_back({along / length, is_null});
    if (is_null) {
      for (Eigen::Index j = 0; j < count; ++j)
        if (std::abs(axis[j]) > kInDirection * largest) result.matrix(j, j) = kInfinity;
      continue;
    }
    ++result.rank;
    result.matrix += scale / (singular * singular) * along * along.transpose();
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    if (!is_at_bound(minimum.where.at[j])) continue;
    result.matrix.row(j).setConstant(kNaN);
    result.matrix.col(j).setConstant(kNaN);
  }
  return result;
}

Eigen::MatrixXd correlation_matrix(const Eigen::MatrixXd& covariance) {
  const auto known = [](double variance) { return variance > 0.0 && std::isfinite(variance) ? variance : kNaN; };
  const Eigen::VectorXd inverses = covariance.diagonal().unaryExpr(known).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd correlation = inverses.asDiagonal() * covariance * inverses.asDiagonal();
  for (double& entry : correlation.diagonal()) entry = std::isnan(entry) ? kNaN : 1.0;
  return correlation;
}

std::string direction_text(const Direction& direction, const std::vector<FitParameter>& parameters) {
  std::vector<std::string> rising, falling;
  std::string extent = direction.is_null ? "at all" : "within its range";
  const Eigen::VectorXd& along = direction.along;
  for (Eigen::Index j = 0; j < along.size(); ++j) {
    if (std::abs(along[j]) < kInDirection) continue;
    const FitParameter& parameter = parameters[static_cast<std::size_t>(j)];
    (along[j] > 0.0 ? rising : falling).push_back(parameter.key);
    // The derivatives are local, but the interval covers the whole range.
    if (direction.is_null && (parameter.interval_95.low || parameter.interval_95.high)) extent = "near its best value";
  }
  if (rising.empty()) std::swap(rising, falling);
  if (rising.size() + falling.size() == 1)
    return fmt::format("the data do not determine {} {}", rising.front(), extent);
  const std::string up = fmt::format("{}", fmt::join(rising, " and "));
  if (falling.empty()) return fmt::format("the data cannot tell {} apart: both may rise or fall together", up);
  const std::string down = fmt::format("{}", fmt::join(falling, " and "));
  return fmt::format("the data cannot tell {} and {} apart: {} may rise while {} {}", up, down, up, down,
                     falling.size() == 1 ? "falls" : "fall");
}

void set_error(FitParameter& fitted, const FitRange& range, double deviation, bool has_scale) {
  const double error = deviation * range.slope(fitted.value);
  if (fitted.is_at_bound) {
    fitted.why_no_error = "it is at its bound";
  } else if (!has_scale) {
    fitted.why_no_error = "there are as many parameters as points";
  } else if (!std::isfinite(error)) {
    fitted.why_no_error = "the data do not determine it near this value";
  } else if (fitted.value - error < range.low || fitted.value + error > range.high) {
    fitted.why_no_error = fmt::format("{:.2g} would reach beyond its range {:g}:{:g}", error, range.low, range.high);
  } else {
    fitted.standard_error = error;
  }
}

FitInterval parameter_interval(const FitRange& parameter, const std::vector<CoordinateInterval>& intervals) {
  FitInterval interval;
  interval.is_empty = intervals.empty();
  for (const CoordinateInterval& piece : intervals) {
    std::optional<double> low, high;
    if (piece.low > kAtBound) low = parameter.at(piece.low);
    if (piece.high < 1.0 - kAtBound) high = parameter.at(piece.high);
    interval.pieces.emplace_back(low, high);
  }
  if (interval.is_empty) return interval;
  interval.low = interval.pieces.front().first;
  interval.high = interval.pieces.back().second;
  return interval;
}

class Fit {
 public:
  Fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options)
      : model_(model),
        options_(options),
        coarse_(model, evaluator, residual_options(coarse_tolerance(model), Differences::kForward)),
        fine_(model, evaluator, residual_options(fine_tolerance(model), Differences::kCentral)),
        profile_(model, evaluator, residual_options(fine_tolerance(model), Differences::kForward)) {}

  std::optional<FitResult> run(double most_aic) {
    constexpr int kMostRestarts = 4;  // a restart begins at a lower minimum that a profile has found
    if (options_.phase) options_.phase("descents of the search");
    if (model_.parameters().size() == 1) curve_.emplace(coarse_, fine_, options_);
    minima_ = curve_ ? descend_to_minima(fine_, curve_->low_points(), guess_scale())
                     : find_minima(coarse_, fine_, options_, guess_scale(), count_);
    if (minima_.empty()) return std::nullopt;
    for (int i = 0;; ++i) {
      const bool may_restart = i < kMostRestarts;
      find_values();
      if (has_scale() && options_.phase) options_.phase("sides of the intervals");
      if (has_scale() && !find_intervals(result_.scale, may_restart, false)) continue;
      describe();
      const bool needs_scaled = result_.p_value.value_or(1.0) < kDoubtfulBelow && result_.aic <= most_aic;
      if (!needs_scaled || find_intervals(result_.reduced_chi_square.value(), may_restart, true))
        return std::move(result_);
    }
  }

 private:
  ResidualOptions residual_options(double tolerance, Differences differences) {
    return {tolerance, differences, options_.loss, [this](std::size_t, std::size_t) {
              return !options_.progress || options_.progress(count_.done, count_.total);
            }};
  }

  /// Degrees of freedom: number of points minus number of parameters. With a model error it is the number of points,
  /// because then chi^2 itself has a limit at the ends of an interval. Otherwise the growth of chi^2 has a limit.
  std::size_t freedom() const {
    return model_.observation_count() - (model_.has_model_error() ? 0 : model_.parameters().size());
  }

  bool has_scale() const { return model_.has_uncertainties() || freedom() > 0; }

  /// A guess of the scale (rise of the objective one standard deviation from a minimum) before the search. It is 1 with
  /// uncertainties, otherwise (largest measured value / 100)^2.
  double guess_scale() const {
    if (model_.has_uncertainties()) return 1.0;
    double largest = 0.0;
    for (const MeasuredData& data : model_.data()) {
      for (const Measurement& measurement : data.measurements) largest = std::max(largest, std::abs(measurement.value));
    }
    return std::pow(std::max(0.01 * largest, fine_.tolerance()), 2);
  }

  /// The growth, (objective - minimum) / scale, at the ends of an interval that has the probability `level`.
  double rise_at(double level) const {
    if (model_.has_uncertainties()) {
      const double freedoms = model_.has_model_error() ? static_cast<double>(freedom()) : 1.0;
      return boost::math::quantile(boost::math::chi_squared(freedoms), level);
    }
    const boost::math::students_t t(static_cast<double>(freedom()));
    return std::pow(boost::math::quantile(t, 0.5 * (1.0 + level)), 2);
  }

  void find_values() {
    const Minimum& best = minima_.front();
    result_ = {};
    result_.scale = noise_scale(fine_, best.objective());
    const Eigen::Index count = best.where.at.size();
    // With a model error the covariance matrix is NaN, because residuals are 0 everywhere in a bracket.
    covariance_ = model_.has_model_error()
                      ? Covariance{Eigen::MatrixXd::Constant(count, count, kNaN), {}, static_cast<std::size_t>(count)}
                      : estimate_covariance(best, result_.scale);
    for (std::size_t j = 0; j < model_.parameters().size(); ++j) {
      const FitRange& range = model_.parameters()[j];
      const auto index = static_cast<Eigen::Index>(j);
      FitParameter& fitted = result_.parameters.emplace_back();
      fitted.key = range.key;
      fitted.value = range.at(best.where.at[index]);
      fitted.is_at_bound = is_at_bound(best.where.at[index]);
      set_error(fitted, range, std::sqrt(covariance_.matrix(index, index)), has_scale());
      if (model_.has_model_error())
        fitted.why_no_error = "with a model error the value is one of many that fit as well";
    }
    result_.valley_points = {best};
  }

  /// Sets the intervals. Returns false if a profile found a lower minimum, which is now the first of minima_.
  bool find_intervals(double scale, bool may_restart, bool is_scaled) {
    ProfileOptions options{{rise_at(kLevel68), rise_at(kLevel95)}, 0.0, scale};
    if (!model_.has_model_error()) options.from = minima_.front().objective();
    std::vector<Minimum> near = minima_;
    std::erase_if(near, [&](const Minimum& candidate) {
      return !(candidate.objective() < options.from + options.rises[1] * scale);
    });
    const Profiles profiles =
        curve_ ? curve_->profiles(near, options) : compute_profiles(profile_, near, options, count_);
    if (may_restart && profiles.lower && take(*profiles.lower)) return false;
    for (std::size_t j = 0; j < result_.parameters.size(); ++j) {
      FitParameter& parameter = result_.parameters[j];
      (is_scaled ? parameter.scaled_68.emplace() : parameter.interval_68) =
          parameter_interval(model_.parameters()[j], profiles.intervals[j][0]);
      (is_scaled ? parameter.scaled_95.emplace() : parameter.interval_95) =
          parameter_interval(model_.parameters()[j], profiles.intervals[j][1]);
    }
    if (!is_scaled) std::ranges::copy(profiles.points, std::back_inserter(result_.valley_points));
    return true;
  }

  bool take(const Minimum& lower) {
    std::vector<Minimum> bottoms = {{.where = fine_.at({lower.where.at}).front()}};
    descend(fine_, bottoms, {result_.scale});
    Minimum& bottom = bottoms.front();
    if (!bottom.has_converged || bottom.objective() >= minima_.front().objective()) return false;
    // If the objective is lower by less than the scale, the new point replaces the best minimum as a better estimate.
    if (bottom.objective() > minima_.front().objective() - result_.scale) minima_.erase(minima_.begin());
    minima_.insert(minima_.begin(), std::move(bottom));
    return true;
  }

  void describe() {
    const Minimum& best = minima_.front();
    const Prediction prediction = fine_.predict({best.where.at}).front();
    result_.correlation = correlation_matrix(covariance_.matrix);
    result_.chi_square = best.objective();
    result_.degrees_of_freedom = freedom();
    if (freedom() > 0) {
      const auto freedoms = static_cast<double>(freedom());
      result_.reduced_chi_square = best.objective() / freedoms;
      if (model_.has_uncertainties() && options_.loss == Loss::kSquares)
        result_.p_value = boost::math::gamma_q(0.5 * freedoms, 0.5 * best.objective());
    }
    result_.fit_quality = fit_quality(result_.p_value);
    for (const Minimum& minimum : minima_) {
      const Eigen::VectorXd values = model_.values(minimum.where.at);
      result_.minima.push_back({{values.begin(), values.end()}, minimum.objective()});
    }
    result_.tolerance = fine_.tolerance();
    result_.status = prediction.status;
    result_.residuals = -best.where.residuals;
    result_.predicted = prediction.values;
    result_.numerical_error = prediction.error.cwiseProduct(fine_.weights()).maxCoeff() / std::sqrt(result_.scale);
    result_.evaluations = coarse_.evaluations() + fine_.evaluations() + profile_.evaluations();
    result_.jacobian = find_jacobian(best);
    name_degeneracies();
    const auto points = static_cast<double>(model_.observation_count());
    auto parameters = static_cast<double>(result_.determined);
    double misfit = result_.chi_square;
    if (!model_.has_uncertainties()) {
      misfit = points * std::log(std::max(result_.chi_square, std::numeric_limits<double>::min()) / points);
      parameters += 1.0;  // without uncertainties, the scale is a parameter too
    }
    result_.aic = misfit + 2.0 * parameters;
    result_.bic = misfit + std::log(points) * parameters;
  }

  /// The derivatives of the observables by the numbers of the scene.
  Eigen::MatrixXd find_jacobian(const Minimum& best) {
    Linearisation point = best.where;
    fine_.linearise({&point});
    Eigen::MatrixXd jacobian = fine_.weights().cwiseInverse().asDiagonal() * point.jacobian;
    for (std::size_t j = 0; j < result_.parameters.size(); ++j)
      jacobian.col(static_cast<Eigen::Index>(j)) /= model_.parameters()[j].slope(result_.parameters[j].value);
    return jacobian;
  }

  /// Describes the undetermined combinations of parameters. Leaves out a combination that changes residuals, unless one
  /// of its parameters has an interval that is open at both ends.
  void name_degeneracies() {
    result_.determined = covariance_.rank;
    for (const Direction& direction : covariance_.unconstrained) {
      bool is_open = direction.is_null;
      for (std::size_t j = 0; j < result_.parameters.size(); ++j) {
        const FitInterval& interval = result_.parameters[j].interval_68;
        is_open = is_open || (std::abs(direction.along[static_cast<Eigen::Index>(j)]) >= kInDirection &&
                              !interval.low && !interval.high);
      }
      const std::string words = direction_text(direction, result_.parameters);
      const bool is_new = std::ranges::find(result_.degeneracies, words) == result_.degeneracies.end();
      if (is_open && is_new) result_.degeneracies.push_back(words);
    }
  }

  const Model& model_;
  const FitOptions& options_;
  Count count_;  ///< for FitOptions::progress: descents of the search, then sides of profiles
  Residuals coarse_, fine_, profile_;
  std::optional<Curve> curve_;  ///< if the fit has one parameter
  std::vector<Minimum> minima_;
  Covariance covariance_;
  FitResult result_;
};

}  // namespace

std::string fit_quality(const std::optional<double>& p_value) {
  return !p_value ? "" : *p_value < kBadBelow ? "bad" : *p_value < kDoubtfulBelow ? "doubtful" : "good";
}

std::optional<FitResult> fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options,
                             double most_aic) {
  return Fit(model, evaluator, options).run(most_aic);
}

}  // namespace dolp::fit
