#pragma once
/// Materials that show one colour wherever and from wherever they are seen: what gives light of its
/// own and sends back none of others', as unlit materials do. Where such a one is hit no surface
/// needs to be found.
///
/// Source: none. Differs: nothing. Conventions: for rays that come through air; the colour is what
/// shading the surface would give, bit for bit. Threads: belongs to one.

#include <optional>
#include <span>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

class FlatLooks {
  public:
    /// `ambient` as `unshadowed_terms` takes it. The scene must outlive it.
    FlatLooks(const Scene& scene, std::span<const Rgb> ambient);

    /// Null where the surface tells more.
    [[nodiscard]] const Rgb* find(const Hit& hit) {
        if (looks_.empty()) return nullptr;
        // Neighbours mostly hit the same.
        return is_last(hit) ? last_look_ : look_up(hit);
    }

  private:
    [[nodiscard]] bool is_last(const Hit& hit) const {
        if (hit.primitive != last_.primitive || hit.path.size() != last_.path.size()) return false;
        for (std::size_t i = 0; i < hit.path.size(); ++i) {
            if (hit.path[i] != last_.path[i]) return false;
        }
        return true;
    }
    const Rgb* look_up(const Hit& hit);

    const Scene& scene_;
    std::vector<std::optional<Rgb>> looks_;  ///< [material]; empty where none is flat
    Hit last_;
    const Rgb* last_look_ = nullptr;
};

}  // namespace alhazen
