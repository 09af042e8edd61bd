#pragma once
/// Transforms of the native format.

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/math/affine.h"

namespace alhazen {

/// `transform = ...`: one of translate(x, y, z), rotate((x, y, z), degrees), scale(s), scale(x, y,
/// z), matrix(row, row, row), or a list of them, applied from the first to the last. The identity
/// when the key is absent or invalid.
[[nodiscard]] Affine read_native_transform(BlockReader& reader);

}  // namespace alhazen
