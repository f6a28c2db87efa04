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

void add_fit(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result);

void add_contours(ReportBuilder& report, const fit::Model& model, const fit::FitResult& result,
                  const std::optional<fit::Contours>& drawn);

void add_comparison(ReportBuilder& report, const std::vector<ComparedModel>& models);

}  // namespace dolp
