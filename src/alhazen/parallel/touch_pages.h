#pragma once
/// Touches memory from all threads before one thread fills it: the system clears a page when it is
/// first touched, which takes longer than filling it.

#include <cstddef>

namespace alhazen {

/// Writes a zero into each page of memory that holds no values yet; leaves small blocks untouched.
void touch_pages(void* memory, std::size_t bytes);

}  // namespace alhazen
