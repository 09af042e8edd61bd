#pragma once
/// Sampling by area of flat emitters (triangles, parallelograms) in lanes, for scenes of many
/// lights, most of which are far from any point.
///
/// Conventions: the bits are those of `sample` (emitter.h) and Illumination::draw. Emitters near a
/// point, which may be sampled by solid angle, are left to these. Threads: used by one thread.

#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/light_lanes.h"

namespace alhazen {

/// What a sample by area reads of an emitter, in two lines of the cache.
struct alignas(64) FlatEmitter {
    Vec3 corner, x, y, normal;   ///< columns of Emitter::world_from_own
    double density = 0;          ///< by area
    double far_squared = 0;      ///< of Emitter; below 0: always sampled by area
    double in_plane = -1;        ///< of Emitter
    std::uint32_t radiance = 0;  ///< number of its radiance, the same at all points
    EmitterForm form = EmitterForm::Triangle;
    bool two_sided = false;
    bool is_flat = false;  ///< false: no such emitter

    FlatEmitter() = default;
    FlatEmitter(const Emitter& e, std::uint32_t radiance_number);
    [[nodiscard]] EmittingTriangle triangle() const {
        return {corner, x, y, normal, density, two_sided};
    }
};
static_assert(sizeof(FlatEmitter) == 128);

class AreaLanes {
  public:
    static constexpr std::size_t kMost = LightCallLanes::kMost;

    /// Fills all lanes with a triangle.
    AreaLanes();

    /// Fills a lane with an emitter, number `light`, that was chosen with `probability`.
    void set(std::size_t lane, const FlatEmitter& e, const Spectrum& radiance, std::size_t light,
             double probability);
    /// Samples the emitters of `lanes` for colour channels, and sets their results. Returns the
    /// lanes that are left out, since their points are near the emitter.
    [[nodiscard]] std::uint32_t draw(std::uint32_t lanes, const LightCallLanes& calls,
                                     LightDrawLanes& results);

    /// Input and output of the kernels, [coordinate][lane].
    struct Numbers {
        alignas(64) double corner[3][kMost] = {}, x[3][kMost] = {}, y[3][kMost] = {};
        alignas(64) double normal[3][kMost] = {};
        alignas(64) double area_density[kMost] = {}, far_squared[kMost] = {}, in_plane[kMost] = {};
        alignas(64) double probability[kMost] = {};
        alignas(64) double radiance[Spectrum::kCount][kMost] = {};
        alignas(64) double weights[2][kMost] = {};   ///< result: of the second and third corner
        std::uint32_t two_sided = 0, triangles = 0;  ///< bits of lanes
        std::uint32_t drawn = 0, shining = 0;        ///< results
    };

  private:
    Numbers numbers_;
    std::size_t lights_[kMost] = {};
};

}  // namespace alhazen
