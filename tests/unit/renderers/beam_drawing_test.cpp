#include "alhazen/renderers/beam_tracing/beam_drawing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/beam_tracing/beam_cells.h"
#include "alhazen/renderers/beam_tracing/linear_shade.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/image_texture.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// Even-odd.
bool holds(const DrawingRegion& region, const Vec2& p) {
    bool inside = false;
    for (const std::vector<Vec2>& loop : region.loops) {
        for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
            const Vec2 &a = loop[i], &b = loop[j];
            if ((a.y > p.y) == (b.y > p.y)) continue;
            inside ^= p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x;
        }
    }
    return inside;
}

Rgb color_at(const DrawingRegion& region, const Vec2& p) {
    if (!region.gradient) return region.color;
    const DrawingGradient& g = *region.gradient;
    const Vec2 along = g.to - g.from, d = p - g.from;
    const double t = (along.x * d.x + along.y * d.y) / (along.x * along.x + along.y * along.y);
    const double share = std::clamp(t, 0.0, 1.0);
    return (1 - share) * g.at_from + share * g.at_to;
}

Drawing drawing_of(SceneMaker& maker, const Scene& scene, bool lines, int size = 48) {
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    const auto limit = static_cast<std::int32_t>(kBeamFilm);
    const BeamScene facets = beam_scene(maker.description(), scene);
    const BeamTree tree =
        beam_tree(job, facets, lattice_rectangle({-limit, -limit}, {limit, limit}), {});
    return beam_drawing(job, facets, tree, {.width = size, .height = size, .lines = lines});
}

/// A mirror wall, a box on a floor, and a light that casts its shadow.
struct Room {
    Room() {
        Material matt, red, mirror;
        matt.diffuse.color = matt.ambient.color = {0.7, 0.7, 0.6};
        red.diffuse.color = red.ambient.color = {0.8, 0.2, 0.1};
        mirror.reflective.color = {0.8, 0.8, 0.8};
        const MaterialId floor = maker.material(matt), box = maker.material(red),
                         wall = maker.material(mirror);
        maker.add(Rectangle{.corner = {-3, -1, -3}, .edge_u = {0, 0, 6}, .edge_v = {6, 0, 0}},
                  floor);
        maker.add(BoxShape{.lo = {-0.8, -1, -0.7}, .hi = {0.1, 0.2, 0.3}}, box);
        maker.add(Rectangle{.corner = {-3, -1, -2}, .edge_u = {6, 0, 0}, .edge_v = {0, 3, 0}},
                  wall);
        maker.light(PointLight{.position = {2, 4, 3}, .ambient = {0.2, 0.2, 0.2}});
        maker.description().conventions.film.linear_output = false;
        maker.description().cameras[0].camera =
            look_along({0.4, 1, 5}, {0, -0.25, -1}, {0, 1, 0}, 0.7, 1.0);
        scene = maker.compile();
    }
    [[nodiscard]] Drawing draw(bool lines) { return drawing_of(maker, scene, lines); }
    SceneMaker maker;
    Scene scene;
};

TEST(BeamDrawing, EveryPointHasOneRegionOfTheColourOfWhitted) {
    Room room;
    const Drawing drawing = room.draw(false);
    Film film(48, 48, {0, 0, 48, 48});
    EXPECT_TRUE(Whitted{}
                    .render({.scene = room.scene, .camera = room.scene.cameras[0].camera}, film)
                    .complete());
    int wrong = 0, seen = 0;
    for (int j = 0; j < 48; ++j) {
        for (int i = 0; i < 48; ++i) {
            const Vec2 p{i + 0.5, j + 0.5};
            int regions = 0;
            Rgb color{};
            for (const DrawingGroup& group : drawing.groups) {
                for (const DrawingRegion& region : group.regions) {
                    if (!holds(region, p)) continue;
                    ++regions;
                    color = color_at(region, p);
                }
            }
            EXPECT_EQ(regions, 1) << i << ',' << j;
            const Rgb ray = film.at(i, j);
            double apart = 0;
            for (int k = 0; k < 3; ++k) {
                apart =
                    std::max(apart, std::abs(color[k] - srgb_from_linear(std::min(ray[k], 1.0))));
            }
            wrong += apart > 3.0 / 255;
            seen += ray.r > 0.05;
        }
    }
    EXPECT_LE(wrong, 6);  // centres next to an edge
    EXPECT_GT(seen, 1000);
}

TEST(BeamDrawing, LinesAreWherePlanesAndObjectsEnd) {
    Room room;
    const Drawing drawing = room.draw(true);
    int creases = 0, silhouettes = 0;
    for (const DrawingLine& line : drawing.lines) {
        EXPECT_GE(line.points.size(), 2u);
        creases += line.style == LineStyle::Crease;
        silhouettes += line.style == LineStyle::Silhouette;
    }
    // The box shows three faces, and two or more in the mirror.
    EXPECT_GE(creases, 3 + 2);
    EXPECT_GE(silhouettes, 3 + 2);  // floor, box, mirror; floor and box in it
    EXPECT_LT(creases + silhouettes, 40);
    const std::string svg = drawing_svg(drawing);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(svg.find("linearGradient"), std::string::npos);
    const std::string pdf = drawing_pdf(drawing);
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_NE(pdf.rfind("%%EOF"), std::string::npos);
}

TEST(BeamDrawing, ARectangleHasItsTexture) {
    SceneMaker maker;
    maker.description().textures.push_back({"", testing::red_and_green(), {}});
    Material material;
    material.emission = {{1, 1, 1}, TextureId{0}};
    maker.add(Rectangle{.corner = {-1, -1, 0}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}},
              maker.material(material));
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 2}, {0, 0, -1}, {2, 0, 0}, {0, 2, 0}};
    const Scene scene = maker.compile();
    const Drawing drawing = drawing_of(maker, scene, false);
    const auto at = [&](const Vec2& p) {
        for (const DrawingGroup& group : drawing.groups) {
            for (const DrawingRegion& region : group.regions) {
                if (holds(region, p)) return color_at(region, p);
            }
        }
        return Rgb{};
    };
    const Rgb left = at({5.2, 20.3}), right = at({41.2, 20.3});
    EXPECT_NEAR(left.r, 1.0, 1e-12);
    EXPECT_EQ(left.g, 0.0);
    EXPECT_NEAR(right.g, 1.0, 1e-12);
    EXPECT_EQ(right.r, 0.0);
}

/// A floor from above, 10 units and 400 pixels wide.
struct Floor {
    Floor(const Light& light, double diffuse) {
        Material matt;
        matt.diffuse.color = {diffuse, diffuse, diffuse};
        matt.specular.color = {0.7, 0.7, 0.7};
        matt.shininess.value = 20000;
        maker.add(Rectangle{.corner = {-5, -5, 0}, .edge_u = {10, 0, 0}, .edge_v = {0, 10, 0}},
                  maker.material(matt));
        maker.light(light);
        maker.description().cameras[0].camera =
            OrthographicCamera{{0, 0, 9}, {0, 0, -1}, {10, 0, 0}, {0, 10, 0}};
        drawing = drawing_of(maker, scene = maker.compile(), false, 400);
    }
    [[nodiscard]] double red_at(double x, double y) const {
        const Vec2 p{200 + 40 * x + 0.013, 200 - 40 * y + 0.017};
        for (const DrawingGroup& group : drawing.groups) {
            for (const DrawingRegion& region : group.regions) {
                if (holds(region, p)) return color_at(region, p).r;
            }
        }
        return -1;
    }
    SceneMaker maker;
    Scene scene;
    Drawing drawing;
};

TEST(BeamDrawing, ASpotSmallerThanTheGridOfSamplesIsDrawn) {
    const Vec3 at{1.1, 0.3, 4}, axis = normalize(Vec3{0.2, 0.4, -4});
    const double degree = kPi / 180;
    const Floor floor(SpotLight{.position = at,
                                .direction = axis,
                                .inner_angle = 7 * degree,
                                .outer_angle = 8 * degree},
                      0.2);
    int lit = 0, dark = 0;
    for (double y = -1; y <= 2.5; y += 0.07) {
        for (double x = -0.5; x <= 3; x += 0.07) {
            const double angle = std::acos(dot(axis, normalize(Vec3{x, y, 0} - at))) / degree;
            // Regions of 4 pixels cross the border.
            if (angle < 5) {
                ++lit;
                EXPECT_GT(floor.red_at(x, y), 0.19) << x << ' ' << y;
            } else if (angle > 10) {
                ++dark;
                EXPECT_LT(floor.red_at(x, y), 0.01) << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(lit, 50);
    EXPECT_GT(dark, 500);
}

TEST(BeamDrawing, AHighlightSmallerThanTheGridOfSamplesIsDrawn) {
    // Straight below the light, as the floor is seen from above.
    const Floor floor(PointLight{.position = {0.9, 0.8, 6}}, 0.0);
    EXPECT_GT(floor.red_at(0.9, 0.8), floor.red_at(2, 2) + 0.2);
}

TEST(FitShade, FindsTheDirectionOfALinearChange) {
    std::vector<ShadePoint> points;
    for (int i = 0; i < 20; ++i) {
        const Vec2 at{i % 5 * 3.0, i / 5 * 2.0};
        const double t = 0.02 * at.x - 0.01 * at.y;
        points.push_back({at, {0.5 + t, 0.4 + 0.5 * t, 0.3}});
    }
    const LinearShade shade = fit_shade(points, 1e-3);
    ASSERT_TRUE(shade.gradient);
    EXPECT_LT(shade.error, 1e-6);
    const Vec2 along = shade.gradient->to - shade.gradient->from;
    EXPECT_NEAR(along.y / along.x, -0.5, 1e-6);
    EXPECT_FALSE(fit_shade(points, 0.5).gradient);
    points.push_back({{6, 3}, {1, 1, 1}});  // a highlight
    EXPECT_GT(fit_shade(points, 1e-3).error, 0.1);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
