#pragma once
/// Samples of the materials that are the same at every point, each evaluated once.
///
/// Conventions: for surfaces without vertex colours. The table is small: materials evict each
/// other. Threads: used by one thread.

#include <array>

#include "alhazen/scene/scene.h"

namespace alhazen {

class MaterialCache {
  public:
    /// The scene must outlive the cache and keep its materials.
    explicit MaterialCache(const Scene& scene) : scene_(scene) {}

    /// Null where the material depends on the point. Valid until the next call.
    [[nodiscard]] const MaterialSample* find(MaterialId id) {
        Place& place = places_[static_cast<std::uint32_t>(id) % kPlaces];
        if (place.id != id || !place.used) fill(id, place);
        return place.constant ? &place.sample : nullptr;
    }

  private:
    static constexpr std::size_t kPlaces = 32;
    struct Place {
        MaterialId id{};
        bool used = false, constant = false;
        MaterialSample sample;
    };

    void fill(MaterialId id, Place& place) const;

    const Scene& scene_;
    std::array<Place, kPlaces> places_;
};

}  // namespace alhazen
