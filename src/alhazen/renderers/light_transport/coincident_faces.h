#pragma once
/// Faces of other parts that coincide with the boundary of a volume: a liquid in its glass, two
/// clouds that touch, a block of glass on its table.
///
/// Conventions: a ray meets one of them, that of the lowest primitive, and what leaves it begins
/// beyond all. So they are one surface here. Where one is opaque, that one is met. Else all are
/// crossed at once: one boundary between the volumes before and behind, with the look of the face
/// that was hit. Faces that cover in part, thin sheets and solids of several media do not count.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/base/inline_vector.h"
#include "alhazen/base/unmade.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/medium_stack.h"

namespace alhazen {

/// A face that is crossed together with another.
struct OtherFace {
    Medium inside;  ///< of the volume that it bounds
    bool entering = true;
};
using OtherFaces = InlineVector<Unmade<OtherFace>, 2>;

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

    void look_at(const Hit& hit, const Arrival& arrival);

    const Scene& scene_;
    std::shared_ptr<const std::vector<Kind>> kinds_;  ///< [material]; null: none bounds a volume
    Ray ray_;
    std::vector<Hit> hits_;
    OtherFaces others_;
    std::optional<Hit> opaque_;
    ShadingPoint other_;
};

}  // namespace alhazen
