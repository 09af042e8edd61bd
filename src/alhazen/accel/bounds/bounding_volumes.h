#pragma once
/// Bounds around all primitives without a hierarchy: each ray is tested against all bounds, and
/// against the primitives whose bounds it intersects.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980
/// (spheres); Foley, van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., section 15.10.2
/// (bounding volumes); Kay and Kajiya, SIGGRAPH 1986 (slabs).
/// Complexity: O(n) per ray.

#include <cstdint>
#include <variant>
#include <vector>

#include "alhazen/accel/bounds/bound_kind.h"
#include "alhazen/accel/bounds/bounds.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

class BoundingVolumes {
  public:
    static constexpr const char* kName = "bounding_volumes";
    static constexpr const char* kDescription = "a bound around every primitive, no hierarchy";
    struct Config {
        BoundKind bound = BoundKind::Box;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader) {
        return {read_bound(reader, BoundKind::Box)};
    }

    [[nodiscard]] static BoundingVolumes build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        std::visit(
            [&]<class B>(const std::vector<B>& bounds) {
                const typename B::Probe probe(ray);
                for (std::uint32_t i = 0; i < bounds.size(); ++i) {
                    if (!probe.enter(bounds[i], visitor.t_max(), stats)) continue;
                    if (visitor.visit(i)) return;
                }
            },
            bounds_);
    }

    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    std::variant<std::vector<BoxBound>, std::vector<SphereBound>, std::vector<EllipsoidBound>,
                 std::vector<SlabBound<7>>, std::vector<SlabBound<13>>>
        bounds_;
};
static_assert(Accelerator<BoundingVolumes>);

}  // namespace alhazen
