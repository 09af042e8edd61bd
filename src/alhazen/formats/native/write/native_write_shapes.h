#pragma once
/// Writes the fields of analytic shapes in the native format.

#include "alhazen/formats/native/fields/native_text.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// Adds the pairs from which read_native_shape restores the shape.
void add_shape_fields(NativeBlockText& block, const AnyShape& shape);

}  // namespace alhazen
