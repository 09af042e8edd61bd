#pragma once
/// Processor seconds of this process since construction; waiting and other processes do not count.
///
/// Conventions: reading takes a system call, about 0.3 microseconds.

#include <ctime>

namespace alhazen {

class CpuClock {
  public:
    [[nodiscard]] double seconds() const { return now() - start_; }

  private:
    static double now() {
        std::timespec t{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }

    double start_ = now();
};

}  // namespace alhazen
