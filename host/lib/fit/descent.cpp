#include "fit/descent.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace dolp::fit {
namespace {

constexpr double kLeastStepLength = 1e-7;  // of coordinates in [0, 1]
constexpr double kLeastDecrease = 1e-8;    // of the objective, relative

std::unique_ptr<ceres::LossFunction> loss_function(Loss loss) {
  switch (loss) {
    case Loss::kSquares:
      return nullptr;
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(1.345);
    case Loss::kSoftL1:
      return std::make_unique<ceres::SoftLOneLoss>(1.0);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(2.385);
    case Loss::kTukey:
      return std::make_unique<ceres::TukeyLoss>(4.685);
  }
  return nullptr;
}

/// All residuals and derivatives of a step, computed together before Ceres asks for each of them.
class Batch final : public ceres::EvaluationCallback {
 public:
  Batch(Residuals& residuals, Linearisation start)
      : coordinates(start.at), residuals_(residuals), known_(std::move(start)), now_(known_) {}

  Eigen::VectorXd coordinates;  ///< Ceres writes the point here
  std::exception_ptr failure;   ///< of an evaluation; Ceres sees none

  void PrepareForEvaluation(bool wants_jacobian, bool /*is_new*/) override {
    if (failure) return;
    try {
      wants_jacobian ? prepare_linearised() : prepare();
    } catch (...) {
      failure = std::current_exception();
    }
    is_valid_ = !failure && now_.residuals.allFinite() && (!wants_jacobian || now_.jacobian.allFinite());
  }

  bool is_valid() const { return is_valid_; }
  const Linearisation& now() const { return now_; }
  /// The last point at which Ceres asked for derivatives: that of the last step taken.
  const Linearisation& known() const { return known_; }

 private:
  bool has(const Linearisation& point) const { return point.residuals.size() > 0 && point.at == coordinates; }

  void prepare() {
    if (!has(now_)) now_ = {coordinates, residuals_.at({coordinates}).front(), {}};
  }

  void prepare_linearised() {
    if (known_.at != coordinates || known_.jacobian.size() == 0) known_ = residuals_.linearised(coordinates);
    now_ = known_;
  }

  Residuals& residuals_;
  Linearisation known_;
  Linearisation now_;
  bool is_valid_ = false;
};

/// One residual of the batch.
class OneResidual final : public ceres::CostFunction {
 public:
  OneResidual(const Batch& batch, Eigen::Index row) : batch_(batch), row_(row) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(batch.coordinates.size()), 1);
  }
  bool Evaluate(double const* const* /*parameters*/, double* residual, double** jacobians) const override {
    if (!batch_.is_valid()) return false;
    *residual = batch_.now().residuals[row_];
    for (Eigen::Index j = 0; jacobians != nullptr && j < batch_.coordinates.size(); ++j) {
      if (jacobians[j] != nullptr) *jacobians[j] = batch_.now().jacobian(row_, j);
    }
    return true;
  }

 private:
  const Batch& batch_;
  Eigen::Index row_;
};

/// Ends a descent whose evaluation has failed, or for which derivatives predict too little gain.
class Watch final : public ceres::IterationCallback {
 public:
  Watch(const Batch& batch, double least_gain) : batch_(batch), least_cost_(0.5 * least_gain) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& step) override {
    if (batch_.failure) return ceres::SOLVER_ABORT;
    const double promised = step.cost_change / step.relative_decrease;
    return step.iteration > 0 && promised < least_cost_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const Batch& batch_;
  double least_cost_;
};

ceres::Solver::Options solver_options(const DescentOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = options.most_steps;
  solver.function_tolerance = kLeastDecrease;
  solver.parameter_tolerance = kLeastStepLength;
  solver.gradient_tolerance = 0.0;
  // A step that leaves the bounds is cut there. A line search along it would accept its small gain as a success, and
  // progress would stall.
  solver.max_num_line_search_step_size_iterations = 0;
  solver.min_trust_region_radius = 1e-8;
  // Levenberg's damping: with a radius of 1 it costs one standard deviation to move a parameter over its whole range.
  // Marquardt's damping would allow leaps along directions that the data hardly constrain.
  solver.jacobi_scaling = false;
  solver.min_lm_diagonal = solver.max_lm_diagonal = options.scale;
  solver.initial_trust_region_radius = options.radius;
  return solver;
}

}  // namespace

double objective(const Eigen::VectorXd& residuals, Loss loss) {
  const std::unique_ptr<ceres::LossFunction> function = loss_function(loss);
  if (!function) return residuals.squaredNorm();
  double sum = 0.0;
  for (const double residual : residuals) {
    std::array<double, 3> rho{};
    function->Evaluate(residual * residual, rho.data());
    sum += rho[0];
  }
  return sum;
}

Eigen::VectorXd loss_weights(const Eigen::VectorXd& residuals, Loss loss) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(residuals.size());
  const std::unique_ptr<ceres::LossFunction> function = loss_function(loss);
  for (Eigen::Index i = 0; function && i < residuals.size(); ++i) {
    std::array<double, 3> rho{};
    function->Evaluate(residuals[i] * residuals[i], rho.data());
    weights[i] = rho[1];
  }
  return weights;
}

Minimum descend(Residuals& residuals, const Linearisation& start, const DescentOptions& options) {
  if (static_cast<std::size_t>(start.at.size()) == options.held.size()) {  // nothing is left to move
    Minimum minimum{{start.at, residuals.at({start.at}).front(), start.jacobian}};
    minimum.objective = objective(minimum.where.residuals, options.loss);
    minimum.has_converged = std::isfinite(minimum.objective);
    return minimum;
  }
  // Silences Ceres, which would report every point without a value.
  [[maybe_unused]] static const int quiet = FLAGS_minloglevel = google::GLOG_FATAL;
  Batch batch(residuals, start);
  ceres::Problem::Options ownership;
  ownership.evaluation_callback = &batch;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  const std::unique_ptr<ceres::LossFunction> loss = loss_function(options.loss);
  std::vector<double*> blocks;
  for (double& coordinate : batch.coordinates) blocks.push_back(&coordinate);
  for (std::size_t i = 0; i < residuals.model().observation_count(); ++i) {
    problem.AddResidualBlock(new OneResidual(batch, static_cast<Eigen::Index>(i)), loss.get(), blocks);
  }
  for (std::size_t j = 0; j < blocks.size(); ++j) {
    problem.SetParameterLowerBound(blocks[j], 0, 0.0);
    problem.SetParameterUpperBound(blocks[j], 0, 1.0);
    if (std::ranges::count(options.held, j) > 0) problem.SetParameterBlockConstant(blocks[j]);
  }
  Watch watch(batch, options.least_gain * options.scale);
  ceres::Solver::Options solver = solver_options(options);
  solver.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (batch.failure) std::rethrow_exception(batch.failure);
  Minimum minimum;
  minimum.where = batch.known();
  minimum.radius = summary.iterations.empty() ? options.radius : summary.iterations.back().trust_region_radius;
  minimum.has_converged =
      summary.termination_type == ceres::CONVERGENCE || summary.termination_type == ceres::USER_SUCCESS;
  minimum.objective = summary.IsSolutionUsable() ? objective(minimum.where.residuals, options.loss)
                                                 : std::numeric_limits<double>::infinity();
  return minimum;
}

}  // namespace dolp::fit
