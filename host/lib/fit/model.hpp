#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <string>
#include <vector>

#include <dolp/fit.hpp>
#include "model/evaluator.hpp"
#include "scene/scene.hpp"

namespace dolp::fit {

/// Errors: InputError that begins with `origin` if the scene does not allow the key, the limits or the start.
void check_range(const FitRange& range, const std::string& origin);

struct Prediction {
  /// One row per measurement. The row contains the predicted observable and 0. For DOLP, the row contains Q/I and U/I,
  /// so that DOLP is its length. With ModelError::kBracket, the model predicts a range for each observable, the
  /// bracket. Then the row contains the value in the bracket that is nearest to the measured value, and 0.
  Eigen::MatrixX2d components;
  Eigen::VectorXd values;    ///< the predicted observables; for DOLP the lengths of the rows of `components`
  Eigen::VectorXd error;     ///< bound of the numerical error of each predicted observable
  std::uint32_t status = 0;  ///< status bits of all points, combined by OR
  /// With ModelError::kBracket, one row per measurement: the value with the scene's own emission model, then both ends
  /// of the bracket, the lower one first.
  Eigen::MatrixX3d bracket;
};

/// The model at the measurements of all data sets, as a function of the parameters (the keys that the fit varies).
class Model {
 public:
  /// Errors: InputError if scene, data and parameters do not fit together, for example if a parameter occurs twice.
  Model(const SceneValues& scene, std::vector<MeasuredData> data, std::vector<FitRange> parameters,
        ModelError error = ModelError::kNone);

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const std::vector<MeasuredData>& data() const { return data_; }
  const std::vector<FitRange>& parameters() const { return parameters_; }
  /// The scene of the first data set, in which the parameters have their start values.
  const SceneValues& scene() const { return groups_.front().scene; }
  std::size_t observation_count() const { return count_; }
  bool has_model_error() const { return error_ != ModelError::kNone; }
  bool has_uncertainties() const { return data_.front().has_uncertainties; }

  /// The prediction for each of several sets of parameter values. Sets that differ only in n, k, sigma (or wind speed)
  /// and q take one call of the evaluator per data set.
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& values, double tolerance,
                                  ModelEvaluator& evaluator, const Progress& progress) const;

  /// The values of the parameters at a point, whose coordinates go from 0 to 1 over the range of each parameter.
  Eigen::VectorXd values(const Eigen::VectorXd& point) const;
  std::vector<Setting> settings(const Eigen::VectorXd& values) const;

 private:
  struct Group {
    const MeasuredData* data = nullptr;
    Eigen::Index first_row = 0;              ///< row of the first measurement of the data set in Prediction::components
    SceneValues scene;                       ///< scene of the data set; wavelengths in the data replace its wavelength
    std::optional<EmissionModel> other_end;  ///< with a model error: emission model of the bracket's other end
    std::vector<double> wavelength_um;       ///< wavelengths in the data, ascending; empty if the data have none
    std::vector<OpticalConstants> indices;   ///< n and k at these wavelengths, if the material is tabulated
  };

  void check() const;
  bool varies(const std::string& key) const;
  Group make_group(const SceneValues& scene, const MeasuredData& data, Eigen::Index first_row) const;
  void check_group(const Group& group) const;
  void add_points(std::vector<SceneEntry>& points, const Group& group, const SceneValues& scene) const;
  /// The scene with settings of the data, `extra` settings and parameters. Errors: InputError that names the setting.
  SceneValues data_scene(const SceneValues& scene, const MeasuredData& data, const std::vector<Setting>& extra,
                         const Eigen::VectorXd& values) const;
  SceneValues with(const SceneValues& scene, const Eigen::VectorXd& values) const;

  std::vector<MeasuredData> data_;
  std::vector<FitRange> parameters_;
  ModelError error_;
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

}  // namespace dolp::fit
