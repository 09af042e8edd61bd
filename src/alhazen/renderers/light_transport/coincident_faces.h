#pragma once
/// Faces of other parts that coincide with the boundary of a volume: a liquid in its glass, two
/// clouds that touch, a block of glass on its table.
///
/// Conventions: a ray meets one of them, that of the lowest primitive, and what leaves it begins
/// beyond all. So they are one surface here. Where one is opaque, that one is met. Else all are
/// crossed at once: one boundary between the volumes before and behind, with the look of the face
/// that was hit. Of volumes that are entered together that which is left last lies outermost,
/// whichever is named first; of those that no ray tells apart the lowest primitive does. Faces that
/// cover in part, thin sheets and solids of several media do not count.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/medium_stack.h"

namespace alhazen {

/// A face that is crossed together with another.
struct OtherFace {
    Medium inside;  ///< of the volume that it bounds
    bool entering = true;
    bool around = false;   ///< of the volume that the face that was hit bounds
    bool endless = false;  ///< it bounds what has no end
};
/// Of volumes that are entered, the outermost first.
using OtherFaces = std::vector<OtherFace>;

class CoincidentFaces {
  public:
    explicit CoincidentFaces(const Scene& scene);
    /// Shares what is known of the scene, and looks anew.
    CoincidentFaces(const CoincidentFaces& known) : scene_(known.scene_), kinds_(known.kinds_) {}
    CoincidentFaces& operator=(const CoincidentFaces&) = delete;
    ~CoincidentFaces() = default;

    /// Looks at the point where a ray along `direction` met a surface.
    void find(const ShadingPoint& point, const Vec3& direction, const Arrival& arrival,
              RayMask mask);
    /// Those that are crossed with it.
    [[nodiscard]] const OtherFaces& others() const { return others_; }
    /// An opaque one, along `ray()`; none: the surface itself is met.
    [[nodiscard]] const std::optional<Hit>& opaque() const { return opaque_; }
    /// Along which they were found.
    [[nodiscard]] const Ray& ray() const { return ray_; }

  private:
    enum class Kind : std::uint8_t { BoundsVolume, Opaque, Neither };

    /// One of those that are entered together: where rays from there leave its volume.
    struct Entered {
        std::array<double, 5> left{};
        std::size_t other = 0;  ///< in `others_`; its size: the face that was hit
    };
    /// What a ray is in, on its way out of them.
    struct Within {
        std::uint64_t part = 0;
        std::uint32_t material = 0;
        std::size_t entered = 0;  ///< in `entered_`; its size: none of them
    };

    void look_at(const Hit& hit, const Arrival& arrival);
    /// Sorts what is entered.
    void sort_entered(const ShadingPoint& point, const Vec3& direction, const Arrival& arrival,
                      RayMask mask);
    /// Follows a ray out of all that is entered, its `number`-th.
    void follow(const Ray& ray, std::size_t number, const Medium& own, const Arrival& arrival,
                RayMask mask);

    const Scene& scene_;
    std::shared_ptr<const std::vector<Kind>> kinds_;  ///< [material]; null: none bounds a volume
    Ray ray_;
    std::vector<Hit> hits_;
    OtherFaces others_;
    OtherFaces sorted_;
    std::vector<Entered> entered_;
    std::vector<Within> within_;
    std::optional<Hit> opaque_;
    ShadingPoint other_;
};

}  // namespace alhazen
