// A second opinion: Clipper of Angus Johnson (libpolyclipping).

#include <gtest/gtest.h>

#include <polyclipping/clipper.hpp>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "support/random_polygons.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

ClipperLib::Paths paths(const PolygonSet& set) {
    ClipperLib::Paths result;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        ClipperLib::Path path;
        for (const LatticePoint p : set.loop(i)) {
            path.emplace_back(p.x, p.y);
        }
        result.push_back(path);
    }
    return result;
}

double clipped_area(const PolygonSet& a, const PolygonSet& b, ClipperLib::ClipType type) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(paths(a), ClipperLib::ptSubject, true);
    clipper.AddPaths(paths(b), ClipperLib::ptClip, true);
    ClipperLib::Paths result;
    clipper.Execute(type, result, ClipperLib::pftEvenOdd, ClipperLib::pftEvenOdd);
    double sum = 0;
    for (const ClipperLib::Path& path : result) {
        sum += 2 * ClipperLib::Area(path);
    }
    return sum;
}

TEST(Clipper, HasTheSameAreasUpToItsRounding) {
    RandomPolygons random(6);
    for (int i = 0; i < 3000; ++i) {
        const auto pair = random.pair(12);
        const PolygonSet &a = pair.first, &b = pair.second;
        // Both move each crossing by less than a unit.
        const double room = 8 * (perimeter(a) + perimeter(b) + 4);
        const auto near = [&](const PolygonSet& ours, ClipperLib::ClipType type) {
            return std::abs(static_cast<double>(twice_area(ours)) - clipped_area(a, b, type)) <=
                   room;
        };
        EXPECT_TRUE(near(intersection(a, b), ClipperLib::ctIntersection)) << "pair " << i;
        EXPECT_TRUE(near(difference(a, b), ClipperLib::ctDifference)) << "pair " << i;
        EXPECT_TRUE(near(union_of(a, b), ClipperLib::ctUnion)) << "pair " << i;
    }
}

TEST(Clipper, AgreesExactlyWhereNothingIsRounded) {
    RandomPolygons random(7);
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
        const PolygonSet a = polygon_set(random.steps(1000, 12));
        const PolygonSet b = polygon_set(random.steps(1000, 12));
        if (exact_arrangement(a, b).rounds) {
            continue;
        }
        ++compared;
        EXPECT_EQ(static_cast<double>(twice_area(intersection(a, b))),
                  clipped_area(a, b, ClipperLib::ctIntersection));
        EXPECT_EQ(static_cast<double>(twice_area(difference(a, b))),
                  clipped_area(a, b, ClipperLib::ctDifference));
    }
    EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
