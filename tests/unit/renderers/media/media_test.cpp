#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_near;
using testing::SceneMaker;
using RefractionTint = ShadingConventions::RefractionTint;
using ShadowTint = ShadingConventions::ShadowTint;

const Rgb kGlass{0.9, 0.95, 0.8};
const Rgb kWine{0.6, 0.1, 0.2};

Material white() {
    Material m;
    m.diffuse.color = {1, 1, 1};
    return m;
}
MaterialId clear(SceneMaker& maker, const Rgb& kt) {
    Material m;
    m.transmissive.color = kt;
    m.index.value = 1.0;
    return maker.material(m);
}

/// Glass from z = 0 to 1 and from 3 to 3.5, wine from 1 to 3, in one solid; the medium named first
/// has priority in the overlap.
void add_tank(SceneMaker& maker, bool wine_first, const Affine& placement = {}) {
    const MaterialId glass = clear(maker, kGlass), wine = clear(maker, kWine);
    const ObjectIndex tank = maker.object("tank");
    maker.description().objects.back().combine = Combine::Union;
    if (wine_first) maker.add(BoxShape{{-4, -4, 1}, {4, 4, 3}}, wine, {}, tank);
    maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, glass, {}, tank);
    maker.add(BoxShape{{-4, -4, 3}, {4, 4, 3.5}}, glass, {}, tank);
    if (!wine_first) maker.add(BoxShape{{-4, -4, 0.5}, {4, 4, 3.2}}, wine, {}, tank);
    maker.add(tank, MaterialId{0}, placement);
}

/// Transmittance of the whole tank: by distances, or by its six surfaces, of which each wall counts
/// as one of either medium.
Rgb by_distance() {
    return power(kGlass, 1.5) * power(kWine, 2.0);
}
Rgb by_surface() {
    return power(kGlass, 4.0) * power(kWine, 2.0);
}

TEST(Media, EachTintsTheWayThroughIt) {
    for (const bool wine_first : {false, true}) {
        for (const auto tint : {RefractionTint::PerDistance, RefractionTint::PerEvent}) {
            SceneMaker maker;
            maker.description().picture.background = Rgb{1, 1, 1};
            maker.description().conventions.shading.refraction_tint = tint;
            add_tank(maker, wine_first);
            expect_near(center(maker.compile()),
                        tint == RefractionTint::PerDistance ? by_distance() : by_surface(), 1e-9);
        }
    }
}

TEST(Media, EachTintsTheLightThatReachesWhatLiesBehind) {
    for (const bool wine_first : {false, true}) {
        for (const auto tint : {ShadowTint::PerDistance, ShadowTint::PerCrossing}) {
            for (const double least : {0.0, 1e-6, 0.1}) {
                SceneMaker maker;
                maker.add(Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, maker.material(white()));
                maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
                maker.description().conventions.shading.shadow_tint = tint;
                maker.description().conventions.shading.min_distance = least;
                add_tank(maker, wine_first, Affine::translate({0, 0, 10}));  // above the camera
                expect_near(center(maker.compile()),
                            tint == ShadowTint::PerDistance ? by_distance() : by_surface(), 1e-9);
            }
        }
    }
}

/// Clear, with a channel that passes all light.
Material absorber() {
    Material m;
    m.dielectric = Dielectric{{0.5, 0.2, 0.0}};
    m.index.value = 1.0;
    return m;
}
/// What is left of white light behind this way through the absorber.
Rgb left_after(double way) {
    return {std::exp(-0.5 * way), std::exp(-0.2 * way), 1.0};
}

TriangleMesh block(double bottom, double top, bool inward) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
        mesh.positions.push_back({k & 1 ? 3.0 : -3.0, k & 2 ? 3.0 : -3.0, k & 4 ? top : bottom});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (auto& triangle : mesh.triangles) {
        if (inward) std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

/// Renderers, of which the last have no solids, the very last no half-spaces either.
const std::vector<std::string> kAll{"whitted",       "whitted:fresnel=on,beer=on",
                                    "distributed",   "path_tracing",
                                    "bidirectional", "cone_tracing",
                                    "beam_tracing"};

/// Expects a colour in the middle of the pictures of the first `count` renderers.
void expect_seen(SceneMaker& maker, const Rgb& expected, const std::string& what, std::size_t count,
                 const Vec3& eye = {0.1, 0.2, 9}) {
    maker.description().cameras[0].camera = look_along(eye, {0, 0, -1}, {0, 1, 0}, 1e-4, 1.0);
    maker.description().conventions.shading.max_depth = 8;
    for (std::size_t k = 0; k < count; ++k) {
        SCOPED_TRACE(kAll[k] + ", " + what);
        const std::unique_ptr<Renderer> renderer = make_renderer(kAll[k]);
        Scene scene = maker.compile();
        renderer->adjust(scene.conventions.shading);
        const SamplingPlan plan;
        Film film(1, 1, {0, 0, 1, 1});
        const RenderJob job{.scene = scene,
                            .camera = scene.cameras[0].camera,
                            .samples_per_pixel = kAll[k] == "beam_tracing" ? 1 : 4,
                            .description = &maker.description(),
                            .sampling = &plan};
        ASSERT_TRUE(renderer->render(job, film).complete());
        expect_near(film.at(0, 0), expected, 1e-6);
    }
}

TEST(Media, LightFromInfinityDoesNotCrossWhatAbsorbs) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{1, 1, 1};
    maker.add(HalfSpace{{0, 0, 0}, {0, 0, 1}}, maker.material(absorber()));
    expect_seen(maker, {0, 0, 1}, "half-space", kAll.size() - 1);
}

/// A floor, a lamp and two absorbing layers between them, `gap` apart.
SceneMaker between_layers(double gap, double thickness, bool reversed, bool by_kt) {
    SceneMaker maker;
    maker.add(Rectangle{{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}}, maker.material(white()));
    maker.light(PointLight{.position = {0, 0, 9}});
    std::vector<BoxShape> layers{{{-5, -5, 2}, {5, 5, 2 + thickness}},
                                 {{-4, -4, 2 + thickness + gap}, {4, 4, 6}}};
    if (reversed) std::swap(layers[0], layers[1]);
    for (const BoxShape& layer : layers) {
        maker.add(layer, by_kt ? clear(maker, left_after(1)) : maker.material(absorber()));
    }
    maker.description().conventions.shading.shadow_tint = ShadowTint::PerDistance;
    return maker;
}

TEST(Media, ShadowRaysEnterAndLeaveVolumesNearerThanTheLeastDistance) {
    for (const double gap : {0.0, 1e-9, 1e-3}) {
        for (const double thickness : {1.0, 1e-3}) {
            for (const bool reversed : {false, true}) {
                for (const bool by_kt : {false, true}) {
                    for (const double least : {0.0, 1e-6, 0.1}) {
                        SceneMaker maker = between_layers(gap, thickness, reversed, by_kt);
                        maker.description().conventions.shading.min_distance = least;
                        const std::string what = "gap " + std::to_string(gap) + ", thickness " +
                                                 std::to_string(thickness) + ", least distance " +
                                                 std::to_string(least) + (by_kt ? ", kt" : "");
                        expect_seen(maker, left_after(4 - gap), what, 3, {0, 0, 1});
                    }
                }
            }
        }
    }
}

/// Clear, of that absorption and the index of the air.
Material absorbing(double absorption) {
    Material m;
    m.dielectric = Dielectric{{absorption, absorption, absorption}};
    m.index.value = 1.0;
    return m;
}

TEST(Media, ShadowRaysInAVolumeAcrossAWallStayInIt) {
    for (const bool box_first : {false, true}) {
        SceneMaker maker;
        maker.add(Rectangle{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}, maker.material(white()));
        maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
        const BoxShape box{{-4, -4, 2.5}, {4, 4, 3.5}};
        if (box_first) maker.add(box, maker.material(absorbing(1)));
        const ObjectIndex solid = maker.object("solid");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{{-4, -4, 2}, {4, 4, 3}}, maker.material(absorbing(0.1)), {}, solid);
        maker.add(BoxShape{{-4, -4, 3}, {4, 4, 4}}, maker.material(absorbing(0.3)), {}, solid);
        maker.add(solid);
        if (!box_first) maker.add(box, maker.material(absorbing(1)));
        const double left = std::exp(-0.05 - 1 - 0.15);
        expect_seen(maker, {left, left, left}, box_first ? "box first" : "solid first", 3,
                    {0.1, 0.2, 1});
    }
}

/// A solid of two parts of one material below or above a touching box.
TEST(Media, ShadowRaysLeaveASolidByAnyOfItsParts) {
    for (const bool above : {false, true}) {
        for (const bool box_first : {false, true}) {
            for (const double least : {0.0, 1e-3}) {
                SceneMaker maker;
                maker.description().conventions.shading.min_distance = least;
                maker.add(Rectangle{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}, maker.material(white()));
                maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
                const double bottom = above ? 1 : 2;
                const BoxShape box{{-4, -4, bottom + 1}, {4, 4, bottom + 2}};
                const BoxShape below{{-4, -4, bottom - 1}, {4, 4, bottom}};
                const MaterialId of_box = maker.material(absorbing(0.5));
                if (box_first) maker.add(above ? box : below, of_box);
                const MaterialId id = maker.material(absorbing(1));
                const ObjectIndex solid = maker.object("solid");
                maker.description().objects.back().combine = Combine::Union;
                maker.add(BoxShape{{-4, -4, bottom}, {4, 4, bottom + 0.5}}, id, {}, solid);
                maker.add(BoxShape{{-4, -4, bottom + 0.5}, {4, 4, bottom + 1}}, id, {}, solid);
                maker.add(solid);
                if (!box_first) maker.add(above ? box : below, of_box);
                const double left = std::exp(-1.5);
                expect_seen(maker, {left, left, left}, box_first ? "box first" : "solid first", 3,
                            {0.1, 0.2, 0.5});
            }
        }
    }
}

/// A piece inside a volume that begins below it, and another volume that overlaps its top.
TEST(Media, ShadowRaysLeaveTheVolumeThatTheyBeganIn) {
    for (const bool by_kt : {false, true}) {
        for (const bool around_first : {false, true}) {
            SceneMaker maker;
            auto& shading = maker.description().conventions.shading;
            shading.shadow_tint = ShadowTint::PerDistance;
            shading.refraction_tint = RefractionTint::PerDistance;
            const auto filled = [&](double kt) {
                return by_kt ? clear(maker, {kt, kt, kt})
                             : maker.material(absorbing(-std::log(kt)));
            };
            const BoxShape around{{-4, -4, 0}, {4, 4, 2}}, other{{-1, -1, 1}, {1, 1, 3}};
            if (around_first) maker.add(around, filled(0.6));
            maker.add(other, filled(0.4));
            if (!around_first) maker.add(around, filled(0.6));
            maker.add(Rectangle{{-0.3, -0.3, 0.5}, {0.6, 0, 0}, {0, 0.6, 0}},
                      maker.material(white()));
            maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            // The eye sees the piece from the side, through the surrounding volume alone.
            const Vec3 look{8, 0, -0.8};
            const double in = 4 * length(look) / 8;
            // Where both are, kt is that of the body left first, absorption of the one entered
            // last.
            const double both = by_kt ? 0.6 : 0.4;
            const double left = std::pow(0.6, in + 0.5) * both * 0.4;
            maker.description().cameras[0].camera =
                look_along({-8, 0, 1.3}, look, {0, 0, 1}, 1e-4, 1.0);
            shading.max_depth = 8;
            for (const char* const name : {"whitted", "distributed", "beam_tracing"}) {
                SCOPED_TRACE(std::string(name) + (by_kt ? ", kt" : "") +
                             (around_first ? ", around first" : ""));
                const std::unique_ptr<Renderer> renderer = make_renderer(name);
                const Scene scene = maker.compile();
                const SamplingPlan plan;
                Film film(1, 1, {0, 0, 1, 1});
                const RenderJob job{.scene = scene,
                                    .camera = scene.cameras[0].camera,
                                    .description = &maker.description(),
                                    .sampling = &plan};
                ASSERT_TRUE(renderer->render(job, film).complete());
                expect_near(film.at(0, 0), {left, left, left}, 1e-4);
            }
        }
    }
}

TEST(Media, OutsideOfSolidsTheWindingOfAMeshDecidesWhereItsMaterialIs) {
    for (const bool lamp : {false, true}) {
        for (const bool inward : {false, true}) {
            for (const bool solid : {false, true}) {
                SceneMaker maker;
                const MaterialId glass = maker.material(absorber());
                const MeshIndex mesh = maker.mesh(block(0, 1, inward));
                if (solid) {
                    const ObjectIndex body = maker.object("body");
                    maker.description().objects.back().combine = Combine::Union;
                    maker.add(mesh, glass, {}, body);
                    maker.add(body);
                } else {
                    maker.add(mesh, glass);
                }
                // Two below the mesh.
                const MaterialId light = maker.material(testing::glowing({1, 1, 1}));
                if (lamp) maker.add(Rectangle{{-9, -9, -2}, {18, 0, 0}, {0, 18, 0}}, light);
                if (!lamp) maker.description().picture.background = Rgb{1, 1, 1};
                const bool outside = inward && !solid;
                const Rgb beyond = lamp ? left_after(2) : Rgb{0, 0, 1};
                expect_seen(maker, outside ? beyond : left_after(1),
                            std::string(lamp ? "lamp" : "sky") + (inward ? " inward" : "") +
                                (solid ? " solid" : ""),
                            kAll.size() - (solid ? 2 : 0));
            }
        }
    }
}

/// The eye looks down from z = 0 in an absorber that ends at z = -2, before a shining wall.
TEST(Media, AnEyeInAVolumeSeesThroughIt) {
    for (const bool parallel : {false, true}) {
        for (const std::string renderer : {"whitted", "distributed", "whitted:fresnel=on,beer=on",
                                           "distributed:fresnel=on,beer=on", "path_tracing"}) {
            testing::SceneMaker maker;
            Camera& camera = maker.description().cameras[0].camera;
            camera = look_along({0.3, 0.2, 0}, {0, 0, -1}, {0, 1, 0}, 1e-6, 1.0);
            if (parallel)
                camera = look_along_parallel({0.3, 0.2, 0}, {0, 0, -1}, {0, 1, 0}, 1e-6, 1.0);
            Material absorber;
            absorber.index.value = 1.0;
            absorber.dielectric = Dielectric{{0.3, 0.1, 0}};
            maker.add(BoxShape{{-4, -4, -2}, {4, 4, 2}}, maker.material(absorber));
            maker.add(testing::rectangle({-4, -4, -3}, {8, 0, 0}, {0, 8, 0}),
                      maker.material(testing::shining({1, 1, 1})));
            Scene scene = maker.compile();
            make_renderer(renderer)->adjust(scene.conventions.shading);
            const Rgb found = testing::picture_of(scene, renderer, 1, 1).at(0, 0);
            EXPECT_NEAR(found.r, std::exp(-0.6), 1e-6) << renderer << parallel;
            EXPECT_NEAR(found.g, std::exp(-0.2), 1e-6) << renderer << parallel;
            EXPECT_NEAR(found.b, 1.0, 1e-6) << renderer << parallel;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
