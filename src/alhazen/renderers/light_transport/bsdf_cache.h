#pragma once
/// BSDFs of the materials that are constant over their surfaces, each created once.
///
/// Conventions: those of MaterialCache; for colour channels and surfaces without vertex colours.

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

    /// True if replaced BSDFs are kept until `release`.
    [[nodiscard]] bool keeps() const { return keeps_; }
    /// Frees the replaced BSDFs.
    void release() { replaced_.clear(); }
    /// The BSDF of a material; null if it depends on the point or on wavelengths. Valid until the
    /// next call; if replaced BSDFs are kept, until `release`.
    [[nodiscard]] const Bsdf* find(MaterialId id, const BsdfPlace& place) {
        if (place.etas != nullptr || place.waves.is_spectral()) return nullptr;
        Entry& entry = entries_[static_cast<std::uint32_t>(id) % kEntries];
        if (entry.id != id || !entry.used) begin(id, entry);
        if (!entry.constant) return nullptr;
        Side& side = entry.sides[(place.from_inside ? 1 : 0) + (place.mirrored ? 2 : 0)];
        if (!side.made || !(side.eta == place.eta)) make(id, place, side);
        return side.bsdf.get();
    }

  private:
    static constexpr std::size_t kEntries = 32;
    /// The BSDF from outside or from inside the volume that the surface bounds, mirrored or not.
    struct Side {
        double eta = 0;  ///< BsdfPlace::eta
        bool made = false;
        std::unique_ptr<Bsdf> bsdf;  ///< its memory is reused
    };
    struct Entry {
        MaterialId id{};
        bool used = false, constant = false;
        std::array<Side, 4> sides;
    };

    void begin(MaterialId id, Entry& entry) const;
    void make(MaterialId id, const BsdfPlace& place, Side& side);

    const Scene& scene_;
    bool keeps_;
    std::vector<std::unique_ptr<Bsdf>> replaced_;
    std::array<Entry, kEntries> entries_;
};

}  // namespace alhazen
