#pragma once
/// All that sends light into a scene, ready to be sampled: punctual lights, emitting surfaces, the
/// environment.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997 (densities for
/// multiple importance sampling); Conty Estevez and Kulla, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", HPG 2018 (light_tree.h).
/// Conventions: densities are by solid angle at the point that is lit and contain the probability
/// with which the light is chosen. Singular lights (points, spots, directions) are hit by no ray.
/// Intensities of singular lights are times pi: Whitted's coefficients are not divided by pi, those
/// of a BSDF are, and both show the same diffuse surface.
/// Left to chance hits (density 0): emitting surfaces that cannot be sampled (emitter_list.h).
/// Threads: const functions may be called from many.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "alhazen/illumination/lit_point.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// Where in a light it begins: for `Illumination::point_of_light`.
struct PlaceInLight {
    std::size_t source = 0;  ///< number of the light
    Vec2 parameters;
};

/// A direction from which light comes.
struct LightDraw {
    Vec3 to_light;          ///< unit
    double distance = 0;    ///< to the light; infinite where it has no place
    Spectrum radiance;      ///< that arrives unhindered; of a singular light what it gives a
                            ///< surface across its direction (irradiance)
    double density = 0;     ///< by solid angle; of a singular light the probability of its choice;
                            ///< 0: no light from there
    bool singular = false;  ///< no other strategy finds this light
    RayMask passes = kAllRays;  ///< mask for the shadow ray
    PlaceInLight place;
};

/// A ray of light as it leaves its source. Its power is radiance * cosine / (both densities).
struct LightRay {
    Ray ray;
    Vec3 normal;                   ///< unit, of the surface; the direction where there is none
    Spectrum radiance;             ///< of singular places: intensity; of parallel light: irradiance
    double place_density = 0;      ///< by area, choice included; of a singular place: of the choice
    double direction_density = 0;  ///< by solid angle; of singular directions: 1
    bool singular_place = false;   ///< a point
    bool singular_direction = false;  ///< parallel light
    bool infinite = false;            ///< of the environment or parallel: it comes from infinity by
                                      ///< way of its origin, which lies on a disc across its
                                      ///< direction, before all that is bounded
    PlaceInLight place;
};

/// How one of many lights is chosen.
enum class LightChoice : std::uint8_t {
    Uniform,  ///< all alike
    Power,    ///< by how much they send out
    Tree,     ///< by how much may arrive (light_tree.h)
};
inline constexpr const char* kLightChoiceNames[] = {"uniform", "power", "tree"};

struct IlluminationOptions {
    LightChoice choice = LightChoice::Tree;
};

class Illumination {
  public:
    /// The scene must stay as it is while this is used.
    explicit Illumination(const Scene& scene, const IlluminationOptions& options = {});
    ~Illumination();
    Illumination(Illumination&&) noexcept;
    Illumination& operator=(Illumination&&) noexcept;

    /// False: nothing shines.
    [[nodiscard]] bool shines() const;
    /// Whether some emitting surface is left to chance: `draw` and `emit` never give it.
    [[nodiscard]] bool leaves_some_to_chance() const;

    /// Whether `draw` uses `choice`: there is more than one light.
    [[nodiscard]] bool chooses() const;
    /// A direction to a light. `choice` and `u` in [0, 1).
    [[nodiscard]] LightDraw draw(const LitPoint& at, double choice, const Vec2& u,
                                 const Wavelengths& waves) const;

    /// The density with which `draw(at)` gives the direction of a ray that hit an emitting surface
    /// `distance` away; 0 where `draw` never gives it.
    [[nodiscard]] double density(const LitPoint& at, const Ray& ray, const Hit& hit,
                                 const Surface& surface, double distance) const;

    /// The radiance that a ray finds which leaves the scene.
    [[nodiscard]] Spectrum environment(const Vec3& direction, const Wavelengths& waves) const;
    /// The density with which `draw(at)` gives that direction to the environment.
    [[nodiscard]] double environment_density(const LitPoint& at, const Vec3& direction) const;

    /// Both at once.
    struct FarLight {
        Spectrum radiance;
        double density = 0;
    };
    [[nodiscard]] FarLight far_light(const LitPoint& at, const Vec3& direction,
                                     const Wavelengths& waves) const;
    /// Whether `draw` reads a picture of the sky; if so, what it will read for these numbers can be
    /// fetched into the cache: first the guide, some draws later the texels.
    [[nodiscard]] bool looks_up() const;
    void fetch_guide(const Vec2& u) const;
    void fetch_texels(const Vec2& u) const;

    /// A ray from a light into the scene.
    [[nodiscard]] LightRay emit(double choice, const Vec2& place, const Vec2& direction,
                                const Wavelengths& waves) const;
    /// Densities with which `emit` gives a ray from a point of an emitting surface.
    struct EmitDensity {
        double place = 0, direction = 0;
    };
    [[nodiscard]] EmitDensity emit_density(const Hit& hit, const Surface& surface,
                                           const Vec3& direction) const;
    /// The same for light of the environment that travels along `direction` to the point `lit`; 0
    /// where no ray of `emit` gets to, far beside what is bounded.
    [[nodiscard]] EmitDensity environment_emit_density(const Vec3& direction,
                                                       const Vec3& lit) const;

    /// A point of a light that was drawn or that emitted, for the densities of other strategies.
    struct LightPoint {
        std::size_t source = 0;
        Vec2 parameters;
        Vec3 normal;            ///< unit, of a surface; zero where there is none
        bool infinite = false;  ///< without a place
        bool is_hit = false;    ///< rays can hit it
    };
    [[nodiscard]] LightPoint point_of_light(const PlaceInLight& place, const Vec3& point) const;
    /// What a light with a singular place gives a surface across its direction at a point: by its
    /// own falloff, which need not be that of its rays (the inverse square).
    [[nodiscard]] Spectrum irradiance(const PlaceInLight& place, const Vec3& point,
                                      const Wavelengths& waves) const;
    /// With which `emit` gives a ray from there along `direction` to the point `lit`.
    [[nodiscard]] EmitDensity emit_density(const LightPoint& from, const Vec3& direction,
                                           const Vec3& lit) const;
    /// With which `draw(at)` gives it; as LightDraw::density, but for a light that no ray hits by
    /// solid angle where it has an extent.
    [[nodiscard]] double density(const LitPoint& at, const LightPoint& light, const Vec3& to_light,
                                 double distance) const;

    /// A place of a light, from which light sets out into any direction.
    struct LightPick {
        PlaceInLight place;
        Vec3 at;      ///< a point; of parallel light the unit direction to it
        Vec3 normal;  ///< unit, of a surface; else zero
        bool infinite = false;
        bool is_hit = false;  ///< rays can hit it
        double density = 0;   ///< by area; of a point or a direction the probability; 0: none
    };
    /// By power; never of the environment, nor of points that do not fall with distance.
    [[nodiscard]] LightPick pick(double choice, const Vec2& u) const;
    [[nodiscard]] bool picks_any() const;
    /// What it sends to a point, unhindered: of a surface radiance times the cosine there, of a
    /// point intensity, of parallel light irradiance across it.
    [[nodiscard]] Spectrum sent(const LightPick& from, const Vec3& to,
                                const Wavelengths& waves) const;
    /// Whether `pick` may give what a ray along `direction` hit, with light against the ray.
    [[nodiscard]] bool may_pick(const Hit& hit, const Surface& surface,
                                const Vec3& direction) const;

  private:
    friend class LightDraws;
    struct Data;
    std::unique_ptr<const Data> data_;
};

}  // namespace alhazen
