#include "alhazen/session/technical/technical_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/math/constants.h"
#include "alhazen/session/technical/line_chains.h"
#include "alhazen/session/technical/mesh_edges.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

constexpr int kWidth = 160, kHeight = 120;

struct Sheet {
    explicit Sheet(SceneMaker& maker, bool hidden = true, const Vec3& middle = {}) {
        maker.description().cameras[0].camera =
            look_along(middle + Vec3{2.5, -6, 3.2}, {-2.5, 6, -2.6}, {0, 0, 1}, 0.66, 4.0 / 3.0);
        maker.description().cameras[0].aspect = 4.0 / 3.0;
        loaded.description = maker.description();
        loaded.scene = compile(loaded.description);
        RenderOptions options;
        options.width = kWidth;
        options.height = kHeight;
        drawing = technical_drawing(loaded, options, {.tolerance = 0.01, .hidden = hidden});
    }
    /// The ray of a point of the picture.
    [[nodiscard]] Ray ray(const Vec2& p) const {
        return eye_ray(loaded.scene.cameras[0].camera, p.x / kWidth, 1.0 - p.y / kHeight);
    }
    [[nodiscard]] int count(LineStyle style) const {
        int n = 0;
        for (const DrawingLine& line : drawing.lines) n += line.style == style;
        return n;
    }
    /// Parts of lines between two points.
    [[nodiscard]] std::size_t segments(LineStyle style) const {
        std::size_t n = 0;
        for (const DrawingLine& line : drawing.lines) {
            if (line.style == style) n += line.points.size() - 1;
        }
        return n;
    }
    LoadedScene loaded;
    Drawing drawing;
};

double distance_to(const Ray& ray, const Vec3& p) {
    return length(cross(p - ray.origin, ray.direction)) / length(ray.direction);
}

TEST(TechnicalDrawing, TheOutlineOfASphereIsItsEllipse) {
    SceneMaker maker;
    maker.add(Sphere{.center = {0.4, 0.3, 0.8}, .radius = 0.7}, maker.material({}));
    const Sheet sheet(maker);
    ASSERT_EQ(sheet.drawing.lines.size(), 1u);
    const DrawingLine& line = sheet.drawing.lines[0];
    ASSERT_TRUE(line.arc);
    EXPECT_EQ(line.style, LineStyle::Silhouette);
    EXPECT_NEAR(std::abs(line.arc->to - line.arc->from), 2 * kPi, 1e-9);
    for (int k = 0; k < 60; ++k) {
        EXPECT_NEAR(distance_to(sheet.ray(line.arc->at(0.1 * k)), {0.4, 0.3, 0.8}), 0.7, 1e-12);
    }
    const std::string svg = drawing_svg(sheet.drawing);
    EXPECT_EQ(std::count(svg.begin(), svg.end(), 'A'), 2);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(TechnicalDrawing, RimsAndSidesOfAPlacedConeAreTrue) {
    SceneMaker maker;
    const Affine placed = Affine::translate({-0.4, 0.2, 0.3}) * Affine::rotate({1, 2, 3}, 0.7) *
                          Affine::scale({1.3, 0.8, 1.1});
    maker.add(Cone{.base = {0, 0, 0}, .top = {0, 0, 1.2}, .base_radius = 0.7, .top_radius = 0.3},
              maker.material({}), placed);
    const Sheet sheet(maker);
    const Affine back = inverse(placed);
    int arcs = 0, lines = 0;
    for (const DrawingLine& line : sheet.drawing.lines) {
        for (int k = 0; k <= 20; ++k) {
            const Vec2 p =
                line.arc ? line.arc->at(line.arc->from + (line.arc->to - line.arc->from) * k / 20.0)
                         : line.points[0] + (k / 20.0) * (line.points[1] - line.points[0]);
            const Ray ray = sheet.ray(p);
            const Vec3 o = back.point(ray.origin), d = back.vector(ray.direction);
            if (line.arc) {
                // On one of the two rims.
                double off = 1;
                for (const auto& [z, r] : {std::pair{0.0, 0.7}, {1.2, 0.3}}) {
                    const Vec3 at = o + ((z - o.z) / d.z) * d;
                    off = std::min(off, std::abs(std::hypot(at.x, at.y) - r));
                }
                EXPECT_LT(off, 1e-11);
            } else {
                // x^2 + y^2 = (0.7 - z / 3)^2 has one root along the ray.
                const double r = 0.7 - o.z / 3, f = -d.z / 3;
                const double a = d.x * d.x + d.y * d.y - f * f, b = o.x * d.x + o.y * d.y - r * f,
                             c = o.x * o.x + o.y * o.y - r * r;
                EXPECT_NEAR((b * b - a * c) / (b * b), 0.0, 1e-10);
            }
        }
        (line.arc ? arcs : lines) += 1;
    }
    EXPECT_EQ(lines, 2);
    EXPECT_GE(arcs, 4);  // each rim is divided where it ends the shape
    EXPECT_GE(sheet.count(LineStyle::Hidden), 1);
    EXPECT_GE(sheet.count(LineStyle::Crease), 1);
}

TEST(TechnicalDrawing, WhatIsBehindIsDashedOrLeftOut) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 1}}, grey);
    const Sheet box(maker);
    // Three edges meet in the corner that is farthest.
    EXPECT_EQ(box.segments(LineStyle::Hidden), 3u);
    EXPECT_EQ(box.segments(LineStyle::Silhouette), 6u);
    EXPECT_EQ(box.segments(LineStyle::Crease), 3u);
    EXPECT_EQ(Sheet(maker, false).count(LineStyle::Hidden), 0);
    // A post in front of the box: four of its edges are fully visible, and the box continues behind
    // it.
    maker.add(BoxShape{{0.2, -3, -1}, {0.4, -2.8, 3}}, grey);
    const Sheet both(maker);
    EXPECT_GE(both.segments(LineStyle::Hidden), 3u + 3u + 2u);
    EXPECT_GE(both.segments(LineStyle::Silhouette), 6u + 4u);
}

TEST(TechnicalDrawing, WhatIsBehindIsHiddenFarFromTheOrigin) {
    for (const double far : {1e3, 1e6, 1e8}) {
        SCOPED_TRACE(far);
        SceneMaker maker;
        const Vec3 middle{far, 0, far};
        maker.add(BoxShape{middle + Vec3{-1, -1, 0}, middle + Vec3{1, 1, 1}}, maker.material({}));
        const Sheet sheet(maker, true, middle);
        EXPECT_EQ(sheet.segments(LineStyle::Hidden), 3u);
        EXPECT_EQ(sheet.segments(LineStyle::Silhouette), 6u);
        EXPECT_EQ(sheet.segments(LineStyle::Crease), 3u);
    }
}

/// Points along a line of a drawing.
std::vector<Vec2> points_of(const DrawingLine& line) {
    if (!line.arc) return line.points;
    std::vector<Vec2> points;
    for (int k = 0; k <= 20; ++k) {
        points.push_back(line.arc->at(line.arc->from + (line.arc->to - line.arc->from) * k / 20));
    }
    return points;
}

TEST(TechnicalDrawing, SolidsShowTheTrueEdgesOfTheirCuts) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    const auto plate = maker.object("plate");
    maker.description().objects[static_cast<std::size_t>(plate)].combine = Combine::Difference;
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 0.5}}, grey, {}, plate);
    maker.add(Cylinder{.base = {0, 0, -1}, .top = {0, 0, 2}, .radius = 0.5}, grey, {}, plate);
    // Its lower face lies in that of the plate.
    maker.add(BoxShape{{0.8, -2, 0}, {2, 2, 0.2}}, grey, {}, plate);
    maker.add(plate, grey);
    const Sheet sheet(maker);
    // An arc runs around the mouth of the hole.
    int on_mouth = 0, straight = 0;
    for (const DrawingLine& line : sheet.drawing.lines) {
        if (line.style == LineStyle::Hidden) continue;
        if (!line.arc) {
            straight += static_cast<int>(line.points.size()) - 1;
            continue;
        }
        for (const Vec2& p : points_of(line)) {
            const Ray ray = sheet.ray(p);
            const Vec3 at = ray.origin + ((0.5 - ray.origin.z) / ray.direction.z) * ray.direction;
            on_mouth += std::abs(std::hypot(at.x, at.y) - 0.5) < 1e-9;
        }
    }
    EXPECT_GT(on_mouth, 20);
    EXPECT_EQ(straight, 12);
    EXPECT_GT(sheet.count(LineStyle::Hidden), 5);
}

TEST(TechnicalDrawing, CylindersThatCrossMeetInACurveOnBoth) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    const auto pipes = maker.object("pipes");
    maker.description().objects[static_cast<std::size_t>(pipes)].combine = Combine::Union;
    maker.add(Cylinder{.base = {-1.5, 0, 0}, .top = {1.5, 0, 0}, .radius = 0.6}, grey, {}, pipes);
    maker.add(Cylinder{.base = {0, 0.1, -1}, .top = {0, 0.1, 1.3}, .radius = 0.4}, grey, {}, pipes);
    maker.add(pipes, grey);
    const Sheet sheet(maker);
    int both = 0, segments = 0;
    for (const DrawingLine& line : sheet.drawing.lines) {
        if (line.arc || line.points.size() < 4) continue;
        segments += static_cast<int>(line.points.size());
        for (const Vec2& p : line.points) {
            // Where the ray meets the first cylinder, it is on the second.
            const Ray r = sheet.ray(p);
            const double a = r.direction.y * r.direction.y + r.direction.z * r.direction.z;
            const double b = r.origin.y * r.direction.y + r.origin.z * r.direction.z;
            const double c = r.origin.y * r.origin.y + r.origin.z * r.origin.z - 0.36;
            double off = 1;
            for (const double sign : {-1.0, 1.0}) {
                const double t = (-b + sign * std::sqrt(std::max(0.0, b * b - a * c))) / a;
                const Vec3 at = r.origin + t * r.direction;
                off = std::min(off, std::abs(std::hypot(at.x, at.y - 0.1) - 0.4));
            }
            both += off < 1e-4;
        }
    }
    EXPECT_GT(segments, 40);
    EXPECT_GT(both, segments - 8);  // ends of sight lie on the chords between
}

/// The chords of a curve on a convex solid lie inside of it.
TEST(TechnicalDrawing, CurvesOfAConvexSolidAreSeenInFront) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    const auto lens = maker.object("lens");
    maker.description().objects[static_cast<std::size_t>(lens)].combine = Combine::Intersection;
    maker.add(Sphere{.center = {0, 0, 0}, .radius = 1}, grey, {}, lens);
    maker.add(Cylinder{.base = {-1.2, 0.3, 0}, .top = {1.2, 0.3, 0}, .radius = 0.5}, grey, {},
              lens);
    maker.add(lens, grey);
    const Sheet sheet(maker);
    int seen = 0, wrong = 0;
    for (const DrawingLine& line : sheet.drawing.lines) {
        if (line.arc) continue;
        // Not the points next to where a curve turns to the back.
        for (std::size_t k = 2; k + 2 < line.points.size(); ++k) {
            const Ray ray = sheet.ray(line.points[k]);
            Hit hit;
            if (!sheet.loaded.scene.aggregate->closest(ray, hit, {nullptr, mask_of(RayKind::Eye)}))
                continue;
            const Vec3 at = ray.at(hit.t);
            const bool in_front = std::abs(length(at) - 1) < 2e-3 &&
                                  std::abs(std::hypot(at.y - 0.3, at.z) - 0.5) < 2e-3;
            (line.style == LineStyle::Hidden ? wrong : seen) += in_front;
        }
    }
    EXPECT_GT(seen, 30);
    EXPECT_LE(wrong, 2);
}

TEST(TechnicalDrawing, SeparateObjectsHaveLinesWhereTheyPenetrate) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, grey);
    const int alone = Sheet(maker).count(LineStyle::Silhouette);
    maker.add(BoxShape{{-0.4, -2, -0.4}, {0.4, 0.5, 0.4}}, grey);
    const Sheet sheet(maker);
    EXPECT_GT(sheet.count(LineStyle::Silhouette), alone);
    double seen = 0, hidden = 0;
    for (const DrawingLine& line : sheet.drawing.lines) {
        if (line.arc) continue;
        for (std::size_t k = 0; k + 1 < line.points.size(); ++k) {
            std::array<Vec3, 2> ends;
            bool on = true;
            for (std::size_t i = 0; i < 2; ++i) {
                const Ray ray = sheet.ray(line.points[k + i]);
                ends[i] = ray.at((-1 - ray.origin.y) / ray.direction.y);
                on &= std::abs(std::max(std::abs(ends[i].x), std::abs(ends[i].z)) - 0.4) < 1e-3;
            }
            if (on && line.style == LineStyle::Silhouette) seen += length(ends[1] - ends[0]);
            if (on && line.style == LineStyle::Hidden) hidden += length(ends[1] - ends[0]);
        }
    }
    // The upper and the right line of the square are seen from the right and above.
    EXPECT_NEAR(seen, 1.6, 0.02);
    EXPECT_NEAR(hidden, 1.6, 0.02);
}

TEST(TechnicalDrawing, SpheresHaveACircleWhereTheyPenetrateButNotWhereTheyTouch) {
    for (const double apart : {1.0 - 1e-6, 0.8}) {
        SceneMaker maker;
        const MaterialId grey = maker.material({});
        maker.add(Sphere{.center = {-0.5 * apart, 0, 0}, .radius = 0.5}, grey);
        maker.add(Sphere{.center = {0.5 * apart, 0, 0}, .radius = 0.5}, grey);
        const Sheet sheet(maker);
        int on_circle = 0, tiny = 0;
        for (const DrawingLine& line : sheet.drawing.lines) {
            ASSERT_TRUE(line.arc);
            tiny += std::hypot(line.arc->u.x, line.arc->u.y) < 1;
            const Ray ray = sheet.ray(line.arc->at(0.5 * (line.arc->from + line.arc->to)));
            const Vec3 at = ray.at(-ray.origin.x / ray.direction.x);
            on_circle += std::abs(std::hypot(at.y, at.z) - 0.3) < 1e-9;
        }
        EXPECT_EQ(tiny, 0);
        EXPECT_EQ(on_circle > 0, apart < 0.9);
    }
}

TEST(TechnicalDrawing, EdgesOfAnObjectInAFaceOfAnotherAreDrawnOnce) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, grey);
    // The front faces of both lie in one plane.
    maker.add(BoxShape{{0.3, -1, 0.5}, {0.8, 0.5, 1.5}}, grey);
    const Sheet sheet(maker);
    std::vector<std::array<Vec2, 2>> segments;
    for (const DrawingLine& line : sheet.drawing.lines) {
        for (std::size_t k = 0; k + 1 < line.points.size(); ++k) {
            segments.push_back({line.points[k], line.points[k + 1]});
        }
    }
    const auto is_on = [](const Vec2& p, const std::array<Vec2, 2>& s) {
        const Vec2 d = s[1] - s[0], e = p - s[0];
        const double size = std::hypot(d.x, d.y), t = (d.x * e.x + d.y * e.y) / size;
        return t > 1 && t < size - 1 && std::abs(d.x * e.y - d.y * e.x) < 0.05 * size;
    };
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Vec2 from = segments[i][0], along = segments[i][1] - from;
        for (std::size_t k = 0; k < segments.size(); ++k) {
            EXPECT_FALSE(i != k && is_on(from + 0.3 * along, segments[k]) &&
                         is_on(from + 0.7 * along, segments[k]))
                << from.x << ' ' << from.y << ' ' << along.x << ' ' << along.y;
        }
    }
    EXPECT_GT(segments.size(), 20u);
}

TEST(TechnicalDrawing, ItNeedsGeometry) {
    LoadedScene loaded;
    EXPECT_THROW((void)technical_drawing(loaded, {}, {.tolerance = 0.1}), Error);
}

TEST(MeshEdges, AreThoseOfASmallMeshFarAway) {
    // Its cells have larger numbers than integers.
    const Vec3 corner{1e8, 0, 0}, right{1e-6, 0, 0}, up{0, 1e-6, 0};
    TriangleMesh square;
    square.positions = {corner, corner + right,      corner + right + up,
                        corner, corner + right + up, corner + up};
    square.triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto edges = mesh_edges(square, {corner + Vec3{0, 0, 1}}, MeshSource::Itself);
    EXPECT_EQ(edges.size(), 4u);
    for (const MeshEdge& edge : edges) EXPECT_EQ(edge.kind, MeshEdge::Kind::Border);
}

TEST(LineChains, JoinWhatMeets) {
    std::vector<DrawingLine> lines(3);
    lines[0].points = {{0, 0}, {10, 0}};
    lines[1].points = {{20, 5}, {10, 0}};
    lines[2].points = {{50, 50}, {50, 51}};  // too short to be seen
    const std::vector<DrawingLine> joined = chained(lines);
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0].points.size(), 3u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
