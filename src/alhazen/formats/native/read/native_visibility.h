#pragma once
/// `visible_to` of parts: the kinds of rays to which they are visible.

#include <string>

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/geometry/ray_mask.h"

namespace alhazen {

/// Reads the key; kAllRays if it is absent.
[[nodiscard]] RayMask read_native_visibility(BlockReader& reader);

/// The value that reads back to the same mask: `all`, `none` or a list of kinds.
[[nodiscard]] std::string native_visibility(RayMask mask);

}  // namespace alhazen
