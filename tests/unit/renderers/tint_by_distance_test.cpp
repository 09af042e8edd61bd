// kt as the transmittance of a unit of length, in nested bodies, before things inside and from
// lights inside.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "alhazen/renderers/core/renderer.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::matt;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

using Fill = std::function<void(SceneMaker&)>;

/// Of a scene where kt acts by distance; the eye looks along -z from (0, 0, 5).
Rgb color_of(const std::string& renderer, const Fill& fill) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.refraction_tint = ShadingConventions::RefractionTint::PerDistance;
    c.shadow_tint = ShadingConventions::ShadowTint::PerDistance;
    c.max_depth = 10;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {1e-4, 0, 0}, {0, 1e-4, 0}};
    fill(maker);
    const Scene scene = maker.compile();
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    Film film(1, 1, {0, 0, 1, 1});
    (void)make_renderer(renderer)->render(job, film);
    return film.at(0, 0);
}

Material tinted(double kt) {
    Material m;
    m.transmissive.color = {kt, 1, 0.5 * kt};
    return m;
}

void add_box(SceneMaker& maker, double half, const Material& material) {
    BoxShape box;
    box.lo = {-half, -half, -half};
    box.hi = {half, half, half};
    maker.add(box, maker.material(material));
}

void add_wall(SceneMaker& maker, double z, const Material& material) {
    maker.add(rectangle({-9, -9, z}, {18, 0, 0}, {0, 18, 0}), maker.material(material));
}

const char* const kRenderers[] = {"whitted", "distributed", "beam_tracing", "cone_tracing"};

void expect_color(const Fill& fill, const Rgb& expected, double tolerance = 1e-6) {
    for (const std::string renderer : kRenderers) {
        const Rgb found = color_of(renderer, fill);
        EXPECT_NEAR(found.r, expected.r, tolerance) << renderer;
        EXPECT_NEAR(found.g, expected.g, tolerance) << renderer;
        EXPECT_NEAR(found.b, expected.b, tolerance) << renderer;
    }
}

TEST(TintByDistance, AThingInABodyIsSeenThroughTheWayToIt) {
    expect_color(
        [](SceneMaker& m) {
            add_box(m, 1, tinted(0.5));
            add_box(m, 0.25, shining({1, 0.5, 0.25}));
        },
        {std::pow(0.5, 0.75), 0.5, 0.25 * std::pow(0.25, 0.75)});
    expect_color(
        [](SceneMaker& m) {
            add_box(m, 1, tinted(1));
            add_box(m, 0.25, shining({1, 0.5, 0.25}));
        },
        {1, 0.5, 0.25 * std::pow(0.5, 0.75)});
}

TEST(TintByDistance, EachWayThroughNestedBodiesHasTheInnermostOne) {
    expect_color(
        [](SceneMaker& m) {
            add_box(m, 1.5, tinted(0.5));
            add_box(m, 0.5, tinted(0.9));
            add_wall(m, -3, shining({1, 1, 1}));
        },
        {std::pow(0.5, 2.0) * 0.9, 1, std::pow(0.25, 2.0) * 0.45});
}

TEST(TintByDistance, ABodyBehindAnotherKeepsItsOwnTint) {
    expect_color(
        [](SceneMaker& m) {
            add_box(m, 0.5, tinted(0.5));
            BoxShape behind;
            behind.lo = {-1, -1, -2};
            behind.hi = {1, 1, -1};
            m.add(behind, m.material(tinted(0.8)));
            add_wall(m, -3, shining({1, 1, 1}));
        },
        {0.5 * 0.8, 1, 0.25 * 0.4});
}

TEST(TintByDistance, AnOpenSurfaceHasNoInside) {
    for (const bool turned : {false, true}) {
        expect_color(
            [&](SceneMaker& m) {
                Rectangle pane{.corner = {-1, -1, 0}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}};
                if (turned) std::swap(pane.edge_u, pane.edge_v);
                m.add(pane, m.material(tinted(0.5)));
                add_wall(m, -3, shining({1, 0.5, 0.25}));
            },
            {1, 0.5, 0.25});
    }
}

/// The wall at z = -3 is seen below bodies that are not in the way of the eye.
TEST(TintByDistance, LightPassesNestedBodiesByTheInnermostOne) {
    const auto lit = [](const Fill& bodies) {
        return [bodies](SceneMaker& m) {
            add_wall(m, -3, matt({1, 1, 1}));
            m.light(DirectionalLight{.to_light = {0.6, 0, 0.8}, .color = {1, 1, 1}});
            bodies(m);
        };
    };
    // Along the light the ways are 1 / 0.8 of the thickness.
    const auto slab = [](SceneMaker& m, double near, double far, double kt) {
        BoxShape box;
        box.lo = {0.3, -9, near};
        box.hi = {9, 9, far};
        m.add(box, m.material(tinted(kt)));
    };
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const Rgb one = color_of(renderer, lit([&](SceneMaker& m) { slab(m, -2, 0, 0.5); }));
        EXPECT_NEAR(one.r, 0.8 * std::pow(0.5, 2 / 0.8), 1e-9) << renderer;
        const Rgb nested = color_of(renderer, lit([&](SceneMaker& m) {
                                        slab(m, -2, 0, 0.5);
                                        slab(m, -1.5, -0.7, 1);
                                    }));
        EXPECT_NEAR(nested.r, 0.8 * std::pow(0.5, 1.2 / 0.8), 1e-9) << renderer;
    }
}

TEST(TintByDistance, ALightInsideABodyShinesThroughIt) {
    const auto wall = [](double kt) {
        return [kt](SceneMaker& m) {
            add_wall(m, -3, matt({1, 1, 1}));
            BoxShape box;
            box.lo = {0.5, -9, -2};
            box.hi = {9, 9, 9};
            m.add(box, m.material(tinted(kt)));
            m.light(
                PointLight{.position = {3, 0, 1}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
        };
    };
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const double whole = color_of(renderer, wall(1)).r;
        EXPECT_NEAR(whole, 0.8, 1e-4) << renderer;
        // The last three quarters of the five units to the light.
        EXPECT_NEAR(color_of(renderer, wall(0.5)).r / whole, std::pow(0.5, 3.75), 1e-4) << renderer;
    }
}

/// The floor is inside of the body, so are the eye's ray at its end and the start of the light's.
TEST(TintByDistance, AFloorInsideABodyIsLitAndSeenThroughIt) {
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const Rgb found = color_of(renderer, [](SceneMaker& m) {
            add_wall(m, 0, matt({1, 1, 1}));
            add_box(m, 1, tinted(0.5));
            m.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
        });
        EXPECT_NEAR(found.r, 0.25, 1e-9) << renderer;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
