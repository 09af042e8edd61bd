#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/renderers/photons/photon_tree.h"
#include "alhazen/sampling/random.h"
#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/photons/photon_shots.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::matt;
using testing::power_of;
using testing::SceneMaker;
using testing::shot_of;
using testing::smooth_glass;

TEST(Photon, DirectionsAreKeptWithinATenThousandthOfARadian) {
    RandomStream random(2);
    for (int i = 0; i < 20000; ++i) {
        Vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (i % 7 == 0) v[i % 3] = i % 2 == 0 ? 0.0 : -0.0;
        if (i % 11 == 0) v = {0, 0, i % 2 == 0 ? 1.0 : -1.0};
        v = normalize(v);
        EXPECT_LT(length(OctahedralVector(v).vector() - v), 1e-4) << i;
    }
}

OctahedralVector even_normal(std::size_t number) {
    return OctahedralVector({0, number % 2 == 0 ? 1.0 : -1.0, 0});
}

std::vector<Photon> random_photons(std::size_t count, bool lattice, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<Photon> photons(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (double& x : photons[i].position) {
            x = lattice ? static_cast<double>(random.below(5)) : random.uniform(-1, 1);
        }
        photons[i].power[0] = static_cast<float>(i);
        photons[i].normal = even_normal(i);
    }
    return photons;
}

TEST(PhotonTree, IsLeftBalancedAndDividesEachSubtree) {
    EXPECT_EQ(left_subtree_size(0), 0u);
    EXPECT_EQ(left_subtree_size(1), 0u);
    EXPECT_EQ(left_subtree_size(2), 1u);
    EXPECT_EQ(left_subtree_size(5), 3u);
    EXPECT_EQ(left_subtree_size(6), 3u);
    EXPECT_EQ(left_subtree_size(11), 7u);
    for (const bool lattice : {false, true}) {
        for (const std::size_t count : {1u, 2u, 3u, 10u, 63u, 64u, 1000u, 40000u}) {
            const PhotonTree tree(random_photons(count, lattice, count));
            const auto photons = tree.photons();
            std::vector<bool> seen(count);
            for (const Photon& p : photons) seen[static_cast<std::size_t>(p.power[0])] = true;
            EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0) << count;
            // Each node against each node above it.
            for (std::size_t i = 1; i < count; ++i) {
                for (std::size_t child = i; child > 0;) {
                    const std::size_t above = (child - 1) / 2;
                    const auto k = static_cast<std::size_t>(tree.axis(above));
                    const std::pair own{photons[i].position[k], photons[i].power[0]};
                    const std::pair middle{photons[above].position[k], photons[above].power[0]};
                    EXPECT_EQ(own < middle, child == 2 * above + 1) << count << ": " << i;
                    child = above;
                }
            }
        }
    }
}

TEST(PhotonTree, FindsTheNearestOfBruteForce) {
    RandomStream random(4);
    for (const bool lattice : {false, true}) {
        for (const std::size_t count : {0u, 1u, 2u, 7u, 50u, 3000u}) {
            const PhotonTree tree(random_photons(count, lattice, 3 * count));
            for (int trial = 0; trial < 60; ++trial) {
                Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
                if (lattice) p = {2, 1, double(random.below(5))};
                const std::size_t most = 1 + random.below(20);
                const double squared = trial % 3 == 0 ? kInfinity : random.uniform(0, 1);
                const auto even = [](const Photon& q) { return q.normal == even_normal(0); };
                std::vector<PhotonTree::Near> found, all;
                tree.nearest(p, most, squared, even, found);
                for (std::uint32_t i = 0; i < count; ++i) {
                    const Photon& q = tree.photons()[i];
                    const double apart = length_squared(q.point() - p);
                    if (even(q) && apart <= squared) all.push_back({apart, i});
                }
                std::sort(all.begin(), all.end());
                all.resize(std::min(all.size(), most));
                EXPECT_EQ(found.empty() ? 0.0 : found.front().squared,
                          all.empty() ? 0.0 : all.back().squared);
                std::sort(found.begin(), found.end());
                EXPECT_EQ(found, all) << count << " " << trial;
                std::vector<PhotonTree::Near> first;
                for (const double guess : {0.0, 1e-6, 0.1, random.uniform(0, 1), 3.0, 1e9}) {
                    tree.nearest(p, most, squared, guess, even, found);
                    if (guess == 0.0) first = found;
                    EXPECT_EQ(found, first) << count << " " << trial << " " << guess;
                    if (all.size() == most) {
                        EXPECT_EQ(found.front(), all.back());
                    }
                    std::sort(found.begin(), found.end());
                    EXPECT_EQ(found, all) << count << " " << trial << " " << guess;
                }
            }
        }
    }
}

TEST(PhotonTree, ASearchVisitsFewOfManyCoincidentPhotons) {
    constexpr std::size_t kCount = 100000, kNearest = 20;
    std::vector<Photon> photons(kCount);
    for (std::size_t i = 0; i < kCount; ++i) photons[i].position[i % 3] = i % 2 == 0 ? 1.0 : 2.0;
    const PhotonTree tree(std::move(photons));
    std::size_t visited = 0;
    const auto every = [&](const Photon&) { return ++visited > 0; };
    std::vector<PhotonTree::Near> found, other;
    for (const Vec3& p : {Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 1}}) {
        tree.nearest(p, kNearest, kInfinity, every, found);
        EXPECT_EQ(found.front().squared, 0.0);
        tree.nearest(p, kNearest, kInfinity, 0.0, every, other);
        std::sort(found.begin(), found.end());
        std::sort(other.begin(), other.end());
        EXPECT_EQ(found, other);
    }
    // Six searches; in each some paths of 17 levels.
    EXPECT_LT(visited, 6 * 17 * 8 * kNearest);
}

struct CountVisits {
    std::size_t visits = 0;
    void visit() { ++visits; }
};

// Photons at a point, along a line and in a square, of sizes down to the rounding, are seen from
// beside them along each axis and slantwise, from surfaces of both sides.
TEST(PhotonTree, ASearchFromBesideAClusterVisitsFewOfItsPhotons) {
    constexpr std::size_t kCount = 60000, kNearest = 20;
    RandomStream random(7);
    for (const double size : {0.0, 1e-15, 1e-9, 1e-3}) {
        for (int dimensions = size > 0.0 ? 1 : 0; dimensions < (size > 0.0 ? 3 : 1); ++dimensions) {
            std::vector<Photon> photons = random_photons(kCount, false, 8);
            for (std::size_t i = 0; i < kCount; ++i) {
                photons[i].normal = even_normal(0);
                if (i % 8 == 0) continue;
                photons[i].position = {0.25, 0.5, 0.75};
                for (int k = 0; k < dimensions; ++k) {
                    photons[i].position[static_cast<std::size_t>(k)] +=
                        size * random.uniform(-1, 1);
                }
            }
            const PhotonTree tree(photons);
            for (const Vec3& apart : {Vec3{0, 0, 0}, Vec3{1e-3, 0, 0}, Vec3{0, 1e-3, 0},
                                      Vec3{0, 0, 1e-3}, Vec3{1e-3, 1e-3, 1e-3}}) {
                const Vec3 p = Vec3{0.25, 0.5, 0.75} + apart;
                std::vector<PhotonTree::Near> found, all;
                CountVisits one, other;
                const auto fits = [](const Photon& q) { return q.normal == even_normal(0); };
                tree.nearest(p, kNearest, kInfinity, fits, found, one);
                for (std::uint32_t i = 0; i < kCount; ++i) {
                    all.push_back({length_squared(tree.photons()[i].point() - p), i});
                }
                std::partial_sort(all.begin(), all.begin() + kNearest, all.end());
                all.resize(kNearest);
                std::sort(found.begin(), found.end());
                EXPECT_EQ(found, all) << size << " " << dimensions;
                tree.nearest(p, kNearest, kInfinity, 0.0, fits, found, other);
                std::sort(found.begin(), found.end());
                EXPECT_EQ(found, all) << size << " " << dimensions;
                // Paths of 16 levels.
                EXPECT_LT(one.visits, 16 * 8 * kNearest) << size << " " << dimensions;
                EXPECT_LT(other.visits, 16 * 8 * kNearest) << size << " " << dimensions;
                const auto misfits = [](const Photon& q) { return q.normal == even_normal(1); };
                tree.nearest(p, kNearest, kInfinity, misfits, found, one);
                tree.nearest(p, kNearest, kInfinity, 0.0, misfits, found, other);
                EXPECT_TRUE(found.empty());
                EXPECT_LT(one.visits + other.visits, 2 * 16 * 8 * kNearest);
            }
        }
    }
}

TEST(PhotonDensity, IrradianceAtPhotonsEndsAfterAStop) {
    PhotonMap map;
    std::vector<Photon> photons = random_photons(1000, false, 1);
    for (Photon& p : photons) {
        p.normal = OctahedralVector({0, 0, 1});
        p.power = {1, 1, 1};
    }
    map.tree = PhotonTree(std::move(photons));
    map.nearest = 10;
    map.radius = 1.0;
    const auto lit = [&] {
        return std::count_if(map.irradiance.begin(), map.irradiance.end(),
                             [](const Spectrum& s) { return !s.is_black(); });
    };
    StopFlag stop;
    compute_irradiance(map, &stop);
    EXPECT_EQ(lit(), 1000);
    stop.request();
    compute_irradiance(map, &stop);
    EXPECT_EQ(lit(), 0);
}

TEST(PhotonDensity, FiltersHaveAMeanOfOneOverTheDisc) {
    for (const DensityFilter filter :
         {DensityFilter::Disc, DensityFilter::Cone, DensityFilter::Gauss}) {
        constexpr int kSteps = 10000;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) sum += filter_weight(filter, (i + 0.5) / kSteps);
        EXPECT_NEAR(sum / kSteps, 1.0, 1e-6);
    }
}

const PhotonKinds kAll{PhotonKind::Direct, PhotonKind::Caustic, PhotonKind::Indirect};

TEST(PhotonWalk, AllPowerThatLeavesALightArrives) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 3), maker.material(matt({0.5, 0.25, 0})));
    maker.light(PointLight{.position = {1, 0, 0}, .color = {3, 2, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    const ShotPhotons direct = shot_of(scene, {20000, {PhotonKind::Direct}, 64, 5});
    EXPECT_EQ(direct.photons.size(), 20000u);
    // Intensities are times pi.
    const double sphere = 4 * kPi * kPi;
    EXPECT_NEAR(power_of(direct.photons).r, 3 * sphere, 1e-4);
    EXPECT_NEAR(power_of(direct.photons).b, 1 * sphere, 1e-4);
    // The series of all reflections; one reflection halves the number, not the power.
    const ShotPhotons all = shot_of(scene, {200000, kAll, 64, 5});
    EXPECT_NEAR(power_of(all.photons).r, 2 * 3 * sphere, 0.01 * 6 * sphere);
    EXPECT_NEAR(power_of(all.photons).g, 4.0 / 3.0 * 2 * sphere, 0.01 * 3 * sphere);
    EXPECT_NEAR(power_of(all.photons).b, sphere, 1e-3);
    EXPECT_NEAR(double(all.photons.size()), 400000, 4000);
    double most = 0.0, least = 1e30;
    for (const Photon& p : all.photons) {
        most = std::max(most, p.light().max());
        least = std::min(least, p.light().max());
    }
    EXPECT_NEAR(most, least, 1e-5 * most);
}

TEST(PhotonWalk, PhotonsBeyondTheRangeOfFloatAreKept) {
    for (const double radius : {1e38, 1e39, 1e60}) {
        SceneMaker maker;
        maker.add(ball({0, 0, 0}, radius), maker.material(matt({0.5, 0.5, 0.5})));
        maker.light(PointLight{
            .position = {0.1 * radius, 0, 0}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
        const Scene scene = maker.compile();
        const ShotPhotons shot = shot_of(scene, {1000, {PhotonKind::Direct}, 64, 5});
        EXPECT_EQ(shot.photons.size(), 1000u) << radius;
        EXPECT_LT(usual_radius(PhotonTree(shot.photons), 10), kInfinity);
    }
}

/// Photons in a closed ball by a light of the default attenuation, all lengths times `unit`.
std::vector<Photon> photons_in_units(double unit, double range, bool spot, PhotonKinds kinds) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 3 * unit), maker.material(matt({0.5, 0.25, 0})));
    PointLight point{.position = {unit, 0, 0}, .color = {3, 2, 1}};
    point.range = range * unit;
    SpotLight cone;
    cone.position = point.position;
    cone.direction = {-1, 0, 0};
    cone.color = point.color;
    cone.range = point.range;
    if (spot) {
        maker.light(cone);
    } else {
        maker.light(point);
    }
    return shot_of(maker.compile(), {4000, kinds, 64, 5}).photons;
}

TEST(PhotonWalk, LightThatDoesNotFallOffIsTheSameInEveryUnitOfLength) {
    for (const double range : {kInfinity, 4.5}) {
        for (const bool spot : {false, true}) {
            const std::vector<Photon> one = photons_in_units(1, range, spot, kAll);
            const double power = power_of(one).r;
            // At each surface half of the red light is reflected.
            const double direct =
                power_of(photons_in_units(1, range, spot, {PhotonKind::Direct})).r;
            EXPECT_NEAR(power, 2.0 * direct, 0.03 * power) << range << " " << spot;
            for (const double unit : {0x1p-20, 0x1p-10, 0x1p10, 0x1p20}) {
                const std::vector<Photon> other = photons_in_units(unit, range, spot, kAll);
                EXPECT_EQ(other.size(), one.size()) << unit << " " << range << " " << spot;
                EXPECT_NEAR(power_of(other).r / (unit * unit), power, 1e-6 * power)
                    << unit << " " << range << " " << spot;
            }
        }
    }
}

TEST(PhotonWalk, ALampOfEachKindSendsItsPower) {
    struct Case {
        const char* name;
        void (*add)(SceneMaker&);
        double power;
    };
    const auto glowing = [](SceneMaker& m) {
        Material lamp;
        lamp.emission.color = {2, 2, 2};
        return m.material(lamp);
    };
    static const auto glow = glowing;
    const Case cases[] = {
        {"sphere",
         [](SceneMaker& m) {
             m.add(ball({0.3, 0, 0}, 0.5), glow(m));
         },
         2 * kPi * 4 * kPi * 0.25},
        {"spot",
         [](SceneMaker& m) {
             SpotLight spot;
             spot.position = {0.5, 0, 0};
             spot.direction = {0, 0, -1};
             spot.inner_angle = spot.outer_angle = 0.5;
             spot.color = {2, 2, 2};
             spot.attenuation = {0, 0, 1};
             m.light(spot);
         },
         2 * kPi * 2 * kPi * (1 - std::cos(0.5))},
        {"point with other falloff",
         [](SceneMaker& m) {
             m.light(
                 PointLight{.position = {0, 0, 0}, .color = {2, 2, 2}, .attenuation = {1, 0, 1}});
         },
         // The irradiance at distance 4 is that of 1 / (1 + r^2).
         2 * kPi * 4 * kPi * 16.0 / 17.0},
    };
    for (const Case& c : cases) {
        SceneMaker maker;
        maker.add(ball({0, 0, 0}, 4), maker.material(matt({0, 0, 0.0001})));
        c.add(maker);
        const ShotPhotons shot = shot_of(maker.compile(), {40000, {PhotonKind::Direct}, 64, 5});
        EXPECT_NEAR(power_of(shot.photons).g, c.power, 0.002 * c.power) << c.name;
    }
}

TEST(PhotonWalk, TheSameForAnyThreads) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 3), maker.material(matt({0.5, 0.5, 0.5})));
    maker.add(ball({0, 0, -1}, 1), maker.material(smooth_glass(1.5)));
    maker.light(PointLight{.position = {1, 0, 1}, .color = {3, 2, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    const auto bits = [](const Photon& p) {
        return std::tuple(p.position, p.power, p.from.vector().x, p.normal.vector().x);
    };
    const ShotPhotons one = shot_of(scene, {30000, kAll, 64, 5});
    for (const int threads : {2, 3}) {
        const ShotPhotons more = shot_of(scene, {30000, kAll, 64, 5}, threads);
        ASSERT_EQ(one.photons.size(), more.photons.size());
        for (std::size_t i = 0; i < one.photons.size(); ++i) {
            ASSERT_EQ(bits(one.photons[i]), bits(more.photons[i]));
        }
    }
}

TEST(PhotonScattering, OfMattPointsIsTheSumOfWhatEachPhotonScatters) {
    // Matt, matt below a mirror, and a coated surface, which has no short cut.
    Material shiny = matt({0.2, 0.5, 0.8}), coated;
    shiny.reflective.color = {0.3, 0.2, 0.1};
    coated.metallic_roughness.emplace().coat.strength.value = 1.0;
    RandomStream random(7);
    int lit = 0;
    for (const Material& material : {matt({0.9, 0.4, 0.1}), shiny, coated}) {
        SceneMaker maker;
        maker.add(Sphere{{0, 0, 0}, 1}, maker.material(material));
        const Scene scene = maker.compile();
        for (int i = 0; i < 2000; ++i) {
            const Vec3 aim{random.uniform(-1, 1), random.uniform(-1, 1), 0};
            const Ray ray{{0, 0, 4}, normalize(aim - Vec3{0, 0, 4})};
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
            ShadingPoint point;
            set_shading_point(scene, ray, hit, {}, {}, point);
            // The normal of the shading may be another.
            point.normal = normalize(point.normal + Vec3{0.2 * random.uniform(-1, 1), 0, 0});
            ScatterPoint at;
            at.set(scene, point, {}, kColorChannels, false);
            Photon photon;
            photon.from = OctahedralVector(normalize(
                Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}));
            photon.power = {1.0f, 2.0f, 0.5f};
            for (const LightPart part : {LightPart::All, LightPart::NotGlossy}) {
                const Spectrum one = scattered_light(at, photon, part, false),
                               sum = PhotonScattering(at, part, false)(photon);
                lit += !one.is_black();
                for (int k = 0; k < 3; ++k) ASSERT_NEAR(sum[k], one[k], 1e-13 * one[k]) << i;
            }
        }
    }
    EXPECT_GT(lit, 1000);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
