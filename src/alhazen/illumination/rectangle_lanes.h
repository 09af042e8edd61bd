#pragma once
/// Sampling of rectangular emitters by solid angle, for points in lanes.
///
/// Conventions: the bits are those of SphericalRectangle and of Illumination::draw. Lanes that the
/// kernel does not handle (rectangles that are sampled by area or seen edge on, NaNs) are left to
/// `sample`. Threads: used by one thread.

#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/area_lanes.h"
#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/light_lanes.h"

namespace alhazen {

class RectangleLanes {
  public:
    static constexpr std::size_t kMost = LightCallLanes::kMost;

    /// Fills all lanes with a unit square.
    RectangleLanes();

    /// True if `set` accepts the emitter: a rectangle with perpendicular edges.
    [[nodiscard]] static bool takes(const Emitter& e) {
        return e.form == EmitterForm::Rectangle && e.right_angled;
    }
    /// Fills a lane with an emitter that was chosen with `probability`. `e` must outlive the
    /// object, unchanged. `radiance`: of all its points; null: it varies.
    void set(std::size_t lane, const Emitter& e, const Rgb* radiance, double probability) {
        if (emitters_[lane] != &e) set_emitter(lane, e, radiance);
        numbers_.probability[lane] = probability;
    }
    /// As above, by what `flat` keeps of the emitter, without reading that. It has perpendicular
    /// edges.
    void set(std::size_t lane, const Emitter& e, const FlatEmitter& flat, const Spectrum& radiance,
             double probability) {
        if (emitters_[lane] != &e) {
            emitters_[lane] = &e;
            set_flat(lane, flat);
            set_radiance(lane, &radiance);
        }
        numbers_.probability[lane] = probability;
    }
    [[nodiscard]] double probability(std::size_t lane) const { return numbers_.probability[lane]; }

    /// Lanes, as bits.
    struct Drawn {
        std::uint32_t sampled = 0;  ///< by the kernel
        std::uint32_t shining = 0;  ///< of these: the emitter shines on the point
        std::uint32_t varying = 0;  ///< lanes without `radiance`
    };
    /// Samples the emitters of `lanes` for colour channels. Sets the results of the lanes that are
    /// `sampled`, except for their places; where an emitter does not shine they are 0.
    Drawn draw(std::uint32_t lanes, const LightCallLanes& calls, LightDrawLanes& results);
    /// The result of `sample` for a lane; valid after `draw`.
    [[nodiscard]] EmitterSample sampled(std::size_t lane, const LightCallLanes& calls,
                                        const LightDrawLanes& results) const;

    /// Input and output of the kernels, [coordinate][lane].
    struct Numbers {
        alignas(64) double corner[3][kMost] = {};
        alignas(64) double x[3][kMost] = {}, y[3][kMost] = {}, z[3][kMost] = {};
        alignas(64) double normal[3][kMost] = {};  ///< outer
        alignas(64) double width[kMost] = {}, height[kMost] = {};
        alignas(64) double far_squared[kMost] = {}, in_plane[kMost] = {};  ///< those of Emitter
        alignas(64) double radiance[Spectrum::kCount][kMost] = {};
        alignas(64) double probability[kMost] = {};
        alignas(64) double density[kMost] = {};  ///< result, without the probability
        std::uint32_t two_sided = 0;             ///< bits of lanes
        Drawn drawn;                             ///< `varying` is an input
    };

  private:
    void set_emitter(std::size_t lane, const Emitter& e, const Rgb* radiance);
    void set_flat(std::size_t lane, const FlatEmitter& e);
    /// `e`: an Emitter or a FlatEmitter.
    template <class AnyEmitter>
    void set_rectangle(std::size_t lane, const AnyEmitter& e, const Vec3& corner,
                       const Vec3& normal, const RectangleSides& sides);
    void set_radiance(std::size_t lane, const Spectrum* radiance);

    Numbers numbers_;
    const Emitter* emitters_[kMost] = {};  ///< null: the lane is empty
};

}  // namespace alhazen
