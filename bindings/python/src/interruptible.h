#pragma once
/// Work of the library that Ctrl-C ends, without the interpreter's lock.
///
/// Conventions: called with the lock held; it is released while the work runs. Python delivers
/// signals to its main thread only: elsewhere nothing is interrupted. Python exceptions that a
/// signal handler or a callback raises are thrown as error_already_set.

#include <pybind11/pybind11.h>

#include <cstddef>
#include <functional>

#include "alhazen/base/progress.h"

namespace alhazen::python {

/// Calls work(begin, end) for disjoint ranges that cover [0, count), from at most `threads` threads
/// (0: all cores). Signals are looked for between blocks of ranges, which are made as long as they
/// take about a fortieth of a second.
void run_in_blocks(std::size_t count, int threads,
                   const std::function<void(std::size_t begin, std::size_t end)>& work);

/// Runs work in a thread of its own, and meanwhile calls progress(phase, done, total) unless it is
/// None. On a signal, or an exception of `progress`, requests the stop and waits for the end.
void run_watched(StopFlag& stop, const pybind11::object& progress,
                 const std::function<void(ProgressSink& sink)>& work);

/// The same of work that ends by itself at a point of interruption (interruption.h).
void run_interruptible(const std::function<void()>& work);

}  // namespace alhazen::python
