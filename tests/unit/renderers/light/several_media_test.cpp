/// Solids of several media: side by side, nested, overlapping.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "support/light_pictures.h"
#include "unit/renderers/light/glass_volumes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::absorbing_glass;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::mean_of;
using testing::picture_of;
using testing::SceneMaker;
using testing::through_slab;
using testing::wall_of_light;

/// A solid of two media side by side, at x below 0 and above.
struct TwoMedia {
    double lo, hi;  ///< ends along z
    std::array<double, 2> absorption;
};

/// Transmittance of a ray along -z. In an overlap the medium is that of the solid entered last, of
/// those entered together that of the one left first.
double through(const std::vector<TwoMedia>& solids, std::size_t side) {
    std::vector<double> ends;
    for (const TwoMedia& s : solids) ends.insert(ends.end(), {s.lo, s.hi});
    std::sort(ends.begin(), ends.end());
    double lost = 0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double z = (ends[i - 1] + ends[i]) / 2;
        const TwoMedia* innermost = nullptr;
        for (const TwoMedia& s : solids) {
            if (z < s.lo || z > s.hi) continue;
            if (innermost == nullptr ||
                std::pair(s.hi, -s.lo) < std::pair(innermost->hi, -innermost->lo)) {
                innermost = &s;
            }
        }
        if (innermost != nullptr) lost += innermost->absorption[side] * (ends[i] - ends[i - 1]);
    }
    return std::exp(-lost);
}

/// Solids of several media one before the other in any order: touching, nested, overlapping, with
/// ends that coincide; of the same materials or of others.
TEST(LightVolumes, SolidsOfSeveralMediaAreLeftEachByItself) {
    const std::array<double, 2> x{1, 0.5}, y{0.1, 0.7}, z{0.4, 0.2};
    const std::vector<TwoMedia> cases[] = {
        {{-1, 0, x}, {0, 1, x}},
        {{-1, 0, x}, {0, 1, y}},
        {{-1, 0.5, x}, {0, 1, x}},
        {{-1, 0.3, y}, {0, 1, x}},
        {{-1, 1, x}, {-0.5, 0.5, x}},
        {{-1, 1, x}, {-0.5, 0.5, y}},
        {{-1, 1, x}, {0, 1, y}},
        {{-1, 1, x}, {-1, 0.5, y}},
        {{-1, 0.3, x}, {0, 1, x}, {-0.5, 0.6, x}},
        {{-1, 0.3, x}, {0, 1, y}, {-0.5, 0.6, z}},
        {{-2, -1, x}, {-1, 0, y}, {0, 1, z}},
    };
    for (const std::vector<TwoMedia>& solids : cases) {
        std::vector<std::size_t> order(solids.size());
        std::iota(order.begin(), order.end(), 0);
        do {
            SceneMaker maker = wall_of_light();
            maker.description().conventions.shading.max_depth = 20;
            maker.description().conventions.shading.optics = {true, true};
            std::map<double, MaterialId> materials;
            for (const std::size_t i : order) {
                const ObjectIndex solid = maker.object("solid");
                maker.description().objects.back().combine = Combine::Union;
                for (const std::size_t side : {0, 1}) {
                    const double a = solids[i].absorption[side];
                    if (materials.count(a) == 0) {
                        materials[a] = maker.material(absorbing_glass({a, a, a}, 1.0));
                    }
                    maker.add(BoxShape{{side == 0 ? -4.0 : 0.0, -4, solids[i].lo},
                                       {side == 0 ? 0.0 : 4.0, 4, solids[i].hi}},
                              materials[a], {}, solid);
                }
                maker.add(solid);
            }
            const Scene scene = maker.compile();
            const std::string name =
                ::testing::PrintToString(order) + " of case " + std::to_string(&solids - &cases[0]);
            for (const char* renderer :
                 {"path_tracing", "bidirectional", "sppm:photons=10,radius=0.1",
                  "photon_mapping:photons=10,caustics=0", "vcm:photons=10,radius=0.1,pilot=off",
                  "whitted", "distributed"}) {
                const Film film = picture_of(scene, renderer, 4, 4);
                for (const int column : {0, 3}) {
                    EXPECT_NEAR(film.at(column, 0).g, through(solids, column == 0 ? 0 : 1), 1e-9)
                        << renderer << " " << column << ", order " << name;
                }
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

/// A floor below a point light and solids of several media: two that touch, two of the same media
/// that overlap, one in another.
TEST(LightVolumes, PathsFromBothEndsCrossSolidsOfSeveralMediaAlike) {
    SceneMaker maker = floor_from_above(4.0, {0.5, 0.5, 0.5});
    const auto medium = [&](double a) { return maker.material(absorbing_glass({a, a, a}, 1.0)); };
    const MaterialId a = medium(1), b = medium(0.3), c = medium(0.1), d = medium(0.6);
    const auto add = [&](double lo, double hi, MaterialId left, MaterialId right) {
        const ObjectIndex solid = maker.object("solid");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{{-9, -9, lo}, {0, 9, hi}}, left, {}, solid);
        maker.add(BoxShape{{0, -9, lo}, {9, 9, hi}}, right, {}, solid);
        maker.add(solid);
    };
    add(1.0, 1.4, a, b);
    add(1.2, 1.6, a, b);
    add(1.6, 1.9, c, d);
    add(1.9, 2.6, b, a);
    add(2.1, 2.4, d, c);
    maker.light(PointLight{.position = {0, 0, 3}, .color = {1, 1, 1}});
    const Scene scene = maker.compile();
    expect_same_light(scene, "solids", {"path_tracing", "light_tracing", "bidirectional"}, 32);
    expect_same_light(scene, "solids, merged", {"path_tracing", "vcm:photons=5000"}, 8);
}

/// Two touching solids of several glasses of one index are a block, whichever is named first.
TEST(LightVolumes, TouchingSolidsOfSeveralGlassesAreABlock) {
    for (const bool lower_first : {false, true}) {
        SceneMaker maker = wall_of_light();
        maker.description().conventions.shading.max_depth = 20;
        maker.description().conventions.shading.optics = {true, true};
        for (const bool lower : {lower_first, !lower_first}) {
            const ObjectIndex solid = maker.object("solid");
            maker.description().objects.back().combine = Combine::Union;
            const double a = lower ? 1.5 : 0.5, z = lower ? -1 : 0;
            for (const double x : {-4.0, 0.0}) {
                maker.add(BoxShape{{x, -4, z}, {x + 4, 4, z + 1}},
                          maker.material(absorbing_glass({a, a, a})), {}, solid);
            }
            maker.add(solid);
        }
        const Scene scene = maker.compile();
        for (const char* renderer : {"path_tracing", "bidirectional", "whitted"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 1024)).g,
                        through_slab(std::exp(-2.0)), 0.002)
                << renderer << lower_first;
        }
    }
}

/// Two instances of one object that overlap, in an object that is instanced itself, above a floor:
/// shadow rays meet the upper instance last.
TEST(LightVolumes, InstancesOfASolidOfSeveralMediaAreLeftEachByItself) {
    for (const double shift : {0.5, 1.0, 1.5}) {
        const auto lit_floor = [&](bool covered, bool grouped) {
            SceneMaker maker = floor_from_above(0.2, {1, 1, 1});
            const ObjectIndex solid = maker.object("solid");
            maker.description().objects.back().combine = Combine::Union;
            const MaterialId a = maker.material(absorbing_glass({1, 1, 1}, 1.0));
            const MaterialId b = maker.material(absorbing_glass({0.5, 0.5, 0.5}, 1.0));
            maker.add(BoxShape{{-9, -9, 1}, {9, 9, 2}}, a, {}, solid);
            maker.add(BoxShape{{-9, -9, 2}, {9, 9, 3}}, b, {}, solid);
            const ObjectIndex both = grouped ? maker.object("both") : ObjectIndex{0};
            if (covered) {
                maker.add(solid, MaterialId{0}, {}, both);
                maker.add(solid, MaterialId{0}, Affine::translate({0, 0, shift}), both);
                if (grouped) maker.add(both, MaterialId{0}, Affine::translate({0, 0, 0.25}));
            }
            maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            maker.description().conventions.shading.optics = {true, true};
            return maker.compile();
        };
        // The lower one alone from 1 to 1 + shift, then the upper one.
        const double below = std::min(shift, 1.0) + 0.5 * std::max(shift - 1.0, 0.0);
        const double expected = std::exp(-below - 1.0 - 0.5);
        const Scene clear = lit_floor(false, false);
        for (const bool grouped : {false, true}) {
            const Scene scene = lit_floor(true, grouped);
            for (const char* renderer :
                 {"path_tracing", "sppm:photons=10,radius=0.1",
                  "photon_mapping:photons=10,caustics=0", "whitted", "distributed"}) {
                const double open = mean_of(picture_of(clear, renderer, 2, 4)).g;
                EXPECT_NEAR(mean_of(picture_of(scene, renderer, 2, 4)).g / open, expected, 1e-4)
                    << renderer << " " << shift << grouped;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
