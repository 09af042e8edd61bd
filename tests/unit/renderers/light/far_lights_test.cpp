// Seen lights far from the origin, where the rounding of points is no longer far below distances.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::fog;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::rectangle_mesh;
using testing::SceneMaker;
using testing::shining;

/// A tetrahedron around a point.
TriangleMesh tetrahedron(const Vec3& center) {
    TriangleMesh mesh;
    for (const Vec3& p :
         {Vec3{0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}, {-0.5, 0.5, -0.5}, {0.5, -0.5, -0.5}}) {
        mesh.positions.push_back(center + p);
    }
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

using Fill = std::function<void(SceneMaker&, const Vec3& at)>;

/// A floor and a wall around `at`, with what `fill` adds.
Scene corner_at(const Vec3& at, const Fill& fill) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along(at + Vec3{0, -4, 1.5}, {0, 4, -1.25}, {0, 0, 1}, 0.4, 1.0);
    const MaterialId white = maker.material(matt({0.7, 0.7, 0.7}));
    maker.add(maker.mesh(rectangle_mesh(at + Vec3{-2.5, -2.5, 0}, {5, 0, 0}, {0, 5, 0})), white);
    maker.add(rectangle(at + Vec3{-2.5, 1.5, 0}, {5, 0, 0}, {0, 0, 4}), white);
    fill(maker, at);
    return maker.compile("wide_bvh");
}

/// Expects the same light far from the origin and at it: all lengths of the scene are multiples of
/// the rounding of its coordinates.
void expect_same_far(const char* name, const Fill& fill, const std::vector<std::string>& renderers,
                     double tolerance) {
    const Scene here = corner_at({}, fill);
    for (const double away : {0x1p24, 0x1p27}) {
        const Scene there = corner_at({away, -1.25 * away, 0.75 * away}, fill);
        for (const std::string& renderer : renderers) {
            const double expected = mean_of(picture_of(here, renderer, 8, 32)).g;
            EXPECT_GT(expected, 0.01) << name << " " << renderer;
            EXPECT_NEAR(mean_of(picture_of(there, renderer, 8, 32)).g, expected,
                        tolerance * expected)
                << name << " " << renderer << " " << away;
        }
    }
}

/// A lamp around `at` + (0, 0, 2) in a frame that moves `at` to the origin: 0: a tube, 1: a patch,
/// 2: a ball.
void add_moved_lamp(SceneMaker& m, int kind, const Vec3& at, bool instanced) {
    const MaterialId light = m.material(shining({4, 4, 4}));
    const ObjectIndex owner = instanced ? m.object("lamp") : ObjectIndex{0};
    const Affine back = Affine::translate(-at), own = instanced ? Affine{} : back;
    if (kind == 0) {
        Cylinder tube;
        tube.base = at + Vec3{-0.5, 0, 2};
        tube.top = at + Vec3{0.5, 0.25, 2.25};
        tube.radius = 0.25;
        m.add(tube, light, own, owner);
    } else if (kind == 1) {
        BezierPatch patch;
        for (int i = 0; i < 16; ++i) {
            const int u = i / 4, v = i % 4;
            patch.points.push_back(at +
                                   Vec3{u / 4.0, v / 4.0, 2.0 + (u % 3 == 0 ? v % 2 : 0) / 4.0});
        }
        m.add(patch, light, own, owner);
    } else {
        m.add(ball(at + Vec3{0, 0, 2}, 0.25), light, own, owner);
    }
    if (instanced) m.add(owner, light, back);
}

TEST(FarLights, EmittingSurfacesDoNotShadeThemselves) {
    const struct {
        const char* name;
        Fill fill;
    } lamps[] = {
        {"ball",
         [](SceneMaker& m, const Vec3& at) {
             m.add(ball(at + Vec3{0, 0, 2.5}, 0.375), m.material(shining({4, 4, 4})));
         }},
        {"disc",
         [](SceneMaker& m, const Vec3& at) {
             Disc disc;
             disc.center = at + Vec3{0.25, 0, 2.5};
             disc.normal = {0.25, 0, -1};
             disc.radius = 0.5;
             m.add(disc, m.material(shining({4, 4, 4})));
         }},
        {"rectangle",
         [](SceneMaker& m, const Vec3& at) {
             m.add(rectangle(at + Vec3{-0.5, -0.5, 2.5}, {1, 0, 0.25}, {0, 1, 0.5}),
                   m.material(shining({4, 4, 4})));
         }},
        {"tube",
         [](SceneMaker& m, const Vec3& at) {
             Cylinder tube;
             tube.base = at + Vec3{-1, 0, 2};
             tube.top = at + Vec3{1, 0.25, 2.25};
             tube.radius = 0.125;
             m.add(tube, m.material(shining({9, 9, 9})));
         }},
        {"mesh", [](SceneMaker& m, const Vec3& at) {
             m.add(m.mesh(tetrahedron(at + Vec3{0, 0, 2})), m.material(shining({4, 4, 4})));
         }}};
    for (const auto& [name, fill] : lamps) {
        expect_same_far(
            name, fill,
            {"path_tracing:depth=1", "bidirectional:depth=1", "vcm:photons=64,radius=0.001,depth=1",
             "photon_mapping:photons=100,depth=1"},
            1e-4);
        expect_same_far(name, fill, {"path_tracing:depth=3", "bidirectional:depth=3"}, 1e-3);
    }
}

TEST(FarLights, FogIsLitBySeenLamps) {
    expect_same_far(
        "fog",
        [](SceneMaker& m, const Vec3& at) {
            m.add(ball(at + Vec3{0, 0, 2.5}, 0.375), m.material(shining({4, 4, 4})));
            m.add(ball(at + Vec3{0, 0, 0.75}, 0.5), m.material(fog({0.25, 0.25, 0.25}, {2, 2, 2})));
        },
        {"path_tracing:depth=2", "bidirectional:depth=2"}, 1e-3);
}

// The lamp's own coordinates are large, in the scene it is near the origin.
TEST(FarLights, LampsThatAreMovedBackFromAfarDoNotShadeThemselves) {
    const auto seen = [](const char* renderer, double away, bool instanced, int kind) {
        const Vec3 at{away, away, away};
        return mean_of(picture_of(corner_at({},
                                            [&](SceneMaker& m, const Vec3&) {
                                                add_moved_lamp(m, kind, at, instanced);
                                            }),
                                  renderer, 4, 16))
            .g;
    };
    for (const bool instanced : {false, true}) {
        for (const int kind : {0, 1, 2}) {
            for (const char* renderer : {"path_tracing:depth=1", "bidirectional:depth=1"}) {
                const double expected = seen(renderer, 0, instanced, kind);
                EXPECT_GT(expected, 0.01) << renderer;
                EXPECT_NEAR(seen(renderer, 0x1p30, instanced, kind), expected, 1e-4 * expected)
                    << renderer << " " << kind << " " << instanced;
            }
        }
    }
}

TEST(FarLights, WhatCoversALampBlocksIt) {
    const double away = 0x1p27;
    for (const Vec3& corner : {Vec3{}, Vec3{away, -1.25 * away, 0.75 * away}}) {
        const Scene scene = corner_at(corner, [](SceneMaker& m, const Vec3& at) {
            m.add(rectangle(at + Vec3{-0.5, -0.5, 2.5}, {1, 0, 0}, {0, 1, 0}),
                  m.material(shining({4, 4, 4})));
            BoxShape box;
            box.lo = at + Vec3{-0.5625, -0.5625, 2.4375};
            box.hi = at + Vec3{0.5625, 0.5625, 2.5625};
            m.add(box, m.material(matt({})));
        });
        for (const char* renderer : {"path_tracing:depth=1", "bidirectional:depth=1"}) {
            EXPECT_EQ(mean_of(picture_of(scene, renderer, 8, 32)), Rgb{}) << renderer;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
