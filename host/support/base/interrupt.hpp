#pragma once

namespace dolp {

/// After this call the first SIGINT, SIGTERM or SIGHUP only makes interrupted() true and interrupts waiting calls. The
/// second one ends the process. Ignored signals, as with nohup, stay ignored.
void watch_for_interrupts();

bool interrupted();

}  // namespace dolp
