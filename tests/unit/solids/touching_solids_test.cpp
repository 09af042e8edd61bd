// Solids that touch in a face have neither gap nor overlap there: a line in the face is in one of
// them.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "alhazen/scene/scene.h"
#include "alhazen/solids/spans.h"
#include "unit/formats/native/native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr std::array<const char*, 8> kKinds{"box",        "cylinder",   "cylinder, reversed",
                                            "polyhedron", "half space", "elliptic cylinder",
                                            "prism",      "lathe"};
constexpr std::size_t kAnyAxis = 6;  ///< kinds that exist along every axis

/// A point with the coordinate `along` on an axis and two others.
Vec3 point(int axis, double along, double a, double b) {
    Vec3 p;
    p[axis] = along;
    p[(axis + 1) % 3] = a;
    p[(axis + 2) % 3] = b;
    return p;
}

std::string text(const Vec3& p) {
    return "(" + std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z) + ")";
}

/// A solid of width 1 between two heights on an axis.
std::string solid(const std::string& kind, int axis, double from, double to) {
    const auto at = [&](double along, double a = 0, double b = 0) {
        return text(point(axis, along, a, b));
    };
    if (kind == "box") return "box { lo=" + at(from, -.5, -.5) + " hi=" + at(to, .5, .5) + " }";
    if (kind == "cylinder") {
        return "cylinder { base=" + at(from) + " top=" + at(to) + " radius=0.5 }";
    }
    if (kind == "cylinder, reversed") {
        return "cylinder { base=" + at(to) + " top=" + at(from) + " radius=0.5 }";
    }
    const auto half_spaces = [&](const char* before, const char* between, const char* after) {
        std::string all;
        const auto add = [&](const std::string& p, const std::string& normal) {
            all += before + p + between + normal + after;
        };
        add(at(from), at(-1));
        add(at(to), at(1));
        for (const double side : {-.5, .5}) {
            add(at(0, side, 0), at(0, 2 * side, 0));
            add(at(0, 0, side), at(0, 0, 2 * side));
        }
        return all;
    };
    if (kind == "polyhedron") {
        std::string planes = half_spaces("(", ",", "),");
        planes.pop_back();
        return "polyhedron { planes=[" + planes + "] }";
    }
    if (kind == "half space") {
        return "intersection { " + half_spaces("half_space { point=", " normal=", " } ") + "}";
    }
    if (kind == "elliptic cylinder") {
        return "elliptic_cylinder { base=" + at(from) + " top=" + at(to) +
               " axis_a=" + at(0, .5, 0) + " axis_b=" + at(0, 0, .5) + " }";
    }
    const std::string lo = std::to_string(from), hi = std::to_string(to);
    if (kind == "prism") {
        return "prism { profile=[(-0.5,-0.5),(0.5,-0.5),(0.5,0.5),(-0.5,0.5)] h0=" + lo +
               " h1=" + hi + " }";
    }
    return "lathe { loops=[[(0," + lo + "),(0.5," + lo + "),(0.5," + hi + "),(0," + hi + ")]] }";
}

/// The length of a line within the solids of a scene.
double thickness(const std::string& scene, const Vec3& origin, const Vec3& direction) {
    const auto read = testing::import_native("material \"m\" { diffuse=1 }\n" + scene);
    EXPECT_EQ(read.errors(), 0u) << read.messages() << scene;
    if (read.errors() > 0) return -1;
    const SolidQueries solids(compile(read.scene).aggregate);
    SpanList scratch;
    return solids.thickness({origin, direction}, scratch).inside_any;
}

void expect_no_gap(const std::string& lower, const std::string& upper, int axis) {
    const std::string both = lower + " " + upper + " material=\"m\" }";
    const std::string block =
        "box { lo=" + text(point(axis, -1, -1, -1)) + " hi=" + text(point(axis, 3, 1, 1)) + " } ";
    for (const double sign : {-1.0, 1.0}) {
        for (const Vec3& along : {point(axis, 0, sign, 0), point(axis, 0, 0, sign)}) {
            const Vec3 origin = point(axis, 1, 0, 0) - 5.0 * along;
            SCOPED_TRACE(both + " along " + text(along));
            EXPECT_NEAR(thickness("union { " + both, origin, along), 1.0, 1e-12);
            EXPECT_NEAR(thickness("group { " + both, origin, along), 1.0, 1e-12);
            EXPECT_NEAR(thickness("difference { " + block + both, origin, along), 1.0, 1e-12);
        }
    }
}

TEST(TouchingSolids, HaveNoGapInTheirCommonFace) {
    for (const char* lower : kKinds) {
        for (const char* upper : kKinds) {
            expect_no_gap(solid(lower, 2, 0, 1), solid(upper, 2, 1, 2), 2);
        }
    }
    for (int axis = 0; axis < 2; ++axis) {
        for (std::size_t i = 0; i < kAnyAxis; ++i) {
            for (std::size_t j = 0; j < kAnyAxis; ++j) {
                expect_no_gap(solid(kKinds[i], axis, 0, 1), solid(kKinds[j], axis, 1, 2), axis);
            }
        }
    }
}

TEST(TouchingSolids, SidesOfPrismsHaveNoGapEither) {
    const auto prism = [](double from, double to) {
        const std::string a = std::to_string(from), b = std::to_string(to);
        return "prism { profile=[(" + a + ",-0.5),(" + b + ",-0.5),(" + b + ",0.5),(" + a +
               ",0.5)] h0=-0.5 h1=0.5 }";
    };
    expect_no_gap(prism(0, 1), prism(1, 2), 0);
    expect_no_gap(prism(0, 1), solid("box", 0, 1, 2), 0);
    expect_no_gap(solid("box", 0, 0, 1), prism(1, 2), 0);
}

// An axis that only rounds to an axis of coordinates; the line crosses half way up.
TEST(TouchingSolids, AnAxisThatIsNearlyOneOfCoordinatesIsNone) {
    EXPECT_NEAR(thickness("cylinder { base=(0,0,0) top=(1,1e-9,0) radius=0.5 material=\"m\" }",
                          {1.5, -1e9, 0}, {-1e-9, 1, 0}),
                1.0, 1e-6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
