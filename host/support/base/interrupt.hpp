#pragma once

namespace dolp {

/// After this call the first SIGINT, SIGTERM or SIGHUP only makes interrupted() true and ends waiting system calls. The
/// second signal ends the process. Signals that the process ignores already (nohup, for example) stay ignored.
void watch_for_interrupts();

bool interrupted();

}  // namespace dolp
