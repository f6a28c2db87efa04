// A scene, synthetic measured data of the scene, and fits to these data, for tests.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "fit/fit.hpp"
#include "fit/residuals.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::fit {

inline const std::string kScene = R"([surface]
n = 1.6
k = 0.5
sigma = 0.2
q = 3
masking = "smith"
[emission]
temperature_K = 300
[surroundings]
temperature_K = 200
[spectrum]
wavelength_um = 10
)";

inline constexpr double kNoise = 0.002;

/// Few descents, which suffice where chi^2 has one minimum.
inline const FitOptions kFewStarts{.vary = {}, .starts = 4};

inline FitRange number(const std::string& key, double low, double high) { return {key, low, high, {}}; }

/// Fits to synthetic data: Q/I of the scene at zeniths up to 80 degrees, with random errors (standard deviation
/// `noise`).
class FitTest : public testing::Test {
 protected:
  MeasuredData measured(double noise, const std::vector<std::string>& overrides = {}, bool has_uncertainties = true,
                        int points = 20, std::uint64_t seed = 7) {
    MeasuredData data;
    data.name = "synthetic";
    data.zenith_column = "theta_deg";
    data.has_uncertainties = has_uncertainties;
    for (int i = 0; i < points; ++i) {
      data.measurements.push_back({.observable = Observable::kQOverI, .theta_deg = 80.0 * (i + 1) / points});
      if (has_uncertainties) data.measurements.back().uncertainty = kNoise;
    }
    const Model model(parse_scene(kScene, "scene", settings_from_text(overrides)), {data},
                      {number("surface.n", 1.6, 2.0)});
    const Eigen::VectorXd truth = Eigen::VectorXd::Constant(1, 1.6);
    const Prediction exact = model.predict({truth}, 1e-8, evaluator_, {}).front();
    std::mt19937_64 engine(seed);
    for (std::size_t i = 0; i < data.measurements.size(); ++i) {
      double deviate = -6.0;  // The sum of twelve uniform numbers, less 6, is nearly normal.
      for (int j = 0; j < 12; ++j) deviate += static_cast<double>(engine() >> 11U) * 0x1p-53;
      data.measurements[i].value = exact.components(static_cast<Eigen::Index>(i), 0) + noise * deviate;
    }
    return data;
  }
  FitResult fitted(const MeasuredData& data, const std::vector<FitRange>& parameters,
                   const FitOptions& options = kFewStarts, const std::vector<std::string>& overrides = {}) {
    const Model model(parse_scene(kScene, "scene", settings_from_text(overrides)), {data}, parameters);
    const std::optional<FitResult> result = fit::fit(model, evaluator_, options);
    EXPECT_TRUE(result.has_value());
    return result.value_or(FitResult{});
  }

  CpuEvaluator evaluator_;
};

inline bool contains(const FitInterval& one, double value) {
  return !one.is_empty && (!one.low || *one.low <= value) && (!one.high || value <= *one.high);
}

}  // namespace dolp::fit
