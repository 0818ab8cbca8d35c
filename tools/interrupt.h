#pragma once

namespace reradiant {

constexpr int exit_interrupted = 130;

/// From here on SIGINT and SIGTERM no longer end the program: work that can stop asks
/// interrupt_requested() between its steps and keeps what it has.
void catch_interrupts();
bool interrupt_requested();

} // namespace reradiant
