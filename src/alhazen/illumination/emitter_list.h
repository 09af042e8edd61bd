#pragma once
/// The emitting surfaces of a scene that can be sampled, numbered, with instances expanded; finds
/// the number of the emitter that a ray hit.
///
/// Conventions: a number is the sum, over the levels of instances, of the emitters before the
/// primitive in the table of the level. A primitive has an emitter for each of its faces or
/// patches. Two successive triangles of a mesh that are the halves of a rectangle share an emitter,
/// if their radiance is constant and they are in no instance. Not included, so that their light is
/// found only by rays that hit them: moving surfaces, surfaces of constructive solids, surfaces
/// invisible to reflected rays, unlit materials, forms without a case in `emitters_of_shape`, and
/// all beyond kMostEmitters.
/// Complexity: O(primitives); a lookup O(depth). Threads: const functions may be
/// called from many.

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Largest number of emitters that are sampled; each takes 328 bytes, and 128 more (area_lanes.h).
inline constexpr std::size_t kMostEmitters = std::size_t{1} << 22;

class EmitterList {
  public:
    explicit EmitterList(const Scene& scene);

    [[nodiscard]] std::size_t size() const { return emitters_.size(); }
    /// True if a material of the scene emits, whether or not its surfaces can be sampled.
    [[nodiscard]] bool may_shine() const { return may_shine_; }
    /// True if some emitting surface is not included.
    [[nodiscard]] bool has_unsampled_emitters() const { return has_unsampled_; }
    [[nodiscard]] const Emitter& operator[](std::size_t i) const { return emitters_[i]; }
    /// The emitter of a hit; none if it is not included.
    [[nodiscard]] std::optional<std::size_t> find(const Hit& hit) const;
    /// Calls `prefer_area` for all emitters.
    void prefer_area() {
        for (Emitter& e : emitters_) alhazen::prefer_area(e);
    }
    /// A bound of the rounding of the points of an emitter, in world space and in the frames that
    /// hold it, and of the tests that find them, times the margin of LeavingRays.
    [[nodiscard]] double rounding(std::size_t i) const {
        return std::max(rounding_within(bounds_of(emitters_[i]).box), rounding_in_frames_[i]);
    }
    /// The radiance of an emitter along a ray from `from` with unit `direction` that hits it at
    /// `distance`.
    [[nodiscard]] Rgb radiance(std::size_t emitter, const Vec3& from, const Vec3& direction,
                               double distance, const Vec2& parameters) const;
    /// A ray that leaves an emitter, and the radiance along it.
    struct Start {
        Ray ray;
        Rgb radiance;
    };
    /// The ray that leaves a point of an emitter along a unit direction, outside of the error bound
    /// of the surface (LeavingRays).
    [[nodiscard]] Start start(std::size_t emitter, const EmitterPoint& p,
                              const Vec3& direction) const;
    /// The radiance of an emitter, if it is the same everywhere; else null.
    [[nodiscard]] const Rgb* constant_radiance(std::size_t emitter) const {
        return varying_[emitter] ? nullptr : &emitters_[emitter].radiance;
    }

  private:
    /// The emitters in an aggregate, those of its instances included.
    struct Table {
        std::vector<std::uint32_t> primitives;  ///< primitives with emitters, ascending
        std::vector<std::uint32_t> before;      ///< [index in primitives] emitters before it (equal
                                                ///< for halves of a rectangle); then the total
        /// [id / kBlock] Index of the first of `primitives` that is not less than the first id of
        /// the block; then their number.
        std::vector<std::uint32_t> of_block;
        static constexpr std::uint32_t kBlock = 64;

        void set_blocks();
        /// The index of a primitive; none if it has no emitters.
        [[nodiscard]] std::optional<std::size_t> index_of(PrimitiveId id) const;
        [[nodiscard]] std::uint32_t count() const { return before.back(); }
    };

    const Table& count(const Aggregate& aggregate);
    /// What holds a table: `frames` are its own and those around it, outermost first, without that
    /// of the world; `seen_by`: the rays that see it.
    struct Holder {
        std::vector<Affine> frames;
        RayMask seen_by = kAllRays;

        [[nodiscard]] Affine world_from_table() const {
            return frames.empty() ? Affine{} : frames.back();
        }
    };
    /// Appends the emitters of an aggregate.
    void expand(const Aggregate& aggregate, const Holder& holder);
    void expand_primitive(const PrimitiveTable& table, PrimitiveId id, const Holder& holder);
    /// Sets `rounding_in_frames_` of the emitters from `first` on, those of a primitive.
    void set_rounding(const PrimitiveTable& table, PrimitiveId id, const Holder& holder,
                      std::size_t first);
    /// Replaces the last emitter, the first half of a rectangle, by the whole rectangle.
    void join_half(const PrimitiveTable& table, PrimitiveId first, PrimitiveId second);
    [[nodiscard]] bool emits(const Material& material) const;
    [[nodiscard]] bool varies(const Material& material) const;
    [[nodiscard]] bool emits(const PrimitiveTable& table, PrimitiveId id) const;
    /// True if the triangle may be half of a rectangle: its radiance is constant.
    [[nodiscard]] bool may_be_half(const PrimitiveTable& table, PrimitiveId id) const;
    [[nodiscard]] std::uint32_t emitters_of(const PrimitiveTable& table, PrimitiveId id);
    /// None if the ray passes beside the emitter.
    [[nodiscard]] std::optional<Hit> hit_of(std::size_t emitter, const Ray& ray, double distance,
                                            const Vec2& parameters) const;
    [[nodiscard]] Rgb mean_radiance(std::size_t emitter) const;

    const Scene& scene_;
    std::map<const Aggregate*, Table> tables_;
    bool may_shine_ = false, has_unsampled_ = false;
    std::vector<Emitter> emitters_;
    std::vector<bool> varying_;               ///< [emitter] its radiance is not constant
    std::vector<bool> has_area_;              ///< [emitter] its area is above 0
    std::vector<double> rounding_in_frames_;  ///< [emitter] but for world space
};

}  // namespace alhazen
