#pragma once
/// A clear coat whose normal is not that of the layers below: with a normal map below it that is
/// not its own, or a map of its own.
///
/// Conventions: those of ScatterPoint. The coat reflects on the side of the view only; it is on top
/// of all other layers, and attenuates all of them alike. Its normal is the one that the eye sees.

#include <optional>

#include "alhazen/renderers/light_transport/shading_frame.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

/// Directions of a scattering in the frame of the viewer of a path.
struct LocalDirections {
    Vec3 view, direction;
};

class TiltedCoat {
  public:
    /// The normals of a point: geometric, on the side of the view; interpolated; of the coat.
    struct Normals {
        Vec3 geometric, shading, mapped;
    };
    TiltedCoat(const CoatLayer& layer, const Normals& normals, const Vec3& tangent,
               const Vec3& view);

    /// BSDF times cosine for light from `direction`; black below the surface.
    [[nodiscard]] Spectrum value(const Vec3& direction) const;
    /// For an eye in `direction`: BSDF times the cosine of the view.
    [[nodiscard]] Spectrum value_seen_from(const Vec3& direction) const;
    /// Share of light that the layers below scatter to the view, or to an eye in `direction`.
    [[nodiscard]] double through() const { return layer_.cover.transmittance(local_view_); }
    [[nodiscard]] double through_to(const Vec3& direction) const {
        return layer_.cover.transmittance(seen_from(direction).direction);
    }
    [[nodiscard]] double density(const Vec3& direction) const;
    /// Of sampling the view for an eye in `direction`.
    [[nodiscard]] double reverse_density(const Vec3& direction) const;
    /// Probability of sampling the coat, where `below` is the largest channel of the albedo of the
    /// layers below; for the view, or for an eye in `direction`.
    [[nodiscard]] double share(double below) const;
    [[nodiscard]] double share_seen_from(const Vec3& direction, double below) const;

    struct Sample {
        Vec3 direction;
        BsdfSample drawn;  ///< its direction is local
    };
    /// A reflected direction above the surface.
    [[nodiscard]] std::optional<Sample> sample(double choice, const Vec2& u) const;
    /// True if `direction` is that of the mirrored view, of a smooth coat.
    [[nodiscard]] bool mirrors_to(const Vec3& direction) const;
    [[nodiscard]] PlaneMueller polarization(const Vec3& direction, bool singular) const {
        return layer_.bsdf.polarization(local_view_, frame_.to_local(direction), singular);
    }
    /// True if the view sees another normal than the surface has: paths from other sides may see
    /// yet another.
    [[nodiscard]] bool turned() const { return turned_; }
    [[nodiscard]] bool has_density() const { return layer_.bsdf.has_density(); }

  private:
    [[nodiscard]] bool is_above(const Vec3& direction) const {
        return dot(direction, normals_.geometric) > 0.0;
    }
    [[nodiscard]] LocalDirections seen_from(const Vec3& direction) const;

    CoatLayer layer_;
    Normals normals_;
    Vec3 tangent_, view_, local_view_;
    ShadingFrame frame_;
    bool turned_ = false;
};

}  // namespace alhazen
