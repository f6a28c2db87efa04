// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dolp {

/// Refuses an output path of any suffix, before anything is computed for it; "-" is standard output.
///
/// Errors: IoError when it is a folder or a file that is read-only, or its folder is missing or cannot be written to.
void check_writable(const std::filesystem::path& path);

/// Writes text or bytes to a temporary file in the folder of `path`, syncs it and renames it to `path`; to standard
/// output for "-", and straight into a device or pipe. Until it is whole the file has no name where the file system
/// allows that; else it is .dolp-*.tmp, and what processes that died left of these is cleared away.
///
/// A symbolic link stays, what it points to is replaced; an existing file keeps its permissions.
/// Errors: IoError, Cancelled when interrupted(); the temporary file is removed and `path` is as it was.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace dolp
