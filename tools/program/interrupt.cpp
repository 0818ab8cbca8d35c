#include "tools/program/interrupt.h"

#include <atomic>
#include <csignal>
#include <tuple>
#include <unistd.h>

namespace reradiant {

namespace {

std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler sets it");

/// Calls only what a signal's handler may call.
void end_now(int /*signal*/) {
    constexpr char text[] = "interrupted while setting up; nothing was written\n";
    std::ignore = ::write(STDERR_FILENO, text, sizeof(text) - 1);
    ::_exit(exit_interrupted);
}

void note_interrupt(int signal) {
    requested = true;
    std::signal(signal, SIG_DFL);
}

} // namespace

void end_at_interrupts() {
    std::signal(SIGINT, end_now);
    std::signal(SIGTERM, end_now);
}

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
