#pragma once
/// Meshes of the native format: inline in the scene or read from other files, placed once (`mesh`)
/// or defined for several parts (`geometry`).

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `geometry "NAME" { ... }`: a mesh that parts refer to by name.
void read_native_geometry(const NativeBlock& block, NativeContext& context, NativeScope& scope);
/// The mesh of a `mesh` block: the geometry that it names, or its own. None after an error.
[[nodiscard]] std::optional<MeshIndex> read_native_mesh(BlockReader& reader,
                                                        const NativeBlock& block,
                                                        NativeContext& context,
                                                        const NativeScope& scope);

}  // namespace alhazen
