#include "alhazen/formats/native/read/native_shapes.h"

#include <array>

#include "alhazen/formats/native/fields/native_shape_fields.h"

namespace alhazen {

namespace {

template <class S>
AnyShape read_shape(BlockReader& reader) {
    S shape;
    read_native_fields(reader, shape);
    return shape;
}

struct ShapeEntry {
    const char* type;
    AnyShape (*read)(BlockReader&);
};

template <class... S>
constexpr std::array<ShapeEntry, sizeof...(S)> entries_of(ShapeTypes<S...>) {
    return {{{S::kName, read_shape<S>}...}};
}

constexpr auto kShapes = entries_of(AnalyticShapes{});

}  // namespace

AnyShape read_native_shape(std::string_view type, BlockReader& reader) {
    for (const ShapeEntry& entry : kShapes) {
        if (entry.type == type) return entry.read(reader);
    }
    return {};
}

bool is_native_shape(std::string_view type) {
    for (const ShapeEntry& entry : kShapes) {
        if (entry.type == type) return true;
    }
    return false;
}

std::vector<std::string_view> native_shape_names() {
    std::vector<std::string_view> names;
    for (const ShapeEntry& entry : kShapes) names.emplace_back(entry.type);
    return names;
}

}  // namespace alhazen
