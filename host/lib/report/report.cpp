#include "report/report.hpp"

namespace dolp {

void ReportBuilder::add(const char* path, const ReportBuilder& part) {
  text_ += part.text_;
  value(path, part.json_);
}

void ReportBuilder::add(const char* path, const std::vector<ReportBuilder>& parts) {
  Json list = Json::array();
  for (const ReportBuilder& part : parts) {
    text_ += part.text_;
    list.push_back(part.json_);
  }
  value(path, list);
}

}  // namespace dolp
