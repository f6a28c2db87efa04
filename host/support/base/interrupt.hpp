// Ctrl-C and its like as a question instead of an end.
#pragma once

namespace dolp {

/// From here on SIGINT, SIGTERM and SIGHUP only make interrupted() true, and break off a call that waits. Those that
/// are ignored, as by nohup, stay so.
void watch_for_interrupts();

bool interrupted();

}  // namespace dolp
