#pragma once
/// Readers of the native format's solids whose fields are lists: part of native_shapes.cpp's table.

#include "alhazen/importers/block_reader.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

[[nodiscard]] AnyShape read_native_polyhedron(BlockReader& reader);

}  // namespace alhazen
