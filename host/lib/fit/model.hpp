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

/// Errors: InputError that begins with `origin` if the key is unknown or no number, if low >= high, if the start lies
/// outside of the range, or if the key does not allow one of these values.
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
  /// Errors: InputError in one line if scene, data and parameters do not fit together, for example if a key varies
  /// twice, if only some data sets have uncertainties, or if the scene refuses an end of a range.
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

  std::vector<Setting> settings(const Eigen::VectorXd& values) const;

 private:
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
  void add_points(std::vector<SceneEntry>& points, const Group& group, const SceneValues& scene) const;
  /// The scene with settings of the data, `extra` and the parameters. Errors: InputError that names a refused setting.
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
