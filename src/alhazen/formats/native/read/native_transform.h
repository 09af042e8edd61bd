#pragma once
/// Transforms of the native format.

#include <vector>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `transform = ...`: one of translate(x, y, z), rotate((x, y, z), degrees), scale(s),
/// scale(x, y, z), matrix(row, row, row), or a list of them, applied from the first to the last.
/// The identity if the key is absent or invalid.
[[nodiscard]] Affine read_native_transform(BlockReader& reader);

/// Reads `motion = [(time, transform), ...]`; none if the key is absent or invalid.
[[nodiscard]] std::vector<TransformKey> read_native_motion(BlockReader& reader);

/// Sets the placement and the motion of the part from `transform` and `motion`.
void read_native_placement(BlockReader& reader, const NativeScope& scope, Part& part);

}  // namespace alhazen
