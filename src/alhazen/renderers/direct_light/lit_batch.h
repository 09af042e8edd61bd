#pragma once
/// Lit batch: the light of hits on exact solids of opaque materials without textures, sixteen at a
/// time in lanes.
///
/// Conventions: for eye rays through air, and renderers without shadows; radiance is bit for bit
/// that of `unhindered_light`. Hits that lanes do not cover are left to the caller.
/// Threads: used by one thread.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/primitives/surface_group.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/direct_light/lit_lanes.h"

namespace alhazen {

class LitBatch {
  public:
    /// `ambient`: as for `unshadowed_terms`. The scene must outlive the batch.
    LitBatch(const Scene& scene, std::span<const Rgb> ambient);
    LitBatch(const LitBatch&) = delete;  // points into itself
    LitBatch& operator=(const LitBatch&) = delete;

    /// Takes the hit of ray k, which is unit and stays valid until `finish`, to add its light to
    /// `radiance[k]`. False if lanes do not cover it.
    bool take(std::size_t k, const Ray& ray, const Hit& hit, std::span<Rgb> radiance) {
        if (!any_ || hit.part != 0) return false;
        if (hit.path.empty() ? hit.primitive >= first_triangle_ : hit.path.size() > 1) return false;
        const Known& known = look_up(hit);
        if (known.material == nullptr) return false;
        Group* group = last_of_kind_[static_cast<std::size_t>(known.source.kind)];
        if (!group->surfaces.takes(known.source)) group = &group_for(known.source, radiance);
        const std::size_t lane = group->surfaces.add(known.source, ray, hit);
        group->lanes.set(lane, ray, known.source.turned, *known.material);
        group->number[lane] = static_cast<std::uint32_t>(k);
        group->primitive[lane] = known.primitive;
        group->around[lane] = known.around;
        if (group->surfaces.full()) shade(*group, radiance);
        return true;
    }
    /// Adds the light of all hits taken.
    void finish(std::span<Rgb> radiance) {
        for (Group& group : groups_) {
            if (!group.surfaces.empty()) shade(group, radiance);
        }
    }

  private:
    /// A primitive inside at most one instance.
    struct alignas(64) Known {
        PrimitiveId primitive = kNoPrimitive, around = kNoPrimitive;
        const LitMaterial* material = nullptr;  ///< null: not in lanes
        SurfaceSource source;
    };
    struct Group {
        SurfaceGroup surfaces;
        LitLanes lanes;
        std::uint32_t number[kSurfaceLanes];  ///< of the ray
        PrimitiveId primitive[kSurfaceLanes], around[kSurfaceLanes];
    };
    static constexpr std::size_t kKnown = 1024, kGroups = 4;

    [[nodiscard]] const Known& look_up(const Hit& hit) {
        const PrimitiveId around = hit.path.empty() ? kNoPrimitive : hit.path[0];
        const auto mixed =
            static_cast<std::uint32_t>(hit.primitive) + 37 * static_cast<std::uint32_t>(around);
        Known& known = known_[mixed % kKnown];
        if (known.primitive != hit.primitive || known.around != around) learn(hit, around, known);
        return known;
    }
    void learn(const Hit& hit, PrimitiveId around, Known& known) const;
    /// A group that takes hits of the source, from now on the last one of its kind.
    [[nodiscard]] Group& group_for(const SurfaceSource& source, std::span<Rgb> radiance);
    void shade(Group& group, std::span<Rgb> radiance);
    [[nodiscard]] Rgb shade_alone(const Group& group, std::size_t lane);

    const Scene& scene_;
    const std::span<const Rgb> ambient_;
    bool any_ = false;
    PrimitiveId first_triangle_{};        ///< of the outermost aggregate
    std::vector<LitMaterial> materials_;  ///< [material]
    std::vector<const Light*> lights_;    ///< those that illuminate
    std::vector<Known> known_;
    std::array<Group, kGroups> groups_;
    Group* last_of_kind_[SurfaceSource::kKinds];
    std::size_t next_ = 0;  ///< the group that is shaded first if none takes a hit
    MaterialCache constant_;
    ShadingPoint alone_;
};

}  // namespace alhazen
