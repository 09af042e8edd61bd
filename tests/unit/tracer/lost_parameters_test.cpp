// Points and normals of hits whose t left the range of double.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "alhazen/tracer/tracer.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

TracerScene unit_bodies(int which) {
    TracerScene scene;
    if (which == 0) scene.add_sphere({0, 0, 0}, 1);
    if (which == 1) scene.add(Cylinder{.base = {0, 0, -1}, .top = {0, 0, 1}, .radius = 1});
    if (which == 2) scene.add(BoxShape{{-1, -1, -1}, {1, 1, 1}});
    return scene;
}

/// Expects the surface that the ray of length 1 finds, within both bounds of the error.
void expect_same_surface(const Surface& at, const Surface& expected) {
    for (int k = 0; k < 3; ++k) {
        EXPECT_LE(std::abs(at.point[k] - expected.point[k]), at.error[k] + expected.error[k]);
        EXPECT_NEAR(at.point[k], expected.point[k], 1e-14);
        EXPECT_NEAR(at.normal[k], expected.normal[k], 1e-14);
    }
}

TEST(LostParameters, AnInfiniteTHasTheSurfaceOfTheHit) {
    for (int which = 0; which < 3; ++which) {
        const Tracer tracer(unit_bodies(which));
        const Ray plain{{5, 0.3, 0.2}, {-1, 0, 0}};
        const Ray tiny{{5, 0.3, 0.2}, {-1e-310, 0, 0}};
        Hit hit, expected;
        ASSERT_TRUE(tracer.intersect(plain, expected));
        ASSERT_TRUE(tracer.intersect(tiny, hit));
        ASSERT_EQ(hit.t, kInf);
        const HitDetails at = tracer.details(tiny, hit);
        expect_same_surface(at, tracer.details(plain, expected));
        Surface surface;
        tracer.surface(tiny, hit, surface);
        expect_same_surface(surface, tracer.details(plain, expected));

        // The other crossing may have the same t, u and v: the bound covers its point as well.
        std::vector<Hit> hits;
        tracer.all_hits(tiny, hits);
        ASSERT_EQ(hits.size(), 2u);
        std::vector<Hit> plain_hits;
        tracer.all_hits(plain, plain_hits);
        const HitDetails last = tracer.details(tiny, hits[1]);
        const Vec3 exact = tracer.details(plain, plain_hits[1]).point;
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(std::abs(last.point[k] - exact[k]), last.error[k] + 1e-15) << which;
        }
    }
}

TEST(LostParameters, ASubnormalOrZeroTHasTheSurfaceOfTheHit) {
    TracerScene scene;
    scene.add_sphere({0, 0, 0}, 1e-8);
    const Tracer tracer(std::move(scene));
    for (const double away : {5e-8, 1.1e-8, 1.0000001e-8}) {
        for (const double speed : {1e308, 1e300}) {
            const Ray plain{{away, 0.1e-8, 0}, {-1, 0, 0}}, fast{plain.origin, {-speed, 0, 0}};
            Hit hit, expected;
            ASSERT_TRUE(tracer.intersect(plain, expected));
            ASSERT_TRUE(tracer.intersect(fast, hit));
            const HitDetails at = tracer.details(fast, hit);
            const HitDetails exact = tracer.details(plain, expected);
            for (int k = 0; k < 3; ++k) {
                EXPECT_LE(std::abs(at.point[k] - exact.point[k]), at.error[k] + exact.error[k]);
                EXPECT_LE(at.error[k], 1e-22);
            }
        }
    }
}

TEST(LostParameters, SpansHaveTheSurfacesOfTheirEnds) {
    for (int which = 0; which < 3; ++which) {
        const Tracer tracer(unit_bodies(which));
        const SolidQueries solids = tracer.solids();
        SpanList tiny, plain;
        const Ray slow{{5, 0.3, 0.2}, {-1e-310, 0, 0}}, usual{slow.origin, {-1, 0, 0}};
        solids.spans(slow, tiny);
        solids.spans(usual, plain);
        ASSERT_EQ(tiny.spans.size(), 1u);
        for (const bool entry : {true, false}) {
            const auto end_of = [&](const Ray& ray, const SolidSpan& span) {
                return entry ? solids.entry_surface(ray, span) : solids.exit_surface(ray, span);
            };
            const SpanSurface at = end_of(slow, tiny.spans[0]);
            const SpanSurface exact = end_of(usual, plain.spans[0]);
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(at.point[k], exact.point[k], 1e-14);
                EXPECT_NEAR(at.normal[k], exact.normal[k], 1e-14);
                EXPECT_LE(at.error[k], 1e-14);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
