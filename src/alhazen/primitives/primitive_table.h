#pragma once
/// The primitives of one aggregate, by type in contiguous columns, and the ray test of each, which
/// all accelerators share.
///
/// Ids number the analytic shapes in the order of `AnalyticShapes`, then the triangles mesh by
/// mesh, then the instances; the type of a primitive follows from the range of its id.

#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/motion/transform_motion.h"
#include "alhazen/geometry/placement.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/nearest_hit.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shapes/meshes/mesh_motion.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

inline constexpr std::uint32_t kNoPlacement = 0xFFFFFFFFu;

/// All shapes of one type.
template <class S>
struct ShapeColumn {
    std::vector<S> shapes;
    /// [shape] index into PrimitiveTable::placements, or kNoPlacement.
    std::vector<std::uint32_t> placements;
    std::vector<MaterialId> materials;  ///< [shape]
    std::vector<std::uint32_t> parts;   ///< [shape] number of its part; empty: all 0
    /// [shape]; shapes beyond its end are visible to all rays.
    std::vector<RayMask> visible_to;

    /// Sets the mask of the last shape.
    void set_last_visible_to(RayMask mask) {
        if (mask == kAllRays) return;
        visible_to.resize(shapes.size(), kAllRays);
        visible_to.back() = mask;
    }
};

/// A mesh in the frame of the aggregate.
struct PlacedMesh {
    std::shared_ptr<const TriangleMesh> mesh;
    MaterialId material{0};
    std::uint32_t first_triangle = 0;  ///< number of triangles in the preceding meshes
    bool mirrored = false;   ///< its transform reversed the winding: normals are flipped back
    std::uint32_t part = 0;  ///< number of its part; see Surface
    RayMask visible_to = kAllRays;
    /// The motion of the vertices; `mesh` is their state as the shutter opens. Only in a
    /// MotionAggregate.
    std::shared_ptr<const MeshMotion> motion;
};

struct Instance {
    std::shared_ptr<const Aggregate> aggregate;
    /// LaneSolid of the aggregate; set by PrimitiveTable::finish, like `in_place`.
    const LaneSolid* lane_solid = nullptr;
    bool in_place = false;  ///< the placement is the identity
    Placement placement;
    std::uint32_t part = 0;  ///< number of the part that placed it
    /// The instance places a mesh that several parts share: `part` is the mesh's own part.
    bool of_shared_mesh = false;
    /// The aggregate holds one shape, which a MotionAggregate tests itself.
    bool holds_one_shape = false;
    /// The aggregate holds the static primitives of a MotionAggregate; the instance is no part.
    bool holds_rest = false;
    RayMask visible_to = kAllRays;
    /// The motion of the instance; `placement` is its state as the shutter opens. Only in a
    /// MotionAggregate.
    std::shared_ptr<const TransformMotion> motion;
};

[[nodiscard]] inline Placement placement_at(const Instance& instance, double time) {
    return instance.motion ? instance.motion->at(time) : instance.placement;
}

/// The ray in the frame of the placed aggregate.
[[nodiscard]] inline Ray inner_ray(const Instance& instance, const Ray& ray) {
    return instance.in_place ? ray : transformed(instance.placement.inner_from_outer, ray);
}

/// The kind of a primitive: the position in AnalyticShapes, or one of the two below.
inline constexpr std::uint32_t kTriangleKind = AnalyticShapes::kCount;
inline constexpr std::uint32_t kInstanceKind = kTriangleKind + 1;
inline constexpr std::uint32_t kKindCount = kInstanceKind + 1;
static_assert(kKindCount <= 256, "kinds are kept in bytes");

/// The effect of a material on light at its surface.
enum class Opacity : std::uint8_t {
    Transparent,      ///< some light may pass; the renderer computes how much
    Opaque,           ///< no light passes
    OpaqueFromFront,  ///< no light passes from the front, all light from the back
};

class PrimitiveTable final : public BoundsSource {
  public:
    // Out of line: the columns of all shape types are expensive to compile in each includer.
    PrimitiveTable();
    PrimitiveTable(const PrimitiveTable&);
    PrimitiveTable& operator=(const PrimitiveTable&);
    PrimitiveTable(PrimitiveTable&&) noexcept;
    PrimitiveTable& operator=(PrimitiveTable&&) noexcept;
    ~PrimitiveTable() override;

    // ---- Columns: filled by `compile`, then sealed by `finish`.
    AnalyticShapes::Columns<ShapeColumn> columns;
    std::vector<PlacedMesh> meshes;
    std::vector<Instance> instances;
    std::vector<Placement> placements;
    std::vector<Opacity> material_opacity;  ///< [material]
    std::vector<RayEnd> known_ray_ends;     ///< lights, in the frame of the aggregate

    /// Prepares the shapes and computes the id ranges. Call once, when the columns are complete.
    void finish();

    // ---- Contents.
    [[nodiscard]] std::size_t size() const override { return first_[kKindCount]; }
    [[nodiscard]] std::uint32_t kind(PrimitiveId id) const {
        const std::uint32_t i = static_cast<std::uint32_t>(id);
        if (i < first_[kTriangleKind]) return kinds_[i];
        return i < first_[kInstanceKind] ? kTriangleKind : kInstanceKind;
    }
    /// First id of a kind; kind + 1 gives its end.
    [[nodiscard]] std::uint32_t first(std::uint32_t kind) const { return first_[kind]; }
    /// Index of a primitive among those of its kind.
    [[nodiscard]] std::uint32_t index(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - first_[kind(id)];
    }
    /// The mesh that contains the i-th triangle of the table.
    [[nodiscard]] const PlacedMesh& mesh_of(std::uint32_t triangle) const;
    /// Vertices of the i-th triangle of the table.
    [[nodiscard]] std::array<Vec3, 3> triangle_vertices(std::uint32_t triangle) const;
    /// The addresses of these vertices, and of their indices, for prefetching.
    [[nodiscard]] std::array<const Vec3*, 3> corner_positions(std::uint32_t triangle) const;
    [[nodiscard]] const std::array<std::uint32_t, 3>* triangle_corners(
        std::uint32_t triangle) const;
    /// True if the primitive lets no light through from either side (false for every instance).
    [[nodiscard]] bool is_opaque(PrimitiveId id) const;
    /// The material of an analytic shape.
    [[nodiscard]] MaterialId shape_material(PrimitiveId id) const;
    /// The opacity of a primitive that is not an instance.
    [[nodiscard]] Opacity opacity(PrimitiveId id) const {
        if (is_opaque(id)) return Opacity::Opaque;
        return is_opaque_from_front(id) ? Opacity::OpaqueFromFront : Opacity::Transparent;
    }

    /// The mask of rays that see the primitive; for an instance, its own mask.
    [[nodiscard]] RayMask visible_to(PrimitiveId id) const;
    /// True if rays of this mask see all primitives.
    [[nodiscard]] bool all_seen(RayMask mask) const { return (common_mask_ & mask) != 0; }
    /// Mask bits of all primitives.
    [[nodiscard]] RayMask common_mask() const { return common_mask_; }
    [[nodiscard]] bool is_seen(PrimitiveId id, RayMask mask) const {
        return all_seen(mask) || (visible_to(id) & mask) != 0;
    }

    /// The effect of a hit primitive (not an instance) on a shadow ray.
    enum class ShadowEffect {
        Blocks,
        Tints,  ///< a crossing for the renderer
        None,   ///< the light arrives at an invisible back
    };
    [[nodiscard]] ShadowEffect shadow_effect(PrimitiveId id, const Ray& ray) const;

    // ---- Bounds; empty for primitives that cannot be hit: triangles with two equal vertices.
    [[nodiscard]] Box3 box(std::size_t i) const override;
    [[nodiscard]] Interval extent(std::size_t i, const Vec3& axis) const override;
    /// Exact up to rounding for spheres without a placement; for an instance the smaller of the
    /// sphere of its contents and the sphere around its box.
    [[nodiscard]] BoundingSphere sphere(std::size_t i) const override;
    /// Exact up to rounding for triangles and for spheres without a placement (their surface, which
    /// is all that rays hit).
    [[nodiscard]] bool overlaps(std::size_t i, const Box3& cell) const override;
    /// Exact up to rounding for triangles.
    [[nodiscard]] Box3 clipped_box(std::size_t i, const Box3& cell) const override;
    [[nodiscard]] std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const override;
    [[nodiscard]] bool blocks_light(std::size_t i) const override;
    [[nodiscard]] std::span<const RayEnd> ray_ends() const override { return known_ray_ends; }
    /// The box of a shape or an instance in its own frame; not for triangles.
    [[nodiscard]] Box3 inner_box(PrimitiveId id) const;
    /// The placement of a shape or an instance; null: in the frame of the table.
    [[nodiscard]] const Placement* placement_of(PrimitiveId id) const;

    // ---- Ray test: appends the crossings of an analytic shape or a triangle in [ray.t_min,
    // ray.t_max], ascending. Precondition: not an instance.
    void intersect(PrimitiveId id, const Ray& ray, const RayShear& shear, ShapeHits& hits) const;
    /// True if the line of the ray starts inside the primitive. Only for an unbounded analytic
    /// solid.
    [[nodiscard]] bool inside_at_minus_infinity(PrimitiveId id, const Ray& ray) const;

    // ---- Queries on one primitive of any kind; primitives outside `mask` are ignored.

    /// Updates `best` to the nearest hit and shrinks ray.t_max to it.
    template <class Stats>
    void closest(PrimitiveId id, Ray& ray, const RayShear& shear, Hit& best, Stats stats,
                 RayMask mask) const;
    template <class Stats>
    bool occluded(PrimitiveId id, const Ray& ray, const RayShear& shear, Stats stats,
                  RayMask mask) const;
    /// Appends all hits, unsorted.
    template <class Stats>
    void all_hits(PrimitiveId id, const Ray& ray, const RayShear& shear, std::vector<Hit>& hits,
                  Stats stats, RayMask mask) const;
    template <class Stats>
    bool shadowed(PrimitiveId id, const Ray& ray, const RayShear& shear,
                  std::vector<Hit>& crossings, Stats stats, RayMask mask) const;

    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    void collect_masks();
    [[nodiscard]] bool is_opaque_from_front(PrimitiveId id) const;
    /// True if a ray through the triangle leaves on its front: towards a light on that side.
    [[nodiscard]] bool leaves_through_front(PrimitiveId id, const Ray& ray) const;

    std::array<std::uint32_t, kKindCount + 1> first_{};
    std::vector<std::uint8_t> kinds_;         ///< [analytic shape]
    std::vector<std::uint32_t> mesh_starts_;  ///< [mesh] its first triangle, for binary search
    /// Primitives from `first` up to the next entry.
    struct MaskRange {
        std::uint32_t first;
        RayMask visible_to;
    };
    /// Ascending; empty if all primitives are visible to all rays.
    std::vector<MaskRange> masks_;
    RayMask common_mask_ = kAllRays;  ///< bits common to all masks
};

}  // namespace alhazen
