// The model at measured points, for many parameter sets at once.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "fit/fit_data.hpp"
#include "fit/parameter.hpp"
#include "model/evaluator.hpp"
#include "scene/scene.hpp"

namespace dolp::fit {

/// A scene before it is read.
struct SceneText {
  std::string text;
  std::string path_name;
  std::vector<std::string> overrides;  ///< KEY=VALUE
};

/// What the model says to all observations, in their order.
struct Prediction {
  /// The observable in the first column; of DOLP the signed Q/I and U/I, whose length it is.
  Eigen::MatrixX2d components;
  Eigen::VectorXd error;     ///< bound of the numerical error of the observable
  std::uint32_t status = 0;  ///< bits of any point
};

/// The scene at the observations of several data sets, as a function of the varied keys.
class Model {
 public:
  /// Errors: InputError, one line, where scene, data and parameters do not fit together: more parameters than
  /// observations, a key twice, a data set that fixes a varied key, data with and without uncertainties, what
  /// parse_scene refuses at either end of the ranges.
  Model(const SceneText& scene, std::vector<FitData> data, std::vector<Parameter> parameters);

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const std::vector<FitData>& data() const { return data_; }
  const std::vector<Parameter>& parameters() const { return parameters_; }
  /// The scene of the first data set at the start of the parameters.
  const Scene& scene() const { return groups_.front().scene; }
  std::size_t observation_count() const { return count_; }
  bool has_uncertainties() const { return data_.front().has_uncertainties; }

  /// Predictions for each set of values, in one call of the evaluator for each group of observations that differ in
  /// angle alone, as long as the sets differ in n, k, sigma and q alone.
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& values, double tolerance,
                                  MomentsEvaluator& evaluator, const Progress& progress) const;

  /// KEY=VALUE of each parameter.
  std::vector<std::string> overrides(const Eigen::VectorXd& values) const;

 private:
  /// Observations of one data set at one wavelength.
  struct Group {
    Scene scene;
    std::vector<const Observation*> observations;
    std::vector<Eigen::Index> rows;  ///< of the predictions
  };

  void check() const;
  void add_groups(const SceneText& scene, const FitData& data, Eigen::Index first_row);
  Scene parse(const SceneText& scene, const FitData& data, const std::vector<std::string>& own,
              const Eigen::VectorXd& values) const;
  Scene with(const Scene& scene, const Eigen::VectorXd& values) const;
  void predict_group(const Group& group, const std::vector<Eigen::VectorXd>& values, double tolerance,
                     MomentsEvaluator& evaluator, const Progress& progress, std::vector<Prediction>& predictions) const;

  std::vector<FitData> data_;
  std::vector<Parameter> parameters_;
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

}  // namespace dolp::fit
