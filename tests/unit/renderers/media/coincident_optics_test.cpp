// Exact optics where faces of several parts coincide: one boundary between the media on both sides.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/shading/optics/fresnel.h"
#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/media/layers.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::above_a_light;
using testing::box;
using testing::center;
using testing::expect_light_passed;
using testing::expect_near;
using testing::glowing;
using testing::Layer;
using testing::physical;
using testing::SceneMaker;

const Rgb kWhite{1, 1, 1};

/// The same medium by Whitted's coefficients.
Material by_kt(const Layer& layer) {
    Material m;
    const double kt = std::exp(-layer.absorption);
    m.index.value = layer.index;
    m.transmissive.color = {kt, kt, kt};
    return m;
}

/// A stack of touching boxes, its top at z = 1, named in an order.
void add_stack(SceneMaker& maker, const std::vector<Layer>& layers,
               const std::vector<std::size_t>& order, Material (*material)(const Layer&)) {
    for (const std::size_t i : order) {
        double top = 1.0;
        for (std::size_t k = 0; k < i; ++k) top -= layers[k].thickness;
        maker.add(box(top - layers[i].thickness, top), maker.material(material(layers[i])));
    }
}

TEST(CoincidentOptics, TouchingLayersInAnyOrderPassWhatTheIndicesSay) {
    const std::vector<Layer> layers{{1.5, 0.1, 1.0}, {1.7, 0.2, 0.7}, {1.33, 0.05, 1.9}};
    const std::vector<Layer> all{{1}, layers[0], layers[1], layers[2], {1}};
    std::vector<std::size_t> order{0, 1, 2};
    do {
        for (const auto material : {&physical, &by_kt}) {
            SceneMaker maker = above_a_light();
            add_stack(maker, layers, order, material);
            expect_light_passed(maker, all);
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

/// Each layer is a solid of two materials side by side.
TEST(CoincidentOptics, TouchingSolidsOfSeveralMediaInAnyOrderPassWhatTheIndicesSay) {
    const std::vector<Layer> layers{{1.5, 0.1, 1.0}, {1.7, 0.2, 0.7}, {1.33, 0.05, 1.9}};
    const std::vector<Layer> all{{1}, layers[0], layers[1], layers[2], {1}};
    std::vector<std::size_t> order{0, 1, 2};
    do {
        SceneMaker maker = above_a_light();
        for (const std::size_t i : order) {
            const ObjectIndex solid = maker.object("solid");
            maker.description().objects.back().combine = Combine::Union;
            double top = 1.0;
            for (std::size_t k = 0; k < i; ++k) top -= layers[k].thickness;
            for (const double x : {-3.0, 0.0}) {
                maker.add(BoxShape{{x, -3, top - layers[i].thickness}, {x + 3, 3, top}},
                          maker.material(physical(layers[i])), {}, solid);
            }
            maker.add(solid);
        }
        expect_light_passed(maker, all);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(CoincidentOptics, HalvesOfABlockAreABlock) {
    for (const double index : {1.0, 1.5}) {
        const Layer half{index, 0.3, 1.0};
        SceneMaker maker = above_a_light();
        add_stack(maker, {half, half, half}, {1, 0, 2}, &physical);
        expect_light_passed(maker, {{1}, {index, 0.3, 3.0}, {1}});
    }
}

TEST(CoincidentOptics, APartFillsTheCavityOfASolid) {
    for (const bool first : {false, true}) {
        SceneMaker maker = above_a_light();
        const Layer shell{1.5, 0.1, 1}, core{1.7, 0.2, 4};
        const MaterialId a = maker.material(physical(shell)), b = maker.material(physical(core));
        if (first) maker.add(box(-2, 2, 2), b);
        const ObjectIndex hollow = maker.object("hollow");
        maker.description().objects.back().combine = Combine::Difference;
        maker.add(box(-3, 3), a, {}, hollow);
        maker.add(box(-2, 2, 2), a, {}, hollow);
        maker.add(hollow, MaterialId{0});
        if (!first) maker.add(box(-2, 2, 2), b);
        expect_light_passed(maker, {{1}, shell, core, shell, {1}});
    }
}

TEST(CoincidentOptics, OfVolumesEnteredTogetherTheOneLeftLastIsOutermost) {
    const Layer outer{1.5, 0.1, 3}, inner{1.8, 0.4, 1};
    for (const bool first : {false, true}) {
        SceneMaker maker = above_a_light();
        if (first) maker.add(box(0, 1, 2), maker.material(physical(inner)));
        maker.add(box(-3, 1), maker.material(physical(outer)));
        if (!first) maker.add(box(0, 1, 2), maker.material(physical(inner)));
        expect_light_passed(maker, {{1}, inner, outer, {1}});
    }
}

TEST(CoincidentOptics, OpaqueFacesAreMetWhicheverIsNamedFirst) {
    for (const bool first : {false, true}) {
        SceneMaker maker = above_a_light();
        const Layer glass{1.5, 0.1, 2};
        const MaterialId table = maker.material(glowing({2, 3, 4}));
        if (first) maker.add(box(-4, -1, 9), table);
        maker.add(box(-1, 1), maker.material(physical(glass)));
        if (!first) maker.add(box(-4, -1, 9), table);
        const double left = 0.96 * std::exp(-0.2);
        expect_near(center(maker.compile()), {2 * left, 3 * left, 4 * left}, 1e-12);
    }
}

TEST(CoincidentOptics, ShadowRaysCrossTouchingFacesAsOne) {
    const std::vector<Layer> layers{{1.5, 0.1, 1.0}, {1.7, 0.2, 0.7}, {1.7, 0.3, 1.9}};
    Material matt;
    matt.diffuse.color = kWhite;
    struct Case {
        double angle;
        bool reversed;
        double min_distance;
    };
    for (const auto [angle, reversed, min_distance] :
         {Case{0, false, 0}, Case{0.7, false, 0}, Case{0.7, true, 0}, Case{0, false, 1e-3},
          Case{0, true, 1e-3}, Case{0.7, true, 1e-6}}) {
        for (const auto material : {&physical, &by_kt}) {
            SceneMaker maker = above_a_light();
            maker.description().conventions.shading.min_distance = min_distance;
            maker.description().conventions.shading.max_depth = 0;
            const double c = std::cos(angle);
            maker.light(DirectionalLight{.to_light = {std::sin(angle), 0, c}, .color = kWhite});
            maker.add(box(-12, -10, 99), maker.material(matt));
            maker.description().cameras[0].camera =
                look_along({0, 0, -5}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
            double top = 1.0, left = c;
            std::vector<std::pair<BoxShape, MaterialId>> boxes;
            for (const Layer& layer : layers) {
                boxes.emplace_back(box(top - layer.thickness, top, 90),
                                   maker.material(material(layer)));
                top -= layer.thickness;
                left *= std::exp(-layer.absorption * layer.thickness / c);
            }
            if (reversed) std::reverse(boxes.begin(), boxes.end());
            for (const auto& [shape, id] : boxes) maker.add(shape, id);
            // The angle is that on the side of the lower index.
            for (const double eta : {1 / 1.5, 1.5 / 1.7, 1 / 1.7}) {
                left *= 1.0 - dielectric_reflectance(c, eta);
            }
            expect_near(center(maker.compile()), {left, left, left}, 1e-12);
        }
    }
}

/// A ceiling is lit from below through both; shadow rays meet all faces of their way at once.
TEST(CoincidentOptics, AFaceThatAShadowRayCrossedIsNotCrossedAgainWithALargeSurfaceBehindIt) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0.1, 0.1, 2.3}, {0, 0, 1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    maker.light(DirectionalLight{.to_light = {0, 0, -1}, .color = {1, 1, 1}});
    maker.add(Rectangle{{-90, -90, 3}, {180, 0, 0}, {0, 180, 0}},
              maker.material(testing::matt({1, 1, 1})));
    maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1e-12}}, maker.material(physical({1.0, 0.7})));
    maker.add(box(-2, 0, 1000), maker.material(physical({1.0, 0.2})));
    const Scene scene = maker.compile();
    const double t = std::exp(-0.4);
    for (const char* renderer : {"path_tracing", "bidirectional", "vcm"}) {
        SCOPED_TRACE(renderer);
        expect_near(testing::picture_of(scene, renderer, 1, 4).at(0, 0), {t, t, t}, 1e-6);
    }
}

/// The volume entered last is the innermost: none of the indices changes where the other is left.
/// From below it is the other one, with the same reflections.
TEST(CoincidentOptics, OverlappingVolumesAreLeftInAnyOrder) {
    const Layer above{1.5, 0, 2}, below{1.7, 0, 2};
    for (const auto material : {&physical, &by_kt}) {
        SceneMaker maker = above_a_light();
        maker.add(box(0, 2), maker.material(material(above)));
        maker.add(box(-1, 1), maker.material(material(below)));
        // Reflections beyond the depth of 16 are left out.
        expect_light_passed(maker, {{1}, above, below, {1}}, 1e-7);
    }
}

TEST(CoincidentOptics, KtAtSurfacesActsAtEachFace) {
    const Layer a{1.5, 0.2, 1}, b{1.7, 0.5, 1};
    SceneMaker maker = above_a_light();
    maker.description().conventions.shading.optics = {true, false};
    maker.description().conventions.shading.max_depth = 3;
    add_stack(maker, {a, b}, {0, 1}, &by_kt);
    const auto passes = [](double m, double n) { return 1.0 - std::pow((m - n) / (m + n), 2.0); };
    const double t =
        passes(1, 1.5) * passes(1.5, 1.7) * passes(1.7, 1) * std::exp(-2 * 0.2 - 2 * 0.5);
    expect_near(center(maker.compile()), {t, t, t}, 1e-12);
}

TEST(CoincidentOptics, PartsThatTheRaysDoNotSeeAreNotCrossed) {
    const Layer seen{1.5, 0.1, 1};
    SceneMaker maker = above_a_light();
    maker.add(box(0, 1), maker.material(physical(seen)));
    maker.add(box(-2, 0), maker.material(physical({1.9, 0.3, 2})));
    maker.description().objects.back().parts.back().visible_to = mask_of(RayKind::Shadow);
    expect_light_passed(maker, {{1}, seen, {1}});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
