#pragma once
/// Random solids that are described by lists, for random_shapes.h.

#include "support/random_shapes.h"

namespace alhazen::testing {

/// Adds a loop around `middle` with radii between 0.4 and 1 times `size`; segments are lines and
/// curves at random.
inline void add_random_loop(Profile& profile, Random& random, Vec2 middle, double size) {
    const int n = 3 + random.below(5);
    const auto at = [&](double turn, double r) {
        return middle + size * r * Vec2{std::cos(turn), std::sin(turn)};
    };
    std::vector<Vec2> corners;
    const double step = 2 * 3.14159265358979 / n;
    for (int i = 0; i < n; ++i) corners.push_back(at(i * step, random.uniform(0.5, 0.9)));
    for (int i = 0; i < n; ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % n];
        if (random.coin()) {
            profile.curves.push_back(line_curve(a, b));
        } else {
            profile.curves.push_back(cubic_curve(a, at((i + 0.35) * step, random.uniform(0.3, 1)),
                                                 at((i + 0.65) * step, random.uniform(0.3, 1)), b));
        }
    }
    profile.loop_ends.push_back(static_cast<std::uint32_t>(profile.curves.size()));
}

inline void add_polygon(Profile& profile, const std::vector<Vec2>& points, bool close = true) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        profile.curves.push_back(line_curve(points[i], points[i + 1]));
    }
    if (close) profile.curves.push_back(line_curve(points.back(), points.front()));
    profile.loop_ends.push_back(static_cast<std::uint32_t>(profile.curves.size()));
}

template <>
struct RandomShape<Prism> {
    static Prism make(const ShapeSource& from) {
        Random& random = from.random;
        Prism prism;
        const Vec3 middle = from.point();
        const double size = from.length();
        prism.h0 = middle.z;
        prism.h1 = middle.z + from.length();
        const double sizes[] = {1, 0, 0.5, 1.5};
        prism.top_scale = sizes[random.below(4)];
        // The slope of tapered sides grows with the distance from the axis.
        const double lean = prism.top_scale == 1 ? 1.0 : 0.05;
        const Vec2 m = from.lattice ? Vec2{middle.x, middle.y} : lean * Vec2{middle.x, middle.y};
        if (from.lattice) {
            const double u = 0.5;
            add_polygon(prism.profile, {m, m + Vec2{2 * u, 0}, m + Vec2{2 * u, u}, m + Vec2{u, u},
                                        m + Vec2{u, 3 * u}, m + Vec2{0, 3 * u}});
            return prism;
        }
        add_random_loop(prism.profile, random, m, size);
        if (random.coin()) add_random_loop(prism.profile, random, m, 0.4 * size);
        // Two loops that cross.
        if (random.below(4) == 0) add_random_loop(prism.profile, random, m + Vec2{size, 0}, size);
        return prism;
    }
};

template <>
struct RandomShape<Lathe> {
    static Lathe make(const ShapeSource& from) {
        Random& random = from.random;
        Lathe lathe;
        const double size = from.length(), z = from.point().z;
        if (from.lattice) {
            const bool open = random.below(4) == 0;
            add_polygon(lathe.profile,
                        {{0, z}, {2 * size, z}, {2 * size, z + 1}, {size, z + 2}, {0, z + 2}},
                        false);
            if (open) {
                lathe.profile.curves.erase(lathe.profile.curves.begin());
                lathe.profile.loop_ends = {3};
            }
            return lathe;
        }
        if (random.coin()) {
            add_random_loop(lathe.profile, random, {random.uniform(1, 3) * size, z}, size);
            return lathe;
        }
        // From axis to axis, or a shell with ends off the axis.
        Vec2 last{random.below(4) == 0 ? 0.3 * size : 0.0, z};
        const int n = 2 + random.below(4);
        const auto beside = [&](double part) {
            return Vec2{random.uniform(0.1, 1) * size, z + part * size};
        };
        for (int i = 0; i < n; ++i) {
            Vec2 next = beside((i + 1.0) / n);
            if (i + 1 == n) next.x = 0.0;
            lathe.profile.curves.push_back(
                random.coin()
                    ? line_curve(last, next)
                    : cubic_curve(last, beside((i + 0.2) / n), beside((i + 0.8) / n), next));
            last = next;
        }
        lathe.profile.loop_ends = {static_cast<std::uint32_t>(n)};
        return lathe;
    }
};

template <>
struct RandomShape<Blob> {
    static Blob make(const ShapeSource& from) {
        Random& random = from.random;
        Blob blob;
        const Vec3 middle = from.point();
        const double size = from.length();
        for (int i = 1 + random.below(8); i > 0; --i) {
            BlobComponent c;
            c.base = middle + (from.lattice ? random.on_lattice(1, 0.5) : size * random.in_cube(1));
            c.radius = from.lattice ? 1.0 : size * random.uniform(0.4, 1.5);
            c.strength = random.below(6) == 0 ? -0.5 : random.uniform(0.7, 2);
            c.rod = random.below(3) == 0;
            c.top = c.rod ? c.base + from.vector() : c.base;
            blob.components.push_back(c);
        }
        blob.components[0].strength = 2;
        return blob;
    }
};

template <>
struct RandomShape<HeightField> {
    static HeightField make(const ShapeSource& from) {
        Random& random = from.random;
        HeightField field;
        const Vec3 corner = from.point();
        field.columns = static_cast<std::uint32_t>(2 + random.below(6));
        field.rows = static_cast<std::uint32_t>(2 + random.below(6));
        field.lo = {corner.x, corner.y};
        field.hi = {corner.x + from.length(), corner.y + from.length()};
        field.base = corner.z;
        auto heights = std::make_shared<std::vector<float>>();
        const double rise = from.length();
        for (std::uint32_t i = 0; i < field.columns * field.rows; ++i) {
            const double h =
                from.lattice ? rise * (1 + random.below(2)) : rise * random.uniform(0.5, 1);
            heights->push_back(static_cast<float>(corner.z + h));
        }
        field.heights = heights;
        return field;
    }
};

}  // namespace alhazen::testing
