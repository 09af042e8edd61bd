#include "alhazen/verification/verify_rays.h"

namespace alhazen {

VerifyRays::VerifyRays(const Box3& bounds, const Camera* camera, const PrimitiveTable& table,
                       std::uint64_t seed)
    : bounds_(bounds), camera_(camera), table_(table), random_(seed) {
    if (bounds_.empty() || !bounds_.bounded()) bounds_ = {{-10, -10, -10}, {10, 10, 10}};
    // A flat scene still needs room around it to start rays in.
    const double margin = 0.1 * max_component(bounds_.size()) + 1e-300;
    bounds_ = {bounds_.lo - Vec3{margin, margin, margin},
               bounds_.hi + Vec3{margin, margin, margin}};
}

VerifyRays::Sample VerifyRays::next() {
    switch (count_++ % 4) {
        case 0:
            return {"random", random_line()};
        case 1:
            return {"lattice", lattice_ray()};
        case 2:
            return {"aimed", aimed_ray()};
        default:
            if (camera_ == nullptr) return {"random", random_line()};
            return {"eye", eye_ray(*camera_, random_.uniform(), random_.uniform())};
    }
}

Vec3 VerifyRays::uniform_point() {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = random_.uniform(bounds_.lo[k], bounds_.hi[k]);
    return p;
}

Ray VerifyRays::random_line() {
    const Vec3 a = uniform_point();
    const Vec3 b = uniform_point();
    const Vec3 direction = b - a;
    // Start well outside: ten times the distance back along the line, half of the time.
    const Vec3 origin = random_.below(2) == 0 ? a - 10.0 * direction : a;
    return {origin, direction};
}

Ray VerifyRays::lattice_ray() {
    constexpr int kCells = 8;
    const Vec3 cell = bounds_.size() / kCells;
    Ray ray;
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] =
            bounds_.lo[k] + cell[k] * (static_cast<double>(random_.below(3 * kCells)) - kCells);
        // Whole numbers are where modelled scenes put their faces.
        if (random_.below(2) == 0) ray.origin[k] = std::round(2.0 * ray.origin[k]) / 2.0;
    }
    do {
        for (int k = 0; k < 3; ++k) {
            const double step = static_cast<double>(random_.below(5)) - 2.0;
            ray.direction[k] = random_.below(2) == 0 ? 0.0 : step;
            if (ray.direction[k] == 0.0 && random_.below(2) == 0) ray.direction[k] = -0.0;
        }
    } while (ray.direction == Vec3{});
    return ray;
}

Ray VerifyRays::aimed_ray() {
    const std::uint32_t first = table_.first(kTriangleKind);
    const std::uint32_t triangles = table_.first(kTriangleKind + 1) - first;
    if (triangles == 0) return random_line();
    const auto corners =
        table_.triangle_vertices(static_cast<std::uint32_t>(random_.below(triangles)));
    Vec3 target = corners[random_.below(3)];
    const std::uint64_t what = random_.below(3);
    if (what == 1) {
        target = 0.5 * corners[0] + 0.5 * corners[1];
    } else if (what == 2) {
        const double w = random_.uniform();
        target = (1.0 - w) * corners[1] + w * corners[2];
    }
    const Vec3 origin = uniform_point();
    if (target == origin) return random_line();
    return {origin, target - origin};
}

}  // namespace alhazen
