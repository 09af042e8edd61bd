#pragma once
/// Long work that can be given up: loading a scene, building an accelerator.
///
/// Conventions: whoever may lose interest makes an `Interruptible` around the work; the work calls
/// `interruption_point` wherever a moment has passed, and cleans up by its destructors alone.
/// Without an Interruptible nothing is ever thrown. Threads: the flag belongs to the thread; those
/// that help in parallel calls inherit it (parallel.h).

#include <exception>

#include "alhazen/base/progress.h"

namespace alhazen {

/// Thrown out of work that was given up. No Error: it is nobody's fault, and no message.
class Interrupted final : public std::exception {
  public:
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

class Interruptible {
  public:
    /// Until it is destroyed, work of this thread ends soon after a request. Null: it never does.
    explicit Interruptible(const StopFlag* flag) : before_(current_) { current_ = flag; }
    ~Interruptible() { current_ = before_; }
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;

    /// The flag of this thread; null: none.
    [[nodiscard]] static const StopFlag* current() { return current_; }

  private:
    const StopFlag* before_;
    static inline constinit thread_local const StopFlag* current_ = nullptr;
};

/// Throws Interrupted where the work of this thread was given up. Costs some nanoseconds.
inline void interruption_point() {
    const StopFlag* const flag = Interruptible::current();
    if (flag != nullptr && flag->requested()) throw Interrupted();
}

}  // namespace alhazen
