#include "alhazen/explain/spans/part_of_primitive.h"

#include <tuple>
#include <utility>

namespace alhazen {

std::uint32_t part_of_primitive(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t index = table.index(id);
    if (kind == kTriangleKind) return table.mesh_of(index).part;
    if (kind == kInstanceKind) return table.instances[index].part;
    std::uint32_t part = 0;
    const auto look = [&](std::uint32_t of_kind, const auto& column) {
        if (of_kind == kind && !column.parts.empty()) part = column.parts[index];
    };
    std::apply(
        [&](const auto&... column) {
            std::uint32_t number = 0;
            (look(number++, column), ...);
        },
        table.columns);
    return part;
}

}  // namespace alhazen
