#pragma once
/// SIGINT and SIGTERM ask running work to stop; a second one ends the process at once.

#include "alhazen/base/progress.h"

namespace alhazen::cli {

/// Installs the handlers once and returns the flag they set.
const StopFlag& stop_on_signals();

/// Lets a write to a closed pipe or beyond a size limit fail with an error instead of ending the
/// process.
void fail_instead_of_dying_on_writes();

}  // namespace alhazen::cli
