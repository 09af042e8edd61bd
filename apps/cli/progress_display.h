#pragma once
/// Progress on stderr: on a terminal a bar with the remaining time, otherwise a line every ten
/// seconds.

#include <chrono>
#include <string>

#include "alhazen/base/progress.h"

namespace alhazen::cli {

class ProgressDisplay final : public ProgressSink {
  public:
    /// `quiet`: shows nothing.
    explicit ProgressDisplay(bool quiet);
    ~ProgressDisplay() override;
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void update(std::string_view phase, std::size_t done, std::size_t total) override;
    /// Ends the line of the bar before other messages.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    void show(double fraction, double elapsed, bool complete);

    bool quiet_;
    bool terminal_;
    bool line_open_ = false;
    std::string phase_;
    Clock::time_point phase_start_, last_shown_;
};

}  // namespace alhazen::cli
