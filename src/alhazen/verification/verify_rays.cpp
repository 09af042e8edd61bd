#include "alhazen/verification/verify_rays.h"

#include <cmath>

namespace alhazen {

namespace {

constexpr int kTileSide = 8;

/// Calls f(column, row) for the pixels of a tile in cells of 4x2, the order of PixelLoop.
template <class F>
void for_each_pixel_of_tile(F&& f) {
    constexpr int kCellWidth = 4, kCellHeight = 2;
    for (int y = 0; y < kTileSide; y += kCellHeight) {
        for (int x = 0; x < kTileSide; x += kCellWidth) {
            for (int j = y; j < y + kCellHeight; ++j) {
                for (int i = x; i < x + kCellWidth; ++i) f(i, j);
            }
        }
    }
}

/// Changes the direction of a ray by `steps` of `step` along one axis. With 0 steps it keeps its
/// negative zero.
void turn(Ray& ray, int axis, int steps, double step) {
    if (steps != 0) ray.direction[axis] += steps * step;
}

}  // namespace

VerifyRays::VerifyRays(const Box3& bounds, const Camera* camera, const PrimitiveTable& table,
                       std::uint64_t seed)
    : bounds_(bounds), camera_(camera), table_(table), random_(seed) {
    if (bounds_.empty() || !bounds_.bounded()) bounds_ = {{-10, -10, -10}, {10, 10, 10}};
    // A flat scene needs room around it for the origins of rays.
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
        default: {
            if (camera_ == nullptr) return {"random", random_line()};
            // Separate statements: the order of evaluation of arguments is unspecified.
            const double x = random_.uniform(), y = random_.uniform();
            return {"eye", eye_ray(*camera_, x, y)};
        }
    }
}

void VerifyRays::append_tile(std::vector<Sample>& samples) {
    static_assert(kTileRays == kTileSide * kTileSide);
    if (tiles_++ % 4 == 0 && camera_ != nullptr) {
        const std::uint64_t tiles_across = std::uint64_t{2} << random_.below(8);
        const double pixel = 1.0 / static_cast<double>(kTileSide * tiles_across);
        const auto x0 = static_cast<double>(kTileSide * random_.below(tiles_across));
        const auto y0 = static_cast<double>(kTileSide * random_.below(tiles_across));
        for_each_pixel_of_tile([&](int i, int j) {
            const Ray ray = eye_ray(*camera_, pixel * (x0 + i + 0.5), pixel * (y0 + j + 0.5));
            samples.push_back({"tile", ray});
        });
        return;
    }
    const Ray middle = middle_ray();
    const int z = dominant_axis(middle.direction);
    const double width = std::ldexp(1.0, -3 - static_cast<int>(random_.below(8)));
    const double step = width * std::abs(middle.direction[z]);
    for_each_pixel_of_tile([&](int i, int j) {
        Ray ray = middle;
        turn(ray, (z + 1) % 3, i - kTileSide / 2, step);
        turn(ray, (z + 2) % 3, j - kTileSide / 2, step);
        samples.push_back({"tile", ray});
    });
}

void VerifyRays::append_shadow_rays(std::span<const Vec3> origins, std::vector<Sample>& samples) {
    const std::uint64_t what = random_.below(4);
    if (what == 0) {
        const Vec3 direction = random_line().direction;
        for (const Vec3& origin : origins) samples.push_back({"parallel", {origin, direction}});
        return;
    }
    Vec3 target = uniform_point();
    if (what == 1) {
        for (int k = 0; k < 3; ++k) target[k] = std::round(2.0 * target[k]) / 2.0;
    }
    const bool of_unit_length = random_.below(2) == 0;
    for (const Vec3& origin : origins) {
        Ray ray{origin, target - origin, 0.0, 1.0};
        const double distance = length(ray.direction);
        if (of_unit_length && distance > 0.0) {
            ray.direction = ray.direction / distance;
            ray.t_max = distance;
        }
        samples.push_back({"converging", ray});
    }
}

Ray VerifyRays::middle_ray() {
    switch (random_.below(3)) {
        case 0:
            return random_line();
        case 1:
            return lattice_ray();
        default:
            return aimed_ray();
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
    // Half of the rays start well outside: ten times the distance back along the line.
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
        // Faces of modelled scenes often have integer coordinates.
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
