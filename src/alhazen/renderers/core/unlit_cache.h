#pragma once
/// Materials that show one colour wherever and from wherever they are seen: what gives light of its
/// own and sends back none of others', as unlit materials do. Where such a one is hit no surface
/// needs to be found.
///
/// Source: none. Differs: nothing. Conventions: for rays that come through air; the colour is what
/// shading the surface would give, bit for bit. Threads: belongs to one.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

class UnlitCache {
  public:
    /// `ambient` as `unshadowed_terms` takes it. The scene must outlive it.
    UnlitCache(const Scene& scene, std::span<const Rgb> ambient);

    /// Null where the surface tells more.
    [[nodiscard]] const Rgb* find(const Hit& hit) {
        if (colors_.empty()) return nullptr;
        if (hit.path.size() > 1) return look_up(hit);
        // Neighbours mostly hit the same few.
        const PrimitiveId around = hit.path.empty() ? kNoPrimitive : hit.path[0];
        Known& known = known_[slot(hit.primitive, around)];
        if (known.primitive != hit.primitive || known.around != around) {
            known = {hit.primitive, around, look_up(hit)};
        }
        return known.look;
    }

  private:
    /// The look of a primitive that lies in no more than one instance.
    struct Known {
        PrimitiveId primitive = kNoPrimitive, around = kNoPrimitive;
        const Rgb* look = nullptr;
    };
    static constexpr std::size_t kKnown = 256;

    [[nodiscard]] static std::size_t slot(PrimitiveId primitive, PrimitiveId around) {
        const auto mixed =
            static_cast<std::uint32_t>(primitive) + 37 * static_cast<std::uint32_t>(around);
        return mixed % kKnown;
    }
    [[nodiscard]] const Rgb* look_up(const Hit& hit) const;

    const Scene& scene_;
    std::vector<std::optional<Rgb>> colors_;  ///< [material]; empty where none is flat
    std::array<Known, kKnown> known_;
};

}  // namespace alhazen
