#include "alhazen/shapes/polygons/polyhedron.h"

#include <gtest/gtest.h>

#include "alhazen/shapes/polygons/box_shape.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;

std::string complaint(const Polyhedron& p) {
    Diagnostics diagnostics;
    p.validate({}, diagnostics);
    return diagnostics.all().empty() ? "" : diagnostics.all().front().message;
}

Polyhedron prepared(Polyhedron p) {
    EXPECT_EQ(complaint(p), "");
    p.prepare();
    return p;
}

Polyhedron box_of_planes(const Vec3& lo, const Vec3& hi) {
    Polyhedron p;
    for (int k = 0; k < 3; ++k) {
        Vec3 axis{};
        axis[k] = 2.0;
        p.planes.push_back({lo, -axis});
        p.planes.push_back({hi, axis});
    }
    return p;
}

std::array<Vec3, 8> box_points(const Vec3& lo, const Vec3& hi) {
    return {Vec3{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z},
            Vec3{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}};
}

/// Volume of the found corners, to test convex_corners.
double volume(const Polyhedron& p) {
    return convex_volume(convex_corners(p.faces));
}

TEST(Polyhedron, OfAxisParallelPlanesIsTheBoxBitForBit) {
    Random random(41);
    for (int i = 0; i < 3000; ++i) {
        const bool lattice = i % 2 == 1;
        const Vec3 lo = lattice ? random.on_lattice(2, 0.5) : random.in_cube(4);
        const Vec3 size{random.uniform(0.5, 3), random.uniform(0.5, 3), random.uniform(0.5, 3)};
        const BoxShape box{.lo = lo, .hi = lo + size};
        const Polyhedron planes = prepared(box_of_planes(box.lo, box.hi));
        const Polyhedron points = prepared(hexahedron(box_points(box.lo, box.hi)));
        EXPECT_NEAR(volume(points), size.x * size.y * size.z, 1e-12 * volume(planes));
        const Ray ray = lattice ? line(random.on_lattice(5, 0.25), random.lattice_direction())
                                : line(random.in_cube(8), lo + 0.5 * size - random.in_cube(8));
        ShapeHit a[2], b[2], c[2];
        const int n = box.intersect(ray, a);
        ASSERT_EQ(planes.intersect(ray, b), n) << i;
        ASSERT_EQ(points.intersect(ray, c), n) << i;
        for (int k = 0; k < n; ++k) {
            ASSERT_EQ(a[k].t, b[k].t) << i;
            ASSERT_NEAR(a[k].t, c[k].t, 1e-14 * (std::abs(a[k].t) + length(lo)));
        }
    }
}

TEST(Polyhedron, HexahedraWithCoincidingPointsAreWedgesPyramidsAndTetrahedra) {
    const Vec3 o{0, 0, 0}, x{2, 0, 0}, y{0, 3, 0}, z{0, 0, 4}, xy = x + y, xz = x + z;
    const struct {
        std::array<Vec3, 8> points;
        double volume;
        std::size_t faces;
    } cases[] = {
        {{o, x, xy, y, z, xz, xy + z, y + z}, 24, 6},
        {{o, x, xy, y, z, xz, xz, z}, 12, 5},  // a wedge
        {{o, x, xy, y, z, z, z, z}, 8, 5},     // a pyramid
        {{o, x, y, y, z, z, z, z}, 4, 4},      // a tetrahedron
        {{o, o, x, y, z, z, z, z}, 4, 4},      // another numbering of it
        {{o, x, xy, y, z, xz, xy, y}, 12, 5},  // points of the top on the bottom
    };
    for (const auto& c : cases) {
        const Polyhedron p = prepared(hexahedron(c.points));
        EXPECT_NEAR(volume(p), c.volume, 1e-12);
        EXPECT_EQ(p.faces.size(), c.faces);
    }
}

TEST(Polyhedron, AMirroredHexahedronIsTheSameSolid) {
    std::array<Vec3, 8> points = box_points({-1, -1, -1}, {1, 2, 3});
    const Polyhedron a = prepared(hexahedron(points));
    for (int i = 0; i < 4; ++i) std::swap(points[i], points[i + 4]);
    const Polyhedron b = prepared(hexahedron(points));
    ShapeHit hits[2];
    const Ray ray = line({0.5, 0.25, -9}, {0, 0, 1});
    ASSERT_EQ(b.intersect(ray, hits), 2);
    EXPECT_EQ(b.surface(ray, hits[0]).normal, (Vec3{0, 0, -1}));
    EXPECT_EQ(volume(a), volume(b));
}

TEST(Polyhedron, FacesNeedBeFlatOnlyRoughly) {
    std::array<Vec3, 8> points = box_points({0, 0, 0}, {100, 100, 100});
    points[6] += Vec3{1e-3, -2e-3, 1e-3};
    EXPECT_EQ(complaint(hexahedron(points)), "");
    points[6] += Vec3{-3, -3, -3};
    EXPECT_NE(complaint(hexahedron(points)).find("not convex"), std::string::npos);
}

/// A dodecahedron from planes at distance 1 from the centre.
Polyhedron dodecahedron(const Vec3& middle) {
    const double phi = (1 + std::sqrt(5.0)) / 2;
    Polyhedron p;
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-phi, phi}) {
            for (const Vec3 n : {Vec3{0, a, b}, Vec3{a, b, 0}, Vec3{b, 0, a}}) {
                p.planes.push_back({middle + normalize(n), n});
            }
        }
    }
    return p;
}

TEST(Polyhedron, TheCornersOfADodecahedronAreItsTwenty) {
    const Polyhedron p = prepared(dodecahedron({3, -2, 5}));
    const ConvexCorners solid = convex_corners(p.faces);
    EXPECT_EQ(solid.corners.size(), 60u);
    // For inradius 1: circumradius, and volume = (area of the faces) / 3.
    const double circumradius = std::sqrt(15.0 - 6.0 * std::sqrt(5.0));
    for (const Vec3& c : solid.corners) {
        EXPECT_NEAR(length(c - Vec3{3, -2, 5}), circumradius, 1e-14);
    }
    EXPECT_NEAR(convex_volume(solid), 10.0 * std::sqrt(130.0 - 58.0 * std::sqrt(5.0)), 1e-12);
    Random random(43);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 inner = Vec3{3, -2, 5} + 0.99 * random.unit_vector();
        ShapeHit hits[2];
        const Ray ray = line(inner, random.unit_vector());
        ASSERT_EQ(p.intersect(ray, hits), 2);
        ASSERT_LT(hits[0].t, 0);
        ASSERT_GT(hits[1].t, 0);
        for (const ShapeHit& hit : hits) {
            const Vec3 at = p.surface(ray, hit).point - Vec3{3, -2, 5};
            double farthest = 0;
            for (const OrientedPlane& f : p.faces) farthest = std::max(farthest, dot(f.normal, at));
            ASSERT_NEAR(farthest, 1, 1e-14);
        }
    }
}

TEST(Polyhedron, RefusesWhatDoesNotBoundAVolume) {
    Polyhedron open = box_of_planes({0, 0, 0}, {1, 1, 1});
    open.planes.pop_back();
    EXPECT_NE(complaint(open).find("do not bound a volume"), std::string::npos);
    Polyhedron empty = box_of_planes({0, 0, 0}, {1, 1, 1});
    empty.planes.push_back({{0, 0, -1}, {0, 0, 1}});
    EXPECT_NE(complaint(empty).find("nothing lies inside"), std::string::npos);
    EXPECT_NE(complaint(Polyhedron{}), "");
    Polyhedron numbers = hexahedron(box_points({0, 0, 0}, {1, 1, 1}));
    numbers.corners[3] = 8;
    EXPECT_NE(complaint(numbers).find("names vertex 8"), std::string::npos);
    Polyhedron nothing = box_of_planes({0, 0, 0}, {1, 1, 1});
    nothing.planes[2].normal = {};
    EXPECT_NE(complaint(nothing).find("normal of a plane"), std::string::npos);
    EXPECT_NE(complaint(hexahedron({})), "");
}

TEST(Polyhedron, PlanesGivenTwiceOrThatDoNotTouchChangeNothing) {
    Polyhedron p = dodecahedron({0, 0, 0});
    const double once = volume(prepared(p));
    p.planes.insert(p.planes.end(), p.planes.begin(), p.planes.begin() + 5);
    p.planes.push_back({{0, 0, 7}, {0, 0, 1}});
    const Polyhedron twice = prepared(p);
    EXPECT_LT(max_component(abs(twice.box().hi - prepared(dodecahedron({0, 0, 0})).box().hi)),
              1e-13);
    ShapeHit hits[2];
    EXPECT_EQ(twice.intersect(line({0, 0, -9}, {0.01, 0.02, 1}), hits), 2);
    EXPECT_GT(once, 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
