#include "report/report.hpp"

#include <cstdio>

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

void Report::print(bool json, bool quiet, const std::string& output) const {
  std::FILE* const out = output == "-" ? stderr : stdout;
  if (json) {
    fmt::print(out, "{}\n", json_text());
  } else if (!quiet) {
    fmt::print(out, "{}", text_);
  }
}

}  // namespace dolp
