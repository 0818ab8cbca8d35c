#include "tools/interrupt.h"

#include <csignal>

namespace reradiant {

namespace {

volatile std::sig_atomic_t requested = 0;

void note_interrupt(int signal) {
    requested = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, note_interrupt);
    std::signal(SIGTERM, note_interrupt);
}

bool interrupt_requested() {
    return requested != 0;
}

} // namespace reradiant
