#pragma once

#include <string>
#include <vector>

#include "fit/fit.hpp"
#include "report/report.hpp"

namespace dolp {

struct ComparedModel {
  std::vector<Setting> settings;         ///< settings that distinguish the model from the others
  std::optional<fit::FitResult> result;  ///< empty if no minimum was found
  std::string refusal;                   ///< why the scene refuses these settings; empty if it accepts them
};

/// Adds the minimum, the parameters, correlations, degeneracies, other minima, and the list of the measurements.
void add_fit(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result);

/// Adds the growth of the objective around the minimum, or the reason why it is not drawn.
void add_contours(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result,
                  const std::optional<fit::Contours>& drawn);

/// Adds the table of compared models, the best first.
void add_comparison(ReportBuilder& report, const std::vector<ComparedModel>& models);

}  // namespace dolp
