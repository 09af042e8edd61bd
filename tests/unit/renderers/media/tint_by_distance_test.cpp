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
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
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

TEST(TintByDistance, AnAbsorberAroundABodyAbsorbsBehindItToo) {
    const double a = 0.3;
    Material absorber;
    absorber.index.value = 1;
    absorber.dielectric = Dielectric{{a, 0, 2 * a}};
    const Rgb outside{std::exp(-2 * a), 1, std::exp(-4 * a)};
    expect_color(
        [&](SceneMaker& m) {
            add_box(m, 1.5, absorber);
            add_box(m, 0.5, tinted(0.9));
            add_wall(m, -3, shining({1, 1, 1}));
        },
        {outside.r * 0.9, 1, outside.b * 0.45});
    // A pane has no inside: the absorber is on both sides.
    expect_color(
        [&](SceneMaker& m) {
            add_box(m, 1, absorber);
            m.add(rectangle({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}), m.material(tinted(0.9)));
            add_wall(m, -3, shining({1, 1, 1}));
        },
        outside);
}

/// The floor is inside of a body, and the light outside.
TEST(TintByDistance, ABodyThatShadowRaysDoNotSeeTintsNoLight) {
    Material absorber;
    absorber.index.value = 1;
    absorber.dielectric = Dielectric{{std::log(2.0), 0, 0}};
    for (const Material& body : {tinted(0.5), absorber}) {
        for (const bool exact : {false, true}) {
            for (const bool seen : {false, true}) {
                for (const std::string renderer : {"whitted", "distributed"}) {
                    const Rgb found = color_of(renderer, [&](SceneMaker& m) {
                        m.description().conventions.shading.optics.beer = exact;
                        add_wall(m, 0, matt({1, 1, 1}));
                        add_box(m, 1, body);
                        if (!seen) {
                            m.description().objects[0].parts.back().visible_to =
                                kRaysOfAllKinds & ~mask_of(RayKind::Shadow);
                        }
                        m.light(PointLight{
                            .position = {0, 0, 4}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
                    });
                    EXPECT_NEAR(found.r, seen ? 0.25 : 0.5, 1e-6) << renderer << exact << seen;
                }
            }
        }
    }
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

/// Both ends of the shadow ray lie in the outer body, and nothing is between them.
TEST(TintByDistance, ALightBesideTheFloorInABodyIsTintedWithoutACrossing) {
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const auto inside = [](double inner) {
            return [inner](SceneMaker& m) {
                add_wall(m, 0, matt({1, 1, 1}));
                add_box(m, 2, tinted(0.5));
                if (inner > 0) {
                    BoxShape box;
                    box.lo = {-0.5, -0.5, 0.5};
                    box.hi = {0.5, 0.5, 1};
                    m.add(box, m.material(tinted(inner)));
                }
                m.light(PointLight{
                    .position = {0.8, 0, 0.6}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
            };
        };
        // Two units of the eye's ray and one of the light's, which is 3, 4, 5 over 5.
        EXPECT_NEAR(color_of(renderer, inside(0)).r, 0.6 * std::pow(0.5, 3.0), 1e-6) << renderer;
        EXPECT_NEAR(color_of(renderer, inside(1)).r, 0.6 * std::pow(0.5, 2.5), 1e-6) << renderer;
    }
}

TEST(TintByDistance, APaneInABodyDoesNotEndIt) {
    for (const bool turned : {false, true}) {
        for (const std::string more : {"", "fresnel=on"}) {
            const Fill fill = [&](SceneMaker& m) {
                m.description().conventions.shading.optics.fresnel = !more.empty();
                add_box(m, 1, tinted(0.5));
                Rectangle pane{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}};
                if (turned) std::swap(pane.edge_u, pane.edge_v);
                m.add(pane, m.material(tinted(1)));
                add_wall(m, -3, shining({1, 1, 1}));
            };
            for (const char* renderer : {"whitted", "beam_tracing", "cone_tracing"}) {
                if (!more.empty() && renderer != std::string("whitted")) continue;
                EXPECT_NEAR(color_of(renderer, fill).r, 0.25, 1e-6) << renderer << more << turned;
            }
        }
    }
}

TEST(TintByDistance, CutFacesOfASolidBoundItsVolumeWhateverCutThem) {
    const Fill fill = [](SceneMaker& m) {
        const MaterialId clear = m.material(tinted(0.5)), opaque = m.material(matt({1, 1, 1}));
        const ObjectIndex solid = m.object("solid");
        ObjectDescription& object = m.description().objects.back();
        object.combine = Combine::Difference;
        object.cut_material = CutMaterial::Minuend;
        m.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, clear, {}, solid);
        m.add(BoxShape{{-2, -2, -2}, {2, 2, 0}}, opaque, {}, solid);
        m.add(solid);
        add_wall(m, -3, shining({1, 1, 1}));
    };
    for (const char* renderer : {"whitted", "distributed"}) {
        EXPECT_NEAR(color_of(renderer, fill).r, 0.5, 1e-9) << renderer;
    }
}

TEST(TintByDistance, ASheetThatCoversInPartLeavesTheWayToItTinted) {
    const Fill fill = [](SceneMaker& m) {
        add_box(m, 1, tinted(0.5));
        Material half = matt({0, 0, 0});
        half.alpha_mode = AlphaMode::Blend;
        half.alpha.value = 0.5;
        add_wall(m, 0, half);
        add_wall(m, -0.5, shining({1, 1, 1}));
    };
    for (const char* renderer : {"whitted", "distributed", "cone_tracing"}) {
        EXPECT_NEAR(color_of(renderer, fill).r, 0.5 * std::pow(0.5, 1.5), 1e-6) << renderer;
    }
}

TEST(TintByDistance, BodiesThatOverlapAreLeftInAnyOrder) {
    expect_color(
        [](SceneMaker& m) {
            BoxShape first, second;
            first.lo = {-4, -4, 0};
            first.hi = {4, 4, 2};
            second.lo = {-4, -4, -1};
            second.hi = {4, 4, 1};
            m.add(first, m.material(tinted(0.5)));
            m.add(second, m.material(tinted(1)));
            add_wall(m, -0.5, shining({1, 1, 1}));
        },
        // From 2 to 1 in the first alone, to 0 in both, where the surface left is the first's.
        {0.25, 1, 0.25 * 0.25 * std::pow(0.5, 0.5)});
}

/// As rays of the eye: in both, from x = 2 to 3, the tint is that of the body left first.
TEST(TintByDistance, LightPassesBodiesThatOverlapByTheOneLeftFirst) {
    const auto lit = [](bool through_bodies) {
        return [=](SceneMaker& m) {
            if (through_bodies) {
                m.add(BoxShape{{1, -4, -4}, {3, 4, 9}}, m.material(tinted(0.5)));
                m.add(BoxShape{{2, -4, -4}, {4, 4, 9}}, m.material(tinted(0.8)));
            }
            add_wall(m, -1, matt({1, 1, 1}));
            m.light(DirectionalLight{.to_light = normalize(Vec3{1, 0, 1}), .color = {1, 1, 1}});
        };
    };
    const double step = std::sqrt(2.0);
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const Rgb all = color_of(renderer, lit(false)), found = color_of(renderer, lit(true));
        EXPECT_NEAR(found.r, all.r * std::pow(0.5, 2 * step) * std::pow(0.8, step), 1e-6)
            << renderer;
        EXPECT_NEAR(found.g, all.g, 1e-6) << renderer;
    }
}

/// A piece in the overlap of two bodies, whose light comes from above; the eye looks down through
/// both, or from the side through one.
TEST(TintByDistance, LightInAnOverlapHasTheTintOfTheBodyThatItLeavesFirst) {
    const auto fill = [](bool low_first, bool light) {
        return [=](SceneMaker& m) {
            BoxShape low, high;
            low.lo = {-2, -2, 0};
            low.hi = {2, 2, 2};
            high.lo = {-1, -1, 1};
            high.hi = {1, 1, 3};
            if (low_first) m.add(low, m.material(tinted(0.5)));
            m.add(high, m.material(tinted(0.8)));
            if (!low_first) m.add(low, m.material(tinted(0.5)));
            m.add(rectangle({-0.3, -0.3, 1.5}, {0.6, 0, 0}, {0, 0.6, 0}),
                  m.material(light ? matt({1, 1, 1}) : shining({1, 1, 1})));
            m.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
        };
    };
    const auto from_the_side = [](const Fill& rest) {
        return [rest](SceneMaker& m) {
            rest(m);
            m.description().cameras[0].camera = OrthographicCamera{
                {-3, 0, 2.1}, normalize(Vec3{1, 0, -0.2}), {0, 1e-6, 0}, {1e-6, 0, 0}};
        };
    };
    for (const bool low_first : {false, true}) {
        for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
            for (const bool side : {false, true}) {
                const auto seen = [&](bool light) {
                    const Fill scene = fill(low_first, light);
                    return color_of(renderer, side ? from_the_side(scene) : scene);
                };
                const Rgb lit = seen(true), glowing = seen(false);
                EXPECT_NEAR(lit.r / glowing.r, std::pow(0.5, 0.5) * 0.8, 1e-6)
                    << renderer << (side ? " from the side" : "");
            }
        }
    }
}

/// The eye is below a pane over a floor, or above it.
TEST(TintByDistance, LightDoesNotDependOnWhetherTheEyeLooksThroughAPane) {
    for (const double height : {0.5, 3.0}) {
        expect_color(
            [height](SceneMaker& m) {
                m.description().cameras[0].camera =
                    OrthographicCamera{{0, 0, height}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
                add_wall(m, 0, matt({1, 1, 1}));
                add_wall(m, 1, tinted(0.3));
                m.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            },
            {0.3, 1, 0.15});
    }
}

TEST(TintByDistance, ShadowsAloneMayBeTintedByDistance) {
    for (const std::string renderer : {"whitted", "distributed", "beam_tracing"}) {
        const Rgb found = color_of(renderer, [](SceneMaker& m) {
            m.description().conventions.shading.refraction_tint =
                ShadingConventions::RefractionTint::PerEvent;
            add_wall(m, 0, matt({1, 1, 1}));
            add_box(m, 2, tinted(0.5));
            m.light(PointLight{
                .position = {0.8, 0, 0.6}, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
        });
        EXPECT_NEAR(found.r, 0.5 * 0.6 * 0.5, 1e-6) << renderer;
    }
}

/// A mesh of a closed tetrahedron of which one face is turned, and one that faces inward.
TEST(TintByDistance, AMeshThatFacesInwardOrBothWaysIsNoBody) {
    for (const bool inward : {false, true}) {
        TriangleMesh mesh;
        mesh.positions = {{-4, -4, -1}, {4, -4, -1}, {0, 6, -1}, {0, 0, 1}};
        mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        for (std::size_t k = 0; k < (inward ? 4u : 1u); ++k) {
            std::swap(mesh.triangles[k][0], mesh.triangles[k][1]);
        }
        SceneMaker maker;
        maker.description().conventions.shading.refraction_tint =
            ShadingConventions::RefractionTint::PerDistance;
        maker.add(maker.mesh(std::move(mesh)), maker.material(tinted(0.5)));
        EXPECT_FALSE(maker.compile().is_closed(0)) << inward;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
