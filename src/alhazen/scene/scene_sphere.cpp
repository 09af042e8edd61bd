#include "alhazen/scene/scene_sphere.h"

#include <algorithm>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

BoundingSphere sphere_around_bounded(const Scene& scene) {
    Box3 box;
    if (scene.aggregate) {
        box = scene.aggregate->box();
        if (!box.empty() && !box.bounded()) {
            const PrimitiveTable& table = scene.aggregate->primitives();
            box = {};
            for (std::size_t i = 0; i < table.size(); ++i) {
                const Box3 b = table.box(i);
                if (!b.empty() && b.bounded()) box.include(b);
            }
        }
    }
    if (box.empty()) box = {{-1, -1, -1}, {1, 1, 1}};
    return {box.center(), std::max(0.5 * length(box.size()) * (1.0 + 1e-9), 1e-100)};
}

bool reaches_infinity(const Scene& scene) {
    if (!scene.aggregate) return false;
    const Box3 box = scene.aggregate->box();
    return !box.empty() && !box.bounded();
}

}  // namespace alhazen
