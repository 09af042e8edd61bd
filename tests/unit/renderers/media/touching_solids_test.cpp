// Solids that share a face, named in either order, without exact optics.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/core/renderer.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::matt;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

enum class Kt { AtSurfaces, ByDistance };

/// A block, from above down, of thickness 1.
struct Block {
    Material material;
    double top = 0;
};

Material glass(double index, double absorption) {
    Material m;
    m.index.value = index;
    m.dielectric = Dielectric{{absorption, 2 * absorption, 0}};
    return m;
}
Material tinted(double index, double kt) {
    Material m;
    m.index.value = index;
    m.transmissive.color = {kt, 1, kt};
    return m;
}

/// Two blocks above a wall at z = -3 that shines, or is `wall`.
SceneMaker two_blocks(const Block& a, const Block& b, bool reversed, Kt kt,
                      const Material& wall = shining({1, 1, 1})) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.max_depth = 10;
    if (kt == Kt::ByDistance) {
        c.refraction_tint = ShadingConventions::RefractionTint::PerDistance;
        c.shadow_tint = ShadingConventions::ShadowTint::PerDistance;
    }
    const auto add = [&](const Block& block) {
        maker.add(BoxShape{{-4, -4, block.top - 1}, {4, 4, block.top}},
                  maker.material(block.material));
    };
    add(reversed ? b : a);
    add(reversed ? a : b);
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), maker.material(wall));
    return maker;
}

/// What a thin cone or a ray along `direction` from above (0, 0, 1) sees.
Rgb color_of(SceneMaker& maker, const std::string& renderer, const Vec3& direction = {0, 0, -1}) {
    maker.description().cameras[0].camera =
        look_along(Vec3{0.0137, 0.0071, 1} - 4.0 * direction, direction, {0.1, 1, 0}, 1e-6, 1.0);
    Scene scene = maker.compile();
    const std::unique_ptr<Renderer> made = make_renderer(renderer);
    made->adjust(scene.conventions.shading);
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    Film film(1, 1, {0, 0, 1, 1});
    (void)made->render(job, film);
    return film.at(0, 0);
}

const char* const kRenderers[] = {"whitted", "distributed", "cone_tracing"};

TEST(TouchingSolids, TwoAbsorbersLetThroughTheirProduct) {
    const Block above{glass(1, 0.5), 1}, below{glass(1, 0.2), 0};
    for (const bool reversed : {false, true}) {
        for (const std::string renderer :
             {"whitted", "distributed", "cone_tracing", "path_tracing"}) {
            SceneMaker maker = two_blocks(above, below, reversed, Kt::AtSurfaces);
            const Rgb found = color_of(maker, renderer);
            EXPECT_NEAR(found.r, std::exp(-0.7), 1e-6) << renderer << reversed;
            EXPECT_NEAR(found.g, std::exp(-1.4), 1e-6) << renderer << reversed;
            EXPECT_NEAR(found.b, 1, 1e-6) << renderer << reversed;
        }
    }
}

TEST(TouchingSolids, KtByDistanceActsInEachOverItsWay) {
    for (const double index : {1.0, 1.5}) {
        const Block above{tinted(index, 0.5), 1}, below{tinted(1.2 * index, 0.8), 0};
        for (const bool reversed : {false, true}) {
            for (const std::string renderer : kRenderers) {
                SceneMaker maker = two_blocks(above, below, reversed, Kt::ByDistance);
                EXPECT_NEAR(color_of(maker, renderer).r, 0.4, 1e-6) << renderer << reversed;
            }
        }
    }
}

TEST(TouchingSolids, KtAtSurfacesActsAtEachFace) {
    const Block above{tinted(1, 0.5), 1}, below{tinted(1, 0.8), 0};
    for (const bool reversed : {false, true}) {
        for (const std::string renderer : kRenderers) {
            SceneMaker maker = two_blocks(above, below, reversed, Kt::AtSurfaces);
            EXPECT_NEAR(color_of(maker, renderer).r, 0.16, 1e-6) << renderer << reversed;
        }
    }
}

/// The boundary between them reflects as that of one against the other.
TEST(TouchingSolids, GlassesReflectByTheirIndices) {
    const Block above{glass(1.5, 0.5), 1}, below{glass(1.7, 0.2), 0};
    const auto passes = [](double m, double n) { return 1.0 - std::pow((m - n) / (m + n), 2.0); };
    const double straight = passes(1, 1.5) * passes(1.5, 1.7) * passes(1.7, 1) * std::exp(-0.7);
    for (const bool reversed : {false, true}) {
        for (const std::string renderer : kRenderers) {
            SceneMaker maker = two_blocks(above, below, reversed, Kt::AtSurfaces);
            maker.description().conventions.shading.trace_reflections = false;
            EXPECT_NEAR(color_of(maker, renderer).r, straight, 1e-6) << renderer << reversed;
        }
    }
}

/// Oblique rays bend as at one boundary: the wall has the light of the place that they meet.
TEST(TouchingSolids, ObliqueRaysBendAsInExactOptics) {
    const Vec3 direction = normalize(Vec3{0.8, 0.1, -0.4});
    const Block above{glass(1.9, 0.5), 1}, below{glass(1.1, 0.2), 0};
    const auto lit = [&](bool reversed) {
        SceneMaker maker =
            two_blocks(above, below, reversed, Kt::AtSurfaces, matt({0.5, 0.5, 0.5}));
        maker.light(
            PointLight{.position = {1, 0, -2.5}, .color = {10, 10, 10}, .attenuation = {0, 0, 1}});
        maker.description().conventions.shading.trace_reflections = false;
        return maker;
    };
    for (const bool reversed : {false, true}) {
        SceneMaker maker = lit(reversed);
        const double plain = color_of(maker, "whitted", direction).b;
        const double cone = color_of(maker, "cone_tracing", direction).b;
        const double exact = color_of(maker, "whitted:fresnel=on,beer=on", direction).b;
        EXPECT_GT(exact, 0.01);
        // Schlick's formula and Fresnel's equations differ.
        EXPECT_NEAR(plain, exact, 0.1 * exact) << reversed;
        EXPECT_NEAR(cone, plain, 1e-4 * plain) << reversed;
        SceneMaker other = lit(!reversed);
        EXPECT_EQ(color_of(other, "whitted", direction), color_of(maker, "whitted", direction));
    }
}

TEST(TouchingSolids, ABlockOnAnOpaqueOneShowsIt) {
    for (const bool reversed : {false, true}) {
        for (const std::string renderer : kRenderers) {
            SceneMaker maker = two_blocks({glass(1, 0.5), 1}, {shining({0.5, 0.5, 0.5}), 0},
                                          reversed, Kt::AtSurfaces);
            EXPECT_NEAR(color_of(maker, renderer).r, 0.5 * std::exp(-0.5), 1e-6)
                << renderer << reversed;
        }
    }
}

/// A sheet that passes half of the light; the rest, or `metallic` of it, it reflects.
Material sheet(double metallic, double transmission = 1.0) {
    Material m;
    m.index.value = 1.0;
    MetallicRoughness& p = m.metallic_roughness.emplace();
    p.base_color.color = {0.5, 0.5, 0.5};
    p.metallic.value = metallic;
    p.roughness.value = 0.0;
    p.transmission.value = transmission;
    return m;
}

/// A sheet at a height above something with its upper face at z = 1, before a shining wall; lit
/// from the side.
struct BelowSheet {
    AnyShape shape;
    Material material;
    bool first = false;        ///< named before the sheet
    Rgb beyond{0.25, 0.5, 1};  ///< radiance of the wall
};
Rgb seen_below(const BelowSheet& below, const Material& on, double height,
               const std::string& renderer, int sheets = 1) {
    SceneMaker maker;
    maker.description().conventions.shading.max_depth = 12;
    maker.light(DirectionalLight{{0.6, 0, 0.8}, {1.25, 1.25, 1.25}});
    if (below.first) maker.add(below.shape, maker.material(below.material));
    for (int i = 1; i <= sheets; ++i) {
        const double z = 1 + i * height;
        maker.add(rectangle({-4, -4, z}, {8, 0, 0}, {0, 8, 0}), maker.material(on));
    }
    if (!below.first) maker.add(below.shape, maker.material(below.material));
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}),
              maker.material(shining(below.beyond)));
    return color_of(maker, renderer);
}

void expect_as_apart(const BelowSheet& below, const Material& on, const std::string& renderer,
                     double within, int sheets = 1) {
    const Rgb together = seen_below(below, on, 0, renderer, sheets);
    const Rgb apart = seen_below(below, on, 1e-5, renderer, sheets);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(together[i], apart[i], within) << renderer << below.first << i;
    }
    EXPECT_GT(together.b, 0.01);
}

TEST(TouchingSolids, AVolumeBelowASheetIsCrossedWithIt) {
    const BoxShape block{{-4, -4, 0}, {4, 4, 1}};
    for (const bool first : {false, true}) {
        for (const std::string renderer :
             {"whitted", "distributed", "whitted:fresnel=on,beer=on", "path_tracing"}) {
            const Rgb found = seen_below({block, glass(1, 0.7), first}, sheet(0), 0, renderer);
            EXPECT_NEAR(found.r, 0.125 * std::exp(-0.7), 1e-6) << renderer << first;
            EXPECT_NEAR(found.b, 0.5, 1e-6) << renderer << first;
        }
        for (const std::string renderer :
             {"whitted", "distributed", "whitted:fresnel=on,beer=on"}) {
            for (const double metallic : {0.0, 0.5}) {
                expect_as_apart({block, glass(1.5, 0.7), first}, sheet(metallic), renderer, 2e-3);
            }
        }
    }
}

/// The light of the matt face passes the sheet twice.
TEST(TouchingSolids, AnOpaqueFaceBelowASheetIsSeenThroughIt) {
    const AnyShape block = BoxShape{{-4, -4, 0}, {4, 4, 1}};
    const AnyShape card = rectangle({-4, -4, 1}, {8, 0, 0}, {0, 8, 0});
    for (const AnyShape& shape : {block, card}) {
        for (const std::string renderer :
             {"whitted", "distributed", "whitted:fresnel=on,beer=on", "path_tracing"}) {
            const Rgb found =
                seen_below({shape, matt({0.8, 0.4, 0.2}), false, {}}, sheet(0), 0, renderer);
            EXPECT_NEAR(found.r, 0.2, 1e-6) << renderer;
            EXPECT_NEAR(found.g, 0.1, 1e-6) << renderer;
            EXPECT_NEAR(found.b, 0.05, 1e-6) << renderer;
            if (renderer == "path_tracing") continue;
            expect_as_apart({shape, shining({0.5, 1, 2})}, sheet(0), renderer, 1e-6);
            expect_as_apart({shape, matt({0.8, 0.4, 0.2})}, sheet(0, 0.5), renderer, 1e-6);
        }
    }
}

TEST(TouchingSolids, SheetsAtOnePlaceAreAllPassed) {
    const AnyShape floor = rectangle({-4, -4, -1}, {8, 0, 0}, {0, 8, 0});
    for (const std::string renderer :
         {"whitted", "distributed", "whitted:fresnel=on,beer=on", "path_tracing"}) {
        expect_as_apart({floor, shining({0.5, 1, 2})}, sheet(0), renderer, 1e-6, 2);
        if (renderer == "path_tracing") continue;
        expect_as_apart({floor, shining({0.5, 1, 2})}, sheet(0.5, 0.5), renderer, 2e-3, 3);
    }
}

/// Sheets above a card or block with its upper face at z = 1, `height` apart, from the uppermost
/// down, named in this order; lit from the side and by an ambient light.
Rgb seen_through(const std::vector<Material>& sheets, const AnyShape& shape,
                 const Material& material, double height, const std::string& renderer,
                 const Vec3& direction = {0, 0, -1}) {
    SceneMaker maker;
    maker.description().conventions.shading.max_depth = 12;
    maker.light(DirectionalLight{{0.6, 0, 0.8}, {1.25, 1.25, 1.25}});
    maker.light(AmbientLight{{1, 1, 1}});
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        const double z = 1 + static_cast<double>(sheets.size() - i) * height;
        maker.add(rectangle({-4, -4, z}, {8, 0, 0}, {0, 8, 0}), maker.material(sheets[i]));
    }
    maker.add(shape, maker.material(material));
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({1, 1, 1})));
    return color_of(maker, renderer, direction);
}

const AnyShape kCard = rectangle({-4, -4, 1}, {8, 0, 0}, {0, 8, 0});
const char* const kWithOptics[] = {"whitted", "distributed", "whitted:fresnel=on,beer=on"};

TEST(TouchingSolids, SheetsLieInTheOrderInWhichTheyAreNamed) {
    Material red = sheet(0, 0.5), green = sheet(0), blue = sheet(0, 0.25);
    red.metallic_roughness->base_color.color = {0.8, 0.1, 0.1};
    green.metallic_roughness->base_color.color = {0.2, 0.9, 0.2};
    blue.metallic_roughness->base_color.color = {0.3, 0.3, 0.9};
    Material physical;
    physical.index.value = 1.0;
    physical.metallic_roughness.emplace().base_color.color = {0.5, 0.7, 0.9};
    physical.metallic_roughness->metallic.value = 0;
    const AnyShape block = BoxShape{{-4, -4, 0}, {4, 4, 1}};
    for (const std::string renderer : kWithOptics) {
        for (const std::vector<Material>& stack : {std::vector<Material>{red, green},
                                                   {green, red},
                                                   {red, green, blue},
                                                   {blue, red, green}}) {
            for (const auto& [shape, material] :
                 {std::pair{kCard, shining({1, 1, 1})}, std::pair{kCard, matt({0.5, 0.7, 0.9})},
                  std::pair{kCard, physical}, std::pair{block, glass(1, 0.7)}}) {
                const Rgb together = seen_through(stack, shape, material, 0, renderer);
                const Rgb apart = seen_through(stack, shape, material, 1e-5, renderer);
                for (int i = 0; i < 3; ++i) EXPECT_NEAR(together[i], apart[i], 1e-5) << renderer;
            }
        }
    }
}

TEST(TouchingSolids, SheetsAloneLieInTheOrderInWhichTheyAreNamed) {
    Material red = sheet(0, 0.5), green = sheet(0);
    red.metallic_roughness->base_color.color = {0.8, 0.1, 0.1};
    green.metallic_roughness->base_color.color = {0.2, 0.9, 0.2};
    const AnyShape lowest = rectangle({-4, -4, 1}, {8, 0, 0}, {0, 8, 0});
    for (const std::string renderer : kWithOptics) {
        for (const bool is_red : {false, true}) {
            const Material &upper = is_red ? red : green, &lower = is_red ? green : red;
            const Rgb together = seen_through({upper}, lowest, lower, 0, renderer);
            const Rgb apart = seen_through({upper}, lowest, lower, 1e-5, renderer);
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(together[i], apart[i], 1e-5) << renderer;
        }
    }
}

/// Highlights, a colour without light and ambient light, below a sheet of index 1.5.
TEST(TouchingSolids, HighlightsAndOwnColoursBelowASheetAreAsApart) {
    Material clear = sheet(0), unlit = matt({0.2, 0.5, 0.9}), ambient, black = matt({0, 0, 0});
    clear.index.value = 1.5;
    unlit.metallic_roughness.emplace().unlit = true;
    unlit.metallic_roughness->base_color.color = {0.2, 0.5, 0.9};
    ambient.ambient.color = {1, 1, 1};
    for (const std::string renderer : kWithOptics) {
        for (const Material& below : {unlit, ambient, black}) {
            for (const Vec3& along : {Vec3{0, 0, -1}, Vec3{0.6, 0, -0.8}}) {
                const Rgb together = seen_through({clear}, kCard, below, 0, renderer, along);
                const Rgb apart = seen_through({clear}, kCard, below, 1e-5, renderer, along);
                for (int i = 0; i < 3; ++i) {
                    EXPECT_NEAR(together[i], apart[i], 1e-5) << renderer << along.x;
                }
            }
        }
    }
}

/// In the middle of the sharp one, and aside of it.
TEST(TouchingSolids, ASharpHighlightOnABroadOneIsAsApart) {
    Material sharp = sheet(0), broad = sheet(0, 0.0);
    sharp.index.value = broad.index.value = 1.5;
    broad.metallic_roughness->base_color.color = {0, 0, 0};
    broad.metallic_roughness->roughness.value = 0.5;
    Material plain = matt({0, 0, 0});
    plain.shininess.value = 10;
    plain.specular.color = {0.1, 0.1, 0.1};
    for (const std::string renderer : kWithOptics) {
        for (const Material& below : {broad, plain}) {
            for (const Vec3& along : {Vec3{0.6, 0, -0.8}, normalize(Vec3{0.4, 0, -0.9})}) {
                const double apart = seen_through({sharp}, kCard, below, 1e-5, renderer, along).r;
                // Apart, the light passes the sheet without its reflection.
                EXPECT_NEAR(seen_through({sharp}, kCard, below, 0, renderer, along).r, apart,
                            0.05 * apart)
                    << renderer << along.x;
            }
        }
    }
}

/// From inside the one named last is seen first.
TEST(TouchingSolids, SheetsOnABodyAreInTheOtherOrderFromInside) {
    Material red = sheet(0), green = sheet(0, 0.3);
    red.metallic_roughness->base_color.color = {0.8, 0.5, 0.5};
    green.metallic_roughness->base_color.color = {0.6, 0.5, 0.5};
    for (const std::string renderer : kWithOptics) {
        const auto seen = [&](double height) {
            SceneMaker maker;
            maker.description().conventions.shading.max_depth = 12;
            maker.light(AmbientLight{{1, 1, 1}});
            maker.add(rectangle({-4, -4, 1 + 2 * height}, {8, 0, 0}, {0, 8, 0}),
                      maker.material(red));
            maker.add(rectangle({-4, -4, 1 + height}, {8, 0, 0}, {0, 8, 0}), maker.material(green));
            maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, maker.material(glass(1, 0.3)));
            return color_of(maker, renderer, {0, 0, 1});
        };
        const Rgb together = seen(0), apart = seen(1e-5);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(together[i], apart[i], 1e-5) << renderer << i;
    }
}

/// Half of what the sheet does not pass is matt.
TEST(TouchingSolids, ASheetThatScattersOnGlassKeepsTheGlass) {
    const BoxShape block{{-4, -4, 0}, {4, 4, 1}};
    for (const bool first : {false, true}) {
        expect_as_apart({block, glass(1.5, 0.7), first}, sheet(0.5, 0.5),
                        "whitted:fresnel=on,beer=on", 5e-3);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
