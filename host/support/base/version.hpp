// Version and commit of the program.
#pragma once

namespace dolp {

/// "0.2.0".
const char* program_version();

/// The commit that it was built from, with "-changed" where files differ from it; "unknown" outside of a repository.
const char* program_commit();

}  // namespace dolp
