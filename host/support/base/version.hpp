#pragma once

namespace dolp {

const char* program_version();  ///< for example "0.2.0"

/// The Git commit of the sources, with "-changed" if a file differs from this commit; "unknown" without a repository.
const char* program_commit();

}  // namespace dolp
