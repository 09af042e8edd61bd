#pragma once
/// Attenuation along a distance: by absorption, and in bodies whose kt is the transmittance of a
/// unit of length.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", 1980 (kt); Beer,
/// "Bestimmung der Absorption des rothen Lichts in farbigen Fluessigkeiten", 1852.
/// Differs: kt acts by the way inside the innermost closed body; open surfaces have no inside.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/ray_medium.h"

namespace alhazen {

/// Beer's law: exp(-absorption * distance). A channel without absorption has 1 even at infinite
/// distance.
[[nodiscard]] inline Rgb transmittance(const Rgb& absorption, double distance) {
    const auto of = [&](double a) { return a > 0.0 ? std::exp(-a * distance) : 1.0; };
    return {of(absorption.r), of(absorption.g), of(absorption.b)};
}

[[nodiscard]] inline Rgb transmittance_to_infinity(const Rgb& absorption) {
    return transmittance(absorption, std::numeric_limits<double>::infinity());
}

[[nodiscard]] inline Rgb power(const Rgb& base, double exponent) {
    return {std::pow(base.r, exponent), std::pow(base.g, exponent), std::pow(base.b, exponent)};
}

/// Identifies the volume that a surface bounds. The faces of a solid of one medium belong to
/// several parts: a volume whose part is not around a ray is the innermost one of its material.
struct Body {
    static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};
    static constexpr std::uint32_t kSeveral = ~std::uint32_t{0};
    std::uint64_t part = kNowhere;      ///< or a solid of several media; kNowhere: not known
    std::uint32_t material = kSeveral;  ///< kSeveral: of several media, or not known

    [[nodiscard]] bool is_unknown() const { return part == kNowhere; }
    /// Whether they have one medium, the same.
    [[nodiscard]] bool is_alike(const Body& other) const {
        return material != kSeveral && material == other.material;
    }
};

/// The volumes around a ray that passes surfaces without bending, innermost last.
class CrossedVolumes {
  public:
    void clear() {
        volumes_.clear();
        left_.reset();
    }
    [[nodiscard]] bool empty() const { return volumes_.empty(); }
    /// `kt`: transmittance of a unit of length, in addition to the absorption.
    void enter(const Rgb& absorption, const Rgb& kt = {1, 1, 1}, const Body& body = {}) {
        volumes_.push_back({absorption, kt, body});
    }
    /// Leaves the body; if it is not around the ray, the innermost volume of its material, or that
    /// in which the ray began, if it is not known, else the innermost of all.
    void leave(const Body& body) {
        left_ = place_of(body);
        if (left_) volumes_.erase(volumes_.begin() + static_cast<std::ptrdiff_t>(*left_));
    }
    /// At a wall of a body: its next medium is in the place of the one that was left there.
    void enter_behind_wall(const Rgb& absorption, const Rgb& kt, const Body& body) {
        const std::size_t place = left_.value_or(volumes_.size());
        volumes_.insert(volumes_.begin() + static_cast<std::ptrdiff_t>(place),
                        {absorption, kt, body});
        left_.reset();
    }
    /// Until `leave`, no volume is one that was left.
    void forget_left() { left_.reset(); }
    /// The transmittance of the innermost volume; white outside.
    [[nodiscard]] Rgb through(double distance) const {
        if (volumes_.empty()) return {1, 1, 1};
        const Volume& innermost = volumes_.back();
        const Rgb tint = transmittance(innermost.absorption, distance);
        return innermost.kt == Rgb{1, 1, 1} ? tint : tint * power(innermost.kt, distance);
    }

  private:
    struct Volume {
        Rgb absorption, kt;
        Body body;
    };
    /// The volume that `leave` removes.
    [[nodiscard]] std::optional<std::size_t> place_of(const Body& body) const {
        if (volumes_.empty()) return {};
        const auto last = [&](const auto& is_it) {
            std::size_t k = volumes_.size();
            while (k > 0 && !is_it(volumes_[k - 1].body)) --k;
            return k;  // behind it; 0: none
        };
        std::size_t k = last([&](const Body& b) { return b.part == body.part; });
        if (k == 0) k = last([&](const Body& b) { return b.is_alike(body); });
        if (k == 0) k = last([&](const Body& b) { return b.is_unknown(); });
        return (k > 0 ? k : volumes_.size()) - 1;
    }

    std::vector<Volume> volumes_;
    std::optional<std::size_t> left_;  ///< place of the volume that was left last
};

/// The closed bodies around rays where kt is the transmittance of a unit of length
/// (RefractionTint::PerDistance).
/// Conventions: a medium is a number: 0 is outside all bodies, others identify the body entered
/// last and the medium around it. Bodies may be left in any order. Threads: used by one at a time.
class TintedMedia {
  public:
    static constexpr std::uint32_t kOutside = 0;

    /// `release(mark)` removes all media created since `mark()` returned `mark`.
    [[nodiscard]] std::size_t mark() const { return media_.size(); }
    void release(std::size_t mark) { media_.resize(mark); }

    /// White outside.
    [[nodiscard]] const Rgb& kt(std::uint32_t medium) const { return media_[medium].kt; }
    [[nodiscard]] std::uint32_t around(std::uint32_t medium) const { return media_[medium].around; }
    [[nodiscard]] const Body& body(std::uint32_t medium) const { return media_[medium].body; }
    /// Per unit length, besides kt.
    [[nodiscard]] const Rgb& absorption(std::uint32_t medium) const {
        return media_[medium].absorption;
    }
    /// True if shadow rays do not see the body: they are not tinted by it.
    [[nodiscard]] bool is_hidden(std::uint32_t medium) const { return media_[medium].hidden; }
    void hide(std::uint32_t medium) { media_[medium].hidden = true; }
    /// The medium inside a body of `kt` that lies in the medium `around`.
    [[nodiscard]] std::uint32_t enter(const Rgb& kt, const Rgb& absorption, const Body& body,
                                      std::uint32_t around) {
        media_.push_back({kt, absorption, body, around});
        return static_cast<std::uint32_t>(media_.size() - 1);
    }
    [[nodiscard]] bool is_in(const Body& body, std::uint32_t medium) const {
        while (medium != kOutside && media_[medium].body.part != body.part) {
            medium = media_[medium].around;
        }
        return medium != kOutside;
    }
    /// `medium` without the body, as CrossedVolumes::leave. Volumes inside the body are kept.
    [[nodiscard]] std::uint32_t leave(const Body& body, std::uint32_t medium) {
        for (std::uint32_t k = medium; k != kOutside; k = media_[k].around) {
            if (media_[k].body.part == body.part) return without(k, medium);
        }
        for (std::uint32_t k = medium; k != kOutside; k = media_[k].around) {
            if (media_[k].body.is_alike(body)) return without(k, medium);
        }
        return media_[medium].around;
    }

  private:
    struct Medium {
        Rgb kt{1, 1, 1}, absorption;
        Body body;
        std::uint32_t around = kOutside;
        bool hidden = false;
    };
    std::uint32_t without(std::uint32_t left, std::uint32_t medium) {
        if (medium == left) return media_[left].around;
        Medium kept = media_[medium];
        kept.around = without(left, kept.around);
        media_.push_back(kept);
        return static_cast<std::uint32_t>(media_.size() - 1);
    }

    std::vector<Medium> media_{Medium{}};
};

/// The transmittance by kt^distance of the medium through which a ray of length `t` came, if
/// RefractionTint is PerDistance; white otherwise. `around`: the ray's medium in `media`. A ray
/// that leaves a body has the kt of the surface, any other that of the closed body that it entered.
/// `closed`: the surface bounds a volume (closed_parts_of).
[[nodiscard]] Rgb tint_along(const ShadingConventions& conventions, const ShadingPoint& point,
                             bool closed, const TintedMedia& media, std::uint32_t around, double t);

/// The transmittances of a surface crossed without bending, of the way to it, and of the way inside
/// the body that is left there, where kt acts by distance.
struct Crossing {
    Rgb way{1, 1, 1}, body{1, 1, 1}, surface{1, 1, 1};
};
/// Crosses `surface` of `material`, at which the volume of `medium` is entered or left, `length`
/// behind the last crossing. `closed`: it bounds a volume.
[[nodiscard]] Crossing cross(const ShadingConventions& conventions, const Surface& surface,
                             const MaterialSample& material, const MaterialSample& medium,
                             bool leaving, bool closed, double length, CrossedVolumes& volumes);
/// Sets the volumes around a shadow ray that starts in `medium`, a number of `tinted`.
void start_inside(const ShadingConventions& conventions, const TintedMedia& tinted,
                  const RayMedium& medium, CrossedVolumes& volumes);

/// The medium in `media` of a ray that passes through the surface from the medium `around`.
[[nodiscard]] std::uint32_t tinted_medium_behind(const ShadingPoint& point, bool closed,
                                                 TintedMedia& media, std::uint32_t around);
/// The medium behind a surface that bounds media (bounds_media), of which `around` is before it.
/// `closed`: it bounds a volume. `media`: numbers media; null: the number stays.
[[nodiscard]] RayMedium medium_behind(const ShadingPoint& point, bool closed, TintedMedia* media,
                                      const RayMedium& around);

}  // namespace alhazen
