#pragma once
/// Readers of the native format's solids whose fields are lists: part of native_shapes.cpp's table.

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

[[nodiscard]] AnyShape read_native_polyhedron(BlockReader& reader);
[[nodiscard]] AnyShape read_native_prism(BlockReader& reader);
[[nodiscard]] AnyShape read_native_lathe(BlockReader& reader);
[[nodiscard]] AnyShape read_native_blob(BlockReader& reader);
/// Without the heights of a picture: see native_height_picture.h.
[[nodiscard]] AnyShape read_native_height_field(BlockReader& reader);

}  // namespace alhazen
