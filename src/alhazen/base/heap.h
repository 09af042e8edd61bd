#pragma once
/// Settings of the heap, for the `main` of a program.

namespace alhazen {

/// Reserves 64 MB of heap in large pages and keeps freed memory for reuse, which avoids page faults
/// of growing and successive vectors. No effect with C libraries other than glibc.
void prepare_heap();

}  // namespace alhazen
