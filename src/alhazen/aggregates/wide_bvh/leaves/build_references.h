#pragma once
/// The references that a wide BVH is built over: the bounded primitives of a table, with their
/// boxes in the local frame and the kinds of their leaves.
///
/// Complexity and threads: O(n), parallel.

#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {

/// Writes a reference to each bounded primitive, in ascending order of id. The boxes are those of
/// LocalFrame::local.
void make_references(const PrimitiveTable& table, const BoundedPrimitives& bounded,
                     const LocalFrame& frame, std::span<BuildReference> references);

}  // namespace alhazen
