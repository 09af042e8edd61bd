#pragma once
/// Heights of a native height_field from an image file.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `file`, `low` and `high` if the block has a file: the mean of red, green and blue, from 0
/// to 1, maps to a height from low to high. The first row of the image has the highest y.
void read_native_height_picture(BlockReader& reader, const NativeContext& context,
                                const NativeScope& scope, AnyShape& shape);

}  // namespace alhazen
