#include "alhazen/renderers/beam_tracing/beam_tracing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/imaging/film/filter_integral.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/image_texture.h"
#include "support/odd_even_area.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

constexpr int kWidth = 96, kHeight = 72;

struct Picture {
    Film film{kWidth, kHeight, {0, 0, kWidth, kHeight}};
    RenderReport report;
};

Picture beams_of(SceneMaker& maker, const BeamTreeOptions& options = {}, bool exact = false,
                 const RenderControl& control = {}, const char* filter = nullptr) {
    const Scene scene = maker.compile();
    AntialiasSettings settings;
    settings.exact = true;
    if (filter != nullptr) {
        settings.filter = find_filter(filter);
        settings.radius = settings.filter->radius;
    }
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .description = &maker.description(),
                        .antialias = exact ? &settings : nullptr,
                        .control = control};
    Picture picture;
    picture.report = BeamTracing(options).render(job, picture.film);
    EXPECT_TRUE(picture.report.complete());
    return picture;
}

Picture rays_of(SceneMaker& maker) {
    const Scene scene = maker.compile();
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    Picture picture;
    picture.report = Whitted().render(job, picture.film);
    return picture;
}

/// Pixels that differ by more than `bound`.
int differing(const Film& a, const Film& b, double bound) {
    int count = 0;
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
            const Rgb d = a.at(i, j) - b.at(i, j);
            count += std::fmax(std::abs(d.r), std::fmax(std::abs(d.g), std::abs(d.b))) > bound;
        }
    }
    return count;
}

Material painted(const Rgb& color, double reflective = 0) {
    Material material;
    material.diffuse.color = color;
    material.ambient.color = color;
    material.reflective.color = {reflective, reflective, reflective};
    return material;
}

void look(SceneMaker& maker, const Vec3& eye, const Vec3& at) {
    maker.description().cameras[0].camera =
        look_along(eye, at - eye, {0, 0, 1}, 0.9, double(kWidth) / kHeight);
}

/// Blocks and a mesh between two mirrors, under a point light and the sun, partly behind a pane.
void furnish(SceneMaker& maker, double transmissive) {
    look(maker, {-1.13, -3.07, 1.61}, {0.31, 0.9, 0.83});
    const auto floor = maker.material(painted({0.6, 0.5, 0.4}, 0.1));
    const auto mirror = maker.material(painted({0.05, 0.05, 0.05}, 0.8));
    const auto red = maker.material(painted({0.8, 0.2, 0.1}));
    const auto blue = maker.material(painted({0.1, 0.3, 0.8}));
    maker.add(Rectangle{.corner = {-2, -4, 0}, .edge_u = {4, 0, 0}, .edge_v = {0, 8, 0}}, floor);
    maker.add(Rectangle{.corner = {-1.9, -2, 0.2}, .edge_u = {0, 4, 0}, .edge_v = {0, 0, 2}},
              mirror);
    maker.add(Rectangle{.corner = {1.9, 2, 0.2}, .edge_u = {0, -4, 0}, .edge_v = {0, 0, 2}},
              mirror);
    Polygon wall;
    wall.vertices = {{-2, 2.5, 0},    {2, 2.5, 0},      {2, 2.5, 3},     {-2, 2.5, 3},
                     {-1.2, 2.5, .8}, {-1.2, 2.5, 2.1}, {0.3, 2.5, 2.1}, {0.3, 2.5, .8}};
    wall.loop_ends = {4, 8};
    maker.add(wall, red);
    const auto block = maker.object("block");
    maker.add(BoxShape{{-0.3, -0.3, 0}, {0.3, 0.3, 0.6}}, blue, {}, block);
    maker.add(block, blue, Affine::rotate({0, 0, 1}, 0.4));
    maker.add(block, blue, Affine::translate({0.8, 0.9, 0.013}) * Affine::scale({0.7, -1, 1.5}));
    TriangleMesh tent;
    tent.positions = {{-1, 0.5, 0}, {-0.2, 0.6, 0}, {-0.5, 1.3, 0}, {-0.6, 0.8, 1.1}};
    tent.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    maker.add(maker.mesh(tent), red);
    if (transmissive > 0.0) {
        Material pane = painted({0.1, 0.1, 0.1}, 0.1);
        pane.transmissive.color = {transmissive, 0.9 * transmissive, transmissive};
        pane.index.value = 1.0;
        maker.add(
            Rectangle{.corner = {-0.4, -0.9, 0.1}, .edge_u = {1, 0, 0}, .edge_v = {0, 0.1, 1}},
            maker.material(pane));
    }
    maker.light(AmbientLight{{0.2, 0.2, 0.2}});
    maker.light(PointLight{.position = {0.21, -0.43, 2.9}, .color = {0.7, 0.7, 0.6}});
    maker.light(DirectionalLight{normalize(Vec3{-0.5, 0.83, 0.61}), {0.5, 0.5, 0.5}});
}

TEST(BeamTracing, ShadowsAndMirrorsEqualThoseOfRays) {
    SceneMaker maker;
    furnish(maker, 0.0);
    const Picture beams = beams_of(maker);
    EXPECT_EQ(differing(beams.film, rays_of(maker).film, 1e-9), 0);
    EXPECT_GT(beams.report.beams->reflected_beams, 10u);
    EXPECT_EQ(beams.report.beams->seen_area, 1.0);
}

TEST(BeamTracing, APaneThatDoesNotBendLightTintsWhatIsBehindAndItsShadow) {
    SceneMaker maker;
    furnish(maker, 0.7);
    const Picture beams = beams_of(maker);
    EXPECT_GT(beams.report.beams->refracted_beams, 0u);
    EXPECT_EQ(differing(beams.film, rays_of(maker).film, 1e-9), 0);
}

TEST(BeamTracing, ParallelBeamsEqualParallelRays) {
    SceneMaker maker;
    furnish(maker, 0.5);
    maker.description().cameras[0].camera =
        look_along_parallel({-2.03, -3.9, 3.1}, {1.9, 4.1, -2.3}, {0, 0, 1}, 4.0, 4.0 / 3.0);
    EXPECT_EQ(differing(beams_of(maker).film, rays_of(maker).film, 1e-9), 0);
}

TEST(BeamTracing, ARectangleHasItsTexture) {
    SceneMaker maker;
    maker.description().textures.push_back(
        {"", testing::red_and_green(TextureFilter::Bilinear), {}});
    Material material;
    material.emission = {{1, 1, 1}, TextureId{0}};
    maker.add(Rectangle{.corner = {-1, -0.5, 0}, .edge_u = {2, 0.3, 0}, .edge_v = {0, 1, 0.2}},
              maker.material(material), Affine::rotate({1, 2, 3}, 0.3) * Affine::scale({1, 2, 1}));
    const Picture beams = beams_of(maker);
    EXPECT_EQ(differing(beams.film, rays_of(maker).film, 1e-9), 0);
    double red = 0, green = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        red = std::fmax(red, beams.film.at(i % kWidth, i / kWidth).r);
        green = std::fmax(green, beams.film.at(i % kWidth, i / kWidth).g);
    }
    EXPECT_GT(red, 0.9);
    EXPECT_GT(green, 0.9);
}

TEST(BeamTracing, TheOrderComesFromTheTreeOrFromDepth) {
    SceneMaker maker;
    furnish(maker, 0.0);
    const Picture plain = beams_of(maker);
    const Picture listed = beams_of(maker, {.cast = {.tree = false}});
    const Picture without = beams_of(maker, {.cast = {.hulls = false}});
    EXPECT_EQ(differing(plain.film, listed.film, 1e-9), 0);
    EXPECT_EQ(differing(plain.film, without.film, 0.0), 0);
    EXPECT_LT(plain.report.beams->polygons_tested, without.report.beams->polygons_tested);
}

TEST(BeamTracing, ThreadsAndTilesChangeNothing) {
    SceneMaker maker;
    furnish(maker, 0.7);
    const Picture one = beams_of(maker, {}, true, {.threads = 1, .tile_size = 7});
    for (const int tile : {1, 16, 64}) {
        const Picture many = beams_of(maker, {}, true, {.threads = 4, .tile_size = tile});
        EXPECT_EQ(differing(one.film, many.film, 0.0), 0) << tile;
    }
}

TEST(BeamTracing, SmallSharesEndTheTree) {
    SceneMaker maker;
    furnish(maker, 0.0);
    const Picture all = beams_of(maker);
    const Picture few = beams_of(maker, {.least_contribution = 0.5});
    EXPECT_LT(few.report.beams->reflected_beams, all.report.beams->reflected_beams);
    EXPECT_EQ(beams_of(maker, {.least_area = 1.0}).report.beams->reflected_beams, 0u);
}

/// A white triangle before a black ground, a pixel a unit.
SceneMaker white_triangle(const std::array<Vec2, 3>& corners) {
    SceneMaker maker;
    Material glow;
    glow.emission.color = {1, 1, 1};
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {double(kWidth), 0, 0}, {0, double(kHeight), 0}};
    Polygon triangle;
    for (const Vec2& p : corners) triangle.vertices.push_back({p.x, p.y, 0});
    maker.add(triangle, maker.material(glow));
    return maker;
}

constexpr std::array<Vec2, 3> kTriangle{{{-10.3, -7.7}, {21.4, -3.2}, {2.6, 19.9}}};

TEST(BeamTracing, ExactAreasGiveAPixelItsCoveredShare) {
    SceneMaker maker = white_triangle(kTriangle);
    const Picture picture = beams_of(maker, {}, true);
    double sum = 0.0;
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
            const double c = picture.film.at(i, j).r;
            EXPECT_GE(c, -1e-9);
            EXPECT_LE(c, 1.0 + 1e-9);
            sum += c;
        }
    }
    const double area = 0.5 * (31.7 * 27.6 - 4.5 * 12.9);
    EXPECT_NEAR(sum, area, 1e-3);
}

TEST(BeamTracing, AFilterGivesAPixelItsIntegralOverTheTriangle) {
    SceneMaker maker = white_triangle(kTriangle);
    for (const char* name : {"tent", "gaussian", "mitchell", "blackman_harris"}) {
        const Picture picture = beams_of(maker, {}, true, {}, name);
        const FilterIntegral filter(*find_filter(name), find_filter(name)->radius);
        for (int j = 0; j < kHeight; ++j) {
            for (int i = 0; i < kWidth; ++i) {
                const Vec2 center{i + 0.5 - 0.5 * kWidth, 0.5 * kHeight - 0.5 - j};
                double expected = 0.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    expected +=
                        filter.along(kTriangle[k] - center, kTriangle[(k + 1) % 3] - center);
                }
                EXPECT_NEAR(picture.film.at(i, j).r, expected, 2e-5) << name << i << " " << j;
            }
        }
    }
}

TEST(BeamTracing, UnderAFilterThePictureDoesNotEndAtItsBorder) {
    SceneMaker maker = white_triangle({{{-900, -900}, {900, -900}, {0, 900}}});
    const Picture picture = beams_of(maker, {}, true, {}, "mitchell");
    for (int i = 0; i < kWidth; ++i) {
        EXPECT_NEAR(picture.film.at(i, 0).r, 1.0, 1e-9);
        EXPECT_NEAR(picture.film.at(i, kHeight - 1).r, 1.0, 1e-9);
    }
}

TEST(BeamTracing, TheBoxFilterIsTheMeanAndTilesChangeNoFilter) {
    SceneMaker maker;
    furnish(maker, 0.0);
    EXPECT_EQ(
        differing(beams_of(maker, {}, true).film, beams_of(maker, {}, true, {}, "box").film, 1e-9),
        0);
    const Picture one = beams_of(maker, {}, true, {.threads = 1, .tile_size = 7}, "gaussian");
    for (const int tile : {16, 64}) {
        const Picture many =
            beams_of(maker, {}, true, {.threads = 4, .tile_size = tile}, "gaussian");
        EXPECT_EQ(differing(one.film, many.film, 0.0), 0) << tile;
    }
}

TEST(BeamTracing, OtherShapesAreRefusedByName) {
    SceneMaker maker;
    maker.add(Sphere{.center = {0, 0, 0}, .radius = 1}, maker.material({}));
    const Scene scene = maker.compile();
    Film film(4, 4, {0, 0, 4, 4});
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    try {
        (void)BeamTracing().render(job, film);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("sphere"), std::string::npos) << error.what();
    }
}

/// A polygon in front of a wall, seen from the front.
SceneMaker polygon_before_a_wall(const Polygon& polygon) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0.1, -0.2, 6}, {0, 0, -1}, {0, 1, 0}, 0.7, double(kWidth) / kHeight);
    maker.add(Rectangle{.corner = {-3, -3, -1}, .edge_u = {6, 0, 0}, .edge_v = {0, 6, 0}},
              maker.material(painted({0.5, 0.5, 0.5})));
    maker.add(polygon, maker.material(painted({0.7, 0.3, 0.2})));
    maker.light(AmbientLight{{0.3, 0.3, 0.3}});
    maker.light(PointLight{.position = {1, 2, 5}, .color = {0.7, 0.7, 0.7}});
    return maker;
}

TEST(BeamTracing, PolygonsThatCrossThemselvesAreMendedAndSaid) {
    Polygon bow_tie, pentagram, overlap, spike, scribble;
    bow_tie.vertices = {{-1, -1, 0}, {1, 1, 0}, {1, -0.8, 0}, {-1, 1, 0}};
    for (int k = 0; k < 5; ++k) {
        const double angle = 1.5707 + 4 * 3.14159265 * k / 5;
        pentagram.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    }
    overlap.vertices = {{-1, -1, 0},     {0.3, -1, 0}, {0.3, 0.3, 0}, {-1, 0.3, 0},
                        {-0.3, -0.3, 0}, {1, -0.3, 0}, {1, 1, 0},     {-0.3, 1, 0}};
    overlap.loop_ends = {4, 8};
    spike.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {1.4, 1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (int k = 0; k < 40; ++k) {
        scribble.vertices.push_back({std::sin(12.9898 * k * k), std::cos(78.233 * k * k), 0});
    }
    for (const Polygon& polygon : {bow_tie, pentagram, overlap, spike, scribble}) {
        SceneMaker maker = polygon_before_a_wall(polygon);
        const Picture beams = beams_of(maker);
        EXPECT_EQ(differing(beams.film, rays_of(maker).film, 1e-6), 0);
        EXPECT_EQ(beams.report.notes.size(), 1u);
    }
}

TEST(BeamTracing, PolygonsThatMeetThemselvesAreSeenAsByRays) {
    std::vector<Polygon> polygons;
    // Bow ties between parallel sides: their halves cancel, one up to rounding.
    for (const double off : {0.0, 1e-9}) {
        polygons.push_back({.vertices = {{-1, -1, 0}, {1, 1, 0}, {1, -1, off}, {-1, 1, 0}}});
        polygons.push_back({.vertices = {{-1, -1, 0}, {1, 1, 0}, {2, -1, off}, {-1, 1, 0}}});
    }
    for (const auto& [loop, area] : testing::touching_loops()) {
        polygons.push_back({.vertices = loop});
    }
    testing::Random random(4);
    for (int i = 0; i < 40; ++i) {
        polygons.push_back({.vertices = testing::random_loop(random)});
        if (testing::odd_even_area(polygons.back().vertices) == 0.0) polygons.pop_back();
    }
    for (const Polygon& polygon : polygons) {
        SceneMaker maker = polygon_before_a_wall(polygon);
        EXPECT_LE(differing(beams_of(maker).film, rays_of(maker).film, 1e-6), 0)
            << &polygon - polygons.data();
    }
    // Mirrored, and seen from its front alone: rays see both or none of the halves.
    for (const double side : {1.0, -1.0}) {
        SceneMaker maker;
        maker.description().cameras[0].camera = look_along(
            {0.1, -0.2, 6 * side}, {0, 0, -side}, {0, 1, 0}, 0.7, double(kWidth) / kHeight);
        Material front = painted({0.7, 0.3, 0.2});
        front.double_sided = false;
        maker.add(polygons[0], maker.material(front), Affine::scale({-1, 0.5, 1}));
        maker.light(AmbientLight{{0.3, 0.3, 0.3}});
        EXPECT_EQ(differing(beams_of(maker).film, rays_of(maker).film, 1e-6), 0) << side;
    }
}

TEST(BeamTracing, CornersOffAPlaneAreMovedToItOrRefused) {
    const auto bent = [](double by) {
        Polygon polygon;
        polygon.vertices = {{-1, -1, 0}, {1, -1, by}, {1, 1, 0}, {0, 0.2, -by}, {-1, 1, 0}};
        return polygon_before_a_wall(polygon);
    };
    SceneMaker flat = bent(1e-7), little = bent(4e-3), much = bent(0.5);
    EXPECT_TRUE(beams_of(flat).report.notes.empty());
    const Picture beams = beams_of(little);
    ASSERT_EQ(beams.report.notes.size(), 1u);
    EXPECT_NE(beams.report.notes[0].find("off its plane"), std::string::npos);
    EXPECT_LE(differing(beams.film, rays_of(little).film, 0.01), 10);  // along its outline
    try {
        (void)beams_of(much);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("off its plane"), std::string::npos);
    }
}

TEST(BeamTracing, PolygonsOfManyCornersAreTakenWhereTheyAreConvex) {
    Polygon round, rough;
    constexpr int kCorners = 30'000;
    for (int k = 0; k < kCorners; ++k) {
        const double angle = 2 * 3.141592653589793 * k / kCorners;
        const double r = k % 2 == 0 ? 1.0 : 0.8;
        round.vertices.push_back({std::cos(angle), std::sin(angle), 0});
        rough.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    SceneMaker disc = polygon_before_a_wall(round), star = polygon_before_a_wall(rough);
    EXPECT_EQ(differing(beams_of(disc).film, rays_of(disc).film, 1e-6), 0);
    EXPECT_THROW((void)beams_of(star), Error);
}

TEST(BeamTracing, TheErrorOfRefractionIsALayer) {
    // A glass block over a floor: beams bend by the ray through the middle of each piece.
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0.3, -0.2, 6}, {-0.05, 0, -1}, {0, 1, 0}, 0.6, double(kWidth) / kHeight);
    Material glass;
    glass.transmissive.color = {0.9, 0.9, 0.9};
    glass.index.value = 1.5;
    maker.add(Rectangle{.corner = {-3, -3, -1}, .edge_u = {6, 0, 0}, .edge_v = {0, 6, 0}},
              maker.material(painted({0.5, 0.5, 0.5})));
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 0.5}}, maker.material(glass));
    maker.light(AmbientLight{{1, 1, 1}});
    const Scene scene = maker.compile();
    AovFilm aovs(parse_aovs("refraction_error"), {0, 0, kWidth, kHeight});
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .aovs = &aovs,
                        .description = &maker.description()};
    Film film(kWidth, kHeight, {0, 0, kWidth, kHeight});
    (void)BeamTracing().render(job, film);
    const auto& values = aovs.layers().find("refraction_error")->values;
    EXPECT_EQ(values.front(), 0.0f);  // next to the block
    const float middle = values[kHeight / 2 * kWidth + kWidth / 2];
    float most = 0;
    for (const float v : values) most = std::max(most, v);
    EXPECT_LT(middle, most);
    EXPECT_GT(most, 1e-4f);
    EXPECT_LT(most, 0.1f);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
