#pragma once
/// Heights of a native height_field from a picture file.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `file`, `low` and `high` where the block has a file: the mean of red, green and blue, from
/// 0 to 1, maps to a height from low to high. The picture's first row has the highest y.
void read_native_height_picture(BlockReader& reader, const NativeContext& context,
                                const NativeScope& scope, AnyShape& shape);

}  // namespace alhazen
