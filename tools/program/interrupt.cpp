#include "tools/program/interrupt.h"

#include <atomic>
#include <csignal>

namespace reradiant {

namespace {

std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler sets it");

void note_interrupt(int signal) {
    requested = true;
    std::signal(signal, SIG_DFL);
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, note_interrupt);
    std::signal(SIGTERM, note_interrupt);
}

bool interrupt_requested() {
    return requested;
}

StopFlag interrupt_flag() {
    return &requested;
}

} // namespace reradiant
