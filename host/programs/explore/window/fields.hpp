// Fields for numbers that are typed.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace dolp::explore {

/// Fields that lose nothing of what is typed: Enter, Tab, a click elsewhere and the loss of the window's focus take it;
/// what is refused stays in its field, marked, until it is mended or Escape takes it back.
class NumberFields {
 public:
  /// Takes a text; returns why it is refused, in one line, or nothing.
  using Take = std::function<std::string(const std::string& text)>;

  /// Draws a field at ImGui's cursor, with `value` or with what is typed there.
  void draw(const std::string& key, double value, const Take& take);
  /// The text typed in a field that was not taken; empty: none.
  std::string text(const std::string& key) const;
  /// Why it was refused; empty where it was not.
  std::string reason(const std::string& key) const;

 private:
  struct Typed {
    std::string text;
    double value = 0.0;  ///< that the field had
    bool is_active = true;
    std::string reason = {};
  };
  std::map<std::string, Typed> typed_;
};

/// A field for the name of the last item, which a right click opens. Returns what has been typed in this frame.
std::optional<std::string> typed_name(std::string name, const std::string& hint = {});

}  // namespace dolp::explore
