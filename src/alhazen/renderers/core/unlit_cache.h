#pragma once
/// Unlit cache: colours of the materials whose colour depends neither on the point nor on the
/// direction. A hit on one of them needs no surface.
///
/// Conventions: for rays through air; the colour is bit for bit that of shading the surface.
/// Threads: used by one thread.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

class UnlitCache {
  public:
    /// `ambient`: as for `unshadowed_terms`. The scene must outlive the cache.
    UnlitCache(const Scene& scene, std::span<const Rgb> ambient);

    /// The colour of a hit; null if it depends on the surface.
    [[nodiscard]] const Rgb* find(const Hit& hit) {
        if (colors_.empty()) return nullptr;
        if (hit.path.size() > 1) return look_up(hit);
        // Neighbouring rays mostly hit the same few primitives.
        const PrimitiveId around = hit.path.empty() ? kNoPrimitive : hit.path[0];
        Known& known = known_[slot(hit.primitive, around)];
        if (known.primitive != hit.primitive || known.around != around) {
            known = {hit.primitive, around, look_up(hit)};
        }
        return known.color;
    }

  private:
    /// The colour of a primitive inside at most one instance.
    struct Known {
        PrimitiveId primitive = kNoPrimitive, around = kNoPrimitive;
        const Rgb* color = nullptr;
    };
    static constexpr std::size_t kKnown = 256;

    [[nodiscard]] static std::size_t slot(PrimitiveId primitive, PrimitiveId around) {
        const auto mixed =
            static_cast<std::uint32_t>(primitive) + 37 * static_cast<std::uint32_t>(around);
        return mixed % kKnown;
    }
    [[nodiscard]] const Rgb* look_up(const Hit& hit) const;

    const Scene& scene_;
    std::vector<std::optional<Rgb>> colors_;  ///< [material]; empty if no material is unlit
    std::array<Known, kKnown> known_;
};

}  // namespace alhazen
