#pragma once
/// Finds the known end (light) at which a ray ends.
///
/// Conventions: a ray ends at a light if its line passes within `margin` of the light and it
/// extends behind it by at most that distance. Lights at infinity are ignored.

#include <cmath>
#include <optional>
#include <vector>

#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/padded_box.h"

namespace alhazen {

class RayEndFinder {
  public:
    RayEndFinder() = default;
    /// Uses the first `most` ends that are near enough to the primitives for double precision.
    RayEndFinder(const BoundsSource& source, const PaddedBox& space, std::size_t most)
        : margin_(space.pad) {
        for (const RayEnd& end : source.ray_ends()) {
            const bool near = max_component(abs(end.place)) <= 0x1p40 * space.pad;
            if (!end.at_infinity && near && places_.size() < most) places_.push_back(end.place);
        }
    }

    [[nodiscard]] const std::vector<Vec3>& places() const { return places_; }
    /// Maximum distance of a ray from its end.
    [[nodiscard]] double margin() const { return margin_; }

    struct Found {
        std::size_t end;
        double start, stop;  ///< distances of both ends of the ray from the light
    };
    [[nodiscard]] std::optional<Found> find(const Ray& ray) const {
        // Scaled, so that squares neither overflow nor underflow.
        const double scale = max_component(abs(ray.direction));
        const Vec3 d = ray.direction / scale;
        const double length2 = dot(d, d);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Vec3 to_end = places_[i] - ray.origin;
            const double t = dot(to_end, d) / length2;
            if (!(max_component(abs(to_end - t * d)) <= 0.5 * margin_)) continue;
            const double length = std::sqrt(length2);
            const double start = (t - ray.t_min * scale) * length;
            const double stop = (t - ray.t_max * scale) * length;
            if (start > 4 * margin_ && stop >= -margin_) return Found{i, start, stop};
        }
        return std::nullopt;
    }
    /// The same for any-hit and any-blocker queries; empty for other queries.
    template <class Visitor>
    [[nodiscard]] std::optional<Found> find_for(const Ray& ray, const Visitor& visitor) const {
        const AsksFor asked = asks_for(visitor);
        if (asked != AsksFor::AnyHit && asked != AsksFor::AnyBlocker) return std::nullopt;
        return find(ray);
    }

  private:
    std::vector<Vec3> places_;
    double margin_ = 0;
};

}  // namespace alhazen
