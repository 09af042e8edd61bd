#pragma once
/// The sampled light sources of a scene: singular lights, emitting surfaces and the environment.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997 (densities for
/// multiple importance sampling); Conty Estevez and Kulla, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", HPG 2018 (light_tree.h).
/// Conventions: densities are by solid angle at the lit point and include the probability with
/// which the light is chosen. Singular lights (point, spot and directional lights) are hit by no
/// ray. Their intensities are multiplied by pi: a BSDF is divided by pi and Whitted's coefficients
/// are not, so that both show the same diffuse surface.
/// Emitting surfaces that cannot be sampled (emitter_list.h) have density 0: only hits find them.
/// Threads: const functions may be called from many.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "alhazen/illumination/lit_point.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// A point of a light, for `Illumination::point_of_light`.
struct PlaceInLight {
    std::size_t source = 0;  ///< number of the light
    Vec2 parameters;
};

/// A direction from which light comes.
struct LightDraw {
    Vec3 to_light;          ///< unit
    double distance = 0;    ///< to the light; infinite for far lights
    Spectrum radiance;      ///< unoccluded; of a singular light the irradiance of a surface
                            ///< perpendicular to its direction
    double density = 0;     ///< by solid angle; of a singular light the probability of its choice;
                            ///< 0: no light arrives
    bool singular = false;  ///< no other strategy finds this light
    PlaceInLight place;
    double facing = 0;  ///< |cosine| at the surface that rays meet at the light; 0: none
};

/// A ray of light that leaves its source. Its power is radiance * cosine / (both densities).
struct LightRay {
    Ray ray;
    Vec3 normal;                   ///< unit, of the surface; the direction if there is no surface
    Spectrum radiance;             ///< of point lights intensity, of directional lights irradiance
    double place_density = 0;      ///< by area, with the choice; of point lights the choice alone
    double direction_density = 0;  ///< by solid angle; of directional lights: 1
    bool singular_place = false;   ///< from a point light
    bool infinite = false;         ///< from the environment or a directional light: the origin
                                   ///< lies on a disc perpendicular to the direction, in front
                                   ///< of all bounded geometry
    bool is_hit = false;           ///< rays can hit the light
    PlaceInLight place;
};

/// How one of many lights is chosen.
enum class LightChoice : std::uint8_t {
    Uniform,  ///< all with the same probability
    Power,    ///< by largest intensity
    Tree,     ///< by an estimate of the light that arrives (light_tree.h)
};

struct IlluminationOptions {
    LightChoice choice = LightChoice::Tree;
};

class Illumination {
  public:
    /// The scene must outlive the object and not change.
    explicit Illumination(const Scene& scene, const IlluminationOptions& options = {});
    ~Illumination();
    Illumination(Illumination&&) noexcept;
    Illumination& operator=(Illumination&&) noexcept;

    /// True if the scene has light.
    [[nodiscard]] bool emits() const;
    /// True if some emitting surface is never sampled by `draw` and `emit`.
    [[nodiscard]] bool has_unsampled_emitters() const;

    /// True if `draw` uses `choice`: there is more than one light.
    [[nodiscard]] bool chooses() const;
    /// Samples a direction to a light. `choice` and `u` in [0, 1).
    [[nodiscard]] LightDraw draw(const LitPoint& at, double choice, const Vec2& u,
                                 const Wavelengths& waves) const;

    /// The density of `draw(at)` for the direction of a ray that hit an emitting surface at
    /// `distance`; 0 if `draw` never samples it.
    [[nodiscard]] double density(const LitPoint& at, const Ray& ray, const Hit& hit,
                                 const Surface& surface, double distance) const;

    /// The radiance of the environment along a ray that leaves the scene.
    [[nodiscard]] Spectrum environment(const Vec3& direction, const Wavelengths& waves) const;
    /// The density of `draw(at)` for that direction to the environment.
    [[nodiscard]] double environment_density(const LitPoint& at, const Vec3& direction) const;

    /// Radiance and density of the environment together.
    struct FarLight {
        Spectrum radiance;
        double density = 0;
    };
    [[nodiscard]] FarLight far_light(const LitPoint& at, const Vec3& direction,
                                     const Wavelengths& waves) const;
    /// True if the environment is a picture: `far_light` is then the same at all points.
    [[nodiscard]] bool has_sky_picture() const;
    /// `far_light` of each direction, for colour channels. Precondition: `has_sky_picture`.
    void find_far_lights(std::span<const Vec3> directions, FarLight* lights) const;

    /// Samples a ray from a light into the scene.
    [[nodiscard]] LightRay emit(double choice, const Vec2& place, const Vec2& direction,
                                const Wavelengths& waves) const;
    /// The densities of `emit` for a ray, here from a point of an emitting surface.
    struct EmitDensity {
        double place = 0, direction = 0;
    };
    [[nodiscard]] EmitDensity emit_density(const Hit& hit, const Surface& surface,
                                           const Vec3& direction) const;
    /// The densities of `emit` for light of the environment that travels along `direction` to the
    /// point `lit`; 0 outside the disc of `emit`, far from all bounded geometry.
    [[nodiscard]] EmitDensity environment_emit_density(const Vec3& direction,
                                                       const Vec3& lit) const;

    /// A point of a light that was sampled, for the densities of other strategies.
    struct LightPoint {
        std::size_t source = 0;
        Vec2 parameters;
        Vec3 normal;            ///< unit, of a surface; else zero
        bool infinite = false;  ///< environment or directional light
        bool is_hit = false;    ///< rays can hit it
    };
    [[nodiscard]] LightPoint point_of_light(const PlaceInLight& place, const Vec3& point) const;
    /// The irradiance that a point light gives to a surface perpendicular to its direction at
    /// `point`, by its own falloff. The rays of `emit` fall by the inverse square instead.
    [[nodiscard]] Spectrum irradiance(const PlaceInLight& place, const Vec3& point,
                                      const Wavelengths& waves) const;
    /// The densities of `emit` for a ray from the light point along `direction` to the point `lit`.
    [[nodiscard]] EmitDensity emit_density(const LightPoint& from, const Vec3& direction,
                                           const Vec3& lit) const;
    /// Largest distance by which rays miss the points of emitting surfaces, of all that they can
    /// hit: a bound of the rounding of their points and of the tests.
    [[nodiscard]] double rounding() const { return rounding_; }
    /// A point outside of that bound of the surface of a light, beside its `point`, on the side of
    /// `from`; `point` itself of lights without a surface.
    [[nodiscard]] Vec3 before_surface(const PlaceInLight& place, const Vec3& point,
                                      const Vec3& from) const;
    /// The density of `draw(at)` for the light point: LightDraw::density, except that invisible
    /// area lights have a density by solid angle.
    [[nodiscard]] double density(const LitPoint& at, const LightPoint& light, const Vec3& to_light,
                                 double distance) const;

    /// A point of a light, independent of the point that is lit.
    struct LightPick {
        PlaceInLight place;
        Vec3 at;      ///< a point; of a directional light the unit direction to it
        Vec3 normal;  ///< unit, of a surface; else zero
        bool infinite = false;
        bool is_hit = false;  ///< rays can hit it
        double density = 0;   ///< by area; of a singular light the probability; 0: none
    };
    /// Samples a point of a light, by power. Never samples the environment nor point lights
    /// without falloff.
    [[nodiscard]] LightPick pick(double choice, const Vec2& u) const;
    [[nodiscard]] bool picks_any() const;
    /// The unoccluded light from a point of a light to the point `to`: of a surface radiance times
    /// the cosine at it, of a point light intensity, of a directional light irradiance
    /// perpendicular to it.
    [[nodiscard]] Spectrum sent(const LightPick& from, const Vec3& to,
                                const Wavelengths& waves) const;
    /// True if `pick` may sample the hit of a ray along `direction`, and the surface emits against
    /// the ray.
    [[nodiscard]] bool may_pick(const Hit& hit, const Surface& surface,
                                const Vec3& direction) const;

  private:
    friend class LightDraws;
    struct Data;
    std::unique_ptr<const Data> data_;
    double rounding_ = 0;
};

}  // namespace alhazen
