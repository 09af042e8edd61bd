#include "alhazen/scene/leaf_fill.h"

#include <bit>
#include <tuple>

#include "alhazen/scene/primitive_table.h"

namespace alhazen {
namespace {

bool same_bits(const Vec3& a, const Vec3& b) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// True when the block holds the very triangle.
bool fill(TriangleBlock& block, std::size_t lane, const std::array<Vec3, 3>& corners,
          const LocalFrame& frame) {
    bool exact = true;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3 local = frame.local(corners[corner]);
        for (int axis = 0; axis < 3; ++axis) {
            block.vertex[corner][axis][lane] = static_cast<float>(local[axis]);
        }
        exact = exact && same_bits(frame.world(block.corner(corner, lane)), corners[corner]);
    }
    return exact;
}

/// A triangle that few rays come near; those that do are told by the lane's id.
void leave_free(TriangleBlock& block, std::size_t lane) {
    constexpr float kFar[3][3] = {{40, 47, 53}, {41, 45, 52}, {42, 48, 50}};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.vertex[corner][axis][lane] = kFar[corner][axis];
        }
    }
    block.ids[lane] = BlockId::none();
}

}  // namespace

void fill_block(TriangleBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
        const PrimitiveId id = ids[lane];
        const bool exact = fill(block, lane, table.triangle_vertices(table.index(id)), frame);
        block.ids[lane] = {id, table.is_opaque(id), exact};
    }
    for (std::size_t lane = ids.size(); lane < kBlockWidth; ++lane) leave_free(block, lane);
}

void fill_block(IndexBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame&) {
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        block.ids[lane] = lane < ids.size() ? BlockId{ids[lane], table.is_opaque(ids[lane]), false}
                                            : BlockId::none();
    }
}

void fill_block(SphereBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame&) {
    const auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns).shapes;
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        const bool used = lane < ids.size();
        // Free lanes repeat the first.
        const PrimitiveId id = ids[used ? lane : 0];
        const Sphere& sphere = spheres[table.index(id)];
        for (int axis = 0; axis < 3; ++axis) block.center[axis][lane] = sphere.center[axis];
        block.radius[lane] = sphere.radius;
        block.ids[lane] = used ? BlockId{id, table.is_opaque(id), true} : BlockId::none();
    }
    block.lanes = (1u << ids.size()) - 1;
}

}  // namespace alhazen
