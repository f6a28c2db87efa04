#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "explore/scale.hpp"
#include "explore/window/input.hpp"

namespace dolp::explore {

/// Text fields for numbers. A field applies its text after Enter, Tab, a click elsewhere, or when the window loses the
/// focus. A refused text stays in the field, in red, until the user corrects it or presses Escape.
class NumberFields {
 public:
  /// Applies a text. Returns one line with the reason if the text is refused, otherwise "".
  using Apply = std::function<std::string(const std::string& text)>;
  using ApplyEnds = std::function<std::string(const std::string& low, const std::string& high)>;

  /// Draws a field with `value`, or with the text that the user types. Tests find it by the name "field " + `id`.
  void draw(const std::string& id, double value, const Apply& apply);
  /// Draws the field for one end of a range. `end` is 0 or 1; the ID of the field is `id` with " 0" or " 1". `apply`
  /// gets the texts of both ends, because one new end may be allowed only together with the other.
  void draw_end(const std::string& id, std::size_t end, const std::array<double, 2>& ends, const ApplyEnds& apply);
  std::string text(const std::string& id) const {  // text that is typed but not applied; "" if none
    const auto typed = typed_.find(id);
    return typed == typed_.end() ? "" : typed->second.text;
  }
  std::string reason(const std::string& id) const {  // why the typed text was refused; "" if it was not
    const auto typed = typed_.find(id);
    return typed == typed_.end() ? "" : typed->second.reason;
  }
  void draw_reason(const std::string& id) const;  ///< draws reason(id) below the fields

 private:
  struct Typed {
    std::string text;
    double value = 0.0;  ///< the field's value when typing began
    bool is_active = true;
    std::string reason = {};
  };
  std::map<std::string, Typed> typed_;
};

struct ListEntry {
  std::string text;
  std::string note = {};
  bool is_enabled = true;
  std::string group = {};  ///< heading above the first of the consecutive entries of a group
};

struct List {
  std::string id;  ///< tests find the list by this name, and an entry by this name, a blank and the entry's text
  float width;
  std::string current;  ///< text of the closed list
  std::string note;     ///< tooltip of the closed list
  std::optional<std::size_t> chosen;
  std::vector<ListEntry> entries;
};

/// Draws a list that opens on a click. With `search`, the open list has a search field, which has the text `*search`.
/// Returns the index of the entry that the user clicks, unless this index is List::chosen.
std::optional<std::size_t> draw_list(const List& list, std::string* search = nullptr);

void row_label(const std::string& text);  ///< draws a label; the next control that is drawn stands beside it

/// After a right click on the last item, draws a field with the item's name. Returns the name if the user changes it.
std::optional<std::string> typed_name(std::string name, const std::string& hint = {});

/// A small window in which the user types the range of an axis. A double click on the numbers of the axis opens it.
class AxisEditor {
 public:
  struct Change {
    std::optional<Scale> range;  ///< typed range; empty: an automatic one
    bool is_log = false;
  };
  /// Returns why a range is refused, or "". A Check may be empty.
  using Check = std::function<std::string(const Scale& range)>;

  /// Draws the small window if the user opened it for the axis `label`. `numbers` is the area of the axis's numbers.
  std::optional<Change> draw(const std::string& label, const Area& numbers, const Scale& now, const Check& check = {});

  bool is_open() const { return !shown_.empty(); }

 private:
  std::optional<Change> draw_content(const Scale& now, const Check& check);

  NumberFields fields_;
  std::string shown_;  ///< label of the axis; empty if the window is closed
  bool is_opening_ = false;
};

class PathDialog {
 public:
  struct Format {
    std::string text;    ///< shown if there are several formats
    std::string ending;  ///< end of the suggested name, with the suffix
    std::function<void(const std::string& path)> accept;
  };
  struct Request {
    std::string title;
    std::string path;                   ///< suggested
    std::vector<std::string> suffixes;  ///< suffixes of the files in the list
    std::vector<Format> formats;        ///< one, or several to choose from
    std::size_t format = 0;             ///< the chosen format
    bool must_exist = false;            ///< true: the dialog opens a file, otherwise it saves one
  };

  void open(Request request);
  void draw();

 private:
  void enter(const std::filesystem::path& folder);
  void draw_formats();
  bool draw_list();  ///< draws the list; true if the user clicks again on the chosen file
  std::filesystem::path path() const { return folder_ / name_; }

  Request request_;
  bool is_opening_ = false;
  bool wants_focus_ = false;
  std::filesystem::path folder_;     ///< folder on display; empty: the working folder
  std::vector<std::string> listed_;  ///< names in this folder: first the folders, then the files
  std::string name_;
};

}  // namespace dolp::explore
