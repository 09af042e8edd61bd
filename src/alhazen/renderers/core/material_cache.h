#pragma once
/// Samples of the materials that are constant over their surfaces, each evaluated once.
///
/// Conventions: for surfaces without vertex colours. The table is small: materials of the same
/// slot evict each other. Threads: used by one thread.

#include <array>

#include "alhazen/scene/scene.h"

namespace alhazen {

class MaterialCache {
  public:
    /// The scene must outlive the cache and keep its materials.
    explicit MaterialCache(const Scene& scene) : scene_(scene) {}

    /// The sample of a material; null if it depends on the point. Valid until the next call.
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
