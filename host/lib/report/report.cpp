#include "report/report.hpp"

namespace dolp {

void ReportBuilder::show(const ReportBuilder& part) {
  text_ += part.text_;
  rows_.insert(rows_.end(), part.rows_.begin(), part.rows_.end());
}

void ReportBuilder::add(const char* path, const ReportBuilder& part) {
  show(part);
  value(path, part.json_);
}

void ReportBuilder::add(const char* path, const std::vector<ReportBuilder>& parts) {
  Json list = Json::array();
  for (const ReportBuilder& part : parts) {
    show(part);
    list.push_back(part.json_);
  }
  value(path, list);
}

}  // namespace dolp
