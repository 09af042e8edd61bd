#pragma once
/// Everything that a native scene, an object or a group may contain.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the items of a block or file into `scope`; a `defaults` item changes the scope for those
/// after it. `skip` items at the start are left out (the header of a file).
void read_native_items(TextNode block, NativeContext& context, NativeScope& scope,
                       std::size_t skip = 0);

}  // namespace alhazen
