#pragma once
/// The light of eight points of opaque materials without textures, in lanes.
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
    double direction[3][kRayLanes];  ///< unit, of the rays in the world
    double side[kRayLanes];          ///< -1: the normal is reversed
    double base[3][kRayLanes], diffuse[3][kRayLanes];
    double radiance[3][kRayLanes];  ///< the result
    const LitMaterial* material[kRayLanes];
    std::uint32_t shiny;  ///< lanes with highlights

    void set(std::size_t lane, const Vec3& ray_direction, double side_of, const LitMaterial& of) {
        for (int k = 0; k < 3; ++k) {
            direction[k][lane] = ray_direction[k];
            base[k][lane] = of.base[k];
            diffuse[k][lane] = of.sample.diffuse[k];
        }
        side[lane] = side_of;
        material[lane] = &of;
        if (of.shiny) shiny |= 1u << lane;
    }
    /// Copies the first lane to those from `count` on.
    void fill(std::size_t count) {
        fill_lanes(direction, count);
        fill_lanes(base, count);
        fill_lanes(diffuse, count);
        fill_lanes(side, count);
    }
};

/// Sets `radiance` of `count` lanes, from the surfaces as their shapes have them; others are
/// filled. `lights`: those that illuminate.
void shade_lanes(const ShadingConventions& conventions, std::span<const Light* const> lights,
                 std::size_t count, const LaneSurfaces& surfaces, LitLanes& lanes);

}  // namespace alhazen
