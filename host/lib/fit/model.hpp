// The values of the model at measured points, for many parameter sets at once.
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

/// Refuses a range that its key cannot have. Errors: InputError that begins with `origin` if the key is unknown or no
/// number, if low >= high, if the start lies outside of the range, or if the key does not allow one of these values.
void check_range(const FitRange& range, const std::string& origin);

/// The model's predictions of all measurements, in the order of the data.
struct Prediction {
  /// One row per measurement. The observable is in the first column, except DOLP: its row is the signed Q/I and U/I,
  /// and DOLP is the length of the row. With the bracket as model error, the row is the value between both ends that is
  /// nearest to the measured one, and 0.
  Eigen::MatrixX2d components;
  Eigen::VectorXd error;     ///< bound of the numerical error of the observable
  std::uint32_t status = 0;  ///< status bits of all points together
};

/// The model at the measurements of several data sets, as a function of the varied keys.
class Model {
 public:
  /// Errors: InputError in one line if scene, data and parameters do not fit together. Examples are more parameters
  /// than measurements, a key that varies twice, a data set that fixes a varied key, only some data sets with
  /// uncertainties, a model error without a bracket or without uncertainties, and an end of a range that the scene
  /// refuses.
  Model(const SceneValues& scene, std::vector<MeasuredData> data, std::vector<FitRange> parameters,
        ModelError error = ModelError::kNone);

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const std::vector<MeasuredData>& data() const { return data_; }
  const std::vector<FitRange>& parameters() const { return parameters_; }
  /// The scene of the first data set, with the start values of the parameters.
  const SceneValues& scene() const { return groups_.front().scene; }
  std::size_t observation_count() const { return count_; }
  bool has_model_error() const { return error_ != ModelError::kNone; }
  bool has_uncertainties() const { return data_.front().has_uncertainties; }

  /// The predictions for each set of values. Sets that differ only in n, k, sigma (or wind) and q are evaluated
  /// together, with all angles and wavelengths of a data set.
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& values, double tolerance,
                                  ModelEvaluator& evaluator, const Progress& progress) const;

  /// The settings that give the parameters these values.
  std::vector<Setting> settings(const Eigen::VectorXd& values) const;

 private:
  /// The scene of one data set.
  struct Group {
    const MeasuredData* data = nullptr;
    Eigen::Index first_row = 0;  ///< row of its first measurement in the predictions
    SceneValues scene;           ///< scene of the data set, at the shortest wavelength of its data if they have any
    std::optional<EmissionModel> other_end;  ///< emission model of the bracket's other end; empty without model error
    std::vector<double> wavelength_um;       ///< wavelengths of the data, ascending; empty if they have none
    std::vector<OpticalConstants> indices;   ///< n and k of a tabulated material at each wavelength
  };

  void check() const;
  bool varies(const std::string& key) const;
  Group group_of(const SceneValues& scene, const MeasuredData& data, Eigen::Index first_row) const;
  void check_group(const Group& group) const;
  /// Adds one entry for each measurement of a group.
  void add_points(std::vector<SceneEntry>& points, const Group& group, const SceneValues& scene) const;
  /// The scene of a data set, with the settings of the data, `own` and the parameters. Errors: InputError that tells
  /// which of these settings is refused.
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
