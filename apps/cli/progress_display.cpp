#include "progress_display.h"
#include "messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace alhazen::cli {

namespace {

constexpr int kBarWidth = 30;
constexpr double kTerminalInterval = 0.25;  // seconds between refreshes
constexpr double kLineInterval = 10.0;      // seconds between lines without a terminal

std::string minutes(double seconds) {
    const long whole = static_cast<long>(seconds + 0.5);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
    finish();
}

void ProgressDisplay::update(std::string_view phase, std::size_t done, std::size_t total) {
    if (quiet_) return;
    const Clock::time_point now = Clock::now();
    if (phase != phase_) {
        finish();
        phase_ = phase;
        phase_start_ = now;
        last_shown_ = now;
    }
    const bool complete = done == total;
    const double since_shown = std::chrono::duration<double>(now - last_shown_).count();
    if (!complete && since_shown < (terminal_ ? kTerminalInterval : kLineInterval)) return;
    last_shown_ = now;
    const double fraction =
        total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
    show(fraction, std::chrono::duration<double>(now - phase_start_).count(), complete);
    if (complete) finish();
}

void ProgressDisplay::show(double fraction, double elapsed, bool complete) {
    const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
    const std::string times = complete ? fmt::format("{:.2f} s", elapsed)
                                       : fmt::format("{} ETA {}", minutes(elapsed), minutes(left));
    if (!terminal_) {
        tell("{}: {:.0f}% {}\n", phase_, 100.0 * fraction, times);
        return;
    }
    const int filled = static_cast<int>(fraction * kBarWidth);
    // Written unescaped: the terminal must return and clear the line.
    const std::string bar =
        fmt::format("\r{:<7}[{}{}] {:3.0f}% {}\x1b[K", phase_, std::string(filled, '#'),
                    std::string(kBarWidth - filled, '-'), 100.0 * fraction, times);
    (void)std::fwrite(bar.data(), 1, bar.size(), stderr);
    std::fflush(stderr);
    line_open_ = true;
}

void ProgressDisplay::finish() {
    if (line_open_) tell("\n");
    line_open_ = false;
}

}  // namespace alhazen::cli
