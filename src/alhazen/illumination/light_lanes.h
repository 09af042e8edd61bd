#pragma once
/// Arguments and results of `Illumination::draw` for up to sixteen points in lanes.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/lit_point.h"

namespace alhazen {

/// Calls f(lane) for each of `lanes`.
template <class F>
void for_each_lane(std::uint32_t lanes, const F& f) {
    for (; lanes != 0; lanes &= lanes - 1) f(static_cast<std::size_t>(std::countr_zero(lanes)));
}

struct LightCallLanes {
    static constexpr std::size_t kMost = LitPointLanes::kMost;

    LitPointLanes at;
    alignas(64) double choice[kMost] = {};
    alignas(64) double u[2][kMost] = {};

    [[nodiscard]] Vec2 u_of(std::size_t lane) const { return {u[0][lane], u[1][lane]}; }
};

/// The results: those of lane i are the members of LightDraw.
struct LightDrawLanes {
    static constexpr std::size_t kMost = LightCallLanes::kMost;
    using Numbers = double[kMost];  ///< [lane]

    alignas(64) Numbers to_light[3] = {};
    alignas(64) Numbers distance = {}, density = {}, facing = {};
    alignas(64) Numbers radiance[Spectrum::kCount] = {};
    std::uint32_t singular = 0;  ///< bits of lanes
    std::array<PlaceInLight, kMost> places;

    void set(std::size_t lane, const LightDraw& draw) {
        for (int k = 0; k < 3; ++k) to_light[k][lane] = draw.to_light[k];
        distance[lane] = draw.distance;
        density[lane] = draw.density;
        facing[lane] = draw.facing;
        for (int k = 0; k < Spectrum::kCount; ++k) radiance[k][lane] = draw.radiance[k];
        const std::uint32_t bit = 1u << lane;
        singular = draw.singular ? singular | bit : singular & ~bit;
        places[lane] = draw.place;
    }
    [[nodiscard]] LightDraw operator[](std::size_t lane) const {
        return {.to_light = {to_light[0][lane], to_light[1][lane], to_light[2][lane]},
                .distance = distance[lane],
                .radiance = {radiance[0][lane], radiance[1][lane], radiance[2][lane],
                             radiance[3][lane]},
                .density = density[lane],
                .singular = (singular >> lane & 1u) != 0,
                .place = places[lane],
                .facing = facing[lane]};
    }
};

}  // namespace alhazen
