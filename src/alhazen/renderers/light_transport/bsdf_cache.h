#pragma once
/// BSDFs that are the same at every point of their material, each made once.
///
/// Conventions: those of MaterialCache; of colour channels, for surfaces without vertex colours.

#include <array>
#include <memory>
#include <vector>

#include "alhazen/scene/scene.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

class BsdfCache {
  public:
    /// The scene must outlive the cache and keep its materials.
    explicit BsdfCache(const Scene& scene, bool keeps = false) : scene_(scene), keeps_(keeps) {}

    [[nodiscard]] bool keeps() const { return keeps_; }
    /// Frees what has been replaced.
    void release() { replaced_.clear(); }
    /// Null where it depends on the point, or on wavelengths. Valid until the next call; where the
    /// cache keeps what it replaces, until `release`.
    [[nodiscard]] const Bsdf* find(MaterialId id, const BsdfPlace& place) {
        if (place.etas != nullptr || place.waves.is_spectral()) return nullptr;
        Entry& entry = entries_[static_cast<std::uint32_t>(id) % kEntries];
        if (entry.id != id || !entry.used) begin(id, entry);
        if (!entry.constant) return nullptr;
        Side& side = entry.sides[place.from_inside ? 1 : 0];
        if (!side.made || !(side.eta == place.eta)) make(id, place, side);
        return side.bsdf.get();
    }

  private:
    static constexpr std::size_t kEntries = 32;
    /// From outside of the volume that the surface bounds, or from inside.
    struct Side {
        double eta = 0;  ///< BsdfPlace::eta
        bool made = false;
        std::unique_ptr<Bsdf> bsdf;  ///< its room is kept
    };
    struct Entry {
        MaterialId id{};
        bool used = false, constant = false;
        std::array<Side, 2> sides;
    };

    void begin(MaterialId id, Entry& entry) const;
    void make(MaterialId id, const BsdfPlace& place, Side& side);

    const Scene& scene_;
    bool keeps_;
    std::vector<std::unique_ptr<Bsdf>> replaced_;
    std::array<Entry, kEntries> entries_;
};

}  // namespace alhazen
