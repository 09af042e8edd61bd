#pragma once
/// A CSG solid as an aggregate: its hits are the points at which a ray alternately enters and
/// leaves the solid.
///
/// Conventions: those of `Aggregate`; the primitive of a hit is the one whose surface is visible;
/// the surface of a subtracted primitive is reversed (`complete`). All evaluators (csg_evaluator.h)
/// give the same hits.
/// Threads: const functions may be called from many threads.

#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

class CsgAggregate final : public SolidAggregate {
  public:
    /// Throws Error: Usage for an unknown evaluator, Resource for too many leaves.
    CsgAggregate(PrimitiveTable table, CsgExpression expression, const std::string& evaluator);

    [[nodiscard]] const CsgSolid& solid() const { return solid_; }

    [[nodiscard]] const PrimitiveTable& primitives() const override { return solid_.table(); }
    [[nodiscard]] Box3 box() const override;
    [[nodiscard]] BoundingSphere sphere() const override { return sphere_; }
    [[nodiscard]] std::size_t memory_bytes() const override;
    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override;
    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override;
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override;
    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override;
    [[nodiscard]] const LaneSolid* lane_solid() const override { return evaluator_->lane_solid(); }
    [[nodiscard]] bool inside_at_minus_infinity(const Ray& ray) const override;
    void complete(const Ray& ray, double t, PrimitiveId primitive, Surface& surface) const override;
    [[nodiscard]] bool completes_surfaces() const override { return true; }
    [[nodiscard]] bool changes_materials() const override {
        return solid_.has_media() || !shows_minuend_.empty() || !solid_.wall_materials().empty();
    }
    [[nodiscard]] bool turns_normal(PrimitiveId primitive) const override {
        return turned_[static_cast<std::size_t>(primitive)];
    }

  private:
    /// The media on both sides of a hit, and the visible material if it is not the primitive's own.
    struct Look {
        SurfaceMedia media;
        std::optional<MaterialId> material;
    };
    [[nodiscard]] Look look(const CsgRay& ray, double t, PrimitiveId primitive) const;
    /// States the volume behind a cut wall, if it is not of the wall's material.
    void set_volume(Surface& surface) const;
    [[nodiscard]] Opacity opacity(const CsgRay& ray, const Hit& hit) const;

    [[nodiscard]] BoundingSphere find_sphere() const;

    CsgSolid solid_;
    std::uint64_t number_ = 0;  ///< SurfaceMedia::solid
    BoundingSphere sphere_;
    std::unique_ptr<const CsgEvaluator> evaluator_;
    std::vector<bool> shows_minuend_;  ///< [primitive]; empty: false for all
    std::vector<bool> cuts_;           ///< [primitive] CsgSolid::cuts_walls; empty: none does
    std::vector<bool> turned_;         ///< [primitive] true if its normal points into the solid
};

}  // namespace alhazen
