#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// `count` values of an axis in equal (linear or logarithmic) steps. Both ends are included.
struct AxisRange {
  double from = 0.0;
  double to = 0.0;
  std::size_t count = 1;
  bool is_logarithmic = false;
  friend bool operator==(const AxisRange&, const AxisRange&) = default;
};

/// A value in the syntax of a scene file, for example 0.2, [0.1, 0.2] or { from = 0, to = 60, count = 7 }. Text that is
/// not valid TOML is a word, for example smith.
struct TomlText {
  std::string text;
  friend bool operator==(const TomlText&, const TomlText&) = default;
};

/// The value of a key, or no value. A setting without a value removes its key from the scene. If the key is the name of
/// a TOML table, such as "surroundings", the setting removes the whole table.
class DOLP_EXPORT Value {
 public:
  using Content = std::variant<std::monostate, bool, double, std::string, std::vector<double>, AxisRange, TomlText>;

  // NOLINTBEGIN(google-explicit-constructor): numbers, texts and lists convert to a Value implicitly
  Value() = default;
  template <class Number>
  requires std::is_arithmetic_v<Number> Value(Number number) {
    if constexpr (std::same_as<Number, bool>) {
      content_ = number;
    } else {
      content_ = static_cast<double>(number);
    }
  }
  Value(const char* text) : content_(std::string(text)) {}
  Value(std::string text) : content_(std::move(text)) {}
  Value(std::vector<double> numbers) : content_(std::move(numbers)) {}
  Value(std::initializer_list<double> numbers) : content_(std::vector<double>(numbers)) {}
  Value(const AxisRange& range) : content_(range) {}
  Value(TomlText text) : content_(std::move(text)) {}
  // NOLINTEND(google-explicit-constructor)

  const Content& content() const { return content_; }
  /// The value in the syntax of a scene file; "none" if there is no value.
  std::string text() const;

  friend bool operator==(const Value&, const Value&) = default;

 private:
  Content content_;
};

/// A dotted key of a scene ("surface.sigma") and its value. If the scene lacks the TOML table of the key, the setting
/// adds the table. A setting also removes the keys that a scene cannot have together with its key (see Key::rivals).
/// For example, a setting of surface.n removes surface.material.
struct DOLP_EXPORT Setting {
  std::string key;
  Value value;
  std::string origin = {};  ///< beginning of error messages; if empty, messages begin with the key and the value

  /// Reads "KEY=VALUE". VALUE has the syntax of TomlText. `option` is the command-line option to which the argument
  /// belongs; error messages begin with it. Errors: InputError if `argument` has another form.
  static Setting from_text(const std::string& argument, const std::string& option = {});

  std::string text() const;  ///< "KEY=VALUE"

  friend bool operator==(const Setting& a, const Setting& b) { return a.key == b.key && a.value == b.value; }
};

DOLP_EXPORT std::vector<Setting> settings_from_text(const std::vector<std::string>& arguments,
                                                    const std::string& option = {});

}  // namespace dolp
