#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.hpp"

namespace dolp {

inline constexpr double kMebibyte = 1048576.0;
inline constexpr double kPoints = 100.0;  ///< converts DOLP to percentage points
inline constexpr double kPercent = 100.0;

/// A value, and its path in the JSON: keys separated by slashes.
template <class T>
struct Keyed {
  const char* path;
  const T& value;
};

template <class T>
Keyed<T> key(const char* path, const T& value) {
  return {path, value};
}

/// Builds a report as text and JSON. Of the arguments of a line, only those made by key() go into the JSON.
class ReportBuilder {
 public:
  using Json = nlohmann::ordered_json;

  explicit ReportBuilder(int label_width = 10) : label_width_(label_width) {}

  template <class... Args>
  void line(fmt::format_string<const Args&...> text, const Args&... args) {
    text_ += printable_line(fmt::format(text, args...)) + '\n';
    (record(args), ...);
  }

  template <class... Args>
  void row(std::string_view label, fmt::format_string<const Args&...> text, const Args&... args) {
    row_if(true, label, text, args...);
  }

  /// Adds a row to the text if `is_shown`. Adds its Keyed arguments to the JSON in any case.
  template <class... Args>
  void row_if(bool is_shown, std::string_view label, fmt::format_string<const Args&...> text, const Args&... args) {
    if (is_shown) {
      rows_.emplace_back(label, printable_line(fmt::format(text, args...)));
      text_ += fmt::format("  {:<{}} {}\n", label, label_width_, rows_.back().second);
    }
    (record(args), ...);
  }

  /// Adds a value to the JSON but not to the text. NaN, infinity and missing values become null.
  template <class T>
  void value(const char* path, const T& value) {
    json_[Json::json_pointer(std::string("/") + path)] = value;
  }
  template <class T>
  void value(const char* path, const std::optional<T>& optional) {
    optional ? value(path, *optional) : value(path, nullptr);
  }

  void values(const Json& object) { json_.update(object); }

  void show(const ReportBuilder& part) {
    text_ += part.text_;
    rows_.insert(rows_.end(), part.rows_.begin(), part.rows_.end());
  }

  void add(const char* path, const ReportBuilder& part) {
    show(part);
    value(path, part.json_);
  }

  /// Adds the lines of several reports. Adds an array of their JSON under `path`, even if it is empty.
  void add(const char* path, const std::vector<ReportBuilder>& parts) {
    Json list = Json::array();
    for (const ReportBuilder& part : parts) {
      show(part);
      list.push_back(part.json_);
    }
    value(path, list);
  }

  const Json& json() const { return json_; }
  /// The JSON in ASCII, which any terminal can show. Bytes of file names that are not UTF-8 are replaced.
  std::string json_text() const { return json_.dump(2, ' ', true, Json::error_handler_t::replace); }
  const std::string& text() const { return text_; }
  const std::vector<std::pair<std::string, std::string>>& rows() const { return rows_; }

 private:
  template <class T>
  void record(const Keyed<T>& keyed) {
    value(keyed.path, keyed.value);
  }
  template <class T>
  void record(const T&) {}

  int label_width_;
  std::string text_;
  std::vector<std::pair<std::string, std::string>> rows_;
  Json json_ = Json::object();
};

}  // namespace dolp

template <class T>
struct fmt::formatter<dolp::Keyed<T>> : fmt::formatter<T> {
  template <class Context>
  auto format(const dolp::Keyed<T>& keyed, Context& context) const {
    return fmt::formatter<T>::format(keyed.value, context);
  }
};
