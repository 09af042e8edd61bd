#pragma once
/// Where the scene formats differ in what a picture means: values that an importer sets, read by
/// the renderers. No renderer asks which format a scene came from.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; the
/// equation of the UW CSE 457 Trace project:
///   I = ke + sum_j [ kd ILa_j + Ashadow Adist IL_j Bj (kd (N.L) + ks (N.H)+^ns) ] + kr I(Q,R) + kt
///   I(Q,T).

namespace alhazen {

struct ShadingConventions {
    /// The highlight's cosine: of the mirrored light direction and the eye (Phong) or of the normal
    /// and the half vector (Blinn-Phong).
    enum class Highlight { Phong, BlinnPhong };
    Highlight highlight = Highlight::BlinnPhong;

    /// What a transparent surface between a point and a light does to the light.
    enum class ShadowTint {
        PerCrossing,  ///< times kt at every crossing, entering and leaving both
        PerDistance,  ///< times kt^(distance travelled inside) (Beer)
        Opaque,       ///< any surface blocks all light
        None,         ///< nothing casts a shadow
    };
    ShadowTint shadow_tint = ShadowTint::PerCrossing;

    /// What kt does to a ray that travels inside.
    enum class RefractionTint {
        PerEvent,     ///< times kt at each refraction
        PerDistance,  ///< times kt^(distance travelled inside); the refraction itself is not
                      ///< attenuated
    };
    RefractionTint refraction_tint = RefractionTint::PerEvent;

    /// Ambient light is multiplied by ka of the material (and, where the format has none, by kd).
    enum class AmbientFactor { Ambient, Diffuse };
    AmbientFactor ambient_factor = AmbientFactor::Ambient;
    /// Ambient light is multiplied by kt of the medium when the point is seen from inside it.
    bool ambient_inside_times_kt = true;

    /// A point light's 1 / (c + l d + q d^2) never exceeds 1.
    bool clamp_attenuation = true;

    /// Every material colour c from the file is used as floor(255 c) / 255.
    bool truncate_material_colors = false;

    /// A transparent surface reflects although its kr is zero (the ray is cast and counted).
    bool transmitting_surfaces_reflect = false;

    /// A reflected ray that an interpolated normal sends into the surface, or a refracted one that
    /// it sends back out, is made anew with the geometric normal.
    bool correct_interpolated_normals = true;

    /// False where a file switches the rays of a kind off.
    bool trace_reflections = true;
    bool trace_refractions = true;

    /// A file without lights is given one at the eye. False where a scene without lights is meant
    /// to be dark.
    bool headlight = true;

    double air_index = 1.0003;

    /// Where in a pixel its ray goes when there is one sample per pixel.
    enum class PixelSample {
        Center,
        LowerLeftCorner,  ///< x = i / width, y = j / height with j counted from the bottom row
        FrameCorners,  ///< x = i / (width - 1): the outermost rays go through the frame's corners
    };
    PixelSample pixel_sample = PixelSample::Center;

    /// Pictures of this format hold linear values truncated to 8 bits (else sRGB).
    bool linear_output = true;

    /// Recursion depth of the format: 0 = eye rays only.
    int max_depth = 5;
    /// Rays whose product of coefficients falls below this in every channel are not cast; 0 = all
    /// are.
    double min_contribution = 0.0;
};

}  // namespace alhazen
