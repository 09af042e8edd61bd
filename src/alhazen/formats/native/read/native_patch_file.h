#pragma once
/// Patches of a native patch_mesh from a .bpt file.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `file` if the block, located at `where`, has one: its patches, which must have one pair of
/// degrees. False after an error that leaves the patches out.
bool read_native_patch_file(BlockReader& reader, NativeContext& context, const NativeScope& scope,
                            const FileLocation& where, AnyShape& shape);

}  // namespace alhazen
