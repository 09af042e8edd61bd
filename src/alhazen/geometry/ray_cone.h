#pragma once
/// The cone of a ray: the width of its pixel's footprint.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984; Akenine-Möller, Crassin, Boksansky,
/// Belcour, Panteleev and Wright, "Improved Shader and Texture Level of Detail Using Ray Cones",
/// JCGT 10(1), 2021.
/// Differs: surfaces are treated as flat: a reflected or refracted cone keeps its spread, so images
/// in a curved mirror may be filtered too little (convex) or too much (concave). The spread is that
/// of the centre of the image.
/// Conventions: `width` is the diameter across the ray at its origin, in scene units; `spread` is
/// its growth per unit length along a ray of unit direction. If both are zero the ray is a line,
/// and textures are not filtered.

namespace alhazen {

struct RayCone {
    double width = 0, spread = 0;

    [[nodiscard]] double width_at(double t) const { return width + spread * t; }
    /// The cone that continues from the point at `t`.
    [[nodiscard]] RayCone from(double t) const { return {width_at(t), spread}; }
};

}  // namespace alhazen
