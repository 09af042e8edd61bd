#pragma once
/// The heights of a native height_field that come from a picture.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `file`, `low` and `high` where the block has a file: the mean of red, green and blue, from
/// 0 to 1, stands for a height from low to high. The picture's first row is the one of highest y.
void read_native_height_picture(BlockReader& reader, const NativeContext& context,
                                const NativeScope& scope, AnyShape& shape);

}  // namespace alhazen
