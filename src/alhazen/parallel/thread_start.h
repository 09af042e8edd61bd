#pragma once
/// Starts threads while the caller still works alone.

#include <functional>

namespace alhazen {

/// Runs `work` on the calling thread while another one starts `threads` threads (0: all available
/// cores), for which the first parallel call of a ThreadLimit of that many would wait: for work of
/// some milliseconds before parallel work. Runs `work` alone where threads are not kept.
void run_while_threads_start(int threads, const std::function<void()>& work);

}  // namespace alhazen
