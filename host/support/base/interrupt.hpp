// Ctrl-C and similar signals set a flag instead of ending the process.
#pragma once

namespace dolp {

/// From here on SIGINT, SIGTERM and SIGHUP only make interrupted() true, and interrupt waiting calls. Signals that
/// are ignored, as by nohup, stay ignored.
void watch_for_interrupts();

bool interrupted();

}  // namespace dolp
