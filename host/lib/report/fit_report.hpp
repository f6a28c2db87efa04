#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fit/fit.hpp"
#include "report/report.hpp"

namespace dolp {

struct ComparedModel {
  std::vector<Setting> settings;         ///< settings by which this model differs from the others
  SceneValues scene;                     ///< scene with these settings
  std::unique_ptr<fit::Model> model;     ///< null if the scene refuses the settings
  std::optional<fit::FitResult> result;  ///< empty if no minimum was found
  std::string refusal;                   ///< why the scene refuses the settings; empty if it accepts them
};

/// `fitted` has a result.
void add_fit(ReportBuilder& report, const ComparedModel& fitted);
void add_contours(ReportBuilder& report, const ComparedModel& fitted, const std::optional<fit::Contours>& drawn);

void add_comparison(ReportBuilder& report, const std::vector<ComparedModel>& models);

}  // namespace dolp
