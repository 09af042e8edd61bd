#pragma once
/// SIGINT, SIGTERM and, unless ignored, SIGHUP end the process at once with status 75 until there
/// are results to write; after that they ask running work to stop, and a second signal ends the
/// process at once.

#include "alhazen/base/progress.h"

namespace alhazen::cli {

/// Installs the handlers: signals end the process with status 75.
void exit_on_signals();

/// Signals now only set the returned flag; a second one ends the process.
const StopFlag& stop_on_signals();

/// Makes a write to a closed pipe or beyond a size limit fail with an error instead of a signal.
void fail_instead_of_dying_on_writes();

}  // namespace alhazen::cli
