#pragma once
/// An aggregate of primitives that move while the shutter is open, and of one aggregate of all
/// primitives at rest.
///
/// Conventions: those of Aggregate; RayQuery::time is the time of a ray. The table holds meshes
/// with moving vertices, instances that move or contain moving primitives, and all primitives at
/// rest as one instance without a placement. Bounds of the table are those when the shutter opens;
/// the bounds of the aggregate hold at every time.
/// Differs: every aggregate that contains moving primitives is a MotionAggregate; others need no
/// time.

#include <memory>
#include <optional>

#include "alhazen/accel/motion/motion_bvh.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class MotionAggregate final : public Aggregate {
  public:
    /// `table`: finished; `resting`: index of the instance at rest, if there is one.
    MotionAggregate(PrimitiveTable table, std::optional<std::size_t> resting);

    [[nodiscard]] const PrimitiveTable& primitives() const override { return table_; }
    [[nodiscard]] Box3 box() const override { return box_.swept(); }
    [[nodiscard]] MovingBox moving_box() const override { return box_; }
    [[nodiscard]] std::size_t memory_bytes() const override { return tree_.memory_bytes(); }

    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override;
    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override;
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override;
    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override;
    void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                       Coherence coherence) const override;
    void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                        Coherence coherence) const override;
    void closest_batch_at(std::span<const Ray> rays, std::span<const float> times,
                          std::span<Hit> hits, RayQuery query, Coherence coherence) const override;
    void occluded_batch_at(std::span<const Ray> rays, std::span<const float> times,
                           std::span<bool> occluded, RayQuery query,
                           Coherence coherence) const override;

  private:
    /// A motion at constant speed along a line, without rotation or scaling: its translations at
    /// both ends.
    struct Slide {
        Vec3 from, to;
    };
    /// The data of an instance for the leaves of the tree.
    struct Mover {
        std::optional<Slide> slide;  ///< its motion, if it is a slide
        /// Its content, if that is a single sphere without a placement, visible to all rays.
        std::optional<Sphere> ball;
        const PrimitiveTable* lone = nullptr;  ///< table of its content, if that is a single shape
    };

    [[nodiscard]] MovingBox box_of(std::uint32_t primitive) const;
    [[nodiscard]] static Mover mover_of(const Instance& instance);
    [[nodiscard]] static std::optional<Slide> slide_of(const TransformMotion& motion,
                                                       const Box3& inner);
    /// The ray in the frame of an instance.
    [[nodiscard]] Ray inner_ray_of(std::size_t instance, const Ray& ray, double time) const;
    /// The instance at rest, which must exist.
    [[nodiscard]] const Instance& resting_instance() const;
    [[nodiscard]] bool is_triangle(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) < table_.first(kInstanceKind);
    }
    [[nodiscard]] bool hits_triangle(PrimitiveId id, const Ray& ray, const RayShear& shear,
                                     float time, ShapeHit& hit) const;
    [[nodiscard]] PrimitiveTable::ShadowEffect effect_of(PrimitiveId id, const Ray& ray,
                                                         float time) const;
    void closest_moving(const Ray& ray, Hit& hit, RayQuery query) const;
    [[nodiscard]] bool occluded_by_moving(const Ray& ray, RayQuery query) const;
    /// The nearest hit in an instance; `ray` is in its frame.
    bool closest_in(std::size_t instance, const Ray& ray, Hit& hit, RayQuery query) const;
    [[nodiscard]] bool occluded_in(std::size_t instance, const Ray& ray, RayQuery query) const;
    /// Calls `on_triangle(id, shape_hit)` for moving triangles and `on_instance(id, index,
    /// inner_ray)` for instances that the ray may hit, until a call returns true.
    template <MotionBvh::Order kOrder, class Reach, class OnTriangle, class OnInstance>
    void visit(const Ray& ray, RayQuery query, Reach&& t_max, OnTriangle&& on_triangle,
               OnInstance&& on_instance) const;

    PrimitiveTable table_;
    std::vector<Mover> movers_;  ///< [instance]
    std::optional<PrimitiveId> resting_;
    bool rests_alone_ = false;  ///< a single shape is at rest, which has no SIMD test
    MovingBox box_;
    MotionBvh tree_;
};

}  // namespace alhazen
