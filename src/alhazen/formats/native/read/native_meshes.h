#pragma once
/// Meshes of the native format: written out in the scene or read from files beside it, placed once
/// (`mesh`) or defined to be placed by several parts (`geometry`).

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// `geometry "NAME" { ... }`: a mesh that parts can name.
void read_native_geometry(const NativeBlock& block, NativeContext& context, NativeScope& scope);
/// What a `mesh` block is about: the geometry it names or its own. Nothing after an error.
[[nodiscard]] std::optional<MeshIndex> read_native_mesh(BlockReader& reader,
                                                        const NativeBlock& block,
                                                        NativeContext& context,
                                                        const NativeScope& scope);

}  // namespace alhazen
