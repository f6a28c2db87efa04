#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/text.hpp"
#include "fit/constants.hpp"
#include "fit/principal_axes.hpp"
#include "fit/profile.hpp"
#include "fit/search.hpp"

namespace dolp::fit {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLevel68 = 0.682689492137086;
constexpr double kLevel95 = 0.95;

double least_uncertainty(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const MeasuredData& data : model.data()) {
    for (const Measurement& one : data.measurements) least = std::min(least, one.uncertainty.value_or(least));
  }
  return least;
}

/// The tolerance of the model's values; at most the scene's own.
double fine_tolerance(const Model& model) {
  const double wanted =
      model.has_uncertainties() ? kFineShare * least_uncertainty(model) : kToleranceWithoutUncertainties;
  return std::min(model.scene().accuracy.tolerance, std::max(wanted, kLeastTolerance));
}

/// The tolerance of the search.
double coarse_tolerance(const Model& model) {
  const double wanted =
      model.has_uncertainties() ? kCoarseShare * least_uncertainty(model) : kCoarseToleranceWithoutUncertainties;
  return std::max(fine_tolerance(model), std::min(wanted, kMostTolerance));
}

bool is_at_bound(double coordinate) { return coordinate < kAtBound || coordinate > 1.0 - kAtBound; }

/// A direction of coordinates, the largest component 1, and the distance over which the data do not constrain it.
struct Direction {
  Eigen::VectorXd along;
  bool is_null = false;  ///< the data do not see it at all; else the whole range changes less than they can tell
};

/// Covariance of the parameters, from the Jacobian at a minimum.
struct Covariance {
  Eigen::MatrixXd of_coordinates;     ///< infinite variance where a null direction points; NaN at a bound
  std::vector<Direction> directions;  ///< that the data do not see
  std::size_t rank = 0;
};

Covariance covariance_of(const Minimum& minimum, Loss loss, double scale) {
  const Eigen::VectorXd weights = loss_weights(minimum.where.residuals, loss).cwiseSqrt();
  Eigen::MatrixXd jacobian = weights.asDiagonal() * minimum.where.jacobian;
  const Eigen::Index count = jacobian.cols();
  Eigen::VectorXd norms = jacobian.colwise().norm();
  Covariance result;
  std::vector<bool> is_held;
  const double largest_norm = norms.maxCoeff();
  for (Eigen::Index j = 0; j < count; ++j) {
    is_held.push_back(is_at_bound(minimum.where.at[j]));
    const bool is_seen = norms[j] > std::max(kNullShare * kNullShare * largest_norm, kUnseen * std::sqrt(scale));
    jacobian.col(j) *= is_held.back() || !is_seen ? 0.0 : 1.0 / norms[j];
    if (!is_seen) norms[j] = 1.0;
  }
  const PrincipalAxes axes = principal_axes(jacobian.transpose() * jacobian);
  Eigen::MatrixXd& covariance = result.of_coordinates;
  covariance = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd right = axes.directions.col(i);
    const double singular = std::sqrt(axes.values[i]);
    const Eigen::VectorXd along = right.cwiseQuotient(norms);
    const double length = along.cwiseAbs().maxCoeff();
    Eigen::Index first = 0;
    right.cwiseAbs().maxCoeff(&first);
    const bool is_null = singular <= kNullShare * std::sqrt(axes.values[0]);
    if (is_null && is_held[static_cast<std::size_t>(first)]) continue;
    if (is_null || singular < length * std::sqrt(scale)) result.directions.push_back({along / length, is_null});
    if (is_null) {
      const Eigen::VectorXd infinite =
          (right.cwiseAbs().array() > kInDirection * right.cwiseAbs().maxCoeff())
              .select(Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity()),
                      Eigen::VectorXd::Zero(count));
      covariance.diagonal() += infinite;
      continue;
    }
    ++result.rank;
    covariance += scale / (singular * singular) * along * along.transpose();
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    if (is_held[static_cast<std::size_t>(j)]) covariance.row(j).setConstant(kNaN), covariance.col(j).setConstant(kNaN);
  }
  return result;
}

Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd correlation(covariance.rows(), covariance.cols());
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
      const double product = covariance(i, i) * covariance(j, j);
      const bool is_known = std::isfinite(product) && product > 0.0;
      correlation(i, j) = !is_known ? kNaN : i == j ? 1.0 : covariance(i, j) / std::sqrt(product);
    }
  }
  return correlation;
}

/// A direction in words.
std::string words_of(const Direction& direction, const std::vector<FitRange>& parameters) {
  std::vector<std::string> rising, falling;
  const Eigen::VectorXd& along = direction.along;
  for (Eigen::Index j = 0; j < along.size(); ++j) {
    if (std::abs(along[j]) < kInDirection) continue;
    (along[j] > 0.0 ? rising : falling).push_back(parameters[static_cast<std::size_t>(j)].key);
  }
  if (rising.empty()) std::swap(rising, falling);
  const std::string extent = direction.is_null ? "at all" : "within its range";
  if (rising.size() + falling.size() == 1)
    return fmt::format("the data do not determine {} {}", rising.front(), extent);
  std::vector<std::string> all = rising;
  all.insert(all.end(), falling.begin(), falling.end());
  const std::string names = fmt::format("{}", fmt::join(all, " and "));
  if (falling.empty()) return fmt::format("the data cannot tell {} apart: both may rise or fall together", names);
  return fmt::format("the data cannot tell {} apart: {} may rise while {} {}", names, fmt::join(rising, " and "),
                     fmt::join(falling, " and "), falling.size() == 1 ? "falls" : "fall");
}

/// The standard error of a value, or why it has none.
void set_error(FitParameter& fitted, const FitRange& range, double deviation, bool has_scale) {
  const double error = deviation * range.slope(fitted.value);
  if (fitted.is_at_bound) {
    fitted.why_no_error = "it is at its bound";
  } else if (!has_scale) {
    fitted.why_no_error = "there are as many parameters as points";
  } else if (!std::isfinite(error)) {
    fitted.why_no_error = "the data do not determine it";
  } else if (fitted.value - error < range.low || fitted.value + error > range.high) {
    fitted.why_no_error = fmt::format("{:.2g} would reach beyond its range {:g}:{:g}", error, range.low, range.high);
  } else {
    fitted.standard_error = error;
  }
}

FitInterval interval_of(const FitRange& parameter, const std::vector<Stretch>& stretches) {
  FitInterval interval;
  interval.is_empty = stretches.empty();
  for (const Stretch& one : stretches) {
    std::optional<double> low, high;
    if (one.low > kAtRange) low = parameter.at(one.low);
    if (one.high < 1.0 - kAtRange) high = parameter.at(one.high);
    interval.pieces.emplace_back(low, high);
  }
  if (interval.is_empty) return interval;
  interval.low = interval.pieces.front().first;
  interval.high = interval.pieces.back().second;
  return interval;
}

/// One fit while it runs.
class Fit {
 public:
  Fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options)
      : model_(model),
        options_(options),
        poll_([this](std::size_t, std::size_t) { return !options_.progress || options_.progress(done_, total_); }),
        coarse_(model, coarse_tolerance(model), Differences::kForward, evaluator, poll_),
        fine_(model, fine_tolerance(model), Differences::kCentral, evaluator, poll_),
        profile_(model, fine_tolerance(model), Differences::kForward, evaluator, poll_) {}

  std::optional<FitResult> run(double most_aic) {
    SearchOptions search{options_.starts, options_.seed, options_.loss, model_.has_uncertainties(), guess_scale()};
    search.count = [this](std::size_t done, std::size_t total) { count(done, total); };
    if (options_.phase) options_.phase("descents of the search");
    minima_ = find_minima(coarse_, fine_, search);
    if (minima_.empty()) return std::nullopt;
    for (int i = 0;; ++i) {
      const bool may_restart = i < kMostRestarts;
      if (find_intervals(may_restart)) continue;
      describe();
      if (result_.aic > most_aic || !find_scaled(may_restart)) return std::move(result_);
    }
  }

 private:
  void count(std::size_t done, std::size_t total) {
    done_ = done;
    total_ = total;
  }

  /// With a model error the parameters only choose the bracket: each point is a condition of its own.
  std::size_t freedom() const {
    return model_.observation_count() - (model_.has_model_error() ? 0 : model_.parameters().size());
  }

  /// True where the growth of the objective has a scale to be measured with.
  bool has_scale() const { return model_.has_uncertainties() || freedom() > 0; }

  /// 1, or the square of a hundredth of what was measured.
  double guess_scale() const {
    if (model_.has_uncertainties()) return 1.0;
    double largest = 0.0;
    for (const MeasuredData& data : model_.data()) {
      for (const Measurement& one : data.measurements) largest = std::max(largest, std::abs(one.value));
    }
    return std::pow(std::max(kGuessedShare * largest, fine_.tolerance()), 2);
  }

  /// 1, or the mean square of the residuals, which the model's own error bounds from below.
  double find_scale(const Minimum& minimum) const {
    if (model_.has_uncertainties()) return 1.0;
    const double mean = freedom() > 0 ? minimum.objective / static_cast<double>(freedom()) : 0.0;
    return std::max(mean, fine_.tolerance() * fine_.tolerance());
  }

  std::array<double, 2> rises() const {
    if (model_.has_uncertainties()) {
      const boost::math::chi_squared squares(model_.has_model_error() ? static_cast<double>(freedom()) : 1.0);
      return {boost::math::quantile(squares, kLevel68), boost::math::quantile(squares, kLevel95)};
    }
    const boost::math::students_t t(static_cast<double>(freedom()));
    const double at_68 = boost::math::quantile(t, 0.5 * (1.0 + kLevel68));
    const double at_95 = boost::math::quantile(t, 0.5 * (1.0 + kLevel95));
    return {at_68 * at_68, at_95 * at_95};
  }

  /// Inside a bracket no derivative tells parameters apart: it has no covariance.
  Covariance find_covariance(const Minimum& best) const {
    if (!model_.has_model_error()) return covariance_of(best, options_.loss, result_.scale);
    const Eigen::Index count = best.where.at.size();
    return {Eigen::MatrixXd::Constant(count, count, kNaN), {}, static_cast<std::size_t>(count)};
  }

  void find_values(const Minimum& best) {
    result_ = {};
    result_.scale = find_scale(best);
    covariance_ = find_covariance(best);
    for (std::size_t j = 0; j < model_.parameters().size(); ++j) {
      const FitRange& parameter = model_.parameters()[j];
      const auto index = static_cast<Eigen::Index>(j);
      FitParameter& fitted = result_.parameters.emplace_back();
      fitted.key = parameter.key;
      fitted.value = parameter.at(best.where.at[index]);
      fitted.is_at_bound = is_at_bound(best.where.at[index]);
      set_error(fitted, parameter, std::sqrt(covariance_.of_coordinates(index, index)), has_scale());
      if (model_.has_model_error())
        fitted.why_no_error = "with a model error the value is one of many that fit as well";
    }
    result_.seen = {best};
  }

  /// The values and the intervals of all parameters. True where a profile led to a lower minimum, which then is the
  /// best.
  bool find_intervals(bool may_restart) {
    find_values(minima_.front());
    if (!has_scale()) return false;
    if (options_.phase) options_.phase("sides of the intervals");
    const std::optional<Profiles> profiles = find_profiles(result_.scale, may_restart);
    if (!profiles) return true;
    for (std::size_t j = 0; j < result_.parameters.size(); ++j) {
      result_.parameters[j].interval_68 = interval_of(model_.parameters()[j], profiles->stretches[j][0]);
      result_.parameters[j].interval_95 = interval_of(model_.parameters()[j], profiles->stretches[j][1]);
    }
    std::ranges::copy(profiles->seen, std::back_inserter(result_.seen));
    return false;
  }

  /// The scaled intervals of a doubtful or bad fit. True as find_intervals.
  bool find_scaled(bool may_restart) {
    if (result_.p_value.value_or(1.0) >= kDoubtfulBelow) return false;
    const std::optional<Profiles> profiles = find_profiles(result_.reduced_chi_square.value(), may_restart);
    if (!profiles) return true;
    for (std::size_t j = 0; j < result_.parameters.size(); ++j) {
      result_.parameters[j].scaled_68 = interval_of(model_.parameters()[j], profiles->stretches[j][0]);
      result_.parameters[j].scaled_95 = interval_of(model_.parameters()[j], profiles->stretches[j][1]);
    }
    return false;
  }

  /// The profiles around the best minimum, and around others that the data do not exclude; none where one of them led
  /// to a lower minimum, which then is the best.
  std::optional<Profiles> find_profiles(double scale, bool may_restart) {
    const double from = model_.has_model_error() ? 0.0 : minima_.front().objective;
    ProfileOptions options{rises(), from, scale, options_.loss, {}};
    options.count = [this](std::size_t done, std::size_t total) { count(done, total); };
    std::vector<Minimum> near;
    for (const Minimum& one : minima_) {
      if (one.objective < from + options.rises[1] * scale) near.push_back(one);
    }
    if (near.empty())
      return Profiles{.stretches = std::vector<std::array<std::vector<Stretch>, 2>>(result_.parameters.size())};
    Profiles profiles = profiles_of(profile_, near, options);
    if (may_restart && profiles.lower && take(*profiles.lower)) return std::nullopt;
    return profiles;
  }

  /// Descends from a point; true where that gives the new best minimum.
  bool take(const Minimum& lower) {
    DescentOptions descent;
    descent.loss = options_.loss;
    descent.scale = result_.scale;
    std::vector<Minimum> bottoms(1);
    bottoms.front().where.at = lower.where.at;
    descend(fine_, bottoms, descent);
    Minimum& bottom = bottoms.front();
    if (!bottom.has_converged || bottom.objective >= minima_.front().objective) return false;
    if (bottom.objective > minima_.front().objective - result_.scale) minima_.erase(minima_.begin());  // the same
    minima_.insert(minima_.begin(), std::move(bottom));
    return true;
  }

  void describe() {
    const Minimum& best = minima_.front();
    const Prediction prediction = fine_.predict({best.where.at}).front();
    result_.correlation = correlation_of(covariance_.of_coordinates);
    result_.chi_square = best.objective;
    result_.degrees_of_freedom = freedom();
    const auto freedoms = static_cast<double>(freedom());
    if (freedom() > 0) {
      result_.reduced_chi_square = best.objective / freedoms;
      if (model_.has_uncertainties() && options_.loss == Loss::kSquares) {
        result_.p_value = boost::math::gamma_q(0.5 * freedoms, 0.5 * best.objective);
      }
    }
    for (std::size_t i = 1; i < minima_.size(); ++i) {
      result_.minima.push_back({fine_.values(minima_[i].where.at), minima_[i].objective});
    }
    result_.tolerance = fine_.tolerance();
    result_.status = prediction.status;
    result_.residuals = -best.where.residuals;
    result_.predicted = fine_.observed(prediction.components);
    result_.numerical_error = prediction.error.cwiseProduct(fine_.weights()).maxCoeff() / std::sqrt(result_.scale);
    result_.evaluations = coarse_.evaluations() + fine_.evaluations() + profile_.evaluations();
    name_degeneracies();
    add_criteria();
  }

  /// A weakly constrained direction counts only where a profile confirms that a parameter in it is open.
  void name_degeneracies() {
    result_.determined = covariance_.rank;
    for (const Direction& direction : covariance_.directions) {
      bool is_open = direction.is_null;
      for (std::size_t j = 0; j < result_.parameters.size(); ++j) {
        const FitInterval& interval = result_.parameters[j].interval_68;
        is_open = is_open || (std::abs(direction.along[static_cast<Eigen::Index>(j)]) >= kInDirection &&
                              !interval.low && !interval.high);
      }
      const std::string words = words_of(direction, model_.parameters());
      const bool is_new = std::ranges::find(result_.degeneracies, words) == result_.degeneracies.end();
      if (is_open && is_new) result_.degeneracies.push_back(words);
    }
  }

  void add_criteria() {
    const auto points = static_cast<double>(model_.observation_count());
    auto parameters = static_cast<double>(result_.determined);
    double misfit = result_.chi_square;
    if (!model_.has_uncertainties()) {
      misfit = points * std::log(std::max(result_.chi_square, std::numeric_limits<double>::min()) / points);
      parameters += 1.0;  // the scale
    }
    result_.aic = misfit + 2.0 * parameters;
    result_.bic = misfit + std::log(points) * parameters;
  }

  const Model& model_;
  const FitOptions& options_;
  Progress poll_;
  Residuals coarse_, fine_, profile_;
  std::size_t done_ = 0, total_ = 1;
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
