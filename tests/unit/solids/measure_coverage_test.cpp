// Heavy: how often the intervals of whole measurements, which end when they are narrow enough,
// contain the true value. ALHAZEN_COVERAGE_RUNS and ALHAZEN_COVERAGE_ERROR change the number of
// seeds and the wanted error.

#include <gtest/gtest.h>

#include <numbers>

#include <cstdlib>
#include <iostream>

#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/solids/solid_measures.h"
#include "closed_forms.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::KnownSolid;
using testing::LoneScene;
using testing::SceneMaker;

double setting(const char* name, double usual) {
    const char* text = std::getenv(name);
    return text == nullptr ? usual : std::atof(text);
}

const int kRuns = static_cast<int>(setting("ALHAZEN_COVERAGE_RUNS", 400));
const double kError = setting("ALHAZEN_COVERAGE_ERROR", 1e-3);

struct Coverage {
    int volume = 0, area = 0, centroid = 0, crofton = 0, disagree = 0;
};

/// An area of 0 is not measured.
Coverage coverage_of(const Measurable& solid, double volume, double area, double centroid_x) {
    Coverage held;
    for (int run = 0; run < kRuns; ++run) {
        const SolidMeasures m = measure(solid, {.relative_error = kError,
                                                .seconds = 600,
                                                .area = area > 0,
                                                .seed = 5000 + static_cast<unsigned>(run)});
        held.volume += m.volume.holds(volume);
        held.area += m.area.holds(area);
        held.crofton += m.area_by_crofton.holds(area);
        held.centroid += m.centroid[0].holds(centroid_x);
        held.disagree += m.directions_agree && m.areas_agree ? 0 : 1;
    }
    return held;
}

/// The origin of a number's interval.
enum class Interval95 {
    Scatter,  ///< it holds in 95 %
    /// Widened: the solid fills its shadow's rectangle (with_rare_misses), or every line is alike
    /// and only rounding is left.
    Widened,
};

void expect_honest(int held, const std::string& what, Interval95 kind = Interval95::Scatter) {
    std::cout << what << ": " << 100.0 * held / kRuns << " %\n";
    EXPECT_GE(held, kRuns * 90 / 100) << what;
    if (kind == Interval95::Scatter) {
        EXPECT_LE(held, kRuns * 99 / 100) << what;
    }
}

void expect_honest(const Coverage& held, const std::string& name, Interval95 volume,
                   Interval95 area) {
    expect_honest(held.volume, name + " volume", volume);
    expect_honest(held.area, name + " area", area);
    expect_honest(held.crofton, name + " Crofton");
    expect_honest(held.centroid, name + " centroid", volume);
    EXPECT_LE(held.disagree, kRuns / 100) << name;
}

TEST(MeasureCoverage, OfMeasurementsThatEndWhenTheyAreNarrowEnough) {
    for (const KnownSolid& known : testing::known_solids()) {
        const LoneScene scene(known);
        const bool block = known.name == "box" || known.name == "plate";
        expect_honest(coverage_of(scene.solid, known.volume, known.area, known.centroid.x),
                      known.name,
                      block || known.name == "cylinder" ? Interval95::Widened : Interval95::Scatter,
                      block ? Interval95::Widened : Interval95::Scatter);
    }
}

TEST(MeasureCoverage, OfATorus) {
    SceneMaker maker;
    maker.add(Torus{});
    const SolidList solids(maker.compile().aggregate);
    expect_honest(
        coverage_of(IsolatedSolid(solids, SolidId{0}), std::numbers::pi * std::numbers::pi / 8,
                    std::numbers::pi * std::numbers::pi, 0),
        "torus", Interval95::Scatter, Interval95::Scatter);
}

TEST(MeasureCoverage, OfANapkinRing) {
    // Height 1.2: the hole has the radius 0.8.
    SceneMaker maker;
    const ObjectIndex ring = maker.object("ring");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, ring);
    maker.add(Cylinder{{0, 0, -2}, {0, 0, 2}, 0.8}, MaterialId{0}, {}, ring);
    maker.add(ring);
    const SolidList solids(maker.compile().aggregate);
    // Zones of a sphere and a cylinder.
    expect_honest(
        coverage_of(IsolatedSolid(solids, SolidId{0}), std::numbers::pi * 1.2 * 1.2 * 1.2 / 6,
                    2 * std::numbers::pi * 1.2 + 2 * std::numbers::pi * 0.8 * 1.2, 0),
        "napkin ring", Interval95::Scatter, Interval95::Scatter);
}

TEST(MeasureCoverage, OfACornerCutFromABox) {
    SceneMaker maker;
    const ObjectIndex corner = maker.object("corner");
    maker.description().objects.back().combine = Combine::Intersection;
    maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, MaterialId{0}, {}, corner);
    maker.add(HalfSpace{{0.7, 1, 1}, {-1, -0.8, -1.4}}, MaterialId{0}, {}, corner);
    maker.add(corner, MaterialId{0}, Affine::rotate({1, 2, 3}, 0.58));
    const SolidList solids(maker.compile().aggregate);
    expect_honest(
        coverage_of(IsolatedSolid(solids, SolidId{0}), 0.3 * (0.3 / 0.8) * (0.3 / 1.4) / 6, 0, 0)
            .volume,
        "corner volume");
}

TEST(MeasureCoverage, OfTheBicylinder) {
    SceneMaker maker;
    maker.add(Cylinder{{-2, 0, 0}, {2, 0, 0}, 1});
    maker.add(Cylinder{{0, -2, 0}, {0, 2, 0}, 1});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid a(solids, SolidId{0}), b(solids, SolidId{1});
    expect_honest(coverage_of(Overlap(a, b), 16.0 / 3, 0, 0).volume, "bicylinder volume",
                  Interval95::Widened);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
