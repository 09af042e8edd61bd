#pragma once
/// Lights: a closed variant of plain structs.
///
/// ADD A LIGHT HERE: a struct with a member `ambient`, and an entry in `Light`. The compiler then
/// names the other places:
///   - shading/lights/light.cpp: place_of, ready_to_sample, sample;
///   - scene_model/validate.cpp: check of the values;
///   - formats/native/read/native_view.cpp: blocks_of (name and reader of its block);
///   - formats/native/write/native_write_view.cpp: block_of;
///   - session/info.cpp: light_kind;
///   - tests/support/same_description.h: same;
///   - tests/unit/formats/native/native_writer_test.cpp: one in the round trip.
///
/// Of a light with extent (light_extent.h) `sample` gives its stand-in: a point at its centre that
/// sends to a point what the light would from afar. Renderers that distribute their rays sample
/// `AreaLight::surface` instead (`sample_extent`).
///
/// Conventions: every light may carry an ambient term, added at every point whatever is in between
/// (the course's I_La); an `AmbientLight` is nothing else.

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

/// Range of a light: its attenuation is multiplied by clamp(1 - (d / range)^4, 0, 1).
/// Source: Khronos, KHR_lights_punctual, "Range Property".
inline constexpr double kNoRange = std::numeric_limits<double>::infinity();

class IesProfile;

/// How much a light at a point sends in each direction (ies_profile.h).
struct LightProfile {
    std::string file;                           ///< as named; empty: the same in all directions
    std::shared_ptr<const IesProfile> profile;  ///< already read, beside `file`
    Vec3 down{0, 0, -1};                        ///< of its vertical angle 0
    Vec3 front{1, 0, 0};                        ///< of its horizontal angle 0
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

/// A point light that shines into a cone: full within `inner_angle` of the axis, none beyond
/// `outer_angle`, a smooth cubic step of the angle between.
struct SpotLight {
    Vec3 position;
    Vec3 direction{0, 0, -1};                     ///< unit, from the light into the scene
    double inner_angle = 0.5, outer_angle = 0.6;  ///< radians from the axis
    Rgb color{1, 1, 1};
    Attenuation attenuation;
    Rgb ambient;
    double range = kNoRange;
    LightProfile profile;
    /// Cosines beyond which rounding cannot change on which side of the angles a direction is: most
    /// directions need no arc cosine. Set by `ready_to_sample`; these values decide nothing.
    struct SureCosines {
        double within = 2.0, beyond = -2.0;
    } sure;
};

/// A surface that shines with the same radiance from everywhere into all directions of its outer
/// side. A matt surface of diffuse reflectance kd below a light of irradiance E shows kd E / pi.
struct AreaLight {
    LightExtent extent;
    Rgb radiance{1, 1, 1};
    bool two_sided = false;
    Rgb ambient;
    bool seen = true;  ///< as a surface of this emission, by all rays but shadow rays
    /// Of `extent`; made by `ready_to_sample`.
    std::shared_ptr<const LightSurface> surface;
    bool is_part = false;  ///< its surface is a part of the scene already
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
    Direction,  ///< parallel rays
    Point,      ///< rays to one point
};
[[nodiscard]] LightPlace place_of(const Light& light);
/// False for a light that only has an ambient term.
[[nodiscard]] bool illuminates(const Light& light);
/// The light as `sample` expects it: directions normalised, surfaces prepared.
[[nodiscard]] Light ready_to_sample(const Light& light);
[[nodiscard]] LightSample sample(const Light& light, const Vec3& point, bool clamp_attenuation);
/// The light from the point of `light` that `u` selects, divided by the density of that choice: the
/// mean over `u` in the unit square is the light from all of it. No intensity where that point is
/// seen from behind.
[[nodiscard]] LightSample sample_extent(const AreaLight& light, const Vec3& point, const Vec2& u);
[[nodiscard]] Rgb ambient_of(const Light& light);

}  // namespace alhazen
