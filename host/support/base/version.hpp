#pragma once

namespace dolp {

const char* program_version();  ///< for example "0.2.0"

/// The commit of the build, with "-changed" if files differ from it; "unknown" outside a repository.
const char* program_commit();

}  // namespace dolp
