// A sky between two brightness temperatures, and the files that scenes name for such skies.
#pragma once

#include <dolp/dolp.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "base/temporary_folder.hpp"

namespace dolp::explore {

/// A sky whose brightness temperature is a straight line in zenith.
struct SkyPair {
  double zenith_K = 220.0;
  double horizon_K = 285.0;

  /// The file of it that surroundings.profile names: two rows.
  std::string csv() const;
  friend bool operator==(const SkyPair&, const SkyPair&) = default;
};

/// The sky of such a file; none of any other, and where it cannot be read.
std::optional<SkyPair> read_sky_pair(const std::filesystem::path& file);

/// The file that a scene names as its sky; empty for a built-in sky and without one.
std::filesystem::path sky_file(const Scene& scene);

/// Files of skies that are edited, in a folder that is removed at the end: a scene names a sky by its file.
class SkyFiles {
 public:
  /// The path of a sky's file; the scene refuses it where no file can be made.
  std::string path(const SkyPair& sky);
  bool hold(const std::filesystem::path& file) const { return folder_ && file.parent_path() == folder_->path(); }

 private:
  std::optional<TemporaryFolder> folder_;
};

}  // namespace dolp::explore
