#include "report/report.hpp"

namespace dolp {

void Report::add(const char* path, const Report& part) {
  text_ += part.text_;
  value(path, part.json_);
}

void Report::add(const char* path, const std::vector<Report>& parts) {
  Json list = Json::array();
  for (const Report& part : parts) {
    text_ += part.text_;
    list.push_back(part.json_);
  }
  value(path, list);
}

}  // namespace dolp
