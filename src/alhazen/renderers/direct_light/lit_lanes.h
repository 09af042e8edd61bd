#pragma once
/// The light of up to sixteen points of opaque materials without textures, in lanes.
///
/// Source: `unhindered_light` and `sample` of a light, the same operations in the same order.
/// Differs: lights other than points and directions are sampled, and highlights are computed, lane
/// by lane.
/// Conventions: every target returns the bits of the scalar code.

#include <cstdint>
#include <span>

#include "alhazen/shading/lights/light.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shading/shading_conventions.h"
#include "alhazen/shapes/core/lane_surfaces.h"

namespace alhazen {

/// A material whose light is computed in lanes.
struct LitMaterial {
    Rgb base;               ///< emission and ambient terms
    MaterialSample sample;  ///< matt unless `shiny`
    bool fits = false;      ///< false: not in lanes
    bool shiny = false;
};

struct alignas(64) LitLanes {
    double radiance[3][kSurfaceLanes];  ///< the result
    const Ray* ray[kSurfaceLanes];      ///< unit, in the world
    const LitMaterial* material[kSurfaceLanes];
    std::uint32_t turned;  ///< lanes whose normals are reversed
    std::uint32_t shiny;   ///< lanes with highlights
    bool mixed;            ///< materials differ

    void set(std::size_t lane, const Ray& of_lane, bool turns, const LitMaterial& of) {
        if (lane == 0) {
            turned = shiny = 0;
            mixed = false;
        }
        ray[lane] = &of_lane;
        material[lane] = &of;
        turned |= std::uint32_t{turns} << lane;
        shiny |= std::uint32_t{of.shiny} << lane;
        mixed = mixed || &of != material[0];
    }
};

/// Sets `radiance` of the first `count` lanes, from the surfaces as their shapes have them.
/// `in_world`: `surfaces` has the rays in the world. `lights`: those that illuminate.
void shade_lanes(const ShadingConventions& conventions, std::span<const Light* const> lights,
                 std::size_t count, bool in_world, const LaneSurfaces& surfaces, LitLanes& lanes);

}  // namespace alhazen
