// The model at measured points, for many parameter sets at once.
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

/// Refuses a range that the scene's key does not have. Errors: InputError that begins with `origin`: an unknown key or
/// one that is no number, low >= high, a start outside of them, values out of the key's range.
void check_range(const FitRange& range, const std::string& origin);

/// The model's predictions of all observations, in their order.
struct Prediction {
  /// The observable in the first column; for DOLP the signed Q/I and U/I, whose length it is. With the model error of
  /// the bracket: the value between both ends that is nearest to the measured one, and 0.
  Eigen::MatrixX2d components;
  Eigen::VectorXd error;     ///< bound of the numerical error of the observable
  std::uint32_t status = 0;  ///< bits of any point
};

/// The scene at the observations of several data sets, as a function of the varied keys.
class Model {
 public:
  /// Errors: InputError, one line, where scene, data and parameters do not fit together: more parameters than
  /// observations, a key twice, a data set that fixes a varied key, data with and without uncertainties, a model error
  /// without a bracket or without uncertainties, a value at an end of a range that the scene refuses.
  Model(const SceneValues& scene, std::vector<MeasuredData> data, std::vector<FitRange> parameters,
        ModelError error = ModelError::kNone);

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const std::vector<MeasuredData>& data() const { return data_; }
  const std::vector<FitRange>& parameters() const { return parameters_; }
  /// The scene of the first data set at the start of the parameters.
  const SceneValues& scene() const { return groups_.front().scene; }
  std::size_t observation_count() const { return count_; }
  bool has_model_error() const { return error_ != ModelError::kNone; }
  bool has_uncertainties() const { return data_.front().has_uncertainties; }

  /// Predictions for each set of values. Sets that differ in nothing but n, k, sigma and q are evaluated together, with
  /// all angles and wavelengths of a data set.
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& values, double tolerance,
                                  ModelEvaluator& evaluator, const Progress& progress) const;

  /// Each parameter of the scene with its value.
  std::vector<Setting> settings(const Eigen::VectorXd& values) const;

 private:
  /// The scene of one data set.
  struct Group {
    const MeasuredData* data = nullptr;
    Eigen::Index first_row = 0;              ///< its first row in the predictions
    SceneValues scene;                       ///< at the shortest wavelength of the data, if these have any
    std::optional<EmissionModel> other_end;  ///< emission model at the other end of the bracket
    std::vector<double> wavelength_um;       ///< wavelengths of the data, ascending; empty: the scene's
    std::vector<OpticalConstants> indices;   ///< n and k of a tabulated material at each of them
  };

  void check() const;
  bool varies(const std::string& key) const;
  Group group_of(const SceneValues& scene, const MeasuredData& data, Eigen::Index first_row) const;
  void check_group(const Group& group) const;
  /// Adds the points of a group's measurements.
  void add_points(std::vector<SceneEntry>& points, const Group& group, const SceneValues& scene) const;
  /// The scene of some data. Errors: InputError that says whose setting is refused.
  SceneValues scene_of(const SceneValues& scene, const MeasuredData& data, const std::vector<Setting>& extra,
                       const Eigen::VectorXd& values) const;
  SceneValues with(const SceneValues& scene, const Eigen::VectorXd& values) const;
  void predict_group(const Group& group, const std::vector<Eigen::VectorXd>& values, double tolerance,
                     ModelEvaluator& evaluator, const Progress& progress, std::vector<Prediction>& predictions) const;

  std::vector<MeasuredData> data_;
  std::vector<FitRange> parameters_;
  ModelError error_;
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

}  // namespace dolp::fit
