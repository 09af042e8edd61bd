#pragma once
/// Sampling of rectangular emitters by solid angle, for eight points in lanes.
///
/// Conventions: the bits are those of SphericalRectangle. Lanes that the kernel does not handle
/// (solid angles up to kLeastSolidAngle, rectangles edge on, NaNs) are sampled by `sample`.
/// Threads: used by one thread.

#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/emitter.h"

namespace alhazen {

class RectangleLanes {
  public:
    static constexpr std::size_t kMost = 8;

    /// Fills all lanes with a unit square.
    RectangleLanes();

    /// True if `set` accepts the emitter: a rectangle with perpendicular edges.
    [[nodiscard]] static bool takes(const Emitter& e) {
        return e.form == EmitterForm::Rectangle && e.right_angled;
    }
    /// Fills a lane. `e` must outlive the object, unchanged.
    void set(std::size_t lane, const Emitter& e, const Vec3& from, const Vec2& u);
    /// Samples all lanes.
    void draw();
    /// The result of `sample` for the arguments of `set`; valid after `draw`.
    [[nodiscard]] EmitterSample sampled(std::size_t lane) const;
    /// The point of `set`.
    [[nodiscard]] const Vec3& from(std::size_t lane) const { return from_[lane]; }
    /// The same in lanes, where `drawn`.
    struct Numbers;
    [[nodiscard]] const Numbers& numbers() const { return numbers_; }

    /// Input and output of the kernels, [coordinate][lane].
    struct Numbers {
        alignas(64) double corner[3][kMost] = {};  ///< relative to the point of view
        alignas(64) double x[3][kMost] = {}, y[3][kMost] = {}, z[3][kMost] = {};
        alignas(64) double normal[3][kMost] = {};  ///< outer
        alignas(64) double width[kMost] = {}, height[kMost] = {};
        alignas(64) double u[2][kMost] = {};
        // Results.
        alignas(64) double to_light[3][kMost] = {};
        alignas(64) double distance[kMost] = {}, density[kMost] = {};
        std::uint32_t two_sided = 0;  ///< bits of lanes; input
        std::uint32_t drawn = 0;      ///< bits of the lanes that the kernel has sampled
        std::uint32_t shining = 0;    ///< bits of the lanes whose emitter shines on the point
    };

  private:
    Numbers numbers_;
    const Emitter* emitters_[kMost] = {};  ///< null: the lane is empty
    Vec3 from_[kMost];
};

}  // namespace alhazen
