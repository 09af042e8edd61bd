#pragma once
/// The analytic shapes of the native format: all of shapes/shape_list.h. The keys of a shape are
/// the names in its kFields (example: shapes/algebraic/torus.h).

#include <string_view>
#include <vector>

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// Reads a shape of block type `type` from the keys of its block. Precondition:
/// is_native_shape(type).
[[nodiscard]] AnyShape read_native_shape(std::string_view type, BlockReader& reader);
[[nodiscard]] bool is_native_shape(std::string_view type);
/// All block types of shapes.
[[nodiscard]] std::vector<std::string_view> native_shape_names();

}  // namespace alhazen
