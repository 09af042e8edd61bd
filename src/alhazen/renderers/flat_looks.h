#pragma once
/// Materials that show one colour wherever and from wherever they are seen: what gives light of its
/// own and sends back none of others', as unlit materials do. Where such a one is hit no surface
/// needs to be found.
///
/// Source: none. Differs: nothing. Conventions: for rays that come through air; the colour is what
/// shading the surface would give, bit for bit. Threads: const functions may be called from many
/// threads.

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
    [[nodiscard]] const Rgb* find(const Hit& hit) const;

  private:
    const Scene& scene_;
    std::vector<std::optional<Rgb>> looks_;  ///< [material]; empty where none is flat
};

}  // namespace alhazen
