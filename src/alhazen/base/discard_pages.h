#pragma once
/// Memory whose values are needed no more, while its addresses are.

#include <cstddef>

namespace alhazen {

/// Returns the whole pages of a block to the system, or does nothing. The values of the block are
/// lost; it may be written again.
void discard_pages(void* memory, std::size_t bytes);

}  // namespace alhazen
