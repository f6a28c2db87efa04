#pragma once

#include <string>
#include <vector>

#include "fit/fit.hpp"
#include "report/report.hpp"

namespace dolp {

struct ComparedModel {
  std::vector<Setting> settings;         ///< settings by which this model differs from the others
  std::optional<fit::FitResult> result;  ///< empty if no minimum was found
  std::string refusal;                   ///< why the scene refuses `settings`; empty if it accepts them
};

/// Adds the minimum, parameters, correlations, degeneracies, other minima, and the measurements with their residuals.
void add_fit(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result);

/// Adds the growth of the objective around the minimum, or the reason why there are no contours.
void add_contours(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result,
                  const std::optional<fit::Contours>& drawn);

/// Adds a table of the compared models, the best model first.
void add_comparison(ReportBuilder& report, const std::vector<ComparedModel>& models);

}  // namespace dolp
