#pragma once

#include "reradiant/interruption.h"

namespace reradiant {

constexpr int exit_interrupted = 130;

/// From here on SIGINT and SIGTERM end the program at once with exit_interrupted, until
/// catch_interrupts() is called: while kernels are built, which takes long and asks nobody, there
/// is nothing to keep.
void end_at_interrupts();
/// From here on the first SIGINT or SIGTERM does not end the program: work that can stop asks
/// interrupt_requested() between its steps and keeps what it has. The second one does.
void catch_interrupts();
bool interrupt_requested();
/// Returns a flag that is set once interrupt_requested() is true, for work that watches a flag.
StopFlag interrupt_flag();

} // namespace reradiant
