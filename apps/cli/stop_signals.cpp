#include "stop_signals.h"

#include <csignal>

namespace alhazen::cli {

namespace {

StopFlag stop_flag;

extern "C" void on_stop_signal(int signal_number) {
    if (stop_flag.requested()) {
        std::signal(signal_number, SIG_DFL);
        std::raise(signal_number);
        return;
    }
    stop_flag.request();
}

}  // namespace

const StopFlag& stop_on_signals() {
    std::signal(SIGINT, on_stop_signal);
    std::signal(SIGTERM, on_stop_signal);
    return stop_flag;
}

void fail_instead_of_dying_on_writes() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace alhazen::cli
