// The volumes around eyes and lights, where opaque surfaces are in the place of a boundary.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/volumes/media_finder.h"
#include "support/image_texture.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

const Rgb kAbsorption{0.4, 0.8, 1.2};
const std::vector<std::string> kRenderers{
    "path_tracing", "bidirectional", "photon_mapping:photons=10,caustics=0",
    "sppm:photons=10,radius=0.1", "vcm:photons=10,radius=0.1,pilot=off"};

Material glass(double index = 1.5, const Rgb& absorption = kAbsorption) {
    Material m;
    m.dielectric = Dielectric{absorption};
    m.index.value = index;
    return m;
}

Material gold() {
    Material m;
    m.conductor.emplace();
    return m;
}

/// An object of combined parts, added to no other.
ObjectIndex combined(SceneMaker& maker, Combine combine) {
    const ObjectIndex object = maker.object("solid");
    maker.description().objects.back().combine = combine;
    return object;
}

/// A block of glass from z = 0.2 to 1.4 with an open hole: a sphere around (0, 0, 1) of `wall`.
SceneMaker with_hole(const Material& wall, double index, bool instanced = false) {
    SceneMaker maker;
    const MaterialId block = maker.material(glass(index)), other = maker.material(wall);
    const ObjectIndex cut = combined(maker, Combine::Difference);
    maker.add(BoxShape{{-1, -1, 0.2}, {1, 1, 1.4}}, block, {}, cut);
    maker.add(ball({0, 0, 1}, 0.5), other, {}, cut);
    maker.add(cut);
    if (instanced) maker.add(cut, MaterialId{0}, Affine::translate({0, 0, -9}));
    return maker;
}

TEST(HiddenBoundaries, AnOpaqueWallBoundsTheVolumeIntoWhichItIsCut) {
    for (const Material& wall : {matt({0.7, 0.7, 0.7}), gold()}) {
        for (const bool instanced : {false, true}) {
            const Scene scene = with_hole(wall, 1.5, instanced).compile();
            const MediaFinder finder(scene);
            for (const Vec3& outside : {Vec3{0, 0, 1},
                                        {0.1, -0.2, 0.8},
                                        {0, 0, 3},
                                        {2, 0, 1},
                                        {1.2, 0.9, 0.6},
                                        {0.3, 0.2, 1.3}}) {
                EXPECT_TRUE(finder.around(outside, 0).empty()) << outside.x << " " << outside.z;
            }
            for (const Vec3& inside : {Vec3{0.8, 0.1, 1}, {-0.8, 0.1, 1}, {0, 0, 0.3}}) {
                MediumStack media = finder.around(inside, 0);
                ASSERT_FALSE(media.empty()) << inside.x << " " << inside.z;
                EXPECT_EQ(media.here()->index, 1.5);
                EXPECT_EQ(media.here()->absorption, kAbsorption);
                media.leave(*media.here());
                EXPECT_TRUE(media.empty());
            }
        }
    }
}

TEST(HiddenBoundaries, AnEyeInAnOpenHoleSeesTheSky) {
    for (const double index : {1.0, 1.5}) {
        SceneMaker maker = with_hole(matt({0.7, 0.7, 0.7}), index);
        maker.description().picture.background = Rgb{1, 1, 1};
        maker.description().cameras[0].camera =
            look_along({0, 0, 1}, {0, 0, 1}, {0, 1, 0}, 0.1, 1.0);
        const Scene scene = maker.compile();
        for (const std::string& renderer : kRenderers) {
            const Rgb seen = mean_of(picture_of(scene, renderer, 2, 4));
            EXPECT_NEAR(seen.r, 1, 1e-9) << renderer << " " << index;
            EXPECT_NEAR(seen.b, 1, 1e-9) << renderer << " " << index;
        }
    }
}

/// A notch with painted walls, seen along the ray to the light: what is subtracted is no volume.
TEST(HiddenBoundaries, ALightInFrontOfAPaintedNotchIsInAir) {
    SceneMaker maker;
    const MaterialId block = maker.material(glass()), wall = maker.material(matt({0.7, 0.7, 0.7}));
    const ObjectIndex cut = combined(maker, Combine::Difference);
    maker.add(BoxShape{{-4, -6, -6}, {-2.5, 6, 6}}, block, {}, cut);
    maker.add(BoxShape{{-3, -9, -9}, {-2, 9, 9}}, wall, {}, cut);
    maker.add(cut);
    maker.add(rectangle({-1, -1, -2}, {3, 0, 0}, {0, 3, 0}), maker.material(matt({0.5, 0.5, 0.5})));
    maker.light(PointLight{.position = {0, 0, 0}, .attenuation = {0, 0, 1}});
    maker.description().cameras[0].camera =
        look_along({0.5, 0.4, -1.8}, normalize(Vec3{0, -0.4, -0.2}), {0, 1, 0}, 0.2, 1.0);
    const Scene scene = maker.compile();
    const double squared = 4.25, expected = 0.5 * 2 / std::sqrt(squared) / squared;
    for (const std::string renderer :
         {"path_tracing:depth=1", "bidirectional:depth=1", "light_tracing:depth=1"}) {
        const Rgb seen = mean_of(picture_of(scene, renderer, 2, renderer[0] == 'l' ? 1 << 14 : 4));
        // Few paths of light end in the picture.
        EXPECT_NEAR(seen.r, expected, (renderer[0] == 'l' ? 0.9 : 0.05) * expected) << renderer;
        EXPECT_NEAR(seen.b, seen.r, 1e-9) << renderer;
    }
}

/// A part with a face in the plane x = `at`.
enum class Label { Sheet, Block, Open, ForShadowRays };
void add_label(SceneMaker& maker, Label label, double at, MaterialId paint, MaterialId open) {
    const Rectangle sheet = rectangle({at, -6, -6}, {0, 12, 0}, {0, 0, 12});
    if (label == Label::Block) {
        maker.add(BoxShape{{at, -6, -6}, {at + 0.5, 6, 6}}, paint);
    } else {
        maker.add(sheet, label == Label::Open ? open : paint);
    }
    if (label == Label::ForShadowRays) {
        maker.description().objects[0].parts.back().visible_to = mask_of(RayKind::Shadow);
    }
}

TEST(HiddenBoundaries, SurfacesThatCoincideWithABoundaryDoNotHideIt) {
    Material cut_out = matt({0.7, 0.7, 0.7});
    cut_out.alpha_mode = AlphaMode::Mask;
    cut_out.alpha.value = 0;
    for (const Label label : {Label::Sheet, Label::Block, Label::Open, Label::ForShadowRays}) {
        for (const bool first : {false, true}) {
            for (const double at : {0.0, 4.0}) {
                SceneMaker maker;
                const MaterialId paint = maker.material(matt({0.7, 0.7, 0.7})),
                                 open = maker.material(cut_out), clear = maker.material(glass());
                if (first) add_label(maker, label, at, paint, open);
                maker.add(BoxShape{{0, -6, -6}, {4, 6, 6}}, clear);
                if (!first) add_label(maker, label, at, paint, open);
                const Scene scene = maker.compile();
                const MediaFinder finder(scene);
                const Vec3 off{0, 0.137, -0.291};
                EXPECT_TRUE(finder.around(Vec3{5, 0, 0} + off, 0).empty()) << int(label) << at;
                EXPECT_TRUE(finder.around(Vec3{-1, 0, 0} + off, 0).empty()) << int(label) << at;
                EXPECT_FALSE(finder.around(Vec3{2, 0, 0} + off, 0).empty()) << int(label) << at;
            }
        }
    }
}

TEST(HiddenBoundaries, AnEyeBehindALabelIsWhereItIs) {
    // On the near and the far face of glass of index 1.
    struct {
        double eye, label, way;
    } const views[] = {{5, 4, 0}, {2, 0, 6}};
    for (const auto& view : views) {
        for (const bool first : {false, true}) {
            SceneMaker maker;
            const MaterialId paint = maker.material(matt({0.7, 0.7, 0.7}));
            const MaterialId clear = maker.material(glass(1.0));
            if (first) add_label(maker, Label::Sheet, view.label, paint, paint);
            maker.add(BoxShape{{0, -6, -6}, {4, 6, 6}}, clear);
            if (!first) add_label(maker, Label::Sheet, view.label, paint, paint);
            maker.description().picture.background = Rgb{1, 1, 1};
            maker.description().cameras[0].camera =
                look_along({view.eye, 0.01, 0}, {0, 0, 1}, {0, 1, 0}, 1e-4, 1.0);
            const Scene scene = maker.compile();
            for (const std::string& renderer : kRenderers) {
                const Rgb seen = mean_of(picture_of(scene, renderer, 2, 4));
                EXPECT_NEAR(seen.r, std::exp(-kAbsorption.r * view.way), 1e-6) << renderer;
                EXPECT_NEAR(seen.b, std::exp(-kAbsorption.b * view.way), 1e-6) << renderer;
            }
        }
    }
}

/// Six volumes in each other whose lower faces coincide, under an opaque one.
TEST(HiddenBoundaries, VolumesUnderAnOpaqueFaceNestByTheirEnds) {
    for (const bool turned : {false, true}) {
        SceneMaker maker;
        maker.add(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), maker.material(matt({1, 1, 1})));
        for (int i = 0; i < 6; ++i) {
            const double size = 1.0 + (turned ? 5 - i : i);
            maker.add(BoxShape{{-size, -size, 0}, {size, size, size}},
                      maker.material(glass(1.0 + 0.1 * size)));
        }
        // From above, the rays of the finder run down: turn the scene.
        for (Part& part : maker.description().objects[0].parts) {
            part.object_from_part = Affine::scale({1, 1, -1});
        }
        const Scene scene = maker.compile();
        const MediaFinder finder(scene);
        for (int i = 0; i < 6; ++i) {
            const MediumStack media = finder.around({0.01, 0.02, -0.5 - i}, 0);
            ASSERT_FALSE(media.empty());
            EXPECT_NEAR(media.here()->index, 1.1 + 0.1 * i, 1e-12) << i << turned;
        }
    }
}

TEST(HiddenBoundaries, AnOpaqueSpotOfATextureBoundsTheVolumeToo) {
    Material painted;
    painted.index.value = 1.3;
    SceneMaker maker;
    maker.description().textures.push_back({"", testing::red_and_green(), {}});
    painted.transmissive.color = {1, 0, 0};  // the right half is black
    painted.transmissive.texture = TextureId{0};
    maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, maker.material(painted));
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    for (int i = 0; i < 64; ++i) {
        const Vec3 at{0.23 * (i % 4) - 0.35, 0.23 * (i / 4 % 4) - 0.35, 0.23 * (i / 16) - 0.35};
        EXPECT_FALSE(finder.around(at, 0).empty()) << i;
        EXPECT_TRUE(finder.around(at + Vec3{2, 0.1, 0}, 0).empty()) << i;
        EXPECT_TRUE(finder.around(at - Vec3{2, 0.1, 0}, 0).empty()) << i;
    }
}

/// Water around a solid of two glasses, behind which the point is.
TEST(HiddenBoundaries, ASolidOfSeveralMediaStandsInTheVolumeAroundIt) {
    SceneMaker maker;
    const MaterialId water = maker.material(glass(1.3));
    const MaterialId a = maker.material(glass(1.5)), b = maker.material(glass(1.7));
    maker.add(ball({0, 0, 0}, 9), water);
    const ObjectIndex both = combined(maker, Combine::Union);
    maker.add(ball({-2, -1.5, 0.85}, 1), a, {}, both);
    maker.add(ball({-1.6, -1.2, 0.7}, 1), b, {}, both);
    maker.add(both);
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    ASSERT_NE(finder.around({0.01, 0, 0}, 0).here(), nullptr);
    EXPECT_EQ(finder.around({0.01, 0, 0}, 0).here()->index, 1.3);
    EXPECT_EQ(finder.around({-2.1, -1.6, 0.9}, 0).here()->index, 1.5);
}

/// A matt block whose hole is cut by a part of glass: nothing is in glass.
TEST(HiddenBoundaries, AGlassyHoleInAnOpaqueSolidBoundsNothing) {
    SceneMaker maker;
    const MaterialId wood = maker.material(matt({0.5, 0.4, 0.3})), clear = maker.material(glass());
    const ObjectIndex cut = combined(maker, Combine::Difference);
    maker.add(BoxShape{{-2, -2, -2}, {0, 0, 0}}, wood, {}, cut);
    maker.add(ball({-1, -1, 0}, 0.9), clear, {}, cut);
    maker.add(cut);
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    for (int i = 0; i < 27; ++i) {
        const Vec3 at{0.2 + 0.5 * (i % 3), 0.2 + 0.5 * (i / 3 % 3), 0.5 * (i / 9) - 1.5};
        EXPECT_TRUE(finder.around(at, 0).empty()) << i;
    }
}

/// A lamp on the top of an absorbing block shines down through it, one on its bottom past it.
TEST(HiddenBoundaries, LightsOnABoundaryStartOnTheSideToWhichTheyShine) {
    const double high = 2, side = 0.04;
    for (const bool below : {false, true}) {
        for (const int order : {0, 1, 2}) {
            SceneMaker maker = testing::floor_from_above(0.6, {0.5, 0.5, 0.5});
            const MaterialId block = maker.material(glass(1.0));
            Material lamp = shining({1000, 1000, 1000});
            lamp.double_sided = false;
            const MaterialId lit = maker.material(lamp);
            const BoxShape box{{-3, -3, below ? high : high - 1}, {3, 3, below ? high + 1 : high}};
            const Vec3 corner{-side / 2, -side / 2, high}, u{0, side, 0}, v{side, 0, 0};
            if (order == 0) maker.add(box, block);
            if (order == 2) {
                maker.light(AreaLight{.extent = RectangleExtent{corner, u, v},
                                      .radiance = {1000, 1000, 1000},
                                      .seen = false});
            } else {
                maker.add(rectangle(corner, u, v), lit);
            }
            if (order != 0) maker.add(box, block);
            const Scene scene = maker.compile();
            for (const std::string renderer :
                 {"bidirectional", "light_tracing", "vcm:pilot=off,photons=3000,radius=0.1",
                  "sppm:photons=3000,radius=0.1"}) {
                const int samples = renderer[0] == 'b' || renderer[0] == 'l' ? 512 : 2;
                const Rgb seen = mean_of(picture_of(scene, renderer, 2, samples));
                // Ways through the block are 1 to 1.022 long.
                ASSERT_GT(seen.r, 0) << renderer;
                const double way = below ? 0 : 1.01;
                for (int k = 1; k < 3; ++k) {
                    const double expected = std::exp(-way * (kAbsorption[k] - kAbsorption.r));
                    EXPECT_NEAR(seen[k] / seen.r, expected, 0.01)
                        << renderer << " " << below << " " << order << " " << k;
                }
            }
        }
    }
}

/// Light enters it by diffuse transmission alone.
Material milky(double alpha) {
    Material m;
    MetallicRoughness& p = m.metallic_roughness.emplace();
    p.metallic.value = 0;
    p.thickness.value = 1;
    p.diffuse_transmission.share.value = 1;
    p.attenuation_color = {std::exp(-1.0), 1, 1};
    p.attenuation_distance = 1;
    m.alpha.value = alpha;
    if (alpha < 1) m.alpha_mode = AlphaMode::Mask;
    return m;
}

TEST(HiddenBoundaries, AVolumeOfDiffuseTransmissionIsOneWhateverElseIsThere) {
    for (const bool with_glass : {false, true}) {
        SceneMaker maker;
        maker.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, maker.material(milky(0)));
        maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
                  maker.material(shining({1, 1, 1})));
        if (with_glass) {
            // Where nothing sees it.
            Material cut_glass = glass();
            cut_glass.alpha_mode = AlphaMode::Mask;
            maker.add(BoxShape{{0, 0, -9}, {1, 1, -8}}, maker.material(cut_glass));
        }
        maker.description().cameras[0].camera =
            look_along({0.1, 0.2, 4}, {0, 0, -1}, {0, 1, 0}, 0.01, 1.0);
        const Scene open = maker.compile();
        for (const std::string& renderer : kRenderers) {
            const Rgb seen = mean_of(picture_of(open, renderer, 2, 4));
            EXPECT_NEAR(seen.r, std::exp(-1.0), 1e-3) << renderer << with_glass;
            EXPECT_NEAR(seen.g, 1, 1e-9) << renderer << with_glass;
        }
    }
    SceneMaker closed;
    closed.add(BoxShape{{-4, -4, 0}, {4, 4, 1}}, closed.material(milky(1)));
    const Scene scene = closed.compile();
    const MediaFinder finder(scene);
    EXPECT_FALSE(finder.around({0.1, 0.2, 0.5}, 0).empty());
    EXPECT_TRUE(finder.around({0.1, 0.2, 1.5}, 0).empty());
}

/// A thin sheet of such a material has no inside.
TEST(HiddenBoundaries, AnOpenSheetOfDiffuseTransmissionIsNoVolume) {
    SceneMaker maker;
    Material sheet = milky(0);
    sheet.metallic_roughness->thickness.value = 0;
    maker.add(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), maker.material(sheet));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({1, 1, 1})));
    const Scene scene = maker.compile();
    EXPECT_FALSE(ScatteringMedia(scene).has_open_boundaries());
    for (const std::string& renderer : kRenderers) {
        EXPECT_NEAR(mean_of(picture_of(scene, renderer, 2, 4)).r, 1, 1e-9) << renderer;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
