#pragma once
/// Brute force: tests every ray against every primitive, in the order of their ids; the reference
/// for all other accelerators. With `transform=z`, tests the primitives whose bounds the ray
/// intersects, from front to back.
///
/// Source: Appel, "Some Techniques for Shading Machine Renderings of Solids", AFIPS 1968; Rubin and
/// Whitted, "A 3-Dimensional Representation for Fast Rendering of Complex Scenes", SIGGRAPH 1980
/// (`transform=z`: space is rotated so that the ray runs along the z axis; candidates have a bound
/// around x = y = 0, and are sorted by z).
/// Differs: rotates boxes around primitives, widened by more than the rounding of the rotation;
/// primitives themselves are tested unrotated.
/// Complexity: O(n) per ray; no memory, with `transform=z` a box per primitive.

#include <cmath>
#include <vector>

#include "alhazen/accel/bounds/bounds.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/reentrant_stack.h"

namespace alhazen {

class List {
  public:
    static constexpr const char* kName = "list";
    static constexpr const char* kDescription = "brute force: every ray against every primitive";
    struct Config {
        bool to_z = false;  ///< rotate the ray to the z axis
    };
    [[nodiscard]] static Config configure(SettingsReader& reader) {
        static constexpr const char* kTransforms[] = {"none", "z"};
        return {reader.choice("transform", "z: bounds in the frame of the ray, sorted by depth", 0,
                              kTransforms) == 1};
    }

    [[nodiscard]] static List build(const BoundsSource& source, const Config& config) {
        List list;
        list.count_ = static_cast<std::uint32_t>(source.size());
        list.to_z_ = config.to_z;
        for (std::uint32_t i = 0; config.to_z && i < list.count_; ++i) {
            list.boxes_.push_back(source.box(i));
        }
        return list;
    }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (to_z_) return traverse_by_depth(ray, visitor, stats);
        for (std::uint32_t i = 0; i < count_; ++i) {
            if (visitor.visit(i)) return;
        }
    }

    [[nodiscard]] std::size_t memory_bytes() const {
        return sizeof(*this) + boxes_.capacity() * sizeof(Box3);
    }

  private:
    struct Met {
        double depth;
        std::uint32_t primitive;
    };
    /// The frame of a ray: its origin, and unit axes with z along the ray.
    struct RayFrame {
        Vec3 origin, x, y, z;
        double per_t;  ///< depth per unit of t
        double reach;

        explicit RayFrame(const Ray& ray)
            : origin(ray.origin), reach(max_component(abs(ray.origin))) {
            const double scale = max_component(abs(ray.direction));
            const Vec3 scaled = ray.direction / scale;
            per_t = scale * length(scaled);
            z = scaled / length(scaled);
            const Vec3 beside = std::abs(z.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
            x = normalize(cross(beside, z));
            y = cross(z, x);
        }
        /// The range of a box along an axis of the frame.
        [[nodiscard]] Interval range(const Box3& box, const Vec3& axis) const {
            const double middle = dot(axis, box.center() - origin);
            const double half = 0.5 * dot(abs(axis), box.size());
            const double margin =
                kBoundSlack * (reach + max_component(abs(box.lo)) + max_component(abs(box.hi)));
            return {middle - half - margin, middle + half + margin};
        }
    };

    template <class Visitor, class Stats>
    void traverse_by_depth(const Ray& ray, Visitor& visitor, Stats stats) const {
        const RayFrame frame(ray);
        const double near = ray.t_min * frame.per_t, far = visitor.t_max() * frame.per_t;
        ReentrantStack<Met> met;
        stats.boxes(count_);
        for (std::uint32_t i = 0; i < count_; ++i) {
            const Box3& box = boxes_[i];
            if (!frame.range(box, frame.x).contains(0) || !frame.range(box, frame.y).contains(0)) {
                continue;
            }
            const Interval depth = frame.range(box, frame.z);
            if (depth.hi >= near && depth.lo <= far) met.push({depth.lo, i});
        }
        std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {
            return a.depth != b.depth ? a.depth < b.depth : a.primitive < b.primitive;
        });
        for (std::size_t i = 0, n = met.size(); i < n; ++i) {
            // Fetched in each iteration: a visit may reallocate the stack.
            const Met next = met.begin()[i];
            if (next.depth > visitor.t_max() * frame.per_t) return;
            if (visitor.visit(next.primitive)) return;
        }
    }

    std::uint32_t count_ = 0;
    bool to_z_ = false;
    std::vector<Box3> boxes_;  ///< [primitive], for `to_z`
};
static_assert(Accelerator<List>);

}  // namespace alhazen
