#pragma once
/// Interruption of long work: loading a scene, building an accelerator.
///
/// Conventions: a caller that may interrupt the work makes an `Interruptible` around it; the work
/// calls `interruption_point` at short intervals and relies on destructors for cleaning up. Without
/// an Interruptible nothing is thrown. Threads: the flag belongs to the thread; threads that help
/// in parallel calls inherit it (parallel.h).

#include <exception>

#include "alhazen/base/progress.h"

namespace alhazen {

/// Thrown out of interrupted work. It is not an Error: there is no fault to report.
class Interrupted final : public std::exception {
  public:
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

class Interruptible {
  public:
    /// Makes the work of this thread end soon after `flag` is set, until the object is destroyed.
    /// Null: the work is not interruptible.
    explicit Interruptible(const StopFlag* flag) : before_(current_) { current_ = flag; }
    ~Interruptible() { current_ = before_; }
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;

    /// The flag of this thread, or null.
    [[nodiscard]] static const StopFlag* current() { return current_; }

  private:
    const StopFlag* before_;
    static inline constinit thread_local const StopFlag* current_ = nullptr;
};

/// Throws Interrupted if the work of this thread has been interrupted. Costs some nanoseconds.
inline void interruption_point() {
    const StopFlag* const flag = Interruptible::current();
    if (flag != nullptr && flag->requested()) throw Interrupted();
}

}  // namespace alhazen
