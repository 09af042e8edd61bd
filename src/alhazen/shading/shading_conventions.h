#pragma once
/// Terms of the shading equation in which the scene formats differ. An importer sets them, the
/// renderers read them; no renderer asks which format a scene came from.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; the
/// equation of the UW CSE 457 Trace project:
///   I = ke + sum_j [ kd ILa_j + Ashadow Adist IL_j Bj (kd (N.L) + ks (N.H)+^ns) ] + kr I(Q,R) + kt
///   I(Q,T).

namespace alhazen {

/// Laws of optics in place of the shares and tints of the equation, for renderers that trace its
/// rays; docs/reference/materials.md, "Exact optics".
struct Optics {
    bool fresnel = false;  ///< light is shared out between the two rays by Fresnel's equations
    bool beer = false;     ///< kt is what a unit of length leaves of light
    [[nodiscard]] bool any() const { return fresnel || beer; }
};

struct ShadingConventions {
    /// Cosine c of the highlight: of the mirrored light direction and the eye (Phong), or of the
    /// normal and the half vector (Blinn-Phong), to the power n of the shininess. Schlick: that of
    /// Phong as c / (n - n c + c) instead of c^n ("A Fast Alternative to Phong's Specular Model",
    /// Graphics Gems IV, 1994).
    enum class Highlight { Phong, BlinnPhong, Schlick };
    Highlight highlight = Highlight::BlinnPhong;

    /// Effect on light of a transparent surface between a point and the light.
    enum class ShadowTint {
        PerCrossing,  ///< times kt at every crossing, entering and leaving both
        PerDistance,  ///< times kt^(distance travelled inside) (Beer)
        Opaque,       ///< any surface blocks all light
        None,         ///< nothing casts a shadow
    };
    ShadowTint shadow_tint = ShadowTint::PerCrossing;

    /// Effect of kt on a ray that travels inside.
    enum class RefractionTint {
        PerEvent,     ///< times kt at each refraction
        PerDistance,  ///< times kt^(distance travelled inside); the refraction itself is not
                      ///< attenuated
    };
    RefractionTint refraction_tint = RefractionTint::PerEvent;

    /// Factor of ambient light: ka of the material, or kd where the format has no ka.
    enum class AmbientFactor { Ambient, Diffuse };
    AmbientFactor ambient_factor = AmbientFactor::Ambient;
    /// Ambient light is multiplied by kt of the medium when the point is seen from inside it.
    bool ambient_inside_times_kt = true;
    /// Ambient light comes from where the ray begins: it falls with the cosine of the view.
    bool ambient_from_eye = false;

    /// A point light's 1 / (c + l d + q d^2) never exceeds 1.
    bool clamp_attenuation = true;

    /// A transparent surface reflects although its kr is zero (the ray is cast and counted).
    bool transmitting_surfaces_reflect = false;

    /// A reflected ray that an interpolated normal sends into the surface, or a refracted one that
    /// it sends back out, is replaced by the one of the geometric normal.
    bool correct_interpolated_normals = true;

    /// False: no rays of the kind are cast.
    bool trace_reflections = true;
    bool trace_refractions = true;

    Optics optics{};

    double air_index = 1.0003;

    /// A ray that leaves a surface meets nothing nearer than this to where it starts; light that
    /// passes through a surface starts there anew.
    double min_distance = 0.0;

    /// Largest depth of recursion: 0 = eye rays only.
    int max_depth = 5;
    /// Rays whose product of coefficients is below this in every channel are not cast; 0 = all are.
    double min_contribution = 0.0;
};

}  // namespace alhazen
