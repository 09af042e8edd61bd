#include "alhazen/formats/native/write/native_write_shapes.h"

#include "alhazen/formats/native/fields/native_shape_fields.h"

namespace alhazen {

void add_shape_fields(NativeBlockText& block, const AnyShape& shape) {
    std::visit([&](const auto& s) { write_native_fields(block, s); }, shape);
}

}  // namespace alhazen
