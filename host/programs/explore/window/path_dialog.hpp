// A dialog that asks for the path of a file.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "explore/window/plot.hpp"

namespace dolp::explore {

class PathDialog {
 public:
  struct Request {
    std::string title;
    std::string path;                   ///< to begin with
    std::vector<std::string> suffixes;  ///< of the files in the list
    bool must_exist = false;
    std::function<void(const std::string& path)> accept;
  };

  void open(Request request);
  /// Draws it where it is open: a field for the name and a list of the folder; between ImGui's NewFrame and Render.
  void draw();
  /// The last drawn areas of the list's entries by their name; folders end with a slash.
  const std::map<std::string, Area>& areas() const { return areas_; }

 private:
  void enter(const std::filesystem::path& folder);
  /// True where a file that was chosen before is chosen again.
  bool draw_list();
  /// The file whose name is typed, in the folder unless the name has one of its own.
  std::filesystem::path path() const { return folder_ / name_; }

  Request request_;
  bool is_opening_ = false;
  bool wants_focus_ = false;
  std::filesystem::path folder_;     ///< empty: the current one
  std::vector<std::string> listed_;  ///< folders, then files
  std::string name_;
  std::map<std::string, Area> areas_;
};

}  // namespace dolp::explore
