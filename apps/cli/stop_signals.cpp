#include "stop_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <ctime>

#include "commands.h"

namespace alhazen::cli {

namespace {

StopFlag stop_flag;
/// True while running work polls the stop flag.
std::atomic<bool> work_stops{false};
volatile std::sig_atomic_t first_signal_seconds = 0;
/// A second signal within this time counts as a repetition of the first (timeout(1) signals the
/// process and its group).
constexpr long kSameWishSeconds = 1;

long now_seconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<long>(now.tv_sec);
}

extern "C" void on_stop_signal(int signal_number) {
    if (!work_stops.load()) {
        static constexpr char kMessage[] = "alhazen: stopped; the work in hand has no result\n";
        (void)!write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
        _exit(kStopped);
    }
    if (stop_flag.requested()) {
        if (now_seconds() - first_signal_seconds <= kSameWishSeconds) return;
        std::signal(signal_number, SIG_DFL);
        std::raise(signal_number);
        return;
    }
    first_signal_seconds = static_cast<std::sig_atomic_t>(now_seconds());
    stop_flag.request();
}

}  // namespace

void exit_on_signals() {
    std::signal(SIGINT, on_stop_signal);
    std::signal(SIGTERM, on_stop_signal);
    // nohup(1) ignores it.
    if (std::signal(SIGHUP, on_stop_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

const StopFlag& stop_on_signals() {
    exit_on_signals();
    work_stops.store(true);
    return stop_flag;
}

void fail_instead_of_dying_on_writes() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace alhazen::cli
