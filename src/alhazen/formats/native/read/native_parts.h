#pragma once
/// The contents of a native scene, an object or a group.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the items of a block or file into `scope`; a `defaults` item changes the scope for the
/// items after it. The first `skip` items are skipped (the header of a file).
void read_native_items(TextNode block, NativeContext& context, NativeScope& scope,
                       std::size_t skip = 0);

}  // namespace alhazen
