#pragma once
/// Terms of the shading equation in which the scene formats differ. Importers set them, renderers
/// read them; renderers are independent of the scene format.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; the
/// equation of the UW CSE 457 Trace project:
///   I = ke + sum_j [ kd ILa_j + Ashadow Adist IL_j Bj (kd (N.L) + ks (N.H)+^ns) ] + kr I(Q,R) + kt
///   I(Q,T).

#include <optional>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Laws of optics that replace the shares and tints of the equation, for renderers that trace its
/// rays; docs/reference/materials.md, "Exact optics".
struct Optics {
    bool fresnel = false;  ///< the two rays are weighted by Fresnel's equations
    bool beer = false;     ///< kt is the transmittance of a unit of length
    [[nodiscard]] bool any() const { return fresnel || beer; }
};

struct ShadingConventions {
    /// Cosine c of the highlight: of the mirrored light direction and the eye (Phong), or of the
    /// normal and the half vector (Blinn-Phong), to the power n of the shininess. Schlick: Phong's
    /// cosine with c / (n - n c + c) instead of c^n ("A Fast Alternative to Phong's Specular
    /// Model", Graphics Gems IV, 1994).
    enum class Highlight { Phong, BlinnPhong, Schlick };
    Highlight highlight = Highlight::BlinnPhong;

    /// Effect of a transparent surface between a point and the light.
    enum class ShadowTint {
        PerCrossing,  ///< times kt at every crossing, entering and leaving both
        PerDistance,  ///< times kt^(distance travelled inside the innermost closed body) (Beer)
        Opaque,       ///< any surface blocks all light
        None,         ///< no shadows
    };
    ShadowTint shadow_tint = ShadowTint::PerCrossing;

    /// Effect of kt on a ray that travels inside.
    enum class RefractionTint {
        PerEvent,     ///< times kt at each refraction
        PerDistance,  ///< times kt^(distance travelled inside the innermost closed body); the
                      ///< refraction itself is not attenuated
    };
    RefractionTint refraction_tint = RefractionTint::PerEvent;
    /// True if kt is the transmittance of a unit of length for some rays.
    [[nodiscard]] bool tints_by_distance() const {
        return refraction_tint == RefractionTint::PerDistance ||
               shadow_tint == ShadowTint::PerDistance;
    }

    /// Coefficient of ambient light: ka of the material, or kd for formats without ka.
    enum class AmbientFactor { Ambient, Diffuse };
    AmbientFactor ambient_factor = AmbientFactor::Ambient;
    /// Ambient light is multiplied by kt of the medium if the point is seen from inside it.
    bool ambient_inside_times_kt = true;
    /// Ambient light comes from the origin of the ray: it is multiplied by the cosine of the view.
    bool ambient_from_eye = false;

    /// Radiance of eye rays that start inside a solid; none: they show its surface from inside.
    std::optional<Rgb> inside_color;

    /// Limits a point light's attenuation 1 / (c + l d + q d^2) to 1.
    bool clamp_attenuation = true;

    /// Rays are reflected (cast and counted) at a transparent surface whose kr is zero.
    bool transmitting_surfaces_reflect = false;

    /// If an interpolated normal sends a reflected ray into the surface, or a refracted ray back
    /// out, the ray of the geometric normal is used. False: these rays go on, and rays are
    /// refracted into or out of the body by the side of the interpolated normal.
    bool correct_interpolated_normals = true;

    /// False: rays of this kind are not cast.
    bool trace_reflections = true;
    bool trace_refractions = true;

    Optics optics{};

    double air_index = 1.0003;

    /// Smallest distance of a hit from the surface where a ray starts. A shadow ray that passes
    /// through a surface is not tinted by nearer ones, but enters and leaves their volumes.
    double min_distance = 0.0;

    /// Maximum depth of recursion: 0 = eye rays only.
    int max_depth = 5;
    /// Rays whose product of coefficients is below this in every channel are not cast; 0: no limit.
    double min_contribution = 0.0;
};

}  // namespace alhazen
