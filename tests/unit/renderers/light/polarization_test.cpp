#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/renderers/light_transport/polarized_path.h"
#include "alhazen/shading/optics/metals.h"
#include "support/light_pictures.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
constexpr double kDegree = std::numbers::pi / 180.0;

/// A field that swings in space, followed along the light.
struct Field {
    std::complex<double> x, y, z;

    [[nodiscard]] std::complex<double> along(const Vec3& v) const {
        return v.x * x + v.y * y + v.z * z;
    }
    [[nodiscard]] static Field of(std::complex<double> a, const Vec3& u, std::complex<double> b,
                                  const Vec3& v) {
        return {a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
    }
};

/// Points of a path from the eye, and the amplitudes at each but the first and the last.
struct Chain {
    std::vector<Vec3> points;
    std::vector<FresnelAmplitudes> amplitudes;
};

Vec3 along(const Chain& chain, std::size_t k) {
    return normalize(chain.points[k + 1] - chain.points[k]);
}

/// I, Q, U, V in the frame of `axis` at the eye of unpolarised light at the end: the sum of two
/// orthogonal linear polarisations, half each.
std::array<double, 4> by_fields(const Chain& chain, const Vec3& axis) {
    const std::size_t n = chain.amplitudes.size();
    std::array<double, 4> stokes{};
    const Vec3 last = -along(chain, n);
    const Vec3 u = perpendicular(last);
    for (const Vec3& swings : {u, cross(last, u)}) {
        Field field = Field::of(1, swings, 0, u);
        for (std::size_t k = n; k-- > 0;) {
            const Vec3 in = -along(chain, k + 1), out = -along(chain, k);
            const Vec3 across = normalize(cross(in, out));
            const FresnelAmplitudes& r = chain.amplitudes[k];
            field = Field::of(r.across * field.along(across), across,
                              r.along * field.along(cross(in, across)), cross(out, across));
        }
        const std::complex<double> x = field.along(axis),
                                   y = field.along(cross(-along(chain, 0), axis));
        stokes[0] += 0.5 * (std::norm(x) + std::norm(y));
        stokes[1] += 0.5 * (std::norm(x) - std::norm(y));
        stokes[2] += (x * std::conj(y)).real();
        stokes[3] += -(x * std::conj(y)).imag();
    }
    return stokes;
}

std::array<double, 4> by_matrices(const Chain& chain, const Vec3& axis) {
    PolarizedPath path;
    path.begin(axis);
    double unpolarised = 1.0;
    StokesLight before_last;
    for (std::size_t k = 0; k < chain.amplitudes.size(); ++k) {
        const FresnelAmplitudes& r = chain.amplitudes[k];
        unpolarised *= 0.5 * (std::norm(r.across) + std::norm(r.along));
        const Vec3 view = -along(chain, k), direction = along(chain, k + 1);
        before_last = path.arrived(view, direction, PlaneMueller::all(mueller_of(r)));
        path.scatter(view, direction, PlaneMueller::all(mueller_of(r)));
    }
    const StokesLight s = unpolarised * path.arrived();
    EXPECT_NEAR(unpolarised * before_last.i.a, s.i.a, 1e-15);
    EXPECT_NEAR(unpolarised * before_last.v.b, s.v.b, 1e-15);
    return {s.i.a, s.q.b, s.u.c, s.v.d};
}

Vec3 across_first(const Chain& chain) {
    return picture_axis(along(chain, 0), Vec3{0.1, 0.9, 0.2});
}

TEST(PolarizedPath, IsTheFieldFollowedAlongTheLight) {
    testing::Random random(5);
    for (int trial = 0; trial < 200; ++trial) {
        Chain chain;
        const int n = 1 + trial % 6;
        for (int k = 0; k < n + 2; ++k) chain.points.push_back(random.in_cube(1));
        for (int k = 0; k < n; ++k) {
            const auto number = [&] {
                return std::complex<double>(random.uniform(-1, 1), random.uniform(-1, 1));
            };
            chain.amplitudes.push_back({number(), number()});
        }
        const Vec3 axis = across_first(chain);
        const auto expected = by_fields(chain, axis), found = by_matrices(chain, axis);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(found[i], expected[i], 1e-12) << trial << " " << i;
        }
    }
}

TEST(PolarizedPath, FresnelsRhombMakesLinearLightCircular) {
    // Light is polarised at 45 degrees to the plane of a rhomb of index 1.51 and reflected there
    // twice at 54.6 degrees. From the eye: two total reflections, then a mirror at Brewster's
    // angle.
    const double angle = 54.6 * kDegree, n = 1.51;
    const FresnelAmplitudes total = dielectric_reflection(std::cos(angle), n);
    const double brewster = std::atan(n);
    const FresnelAmplitudes mirror = dielectric_reflection(std::cos(brewster), 1.0 / n);
    Chain chain;
    chain.points = {{0, 0, 0}, {0, 0, -1}};
    const Vec3 sideways{std::sin(2 * angle), 0, std::cos(2 * angle)};
    chain.points.push_back(chain.points.back() + sideways);
    chain.points.push_back(chain.points.back() + Vec3{0, 0, -1});
    const double turn = std::sin(2 * brewster) / std::sqrt(2.0);
    chain.points.push_back(chain.points.back() + Vec3{turn, turn, std::cos(2 * brewster)});
    chain.amplitudes = {total, total, mirror};
    const auto s = by_matrices(chain, {1, 0, 0});
    EXPECT_NEAR(std::abs(s[3]) / s[0], 1.0, 1e-5);
    EXPECT_LT(std::hypot(s[1], s[2]) / s[0], 1e-2);
}

/// Two panes of glass, with front faces alone, between the eye and a light; `turn`: angle of the
/// second plane of reflection around the ray between them.
Scene two_mirrors(double incidence, double turn, const Material& material) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 10}, {0, 0, -1}, {0.01, 0, 0}, {0, 0.01, 0}};
    const double s = std::sin(incidence), c = std::cos(incidence);
    const auto plate = [&](const Vec3& middle, const Vec3& normal, MaterialId m) {
        const Vec3 u = perpendicular(normal), v = cross(normal, u);
        maker.add(rectangle(middle - u - v, 2.0 * u, 2.0 * v), m);
    };
    const MaterialId m = maker.material(material);
    const Vec3 first{s, 0, c};
    plate({}, first, m);
    const Vec3 between{2 * s * c, 0, 2 * c * c - 1}, in_plane{2 * c * c - 1, 0, -2 * s * c};
    const Vec3 second =
        -c * between + s * (std::cos(turn) * in_plane + std::sin(turn) * Vec3{0, 1, 0});
    plate(8.0 * between, second, m);
    const Vec3 to_lamp = between + 2 * c * second;
    plate(8.0 * between + 8.0 * to_lamp, -to_lamp, maker.material(shining({1, 2, 3})));
    return maker.compile();
}

Material glass(double index) {
    Material m;
    m.dielectric.emplace();
    m.index.value = index;
    return m;
}

TEST(Polarization, TwoBrewsterMirrorsObeyMalus) {
    const double brewster = std::atan(1.5);
    for (const double degrees : {0.0, 30.0, 60.0, 90.0}) {
        const Scene scene = two_mirrors(brewster, degrees * kDegree, glass(1.5));
        const Rgb off = mean_of(picture_of(scene, "path_tracing:depth=2", 4, 256));
        const Rgb on = mean_of(picture_of(scene, "path_tracing:depth=2,polarization=on", 4, 256));
        EXPECT_GT(off.g, 0.0);
        EXPECT_NEAR(on.g / off.g, 2.0 * std::pow(std::cos(degrees * kDegree), 2), 1e-6);
    }
}

TEST(Polarization, TwoReflectionsInOnePlaneAreTheProductOfEachComponent) {
    for (const double degrees : {30.0, 50.0, 75.0}) {
        const double incidence = degrees * kDegree;
        const FresnelAmplitudes r = dielectric_reflection(std::cos(incidence), 1.0 / 1.5);
        const double across = std::norm(r.across), along = std::norm(r.along);
        for (const bool crossed : {false, true}) {
            const Scene scene = two_mirrors(incidence, crossed ? kDegree * 90 : 0, glass(1.5));
            const Rgb off = mean_of(picture_of(scene, "path_tracing:depth=2", 4, 256));
            const Rgb on =
                mean_of(picture_of(scene, "path_tracing:depth=2,polarization=on", 4, 256));
            const double unpolarised = 0.25 * (across + along) * (across + along);
            const double exact = crossed ? across * along : 0.5 * (across * across + along * along);
            EXPECT_NEAR(on.r / off.r, exact / unpolarised, 1e-6) << degrees << crossed;
        }
    }
}

struct Layers {
    Film film;
    FilmLayers layers;
    [[nodiscard]] double at(const char* channel, int x, int y) const {
        return double{
            layers.find(channel)
                ->values[std::size_t(y) * std::size_t(film.frame_width()) + std::size_t(x)]};
    }
};

Layers layers_of(const Scene& scene, const std::string& renderer, int side, int samples,
                 int threads = 1, bool spectral = false) {
    const SamplingPlan plan;
    AovFilm aovs(parse_aovs("polarization,stokes"), {0, 0, side, side});
    Layers result{Film(side, side, {0, 0, side, side}), {}};
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .samples_per_pixel = samples,
                        .aovs = &aovs,
                        .sampling = &plan,
                        .spectral = spectral,
                        .control = {.threads = threads, .tile_size = threads > 1 ? 3 : 32}};
    EXPECT_TRUE(make_renderer(renderer)->render(job, result.film).complete());
    result.layers = aovs.layers();
    return result;
}

/// A pane that reflects a light to the eye.
Scene one_mirror(double incidence, const Material& material) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 10}, {0, 0, -1}, {0.01, 0, 0}, {0, 0.01, 0}};
    const double s = std::sin(incidence), c = std::cos(incidence);
    const Vec3 tangent{c, 0, -s}, across{0, 1, 0}, to_lamp{2 * s * c, 0, 2 * c * c - 1};
    maker.add(rectangle(-1.0 * tangent - across, 2.0 * tangent, 2.0 * across),
              maker.material(material));
    const Vec3 side{to_lamp.z, 0, -to_lamp.x};
    maker.add(rectangle(8.0 * to_lamp - side - across, 2.0 * side, 2.0 * across),
              maker.material(shining({1, 1, 1})));
    return maker.compile();
}

TEST(Polarization, LayersShowTheDegreeAndTheAngleOfAReflection) {
    for (const double degrees : {20.0, 45.0, std::atan(1.5) / kDegree, 75.0}) {
        const double incidence = degrees * kDegree;
        const Layers seen =
            layers_of(one_mirror(incidence, glass(1.5)), "path_tracing:polarization=on", 2, 256);
        const FresnelAmplitudes r = dielectric_reflection(std::cos(incidence), 1.0 / 1.5);
        const double across = std::norm(r.across), along = std::norm(r.along);
        for (int i = 0; i < 4; ++i) {
            const int x = i % 2, y = i / 2;
            EXPECT_NEAR(seen.at("polarization.degree", x, y), (across - along) / (across + along),
                        1e-6);
            // Across the plane of incidence, which is level: it swings upright.
            EXPECT_NEAR(std::abs(seen.at("polarization.angle", x, y)), 90 * kDegree, 1e-6);
            EXPECT_LT(seen.at("stokes.Q", x, y), 0.0);
            EXPECT_NEAR(seen.at("stokes.V", x, y), 0.0, 1e-9);
        }
    }
}

TEST(Polarization, AReflectiveCoefficientIsThatOfAClearBodyAtNormalIncidence) {
    Material coefficient = matt({0, 0, 0});
    coefficient.reflective.color = {0.04, 0.04, 0.04};  // index 1.5
    for (const double degrees : {20.0, std::atan(1.5) / kDegree, 75.0}) {
        const double incidence = degrees * kDegree;
        const Layers seen =
            layers_of(one_mirror(incidence, coefficient), "path_tracing:polarization=on", 2, 256);
        const FresnelAmplitudes r = dielectric_reflection(std::cos(incidence), 1.0 / 1.5);
        const double across = std::norm(r.across), along = std::norm(r.along);
        EXPECT_NEAR(seen.at("polarization.degree", 1, 0), (across - along) / (across + along),
                    1e-6);
        // The reflectance is that of the scene at every angle.
        EXPECT_NEAR(seen.film.at(1, 0).g, 0.04, 1e-12);
    }
    const double brewster = std::atan(1.5);
    const Scene crossed = two_mirrors(brewster, 90 * kDegree, coefficient);
    EXPECT_GT(mean_of(picture_of(crossed, "path_tracing:depth=2", 4, 256)).g, 0.0);
    const Rgb on = mean_of(picture_of(crossed, "path_tracing:depth=2,polarization=on", 4, 256));
    EXPECT_NEAR(on.g, 0.0, 1e-9);
}

TEST(Polarization, LightThatIsScatteredOnceIsThatWithoutPolarisation) {
    SceneMaker maker;
    Material glossy = matt({0.4, 0.3, 0.2});
    glossy.metallic_roughness.emplace();
    glossy.metallic_roughness->roughness.value = 0.4;
    maker.add(ball({-1, 0, 0}, 1), maker.material(glossy));
    maker.add(ball({1, 0, 0}, 1), maker.material(glass(1.5)));
    maker.add(ball({0, 3, 2}, 1), maker.material(shining({5, 4, 3})));
    maker.add(rectangle({-3, -1, -3}, {6, 0, 0}, {0, 0, 6}), maker.material(matt({1, 1, 1})));
    const Scene scene = maker.compile();
    const Film off = picture_of(scene, "path_tracing:depth=1", 16, 16);
    const Film on = picture_of(scene, "path_tracing:depth=1,polarization=on", 16, 16);
    for (int i = 0; i < 256; ++i) EXPECT_EQ(on.at(i % 16, i / 16), off.at(i % 16, i / 16)) << i;
}

Scene room_of_all_kinds() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -3.8, 1}, {0, 1, 0}, {0, 0, 1}, 0.65, 1.0);
    Material varnish;
    varnish.metallic_roughness.emplace();
    varnish.metallic_roughness->base_color.color = {0.5, 0.4, 0.3};
    varnish.metallic_roughness->metallic.value = 0;
    varnish.metallic_roughness->roughness.value = 0.2;
    Material gold;
    gold.conductor = Conductor{find_metal("gold")->index, find_metal("gold")->extinction, "gold"};
    Material rough_gold = gold;
    rough_gold.roughness.value = 0.4;
    Material frosted = glass(1.5);
    frosted.roughness.value = 0.3;
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), maker.material(varnish));
    maker.add(rectangle({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), maker.material(rough_gold));
    maker.add(rectangle({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}),
              maker.material(shining({1, 2, 3}, {0.5, 0.5, 0.5})));
    maker.add(ball({-0.5, 0.2, 0.4}, 0.4), maker.material(glass(1.6)));
    maker.add(ball({0.5, 0.2, 0.4}, 0.4), maker.material(gold));
    maker.add(ball({0, -0.3, 0.3}, 0.25), maker.material(frosted));
    return maker.compile();
}

TEST(Polarization, DegreesAreSharesAndPicturesDependNeitherOnThreadsNorOnWavelengths) {
    const Scene scene = room_of_all_kinds();
    const Layers one = layers_of(scene, "path_tracing:polarization=on", 12, 16);
    const Layers three = layers_of(scene, "path_tracing:polarization=on", 12, 16, 3);
    const Layers waves = layers_of(scene, "path_tracing:polarization=on", 12, 16, 1, true);
    double most = 0;
    for (int i = 0; i < 144; ++i) {
        const int x = i % 12, y = i / 12;
        EXPECT_EQ(one.film.at(x, y), three.film.at(x, y));
        for (const char* channel : {"polarization.degree", "polarization.angle", "stokes.V"}) {
            EXPECT_EQ(one.at(channel, x, y), three.at(channel, x, y));
        }
        for (const Layers* seen : {&one, &waves}) {
            EXPECT_GE(seen->at("polarization.degree", x, y), 0.0);
            EXPECT_LE(seen->at("polarization.degree", x, y), 1.0);
            EXPECT_LE(std::abs(seen->at("polarization.angle", x, y)), 90.001 * kDegree);
            most = std::max(most, seen->at("polarization.degree", x, y));
        }
        for (int k = 0; k < 3; ++k) EXPECT_GE(one.film.at(x, y)[k], 0.0);
    }
    EXPECT_GT(most, 0.1);
}

TEST(Polarization, ExcludesChainsOfMirrors) {
    EXPECT_THROW((void)make_renderer("path_tracing:polarization=on,manifold=on"), Error);
    EXPECT_THROW((void)make_renderer("path_tracing:polarization=maybe"), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
