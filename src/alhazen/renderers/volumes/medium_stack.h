#pragma once
/// The volumes around the end of a path, innermost last.
///
/// Conventions: a volume is identified by the part that bounds it, so that overlapping volumes may
/// be left in any order. Leaving a part that was not entered leaves the innermost volume of its
/// material: a boundary may consist of several parts. A solid of several media is one volume, whose
/// medium changes at its walls. Beyond kMost volumes around a point, the outermost are dropped. A
/// ray begins in no volume whose part it does not see, if it leaves an eye or a light or goes to
/// one; other rays are in all volumes that their path has entered and not left.

#include <cstdint>

#include "alhazen/base/inline_vector.h"
#include "alhazen/base/unmade.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

/// The identity of a placed part.
[[nodiscard]] inline std::uint64_t part_number(const HitParts& parts) {
    return std::uint64_t{parts.instance} << 32 | parts.part;
}

struct Medium {
    std::uint64_t part = 0;  ///< that bounds it (volume_number)
    double index = 1;
    Rgb absorption;  ///< per unit length: transmittance is exp(-absorption * length)
    std::uint32_t material = 0;
    RayMask seen_by = kAllRays;  ///< the part
};

class MediumStack {
  public:
    static constexpr std::size_t kMost = 8;

    /// Not defaulted: that would zero the storage first.
    MediumStack() {}  // NOLINT(modernize-use-equals-default)

    [[nodiscard]] bool empty() const { return media_.empty(); }
    [[nodiscard]] std::size_t size() const { return media_.size(); }
    /// Outermost first.
    [[nodiscard]] const Medium& operator[](std::size_t i) const { return media_[i].value; }
    /// The innermost volume; null outside all volumes.
    [[nodiscard]] const Medium* here() const {
        return media_.empty() ? nullptr : &media_.back().value;
    }
    /// The innermost volume after `volume` is left; null outside all volumes.
    [[nodiscard]] const Medium* without(const Medium& volume) const {
        const std::size_t left = place_of(volume);
        for (std::size_t i = media_.size(); i-- > 0;) {
            if (i != left) return &media_[i].value;
        }
        return nullptr;
    }
    /// The innermost volume, where `volume` is left and is another one around it; else null.
    [[nodiscard]] const Medium* within(const Medium& volume) const {
        return place_of(volume) + 1 < media_.size() ? here() : nullptr;
    }
    void enter(const Medium& medium) {
        if (media_.full()) remove(0);
        media_.push_back(medium);
    }
    /// Adds the volumes of `other` that `known` lacks (by part and by material) as outermost ones.
    void surround(const MediumStack& other, const MediumStack& known) {
        MediumStack all;
        for (const Unmade<Medium>& m : other.media_) {
            if (known.place_of(m.value) == known.media_.size()) all.enter(m.value);
        }
        if (all.empty()) return;
        for (const Unmade<Medium>& m : media_) all.enter(m.value);
        *this = all;
    }
    /// Does nothing if the volume was not entered.
    void leave(const Medium& volume) {
        if (const std::size_t i = place_of(volume); i < media_.size()) remove(i);
    }
    /// Removes all volumes whose parts rays of `mask` do not see.
    void keep_seen_by(RayMask mask) {
        for (std::size_t i = media_.size(); i-- > 0;) {
            if ((media_[i].value.seen_by & mask) == 0) remove(i);
        }
    }
    /// The volume of the part has that medium from now on; it is entered if it was not.
    void change(const Medium& medium) {
        const std::size_t i = place_of_part(medium);
        if (i == media_.size()) return enter(medium);
        media_[i] = medium;
    }

  private:
    [[nodiscard]] std::size_t place_of_part(const Medium& volume) const {
        for (std::size_t i = media_.size(); i-- > 0;) {
            if (media_[i].value.part == volume.part) return i;
        }
        return media_.size();
    }
    [[nodiscard]] std::size_t place_of(const Medium& volume) const {
        if (const std::size_t i = place_of_part(volume); i < media_.size()) return i;
        for (std::size_t i = media_.size(); i-- > 0;) {
            if (media_[i].value.material == volume.material) return i;
        }
        return media_.size();
    }
    void remove(std::size_t i) {
        for (; i + 1 < media_.size(); ++i) media_[i] = media_[i + 1];
        media_.pop_back();
    }

    InlineVector<Unmade<Medium>, kMost> media_;
};

}  // namespace alhazen
