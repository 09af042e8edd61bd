/// Areas and integrals within pixels, of beam tracing.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "alhazen/geometry/facets/convex_parts.h"
#include "alhazen/renderers/beam_tracing/beam_raster.h"
#include "alhazen/renderers/beam_tracing/pixel_quadrature.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(BeamTracing, AreasOfARowHaveTheirMiddles) {
    PolygonSet triangle;
    for (const LatticePoint p : {LatticePoint{0, 0}, LatticePoint{40, 0}, LatticePoint{0, 30}}) {
        triangle.add_vertex(p);
    }
    triangle.end_loop();
    const std::array<double, 5> edges{-10, 0, 10, 20, 50};
    RowAreas areas;
    areas.begin(0, 30, edges);
    areas.add(triangle);
    std::vector<BeamSample> samples;
    areas.take(3, 7, samples);
    double area = 0.0, x = 0.0, y = 0.0;
    for (const BeamSample& s : samples) {
        const auto c = static_cast<std::size_t>(s.i - 7);
        const double part = s.share * 30 * (edges[c + 1] - edges[c]);
        area += part;
        x += part * s.at.x;
        y += part * s.at.y;
        EXPECT_EQ(s.j, 3);
    }
    EXPECT_NEAR(area, 600, 1e-9);
    EXPECT_NEAR(x / area, 40.0 / 3, 1e-9);
    EXPECT_NEAR(y / area, 10, 1e-9);
}

/// An L with a hole, of the area 0.44.
PixelPolygon angled_polygon() {
    PixelPolygon polygon;
    polygon.add(std::array<Vec2, 6>{
        {{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.1}, {-0.1, -0.1}, {-0.1, 0.1}, {-0.5, 0.1}}});
    polygon.add(std::array<Vec2, 4>{{{-0.4, -0.4}, {-0.4, -0.2}, {-0.2, -0.2}, {-0.2, -0.4}}});
    return polygon;
}

TEST(PixelQuadrature, FourPointsHaveTheMomentsOfAPolygon) {
    const PixelPolygon polygon = angled_polygon();
    const PixelRule rule = rule_of(polygon);
    EXPECT_NEAR(rule.area, 0.44, 1e-15);
    double xx = 0, xy = 0, yy = 0;
    for (const Vec2& p : rule.points) {
        xx += p.x * p.x / 4;
        xy += p.x * p.y / 4;
        yy += p.y * p.y / 4;
    }
    // By the rectangles that it is made of: lo, hi, sign.
    const std::array<std::array<double, 5>, 3> boxes{
        {{-0.5, -0.5, 0.5, -0.1, 1}, {-0.5, -0.1, -0.1, 0.1, 1}, {-0.4, -0.4, -0.2, -0.2, -1}}};
    double exact_xx = 0, exact_xy = 0, exact_yy = 0;
    for (const auto& [x0, y0, x1, y1, sign] : boxes) {
        exact_xx += sign * (x1 * x1 * x1 - x0 * x0 * x0) / 3 * (y1 - y0) / 0.44;
        exact_yy += sign * (y1 * y1 * y1 - y0 * y0 * y0) / 3 * (x1 - x0) / 0.44;
        exact_xy += sign * (x1 * x1 - x0 * x0) / 2 * (y1 * y1 - y0 * y0) / 2 / 0.44;
    }
    EXPECT_NEAR(xx, exact_xx, 1e-14);
    EXPECT_NEAR(xy, exact_xy, 1e-14);
    EXPECT_NEAR(yy, exact_yy, 1e-14);
}

TEST(PixelQuadrature, PeaksWithinAPixelAreIntegratedToTheErrorAskedFor) {
    // A light at a height above the pixel: the integral over a rectangle is that of 1 / r^2
    // cosines.
    const double height = 0.05;
    const auto lamp = [&](const Vec2& p, double) {
        const double r = p.x * p.x + p.y * p.y + height * height;
        const double c = height * height / (r * r);
        return Rgb{c, 0.5 * c, 1};
    };
    // Its integral from (0, 0).
    const auto corner = [&](double x, double y) {
        const double a = std::hypot(x, height), b = std::hypot(y, height);
        return 0.5 * (x / a * std::atan(y / a) + y / b * std::atan(x / b));
    };
    double before = 1;
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const Rgb mean = PixelQuadrature(error).mean(whole_pixel(), lamp);
        const double off = std::abs(mean.r - 4 * corner(0.5, 0.5));
        EXPECT_LE(off, error);
        EXPECT_LE(off, before);
        EXPECT_NEAR(mean.b, 1, 1e-12);
        before = off;
    }
}

TEST(ConvexParts, CoverAPolygonWithHolesOnce) {
    const std::vector<Vec3> corners{{0, 0, 1}, {9, 0, 1}, {9, 9, 1},     {5, 6, 1},     {0, 9, 1},
                                    {1, 1, 1}, {3, 1, 1}, {3, 3, 1},     {1, 3, 1},     {5, 1, 1},
                                    {8, 1, 1}, {7, 4, 1}, {5.5, 1.2, 1}, {7.5, 1.2, 1}, {7, 2, 1}};
    const std::vector<std::uint32_t> ends{5, 9, 12, 15};
    double area = 0.0;
    for (const std::vector<Vec3>& part : convex_parts(corners, ends, {0, 0, 1})) {
        const Vec3 c = cross(part[1] - part[0], part[2] - part[0]);
        EXPECT_GT(c.z, 0.0);
        area += 0.5 * c.z;
    }
    // The outline, less two holes, and an island in the second.
    EXPECT_NEAR(area, (81 - 13.5) - 4 - 4.5 + 0.8, 1e-12);
    const std::vector<Vec3> square{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
    EXPECT_EQ(convex_parts(square, {}, {1, 0, 0}).size(), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
