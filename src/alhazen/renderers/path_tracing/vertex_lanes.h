#pragma once
/// Vertices of eye paths in lanes: points of triangles with a BSDF that neither transmits nor has
/// singular lobes. From hits to the rays to lights and the next rays.
///
/// Conventions: the bits are those of ScatterPoint and PathTracer, one vertex after the other.
/// Light and directions count on the side of the view only, where all rays begin. Used in the order
/// of its functions: `find_frames`, `scatter`, for BSDFs that are not matt changes of single lanes,
/// `weigh`.

#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/light_lanes.h"
#include "alhazen/shapes/meshes/triangle_lanes.h"

namespace alhazen {

struct VertexLanes {
    static constexpr std::size_t kMost = TriangleLanes::kMost;
    static_assert(kMost == LightCallLanes::kMost);
    using Numbers = TriangleLanes::Numbers;
    using Vectors = TriangleLanes::Vectors;
    using Spectra = Numbers[4];

    VertexLanes();

    /// Finds the surfaces of the first `count` lanes, their frames and the starts of rays. Writes
    /// the points at which light is wanted into `lights`.
    void find_frames(std::size_t count, LightCallLanes& lights);
    /// Light and next directions in the frames; values, densities and weights of matt BSDFs.
    void scatter(const LightDrawLanes& lights);
    /// The light of the shadow rays, the next directions and throughputs.
    void weigh(const LightDrawLanes& lights);

    // Filled with the hits.
    TriangleLanes triangles;
    alignas(64) Vectors ray = {};         ///< unit direction
    alignas(64) Spectra throughput = {};  ///< after `weigh` that of the next ray
    alignas(64) Spectra matt = {};        ///< values of matt BSDFs, without cosine
    alignas(64) Numbers u[2] = {};        ///< random numbers of the direction

    // Of `find_frames`.
    alignas(64) Vectors geometric = {};          ///< normal on the side of the view
    alignas(64) Vectors x = {}, y = {}, z = {};  ///< ShadingFrame
    alignas(64) Vectors view = {};               ///< in the frame
    alignas(64) Vectors origin = {};             ///< of rays that leave on the side of the view
    std::uint32_t entering = 0;                  ///< ShadingPoint::entering
    std::uint32_t used = 0;                      ///< the first `count` lanes

    // Of `scatter`, and of BSDFs that are not matt.
    alignas(64) Vectors to_light = {};  ///< in the frame
    alignas(64) Spectra value = {};     ///< for that direction, with the cosine
    alignas(64) Numbers density = {};   ///< of that direction
    alignas(64) Vectors next = {};      ///< sampled direction, in the frame
    alignas(64) Numbers next_density = {};
    alignas(64) Spectra next_weight = {};
    bool shadow_rays_alone = false;  ///< DirectLightWeights; set before `weigh`
    std::uint32_t lit = 0;           ///< lanes with light above the surface
    std::uint32_t sampled = 0;       ///< lanes with a next direction

    // Of `weigh`; `lit` and `sampled` are then the lanes that have a ray.
    alignas(64) Spectra light = {};
    alignas(64) Vectors direction = {};  ///< of the next ray
};

}  // namespace alhazen
