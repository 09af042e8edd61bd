// Exact optics and light transport where a thin sheet lies at the place of faces of volumes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/media/layers.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::above_a_light;
using testing::box;
using testing::center;
using testing::expect_near;
using testing::glowing;
using testing::physical;
using testing::SceneMaker;

const Rgb kWhite{1, 1, 1};

/// A thin sheet that passes a share of the light straight.
Material clear_sheet(double share) {
    Material m;
    m.index.value = 1.0;
    MetallicRoughness& p = m.metallic_roughness.emplace();
    p.base_color.color = {share, share, share};
    p.metallic.value = p.roughness.value = 0.0;
    p.transmission.value = 1.0;
    return m;
}

/// A sheet of the shape of a polygon: not hit before a box, as a rectangle is.
Polygon square(double z) {
    return {.vertices = {{-3, -3, z}, {3, -3, z}, {3, 3, z}, {-3, 3, z}}};
}

/// `box(bottom, top, 90)` of triangles.
TriangleMesh mesh_block(double bottom, double top) {
    TriangleMesh mesh;
    for (const double z : {bottom, top}) {
        for (const double y : {-90.0, 90.0}) {
            mesh.positions.insert(mesh.positions.end(), {{-90, y, z}, {90, y, z}});
        }
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

TEST(CoincidentSheets, ASheetAndTheFacesAtItsPlaceAreAllMet) {
    // Volumes of the index of the air, and a block of one index in two halves.
    for (const bool halves : {false, true}) {
        std::vector<int> order{0, 1, 2};
        for (bool polygon = false, more = true; more; polygon = !polygon) {
            SCOPED_TRACE(polygon);
            for (const std::string_view renderer :
                 {"whitted", "distributed", "path_tracing", "bidirectional", "sppm"}) {
                SCOPED_TRACE(renderer);
                // Glass that paths reflect from, or not, at random.
                const bool exact = renderer == "whitted" || renderer == "distributed";
                const bool noisy = halves && !exact;
                if (noisy && renderer == "sppm") continue;
                SceneMaker maker = above_a_light();
                const double index = halves ? 1.5 : 1.0;
                // One that does not reflect: exact optics turn it to the index around it.
                Material clear = clear_sheet(0.5);
                clear.index.value = exact ? index : 1.0;
                for (const int i : order) {
                    if (i == 0) maker.add(box(0, 1), maker.material(physical({index, 1.0})));
                    if (i == 1) maker.add(box(1, 2), maker.material(physical({index, 2.0})));
                    if (i != 2) continue;
                    const MaterialId sheet = maker.material(clear);
                    if (polygon) {
                        maker.add(square(1), sheet);
                    } else {
                        maker.add(Rectangle{{-2, -2, 1}, {4, 0, 0}, {0, 4, 0}}, sheet);
                    }
                }
                const double t = halves ? 0.96 * 0.96 * std::exp(-3.0) * 0.5 : 0.5 * std::exp(-3.0);
                const Film film = testing::picture_of(maker.compile(), std::string(renderer), 1,
                                                      noisy ? 1000 : 4);
                // Reflections between the ends of the block are below exp(-6).
                expect_near(film.at(0, 0), {t, t, t}, noisy ? 0.05 * t : halves ? 1e-4 * t : 1e-6);
            }
            if (polygon) more = std::next_permutation(order.begin(), order.end());
        }
    }
}

TEST(CoincidentSheets, AClearSheetOnAFaceThatRefractsAddsNoLight) {
    // Everything is in uniform light of 1 and takes none of it.
    for (const double z : {1.0, 0.0}) {
        for (const bool sheet_first : {false, true}) {
            SceneMaker maker;
            maker.description().picture.background = kWhite;
            const auto add_sheet = [&] {
                maker.add(Rectangle{{-2, -2, z}, {4, 0, 0}, {0, 4, 0}},
                          maker.material(clear_sheet(1.0)));
            };
            if (sheet_first) add_sheet();
            maker.add(box(0, 1), maker.material(physical({1.5, 0.0})));
            if (!sheet_first) add_sheet();
            const Scene scene = maker.compile();
            for (const char* renderer : {"whitted", "distributed", "path_tracing", "bidirectional",
                                         "photon_mapping:photons=10", "sppm:photons=10"}) {
                SCOPED_TRACE(renderer);
                const Rgb c = testing::picture_of(scene, renderer, 1, 64).at(0, 0);
                expect_near(c, kWhite, 1e-3);
            }
        }
    }
}

/// Half of a mirror, a mirror, glass of a high index, a tint, a tint that is hardly rough.
std::vector<Material> reflecting_sheets() {
    Material half = clear_sheet(0.9);
    half.index.value = 1.5;
    half.metallic_roughness->metallic.value = 0.5;
    Material mirror = half;
    mirror.metallic_roughness->metallic.value = 1.0;
    Material dense = clear_sheet(1.0);
    dense.index.value = 10.0;
    Material tint = clear_sheet(0.5);
    tint.index.value = 1.5;
    Material hardly_rough = tint;
    hardly_rough.metallic_roughness->roughness.value = 0.02;
    return {half, mirror, dense, tint, hardly_rough};
}

/// Of a block in uniform light of 1 above a weaker light, with a sheet, which is named first or
/// not, at a height.
Scene block_and_sheet(const Material& sheet, double z, bool first) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.optics = {true, true};
    c.max_depth = 12;
    maker.description().picture.background = kWhite;
    maker.description().cameras[0].camera =
        look_along({-1.2, 0, 5}, {0.3, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
    maker.add(Rectangle{{-50, -50, -20}, {100, 0, 0}, {0, 100, 0}},
              maker.material(glowing({0.2, 0.2, 0.2})));
    if (first) maker.add(square(z), maker.material(sheet));
    maker.add(box(0, 1), maker.material(physical({1.5, 0.5})));
    if (!first) maker.add(square(z), maker.material(sheet));
    return maker.compile();
}

TEST(CoincidentSheets, ASmoothSheetOnAFaceThatRefractsActsAsALittleOutsideOfIt) {
    for (const Material& sheet : reflecting_sheets()) {
        for (const double z : {0.0, 1.0}) {
            for (const bool first : {false, true}) {
                SCOPED_TRACE(::testing::Message() << z << first);
                const Scene on = block_and_sheet(sheet, z, first);
                const Scene apart = block_and_sheet(sheet, z > 0.0 ? z + 1e-5 : z - 1e-5, first);
                for (const char* renderer : {"whitted", "distributed"}) {
                    SCOPED_TRACE(renderer);
                    expect_near(testing::picture_of(on, renderer, 1, 1).at(0, 0),
                                testing::picture_of(apart, renderer, 1, 1).at(0, 0), 1e-4);
                }
                for (const char* renderer : {"path_tracing", "bidirectional"}) {
                    SCOPED_TRACE(renderer);
                    expect_near(testing::picture_of(on, renderer, 1, 1000).at(0, 0),
                                testing::picture_of(apart, renderer, 1, 1000).at(0, 0), 0.06);
                }
            }
        }
    }
}

TEST(CoincidentSheets, ARoughMetalOnAFaceIsMetWhicheverIsNamedFirst) {
    Material metal = clear_sheet(0.9);
    metal.metallic_roughness->metallic.value = 1.0;
    metal.metallic_roughness->roughness.value = 0.3;
    for (const bool first : {false, true}) {
        expect_near(center(block_and_sheet(metal, 1.0, first)),
                    center(block_and_sheet(metal, 1.0 + 1e-5, first)), 1e-6);
    }
}

/// The second surface is so large that its error bound reaches back before the first face.
TEST(CoincidentSheets, AFaceThatWasCrossedIsNotCrossedAgainWithALargeSurfaceBehindIt) {
    const double half = 1e6;
    for (const bool sheet : {false, true}) {
        SceneMaker maker = above_a_light();
        maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1e-9}}, maker.material(physical({1.0, 0.7})));
        if (sheet) {
            maker.add(Rectangle{{-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}},
                      maker.material(clear_sheet(0.5)));
        } else {
            maker.add(box(-2, 0, half), maker.material(physical({1.0, 0.2})));
        }
        const Scene scene = maker.compile();
        // The volume that is entered last is the innermost.
        const double t = sheet ? 0.5 * std::exp(-0.7) : std::exp(-0.4);
        for (const char* renderer : {"whitted", "path_tracing", "bidirectional"}) {
            SCOPED_TRACE(::testing::Message() << renderer << sheet);
            expect_near(testing::picture_of(scene, renderer, 1, 4).at(0, 0), {t, t, t}, 1e-6);
        }
    }
}

/// Two boxes have their lower faces at one place, with a sheet on them; a floor is lit through all.
TEST(CoincidentSheets, ShadowRaysCrossFacesAtTheirPlaceTogetherBehindASheet) {
    const Vec3 move{-4.321323653165139, 18.771261203697428, -25.01697733910349};
    const Affine placed = Affine::translate(move);
    Material sheet = clear_sheet(0.5);
    sheet.metallic_roughness->specular.value = 0;
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{move + Vec3{0.1, 0.2, -0.5}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    const Vec3 to_light =
        -1.0 * normalize(Vec3{-0.3703352894700126, 0.8553061622271785, -0.3623577544766736});
    maker.light(DirectionalLight{.to_light = to_light, .color = {1, 1, 1}});
    maker.add(BoxShape{{-47, -47, 1}, {47, 47, 2}}, maker.material(physical({1.0, 0.07})), placed);
    maker.add(BoxShape{{-50, -50, 1}, {50, 50, 4}}, maker.material(physical({1.0, 0.15})), placed);
    maker.add(Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, maker.material(sheet),
              Affine::translate(move + Vec3{0, 0, 1}) * Affine::scale({59, 59, 59}));
    maker.add(Rectangle{{-99, -99, -1}, {198, 0, 0}, {0, 198, 0}},
              maker.material(testing::matt({1, 1, 1})), placed);
    const Scene scene = maker.compile();
    // From above the small box is entered last.
    const double t = 0.5 * to_light.z * std::exp(-(2 * 0.15 + 0.07) / to_light.z);
    for (const char* renderer : {"path_tracing", "bidirectional", "vcm"}) {
        SCOPED_TRACE(renderer);
        expect_near(testing::picture_of(scene, renderer, 1, 4).at(0, 0), {t, t, t}, 1e-6);
    }
}

TEST(CoincidentSheets, AFaceUnderASheetKeepsItsTint) {
    Material physical_tint = testing::smooth_glass(1.0);
    physical_tint.metallic_roughness->base_color.color = {0.5, 0.5, 0.5};
    Material kt;
    kt.index.value = 1.0;
    kt.transmissive.color = {0.5, 0.5, 0.5};
    for (const Material& tinted : {physical_tint, kt}) {
        for (const std::vector<double>& sheets :
             std::vector<std::vector<double>>{{}, {1}, {0}, {0, 1}}) {
            for (const bool first : {false, true}) {
                SceneMaker maker = above_a_light();
                // kt acts at surfaces.
                maker.description().conventions.shading.optics = {true, false};
                if (!first) maker.add(box(0, 1), maker.material(tinted));
                for (const double z : sheets) {
                    maker.add(Rectangle{{-2, -2, z}, {4, 0, 0}, {0, 4, 0}},
                              maker.material(clear_sheet(0.9)));
                }
                if (first) maker.add(box(0, 1), maker.material(tinted));
                const Scene scene = maker.compile();
                const double t = 0.25 * std::pow(0.9, static_cast<double>(sheets.size()));
                for (const char* renderer : {"whitted", "path_tracing", "bidirectional"}) {
                    SCOPED_TRACE(::testing::Message() << renderer << " " << sheets.size() << first);
                    const Rgb c = testing::picture_of(scene, renderer, 1, 4).at(0, 0);
                    expect_near(c, {t, t, t}, 1e-6);
                }
            }
        }
    }
}

TEST(CoincidentSheets, ASheetOnAFaceThatDoesNotRefractReflects) {
    const Material volume = physical({1.0, 1.0});
    Material mirror = clear_sheet(1.0);
    mirror.index.value = 1.5;
    for (const double z : {0.0, 1.0}) {
        for (const bool first : {false, true}) {
            SceneMaker maker = above_a_light();
            maker.add(Rectangle{{-50, -50, 40}, {100, 0, 0}, {0, 100, 0}},
                      maker.material(glowing({10, 10, 10})));
            const Rectangle sheet{{-2, -2, z}, {4, 0, 0}, {0, 4, 0}};
            if (first) maker.add(sheet, maker.material(mirror));
            maker.add(box(0, 1), maker.material(volume));
            if (!first) maker.add(sheet, maker.material(mirror));
            const Scene scene = maker.compile();
            const double down = std::exp(-1.0), up = z > 0.0 ? 1.0 : std::exp(-2.0);
            const double light = 0.96 * down + 0.04 * 10.0 * up;
            for (const char* renderer : {"whitted", "distributed"}) {
                SCOPED_TRACE(renderer);
                const Rgb c = testing::picture_of(scene, renderer, 1, 4).at(0, 0);
                expect_near(c, {light, light, light}, 1e-6);
            }
        }
    }
}

/// A box and a mesh of the same shape are hit at distances that differ by rounding, the sheet
/// between them.
TEST(CoincidentSheets, ShadowRaysCrossFacesOnceAroundASheet) {
    const auto add_block = [](SceneMaker& maker, bool mesh, double bottom, double top,
                              double absorption) {
        const MaterialId id = maker.material(physical({1.0, absorption}));
        if (!mesh) return maker.add(box(bottom, top, 90), id);
        maker.add(maker.mesh(mesh_block(bottom, top)), id);
    };
    for (const double z : {0.3, 0.5, 1.0}) {
        for (const bool mesh : {false, true}) {
            for (const bool nested : {false, true}) {
                for (const bool open : {false, true}) {
                    SCOPED_TRACE(::testing::Message() << z << mesh << nested << open);
                    SceneMaker maker = testing::looking_down();
                    maker.description().conventions.shading.optics = {true, true};
                    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = kWhite});
                    maker.add(box(-12, -10, 99), maker.material(testing::matt(kWhite)));
                    maker.description().cameras[0].camera =
                        look_along({0.01, 0.02, -5}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
                    add_block(maker, mesh, nested ? z : z - 1.0, nested ? z + 2.0 : z, 0.5);
                    add_block(maker, !mesh, z, z + 1.0, 1.0);
                    Material sheet = clear_sheet(0.5);
                    if (open) {
                        sheet = testing::matt({0, 0, 0});
                        sheet.alpha_mode = AlphaMode::Blend;
                        sheet.alpha.value = 0.5;
                    }
                    maker.add(square(z), maker.material(sheet));
                    const Scene scene = maker.compile();
                    const double t = 0.5 * std::exp(-1.5);
                    for (const char* renderer : {"whitted", "path_tracing"}) {
                        SCOPED_TRACE(renderer);
                        const Rgb c = testing::picture_of(scene, renderer, 1, 1).at(0, 0);
                        expect_near(c, {t, t, t}, 1e-6);
                    }
                }
            }
        }
    }
}

/// The eye is in a solid of two media: the wall between them and the sheet on it know other media
/// before them, and neither is met instead of the other for ever.
TEST(CoincidentSheets, ASheetOnAWallAroundTheEyeIsMetOnce) {
    const auto seen = [](double z) {
        SceneMaker maker = above_a_light();
        const ObjectIndex solid = maker.object("solid");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(box(0, 1), maker.material(physical({1.5, 1.0})), {}, solid);
        maker.add(box(1, 2), maker.material(physical({1.5, 2.0})), {}, solid);
        maker.add(solid);
        maker.add(square(z), maker.material(clear_sheet(0.5)));
        maker.description().cameras[0].camera =
            look_along({0.1, 0.2, 1.5}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
        return center(maker.compile());
    };
    expect_near(seen(1.0), seen(1.0 + 1e-7), 1e-6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
