#include "alhazen/aggregates/wide_bvh/leaves/leaf_writer.h"

#include <algorithm>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/parallel/touch_pages.h"

namespace alhazen {
namespace {

template <class Block>
void resize_blocks(MappableVector<Block>& blocks, std::size_t count) {
    blocks.reserve(count);
    touch_pages(blocks.data(), count * sizeof(Block));
    blocks.resize(count);
}

/// Calls `fill` with each block and the primitives in it.
template <class Block, class T, class Fill>
void for_blocks(Block* block, std::span<const T> all, Fill&& fill) {
    for (std::size_t i = 0; i < all.size(); i += kBlockWidth, ++block) {
        fill(*block, all.subspan(i, std::min(kBlockWidth, all.size() - i)));
    }
}

}  // namespace

void LeafWriter::resize(const std::array<std::size_t, kLeafKinds>& blocks) {
    const std::size_t triangles = blocks[static_cast<std::size_t>(LeafType::Triangles)];
    if (leaves_ == Leaves::Indices) {
        resize_blocks(layout_.indices, triangles);
        indices_ = layout_.indices.data();
    } else {
        resize_blocks(layout_.triangles, triangles);
        triangles_ = layout_.triangles.data();
    }
    resize_blocks(layout_.spheres, blocks[static_cast<std::size_t>(LeafType::Spheres)]);
    resize_blocks(layout_.frustums, blocks[static_cast<std::size_t>(LeafType::Frustums)]);
    resize_blocks(layout_.others, blocks[static_cast<std::size_t>(LeafType::Others)]);
}

inline LeafTriangle LeafWriter::find(PrimitiveId id) const {
    const PlacedMesh& placed = mesh_of(id);
    const auto& numbers = corners(id, placed);
    LeafTriangle found;
    for (std::size_t k = 0; k < 3; ++k) {
        found.corner[k] = placed.mesh->positions.data() + numbers[k];
        __builtin_prefetch(found.corner[k]);
    }
    found.id = id;
    found.opaque = is_opaque(id, placed);
    return found;
}

float LeafWriter::write(LeafType type, std::size_t offset, std::span<const PrimitiveId> ids) const {
    const auto fill = [&](auto& blocks) {
        for_blocks(&blocks[offset], ids, [&](auto& block, std::span<const PrimitiveId> here) {
            fill_block(block, here, table_, layout_.frame);
        });
    };
    switch (type) {
        case LeafType::Triangles: {
            std::array<LeafTriangle, kBlockWidth * NodeRef::kMaxBlocks> room;
            const std::span triangles = std::span(room).first(ids.size());
            for (const PrimitiveId id : ids) prefetch(id);
            std::transform(ids.begin(), ids.end(), triangles.begin(),
                           [this](PrimitiveId id) { return find(id); });
            write_triangles(offset, triangles);
            return area_of(triangles);
        }
        case LeafType::Spheres:
            fill(layout_.spheres);
            break;
        case LeafType::Frustums:
            fill(layout_.frustums);
            break;
        case LeafType::Others:
            fill(layout_.others);
            break;
    }
    float surface = 0;
    for (const PrimitiveId id : ids) {
        surface += surface_of(surface_area(table_, id), table_.is_opaque(id));
    }
    return surface;
}

void LeafWriter::write_triangles(std::size_t offset,
                                 std::span<const LeafTriangle> triangles) const {
    const auto fill = [&](auto& block, std::span<const LeafTriangle> here) {
        fill_block(block, here, layout_.frame);
    };
    if (leaves_ == Leaves::Indices) {
        for_blocks(indices_ + offset, triangles, fill);
    } else {
        for_blocks(triangles_ + offset, triangles, fill);
    }
}

float LeafWriter::area_of(std::span<const LeafTriangle> triangles) const {
    float surface = 0;
    for (const auto& [corner, id, opaque] : triangles) {
        const Vec3 u = *corner[1] - *corner[0], v = *corner[2] - *corner[0];
        surface += surface_of(0.5 * length(cross(u, v)), opaque);
    }
    return surface;
}

}  // namespace alhazen
