#pragma once
/// Settings of the heap, for the `main` of a program.

namespace alhazen {

/// Reserves 64 MB of heap in large pages and keeps freed memory for reuse, which avoids page faults
/// of growing and successive vectors. No effect with C libraries other than glibc.
void prepare_heap();

/// From here on all threads share the heap of the main thread. Else each thread that allocates much
/// has a heap of its own, which keeps what it has freed: a server whose requests run in any of its
/// threads would hold the memory of one request for each of them. Call it before there are threads.
/// No effect with C libraries other than glibc.
void use_one_heap();

}  // namespace alhazen
