#include "alhazen/renderers/core/tinted_media.h"

#include "alhazen/base/inline_vector.h"

namespace alhazen {

namespace {

/// The volume that a surface bounds; a solid of several media is one body.
Body body_of(const Surface& surface) {
    const SurfaceMedia& media = surface.media;
    if (media.known) return {.part = media.solid};
    return {std::uint64_t{surface.instance} << 32 | surface.part,
            static_cast<std::uint32_t>(volume_material(surface))};
}

}  // namespace

Rgb tint_along(const ShadingConventions& conventions, const ShadingPoint& point, bool closed,
               const TintedMedia& media, std::uint32_t around, double t) {
    if (conventions.refraction_tint != ShadingConventions::RefractionTint::PerDistance) {
        return {1, 1, 1};
    }
    const bool in_body = around != TintedMedia::kOutside;
    const bool leaves = point.surface.media.known
                            ? point.surface.media.before.has_value()
                            : !point.entering && !point.medium.is_black() && (closed || !in_body);
    if (leaves && (point.inside || in_body)) {
        return point.medium_is_physical ? Rgb{1, 1, 1} : power(point.medium, t);
    }
    return in_body ? power(media.kt(around), t) : Rgb{1, 1, 1};
}

Crossing cross(const ShadingConventions& conventions, const Surface& surface,
               const MaterialSample& material, const MaterialSample& medium, bool leaving,
               bool closed, double length, CrossedVolumes& volumes) {
    const bool by_distance = !material.physical && !material.transmissive.is_black() &&
                             conventions.shadow_tint == ShadingConventions::ShadowTint::PerDistance;
    Crossing result;
    const bool behind_wall = !leaving && surface.media.before && surface.media.after;
    if (!behind_wall) volumes.forget_left();
    if (conventions.shadow_tint == ShadingConventions::ShadowTint::Opaque) {
        result.surface = {};
    } else if (!by_distance) {
        result.surface = material.transmissive;
    }
    if (medium.physical && medium.thin) return result;
    const Body body = body_of(surface);
    if (by_distance && leaving && (closed || volumes.empty())) {
        result.body = power(medium.transmissive, length);
    } else {
        result.way = volumes.through(length);
    }
    if (!medium.physical && !(by_distance && closed)) return result;
    const Rgb kt = by_distance ? medium.transmissive : Rgb{1, 1, 1};
    if (leaving) {
        volumes.leave(body);
    } else if (behind_wall) {
        volumes.enter_behind_wall(medium.absorption, kt, body);
    } else {
        volumes.enter(medium.absorption, kt, body);
    }
    return result;
}

void start_inside(const ShadingConventions& conventions, const TintedMedia& tinted,
                  const RayMedium& medium, CrossedVolumes& volumes) {
    volumes.clear();
    const bool inside = medium.inside && !medium.hidden;
    const bool tints = medium.medium != TintedMedia::kOutside &&
                       conventions.shadow_tint == ShadingConventions::ShadowTint::PerDistance;
    if (tints) {
        InlineVector<std::uint32_t, 8> outward;  // of more than eight bodies the innermost
        for (std::uint32_t k = medium.medium; k != TintedMedia::kOutside && !outward.full();
             k = tinted.around(k)) {
            outward.push_back(k);
        }
        for (std::size_t k = outward.size(); k-- > 0;) {
            const std::uint32_t m = outward[k];
            if (tinted.is_hidden(m)) continue;
            volumes.enter(inside && k == 0 ? medium.absorption : tinted.absorption(m), tinted.kt(m),
                          tinted.body(m));
        }
    } else if (inside) {
        volumes.enter(medium.absorption);
    }
}

std::uint32_t tinted_medium_behind(const ShadingPoint& point, bool closed, TintedMedia& media,
                                   std::uint32_t around) {
    if (point.material->thin) return around;
    const Surface& surface = point.surface;
    const Body body = body_of(surface);
    if (surface.media.known) {
        if (surface.media.before) around = media.leave(body, around);
        return point.behind.inside
                   ? media.enter(point.behind.kt, point.behind.absorption, body, around)
                   : around;
    }
    if (!closed) return around;
    if (!point.entering) {
        // Where a body is opaque it is left, but only if it was entered elsewhere.
        const bool leaves = !point.medium.is_black() || media.is_in(body, around);
        return leaves ? media.leave(body, around) : around;
    }
    const MaterialSample& material = *point.material;
    const bool physical = surface.volume ? point.medium_is_physical : material.physical;
    const Rgb& kt = surface.volume ? point.medium : material.transmissive;
    return media.enter(physical ? Rgb{1, 1, 1} : kt, material.absorption, body, around);
}

RayMedium medium_behind(const ShadingPoint& point, bool closed, TintedMedia* media,
                        const RayMedium& around) {
    const MaterialSample& material = *point.material;
    const BehindSurface& behind = point.behind;
    // Before the back of an opaque face is no medium of its own, unless its body was entered.
    if (!behind.known && !behind.joined && !point.entering && point.medium.is_black() &&
        (media == nullptr || !media->is_in(body_of(point.surface), around.medium))) {
        return around;
    }
    RayMedium result = around;
    result.hidden = false;
    result.inside = behind.known ? behind.inside : point.entering;
    result.absorption = behind.known     ? behind.absorption
                        : point.entering ? material.absorption
                                         : Rgb{};
    if (media == nullptr) return result;
    result.medium =
        behind.joined ? behind.medium : tinted_medium_behind(point, closed, *media, around.medium);
    // An open surface of Whitted's materials has no inside.
    const bool has_inside = point.surface.media.known || closed || material.physical;
    result.hidden = result.inside && !has_inside;
    // The absorption of a body around, if the ray is in no other.
    const bool in_body = result.medium != TintedMedia::kOutside;
    if (in_body && !(result.inside && has_inside) && !media->absorption(result.medium).is_black()) {
        result.inside = true;
        result.absorption = media->absorption(result.medium);
    }
    return result;
}

}  // namespace alhazen
