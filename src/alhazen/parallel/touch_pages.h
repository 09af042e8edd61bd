#pragma once
/// Memory that one thread is about to set, brought in by all of them: the system clears a page when
/// it is touched first, which takes longer than to set it.

#include <cstddef>

namespace alhazen {

/// Writes a zero to each page of memory that holds nothing yet.
void touch_pages(void* memory, std::size_t bytes);

}  // namespace alhazen
