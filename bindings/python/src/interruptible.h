#pragma once
/// Runs work of the library without the interpreter's lock; Ctrl-C ends it.
///
/// Conventions: called with the lock held, which is released while the work runs. Python delivers
/// signals only to its main thread: in other threads nothing is interrupted. Python exceptions
/// raised by a signal handler or a callback are thrown as error_already_set.

#include <pybind11/pybind11.h>

#include <cstddef>
#include <functional>

#include "alhazen/base/progress.h"

namespace alhazen::python {

/// Calls work(begin, end) for disjoint ranges that cover [0, count), from at most `threads` threads
/// (0: all cores). Signals are checked between blocks of ranges, whose size is adapted to take
/// about a fortieth of a second.
void run_in_blocks(std::size_t count, int threads,
                   const std::function<void(std::size_t begin, std::size_t end)>& work);

/// Runs work in a separate thread, and meanwhile calls progress(phase, done, total) unless it is
/// None. On a signal, or an exception of `progress`, requests the stop and waits for the end.
void run_watched(StopFlag& stop, const pybind11::object& progress,
                 const std::function<void(ProgressSink& sink)>& work);

/// As run_watched, for work that ends at an interruption point (interruption.h).
void run_interruptible(const std::function<void()>& work);

}  // namespace alhazen::python
