// Version and commit of the program.
#pragma once

namespace dolp {

/// "0.2.0".
const char* program_version();

/// The commit from which the program was built, with "-changed" if files differ from it; "unknown" outside a
/// repository.
const char* program_commit();

}  // namespace dolp
