#pragma once
/// A number that is equal for tables with the same tree.
///
/// It covers the input of the builder of `wide_bvh`: kinds and opacity of all primitives, the
/// triangles and spheres that are copied into leaves, outlines of polygons, and the boxes and
/// bounding bodies of all others. Masks are not stored in trees and may differ. Tables with equal
/// fingerprints get the same tree, so a tree of one gives correct hits on the other.
/// Complexity: O(size of the table); a fraction of a build.

#include <cstdint>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

[[nodiscard]] std::uint64_t table_fingerprint(const PrimitiveTable& table);

}  // namespace alhazen
