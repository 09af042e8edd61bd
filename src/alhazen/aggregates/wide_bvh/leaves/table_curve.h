#pragma once
/// The bounded primitives of a table for the builder along a curve, and the leaves of a layout that
/// they are put into.
///
/// Differs from the leaves of other builders: the vertices of meshes are rounded first, and the
/// boxes of leaves are made of the rounded ones, a few steps larger.

#include "alhazen/accel/wide_bvh/build/curve_builder.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_writer.h"
#include "alhazen/aggregates/wide_bvh/leaves/local_vertices.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {

class TableCurve final : public CurvePrimitives {
  public:
    /// Keeps references.
    TableCurve(const BoundedPrimitives& bounded, LeafWriter& writer);

    [[nodiscard]] std::uint32_t size() const override {
        return static_cast<std::uint32_t>(bounded_.size());
    }
    [[nodiscard]] std::uint32_t common_kind() const override;
    [[nodiscard]] std::uint32_t kind(std::uint32_t index) const override;
    void centers(std::uint32_t begin, std::uint32_t end, Float4* to) const override;
    void resize(const std::array<std::size_t, kLeafKinds>& blocks) override {
        writer_.resize(blocks);
    }
    void fill(std::span<const CurveLeaf> leaves, const std::uint32_t* indices, std::uint32_t first,
              BuildReference* boxes, float* areas) const override;

  private:
    /// A mesh of the table.
    struct MeshView {
        /// The corners of triangle `first` and those after it.
        const std::array<std::uint32_t, 3>* triangles;
        std::uint32_t first, first_vertex;
        bool opaque, same;  ///< opaque where all triangles are the same

        [[nodiscard]] const std::array<std::uint32_t, 3>& corners(PrimitiveId id) const {
            return triangles[static_cast<std::uint32_t>(id) - first];
        }
    };
    template <bool kSimple>
    class Finder;

    [[nodiscard]] MeshView view(PrimitiveId id) const;
    [[nodiscard]] std::uint32_t first_vertex(const PlacedMesh& placed) const;
    void triangle_centers(std::uint32_t begin, std::uint32_t end, Float4* to) const;
    void fill_triangles(std::span<const CurveLeaf> leaves, const std::uint32_t* indices,
                        std::uint32_t first, BuildReference* boxes, float* areas) const;
    template <class TriangleFinder>
    void fill_found(const TriangleFinder& finder, std::span<const CurveLeaf> leaves,
                    std::uint32_t first, BuildReference* boxes, float* areas) const;
    void fill_shapes(const CurveLeaf& leaf, const std::uint32_t* indices, std::uint32_t number,
                     BuildReference& box, float& area) const;

    const BoundedPrimitives& bounded_;
    LeafWriter& writer_;
    LocalVertices vertices_;
    bool only_triangles_;
};

}  // namespace alhazen
