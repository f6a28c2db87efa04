#pragma once

namespace dolp {

/// After this call, the first SIGINT, SIGTERM or SIGHUP makes interrupted() true and ends waiting system calls. A
/// second signal ends the process. Signals that the process ignores (for example under nohup) stay ignored.
void watch_for_interrupts();

bool interrupted();

}  // namespace dolp
