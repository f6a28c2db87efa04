// The sky of a scene: one temperature, a built-in sky, two temperatures, or a file.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "explore/session.hpp"
#include "explore/window/fields.hpp"
#include "explore/window/plot.hpp"

namespace dolp::explore {

class SkyEditor {
 public:
  /// Draws the list of skies and, of a sky between two temperatures, both. `areas` gets "sky", and "sky zenith",
  /// "field sky zenith" and those of the horizon.
  void draw(Session& session, std::map<std::string, Area>& areas);

 private:
  void draw_list(Session& session, std::map<std::string, Area>& areas);
  void draw_temperature(Session& session, const std::string& name, double SkyPair::*part,
                        std::map<std::string, Area>& areas);

  NumberFields fields_;
  std::string file_;  ///< of which pair_ is known
  std::optional<SkyPair> pair_;
};

}  // namespace dolp::explore
