// Traces a ball above a square of two triangles and prints the view of an eye in front of them: O
// lit ball, o shaded ball, - floor, # shadow on the floor.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

#include "alhazen/tracer/tracer.h"

int main() try {
    using namespace alhazen;
    TracerScene scene;
    const std::vector<float> corners{-4, 0, -4, 4, 0, -4, 4, 0, 4, -4, 0, 4};
    const std::vector<std::uint32_t> triangles{0, 2, 1, 0, 3, 2};
    scene.add_mesh(corners, triangles);
    const GeometryId ball = scene.add_sphere({0, 1.2, 0}, 1);
    const Tracer tracer(std::move(scene));

    constexpr int kColumns = 64, kRows = 20;
    std::vector<Ray> rays;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            rays.push_back({{0, 3, 9}, {(column - 31.5) / 60, (5 - row) / 30.0 - 0.1, -1}});
        }
    }
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);

    const Vec3 light{3, 6, 3};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        char sign = ' ';
        if (hits[i].found()) {
            const HitDetails at = tracer.details(rays[i], hits[i]);
            const bool dark = tracer.occluded(leaving_ray(at, light - at.point, 1.0));
            sign = at.geometry == ball ? (dark ? 'o' : 'O') : (dark ? '#' : '-');
        }
        std::putchar(sign);
        if (i % kColumns == kColumns - 1) std::putchar('\n');
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "trace_rays: %s\n", error.what());
    return 1;
}
