#pragma once
/// The contents of a native scene, an object or a group.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the items of a block or file into `scope`; a `defaults` item changes the scope for later
/// items. Skips the first `skip` items (the header of a file).
void read_native_items(TextNode block, NativeContext& context, NativeScope& scope,
                       std::size_t skip = 0);

/// All block types, in the order of messages: settings, cameras, lights, materials and textures,
/// containers of parts, shapes. Includes `instance` and `include`, which are not blocks.
[[nodiscard]] std::vector<std::string_view> native_block_names();

}  // namespace alhazen
