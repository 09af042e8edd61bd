#pragma once
/// Tells whether a tree that was built over one table serves another.
///
/// What goes into the number is what the builder of `wide_bvh` reads: kinds and opacity of all
/// primitives, the triangles and spheres that are copied into leaves, and of everything else the
/// boxes alone. Masks are the table's and in no tree, so they may differ. Two tables with one
/// fingerprint get the same tree, so a tree of the one gives the right hits on the other.
/// Complexity: O(size of the table); a fraction of a build.

#include <cstdint>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

[[nodiscard]] std::uint64_t table_fingerprint(const PrimitiveTable& table);

}  // namespace alhazen
