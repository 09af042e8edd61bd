#pragma once
/// The tree of rays of one sample of a pixel, with every term of the shading equation at every
/// surface.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, Fig. 3
/// (the tree of rays).
/// Differs: recorded from the renderer while it traces (ray_tree_recorder.h), not computed again.
/// Conventions: radiance of a ray = sum over its surfaces of share * color + left * background;
///   color = (emission + sum of the ambient terms + sum over the lights of through * intensity *
///   (diffuse + highlight) + kr * reflected + kt * refracted), times `filter` if `filtered`.
/// `radiance_of` computes it in the order of the renderer, bit-identically.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// The terms of a light at a surface.
struct LightTerm {
    std::size_t light = 0;   ///< index in Scene::lights
    double cosine = 0;       ///< N.L, positive
    Rgb intensity;           ///< arriving if unshadowed, attenuation included
    Rgb diffuse, highlight;  ///< kd (N.L), and ks times the highlight
    Rgb through{1, 1, 1};    ///< fraction transmitted between the light and the point
    /// False: the conventions cast no shadow rays, or no light arrives.
    bool cast = true;
    Ray shadow;  ///< from the surface to the light
    /// Surfaces between the point and the light, nearest first; the first opaque one ends the list.
    struct Crossing {
        double t = 0;
        std::uint32_t part = 0;  ///< Surface::part
    };
    std::vector<Crossing> crossings;

    [[nodiscard]] bool blocked() const { return through.is_black(); }
};

/// Reason why a surface sends no reflected or no refracted ray.
enum class NotSent {
    Sent,
    NoCoefficient,    ///< its coefficient is 0
    Deepest,          ///< the tree ends at this depth
    TooWeak,          ///< its share of the pixel is below the least contribution
    TotalReflection,  ///< no direction satisfies Snell's law
    NotTraced,        ///< the conventions of the scene trace no such rays
};
inline constexpr const char* kNotSentNames[] = {"sent",     "no_coefficient",   "deepest",
                                                "too_weak", "total_reflection", "not_traced"};

struct RayNode;

/// A surface that a ray hits.
struct SurfaceNode {
    double t = 0;  ///< from the origin of the ray
    Vec3 point;
    Vec3 normal;             ///< unit shading normal, towards the origin of the ray
    std::uint32_t part = 0;  ///< Surface::part
    std::uint32_t material = 0;
    bool entering = true;  ///< the ray hits the outside
    bool lit = true;       ///< false: only its emission is visible
    Rgb share;             ///< of the ray's radiance: coverage times the fraction left over
    Rgb kd, ks, kr, kt;    ///< coefficients of the material at the point
    double shininess = 0, index = 1;
    Rgb emission;
    Rgb ambient_factor;        ///< factor of the ambient term of each light
    std::vector<Rgb> ambient;  ///< [light] ambient terms
    std::vector<LightTerm> lights;
    Rgb direct;  ///< sum of the terms of the lights, as computed by the renderer
    Rgb reflected_factor, refracted_factor;  ///< factors of the radiance of the two rays
    bool filtered = false;
    Rgb filter{1, 1, 1};  ///< factor of all light if the ray passed a medium
    NotSent no_reflected = NotSent::NoCoefficient, no_refracted = NotSent::NoCoefficient;
    std::vector<RayNode> reflected, refracted;  ///< none or one
};

struct RayNode {
    RayKind kind = RayKind::Eye;
    Ray ray;
    int depth = 0;
    bool inside = false;                ///< starts inside a transparent object
    std::vector<SurfaceNode> surfaces;  ///< several if surfaces in front cover only in part
    bool escaped = false;               ///< the fraction `left` hit nothing
    bool given_up = false;              ///< the fraction `left` had passed kMaxPassedSurfaces
    Rgb left;
    Rgb radiance;  ///< as computed by the renderer
};

/// The color of a surface from its terms.
[[nodiscard]] Rgb color_of(const SurfaceNode& surface);
/// The radiance of a ray from its surfaces.
[[nodiscard]] Rgb radiance_of(const RayNode& ray, const Rgb& background);
/// Number of rays of the tree by kind, shadow rays included.
struct RayCensus {
    std::size_t eye = 0, shadow = 0, reflection = 0, refraction = 0;
};
[[nodiscard]] RayCensus census_of(const RayNode& ray);

}  // namespace alhazen
