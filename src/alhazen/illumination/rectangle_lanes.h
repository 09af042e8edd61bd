#pragma once
/// Rectangles that shine, each sampled as a point sees it, for eight points in lanes.
///
/// Conventions: the bits of SphericalRectangle. Lanes that it does not do (solid angles too small,
/// numbers that are none) are left to `sample`.
/// Threads: used by one thread.

#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/emitter.h"

namespace alhazen {

class RectangleLanes {
  public:
    static constexpr std::size_t kMost = 8;

    /// All lanes hold some rectangle.
    RectangleLanes();

    /// Whether the emitter may be asked.
    [[nodiscard]] static bool takes(const Emitter& e) {
        return e.form == EmitterForm::Rectangle && e.right_angled;
    }
    /// Fills a lane; `e` stays as it is.
    void set(std::size_t lane, const Emitter& e, const Vec3& from, const Vec2& u);
    /// Samples all lanes.
    void draw();
    /// What `sample` gives for what the lane was filled with.
    [[nodiscard]] EmitterSample sampled(std::size_t lane) const;

    /// [coordinate][lane], read and written by kernels.
    struct Numbers {
        alignas(64) double corner[3][kMost] = {};  ///< from the point that sees it
        alignas(64) double x[3][kMost] = {}, y[3][kMost] = {}, z[3][kMost] = {};
        alignas(64) double width[kMost] = {}, height[kMost] = {};
        alignas(64) double u[2][kMost] = {};
        // Drawn.
        alignas(64) double to_light[3][kMost] = {};
        alignas(64) double distance[kMost] = {}, density[kMost] = {};
        std::uint32_t drawn = 0;  ///< bit of each lane
    };

  private:
    Numbers numbers_;
    const Emitter* emitters_[kMost] = {};  ///< null: the lane is empty
    Vec3 from_[kMost];
};

}  // namespace alhazen
