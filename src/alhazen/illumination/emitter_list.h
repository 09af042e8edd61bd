#pragma once
/// All emitting surfaces of a scene that can be sampled, numbered, instances expanded; and the
/// number of the one that a ray hit.
///
/// Conventions: a number is the sum, over the levels of instances, of the emitters that the table
/// of the level has before the primitive: no map is needed. A primitive has an emitter for each of
/// its faces or patches; two triangles of a mesh that follow each other and are the halves of a
/// rectangle, of one material that shines evenly and in no instance, have one together. Left out,
/// so that only rays that happen to hit them find their light: what moves, surfaces of constructive
/// solids, what reflected rays do not see, unlit materials, forms without a case in
/// `emitters_of_shape`, and all beyond kMostEmitters. Complexity: O(primitives); a lookup O(depth
/// log emitters). Threads: const functions may be called from many.

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// More are counted, not sampled: they take 250 bytes each.
inline constexpr std::size_t kMostEmitters = std::size_t{1} << 22;

class EmitterList {
  public:
    explicit EmitterList(const Scene& scene);

    [[nodiscard]] std::size_t size() const { return emitters_.size(); }
    /// False: no material of the scene emits. True also where none of its surfaces can be sampled.
    [[nodiscard]] bool may_shine() const { return may_shine_; }
    /// Whether some surface that emits is not among them.
    [[nodiscard]] bool leaves_some_to_chance() const { return leaves_some_; }
    [[nodiscard]] const Emitter& operator[](std::size_t i) const { return emitters_[i]; }
    /// The emitter of a hit; none where it cannot be sampled.
    [[nodiscard]] std::optional<std::size_t> find(const Hit& hit) const;
    /// The radiance that an emitter sends from a point of it against the unit `direction` of a ray
    /// from `from`.
    [[nodiscard]] Rgb radiance(std::size_t emitter, const Vec3& from, const Vec3& direction,
                               double distance, const Vec2& parameters) const;

  private:
    /// The emitters in an aggregate, those of instances included.
    struct Table {
        std::vector<std::uint32_t> primitives;  ///< that have some, ascending
        std::vector<std::uint32_t> before;      ///< [of primitives] emitters of all before, of the
                                                ///< second half of a rectangle but one; and all
        [[nodiscard]] std::uint32_t count() const { return before.back(); }
    };

    const Table& count(const Aggregate& aggregate);
    void expand(const Aggregate& aggregate, const Affine& world_from_table);
    void expand_primitive(const PrimitiveTable& table, PrimitiveId id,
                          const Affine& world_from_table);
    /// The last emitter, the first half of a rectangle, becomes all of it.
    void join_half(const PrimitiveTable& table, PrimitiveId first, PrimitiveId second);
    [[nodiscard]] bool emits(const Material& material) const;
    [[nodiscard]] bool varies(const Material& material) const;
    [[nodiscard]] bool shines(const PrimitiveTable& table, PrimitiveId id) const;
    /// Whether the triangle may be half of a rectangle: it shines evenly.
    [[nodiscard]] bool may_be_half(const PrimitiveTable& table, PrimitiveId id) const;
    [[nodiscard]] std::uint32_t emitters_of(const PrimitiveTable& table, PrimitiveId id);
    [[nodiscard]] Hit hit_of(std::size_t emitter, const Ray& ray, double distance,
                             const Vec2& parameters) const;
    [[nodiscard]] Rgb mean_radiance(std::size_t emitter) const;

    const Scene& scene_;
    std::map<const Aggregate*, Table> tables_;
    bool may_shine_ = false, leaves_some_ = false;
    std::vector<Emitter> emitters_;
    std::vector<bool> varying_;  ///< [emitter] its radiance is not the same everywhere
};

}  // namespace alhazen
