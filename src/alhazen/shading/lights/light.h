#pragma once
/// Lights: a closed variant of plain structs.
///
/// ADD A LIGHT HERE: a struct with a member `ambient`, and an entry in `Light`. Visits without a
/// generic overload then fail to compile; the main ones:
///   - shading/lights/light.cpp: place_of, ready_to_sample, sample;
///   - scene_model/validate.cpp: check of the values;
///   - formats/native/read/native_lights.cpp: blocks_of (name and reader of its block);
///   - formats/native/write/native_write_view.cpp: block_of;
///   - session/scene_info/info.cpp: light_kind; session/lighting.cpp: kLightKinds, describe;
///   - renderers/beam_tracing/beam_tree.cpp: apex_of;
///   - tests/support/same_description.h: same;
///   - tests/unit/formats/native/native_writer_test.cpp: one in the round trip.
/// The compiler does not name illumination/ (illumination.cpp, illumination_emission.cpp,
/// light_picks.cpp): it treats a light at a point that is no SpotLight as a PointLight (std::get)
/// and has generic overloads. Check it by hand.
///
/// `sample` treats a light with extent (light_extent.h) as a point light at its centre that gives
/// the irradiance of the whole light seen from afar. Renderers that distribute their rays sample
/// `AreaLight::surface` instead (`sample_extent`).
///
/// Conventions: every light may carry an ambient term, added at every point without occlusion (the
/// course's I_La); an `AmbientLight` has nothing else.

#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

struct AmbientLight {
    Rgb ambient;
};

struct DirectionalLight {
    Vec3 to_light{0, 0, 1};  ///< unit, from the scene towards the light
    Rgb color{1, 1, 1};
    Rgb ambient;
    bool glints = true;  ///< see PointLight
};

/// 1 / (constant + linear d + quadratic d^2).
struct Attenuation {
    double constant = 1, linear = 0, quadratic = 0;
};

/// An unlimited range. A finite range multiplies the attenuation by clamp(1 - (d / range)^4, 0, 1).
/// Source: Khronos, KHR_lights_punctual, "Range Property".
inline constexpr double kNoRange = std::numeric_limits<double>::infinity();

class IesProfile;

/// Angular distribution of a light at a point (ies_profile.h).
struct LightProfile {
    std::string file;                           ///< name; empty: the same in all directions
    std::shared_ptr<const IesProfile> profile;  ///< content of `file`, already read
    Vec3 down{0, 0, -1};                        ///< direction of its vertical angle 0
    Vec3 front{1, 0, 0};                        ///< direction of its horizontal angle 0
};

struct PointLight {
    Vec3 position;
    Rgb color{1, 1, 1};
    Attenuation attenuation;
    Rgb ambient;
    double range = kNoRange;
    bool glints = true;  ///< false: no highlights on materials that transmit light
    LightProfile profile;
};

/// A point light that emits into a cone: full intensity within `inner_angle` of the axis, 0 beyond
/// `outer_angle`, a smooth cubic step of the angle in between.
struct SpotLight {
    Vec3 position;
    Vec3 direction{0, 0, -1};                     ///< unit, from the light into the scene
    double inner_angle = 0.5, outer_angle = 0.6;  ///< radians from the axis
    Rgb color{1, 1, 1};
    Attenuation attenuation;
    Rgb ambient;
    double range = kNoRange;
    LightProfile profile;
    /// Conservative cosines: directions whose cosine lies beyond them are inside or outside for
    /// certain and need no arc cosine. Set by `ready_to_sample`; the result does not depend on
    /// them.
    struct SureCosines {
        double within = 2.0, beyond = -2.0;
    } sure;
};

/// A surface of uniform radiance in all directions of its outer side. A matt surface of diffuse
/// reflectance kd below a light of irradiance E has radiance kd E / pi.
struct AreaLight {
    LightExtent extent;
    Rgb radiance{1, 1, 1};
    bool two_sided = false;
    Rgb ambient;
    bool seen = true;  ///< visible as an emitting surface to all rays but shadow rays
    /// `extent` ready for sampling; made by `ready_to_sample`.
    std::shared_ptr<const LightSurface> surface;
    bool is_part = false;  ///< true: its surface is already a part of the scene
};

using Light = std::variant<AmbientLight, DirectionalLight, PointLight, SpotLight, AreaLight>;

/// A light as seen from a point: unit direction towards it, distance (infinite for directional
/// lights) and the intensity that arrives unshadowed, attenuation included.
struct LightSample {
    Vec3 to_light;
    double distance = 0;
    Rgb intensity;
    bool glints = true;  ///< see PointLight
};

/// End of the shadow rays to a light.
enum class LightPlace {
    None,       ///< the light has an ambient term only: no shadow rays
    Direction,  ///< parallel shadow rays
    Point,      ///< shadow rays to one point
};
[[nodiscard]] LightPlace place_of(const Light& light);
/// False for a light that has only an ambient term.
[[nodiscard]] bool illuminates(const Light& light);
/// The light as expected by `sample`: directions normalised, surfaces prepared.
[[nodiscard]] Light ready_to_sample(const Light& light);
[[nodiscard]] LightSample sample(const Light& light, const Vec3& point, bool clamp_attenuation);
/// The contribution of the point of `light` selected by `u`, divided by its density: its mean over
/// `u` in the unit square is the light from the whole surface. The intensity is 0 if that point is
/// seen from behind.
[[nodiscard]] LightSample sample_extent(const AreaLight& light, const Vec3& point, const Vec2& u);
[[nodiscard]] Rgb ambient_of(const Light& light);

}  // namespace alhazen
