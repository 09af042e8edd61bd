#pragma once
/// Puts the primitives of a table into the leaves of a layout.
///
/// Threads: the const functions may write different blocks at the same time.

#include <array>
#include <span>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class LeafWriter {
  public:
    /// Keeps references. The frame of the layout is set.
    LeafWriter(const PrimitiveTable& table, Leaves leaves, WideBvhLayout& layout)
        : table_(table),
          leaves_(leaves),
          layout_(layout),
          first_(table.first(kTriangleKind)),
          only_(table.meshes.size() == 1 ? table.meshes.data() : nullptr) {}

    [[nodiscard]] const PrimitiveTable& table() const { return table_; }
    [[nodiscard]] const LocalFrame& frame() const { return layout_.frame; }

    /// Allocates the blocks.
    void resize(const std::array<std::size_t, kLeafKinds>& blocks);
    /// Writes primitives in the order of their ids into blocks from `offset` on. Returns the area
    /// at which any-hit queries end.
    float write(LeafType type, std::size_t offset, std::span<const PrimitiveId> ids) const;

    /// The blocks of triangles with Leaves::Indices; else null.
    [[nodiscard]] IndexBlock* index_blocks() const { return indices_; }
    [[nodiscard]] TriangleBlock* triangle_blocks() const { return triangles_; }

    // ---- Triangles, which are scattered in memory, in steps.
    void prefetch(PrimitiveId id) const { __builtin_prefetch(&corners(id, mesh_of(id))); }
    [[nodiscard]] const PlacedMesh& mesh_of(PrimitiveId id) const {
        return only_ != nullptr ? *only_ : table_.mesh_of(index(id));
    }
    /// The numbers of the corners in the mesh of a triangle.
    [[nodiscard]] const std::array<std::uint32_t, 3>& corners(PrimitiveId id,
                                                              const PlacedMesh& placed) const {
        return placed.mesh->triangles.data()[index(id) - placed.first_triangle];
    }
    [[nodiscard]] bool is_opaque(PrimitiveId id, const PlacedMesh& placed) const {
        return placed.mesh->vertex_materials.empty() ? is_opaque(placed.material)
                                                     : table_.is_opaque(id);
    }

  private:
    [[nodiscard]] std::uint32_t index(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - first_;
    }
    /// Prefetches the corners.
    [[nodiscard]] LeafTriangle find(PrimitiveId id) const;
    void write_triangles(std::size_t offset, std::span<const LeafTriangle> triangles) const;
    [[nodiscard]] float area_of(std::span<const LeafTriangle> triangles) const;
    [[nodiscard]] bool is_opaque(MaterialId material) const {
        return table_.material_opacity[static_cast<std::uint32_t>(material)] == Opacity::Opaque;
    }
    /// A surface that lets light through may not end a query, so it counts for less.
    [[nodiscard]] float surface_of(double area, bool opaque) const {
        area *= layout_.frame.scale * layout_.frame.scale;
        return static_cast<float>(opaque ? area : 0.5 * area);
    }

    const PrimitiveTable& table_;
    Leaves leaves_;
    WideBvhLayout& layout_;
    std::uint32_t first_;     ///< id of the first triangle
    const PlacedMesh* only_;  ///< the only mesh
    IndexBlock* indices_ = nullptr;
    TriangleBlock* triangles_ = nullptr;
};

}  // namespace alhazen
