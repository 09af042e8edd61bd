#pragma once
/// SIGINT and SIGTERM ask running work to stop; a second one ends the process at once.

#include "alhazen/base/progress.h"

namespace alhazen::cli {

/// Installs the handlers once and returns the flag they set.
const StopFlag& stop_on_signals();

}  // namespace alhazen::cli
