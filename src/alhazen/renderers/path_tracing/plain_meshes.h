#pragma once
/// The meshes whose points are vertices for VertexLanes: all points of a material scatter alike,
/// on the side of the view only, and do not emit.
///
/// Conventions: for colour channels, paths outside of all volumes and scenes at rest. Threads: used
/// by one thread.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/geometry/hit.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/renderers/path_tracing/rough_lanes.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

struct PlainMaterial {
    std::array<Bsdf, 2> bsdfs;                              ///< [ShadingPoint::entering]
    std::array<std::unique_ptr<const RoughLobe>, 2> rough;  ///< of `bsdfs`; null: other lobes
    bool is_matt = false;  ///< one diffuse reflection, the same from both sides
    Spectrum matt;         ///< its value, without cosine; else black
};

class PlainMeshes {
  public:
    /// The scene must outlive the object and keep its materials.
    explicit PlainMeshes(const Scene& scene);

    struct Place {
        const PlacedMesh* mesh = nullptr;
        std::uint32_t triangle = 0;               ///< of the mesh
        const PlainMaterial* material = nullptr;  ///< null: not plain
    };
    /// The triangle of a hit; without material if its points are not plain.
    [[nodiscard]] Place find(const Hit& hit) {
        const std::uint32_t kind = table_.kind(hit.primitive);
        if (!any_ || kind != kTriangleKind || !hit.path.empty()) return {};
        const std::uint32_t index = static_cast<std::uint32_t>(hit.primitive) - first_;
        const std::size_t number = mesh_at(index);
        const PlacedMesh& mesh = table_.meshes[number];
        Look& look = looks_[number];
        if (!look.known) look_at(mesh, look);
        return {&mesh, index - mesh.first_triangle, look.material};
    }

  private:
    struct Look {
        bool known = false;
        const PlainMaterial* material = nullptr;
    };

    /// Successive triangles: that of number i is of mesh `numbers_[first + (i & mask)]`. The mask
    /// is 0 where all are of one mesh.
    struct Block {
        std::uint32_t first, mask;
    };

    /// The number of the mesh of a triangle.
    [[nodiscard]] std::size_t mesh_at(std::uint32_t triangle) const {
        const Block block = blocks_[triangle >> block_bits_];
        return numbers_[block.first + (triangle & block.mask)];
    }
    void list_meshes();
    void look_at(const PlacedMesh& mesh, Look& look);
    [[nodiscard]] const PlainMaterial* material_of(MaterialId id);

    const Scene& scene_;
    const PrimitiveTable& table_;
    std::uint32_t first_;      ///< primitive of the first triangle
    bool any_;                 ///< false: no hit is plain
    std::vector<Look> looks_;  ///< [mesh]
    int block_bits_ = 0;
    std::vector<Block> blocks_;                              ///< [triangle >> block_bits_]
    std::vector<std::uint32_t> numbers_;                     ///< of meshes
    std::vector<std::unique_ptr<PlainMaterial>> materials_;  ///< [material]; null: not yet made
};

}  // namespace alhazen
