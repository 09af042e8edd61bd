#pragma once
/// The fields of analytic shapes in the native format, as they are written. ADD A SHAPE in the
/// .cpp: one overload.

#include "alhazen/formats/native/read/native_text.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// Adds the keys that read_native_shape makes the same shape of.
void add_shape_fields(NativeBlockText& block, const AnyShape& shape);

}  // namespace alhazen
