// The node test never misses a box that the exact line intersects, on any instruction set, and has
// few false positives.

#include "alhazen/accel/wide_bvh/trace/slab_ray.h"

#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <vector>

#include "alhazen/simd/dispatch.h"
#include "alhazen/simd/targets.h"
#include "support/quad.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "unit/accel/slab_ray_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Must follow foreach_target.h.
#include "alhazen/accel/wide_bvh/trace/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

std::uint32_t met(const WideNode& node, const LocalFrame& frame, const Ray& ray) {
    SlabRay slabs;
    if (!make_ray(frame, frame.slack.slab, ray, slabs, [](const AxisLanes&) {})) return 0;
    Floats entry;
    return bits_of(intersect_children(node, slabs, Floats(slabs.s_max), entry));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

ALHAZEN_KERNEL_TABLE(met);

using testing::Quad;
using RandomEngine = std::mt19937_64;

double uniform(RandomEngine& random, double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

/// Returns whether the ray intersects the box, in arithmetic with 113 bits.
bool meets(const Box3& box, const Ray& ray) {
    Quad lo = ray.t_min, hi = ray.t_max;
    for (int k = 0; k < 3; ++k) {
        const Quad o = ray.origin[k], d = ray.direction[k];
        if (d == 0) {
            if (o < box.lo[k] || o > box.hi[k]) return false;
            continue;
        }
        Quad a = (box.lo[k] - o) / d, b = (box.hi[k] - o) / d;
        if (a > b) std::swap(a, b);
        lo = a > lo ? a : lo;
        hi = b < hi ? b : hi;
    }
    return lo <= hi;
}

/// A box with `p` on its surface: on a face, an edge or a corner, or anywhere if flat.
Box3 box_around(const Vec3& p, RandomEngine& random) {
    Box3 box{p, p};
    for (int k = 0; k < 3; ++k) {
        const double size = std::ldexp(uniform(random, 0.5, 1), -static_cast<int>(random() % 24));
        switch (random() % 4) {
            case 0:
                box.lo[k] -= size;
                break;
            case 1:
                box.hi[k] += size;
                break;
            case 2:
                break;
            default:
                box.lo[k] -= size;
                box.hi[k] += uniform(random, 0, 0.5) * size;
        }
        box.lo[k] = std::max(box.lo[k], -1.0);
        box.hi[k] = std::min(box.hi[k], 1.0);
    }
    return box;
}

Vec3 any_direction(RandomEngine& random) {
    constexpr double kComponents[] = {0.0, -0.0, 0x1p-1074, -0x1p-1040, 1e-20, -1e-17, 1.0, -1.0};
    Vec3 d{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    for (int k = 0; k < 3; ++k) {
        if (random() % 3 == 0) d[k] = kComponents[random() % 8];
    }
    if (d == Vec3{}) d[static_cast<int>(random() % 3)] = -1;
    return std::ldexp(1.0, static_cast<int>(random() % 60) - 30) * d;
}

/// A ray through (nearly) `p`, from up to `distance` away; its range often ends near there.
Ray ray_through(const Vec3& p, double distance, RandomEngine& random) {
    Ray ray;
    ray.direction = any_direction(random);
    const double back = distance * uniform(random, -0.2, 1) / max_component(abs(ray.direction));
    ray.origin = p - back * ray.direction;
    for (int k = 0; k < 3; ++k) {
        // In the plane of a face, where the direction allows.
        if (ray.direction[k] == 0) ray.origin[k] = p[k];
    }
    if (random() % 4 == 0) ray.t_max = back;
    if (random() % 4 == 0) ray.t_min = back;
    if (random() % 8 == 0) ray.t_min = -std::numeric_limits<double>::infinity();
    return ray;
}

std::string show(const Ray& ray) {
    std::ostringstream out;
    out << std::hexfloat << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z << " d "
        << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z << " t " << ray.t_min
        << " " << ray.t_max;
    return out.str();
}

const Box3 kUnit{{-1, -1, -1}, {1, 1, 1}};

struct Case {
    Ray ray;
    WideNode node;
    std::uint32_t exact = 0;  ///< bits of the boxes that are hit
};

Case grazing_case(const LocalFrame& frame, RandomEngine& random) {
    constexpr double kDistances[] = {1, 1, 3, 10, 1e3, 1e6, 1e9, 1e12, 1e15};
    const Vec3 p{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    Case c;
    c.ray = ray_through(p, kDistances[random() % 9], random);
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
        const Box3 box = box_around(p, random);
        c.node.set_box(slot, frame.local(box));
        if (meets(box, c.ray)) c.exact |= 1u << slot;
    }
    return c;
}

TEST(SlabRay, NeverMissesABoxThatTheExactLineMeets) {
    const LocalFrame frame(kUnit);
    RandomEngine random(5);
    int hits = 0;
    for (int round = 0; round < 30; ++round) {
        std::vector<Case> cases;
        for (int i = 0; i < 5000; ++i) {
            const Case c = grazing_case(frame, random);
            if (is_valid(c.ray)) cases.push_back(c);
            hits += std::popcount(cases.back().exact);
        }
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride use(target);
            for (const Case& c : cases) {
                const std::uint32_t found = ALHAZEN_KERNEL(met)(c.node, frame, c.ray);
                ASSERT_EQ(c.exact & ~found, 0u) << target << ", ray " << show(c.ray);
            }
        }
    }
    EXPECT_GT(hits, 300000) << "too few grazing hits to prove anything";
}

TEST(SlabRay, MissesBoxesThatAreAThousandthOfAPercentAside) {
    const LocalFrame frame(kUnit);
    RandomEngine random(6);
    for (int i = 0; i < 20000; ++i) {
        Ray ray{{uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)}, {}};
        const Vec3 p{uniform(random, -0.9, 0.9), uniform(random, -0.9, 0.9),
                     uniform(random, -0.9, 0.9)};
        ray.direction = p - ray.origin;
        const Vec3 d = normalize(ray.direction);
        const Vec3 aside = p + 1e-5 * perpendicular(d);
        WideNode node;
        node.set_box(0, frame.local(Box3{aside, aside}));
        node.set_box(1, frame.local(Box3{p, p}));
        EXPECT_EQ(ALHAZEN_KERNEL(met)(node, frame, ray), 2u) << show(ray);
        ray.t_max = 1 - 1e-5;
        EXPECT_EQ(ALHAZEN_KERNEL(met)(node, frame, ray), 0u) << show(ray);
    }
}

TEST(SlabRay, AFreeSlotIsNeverMet) {
    const LocalFrame frame(kUnit);
    RandomEngine random(7);
    const WideNode empty;
    for (int i = 0; i < 20000; ++i) {
        const double distance = std::ldexp(1.0, static_cast<int>(random() % 1000) - 10);
        const Ray ray = ray_through({0, 0, 0}, distance, random);
        if (!is_valid(ray)) continue;
        ASSERT_EQ(ALHAZEN_KERNEL(met)(empty, frame, ray), 0u) << show(ray);
    }
}

TEST(SlabRay, ExtremeRaysPassWhatTheyMayHit) {
    const LocalFrame frame(kUnit);
    WideNode node;
    node.set_box(0, frame.local(Box3{{-1, -0.5, -0.5}, {1, 0.5, 0.5}}));
    const double inf = std::numeric_limits<double>::infinity();
    for (const Ray& ray :
         {Ray{{-1e300, 0, 0}, {1, 0, 0}}, Ray{{-1e300, 0, 0}, {1e300, 0, 0}},
          Ray{{-1e-300, 0, 0}, {1e-300, 0, 0}}, Ray{{-5, 0, 0}, {0x1p-1074, 0, 0}},
          Ray{{-5, 0, 0}, {1.7e308, 0, 0}}, Ray{{-5, 0, 0}, {1, 0, 0}, -inf, inf},
          Ray{{-5, 0, 0}, {1, 0, 0}, 4, 4}, Ray{{-1e15, 0, 0}, {1, 0, 0}, 0, 1e15}}) {
        EXPECT_EQ(ALHAZEN_KERNEL(met)(node, frame, ray) & 1, 1u) << show(ray);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
#endif
