#include "alhazen/solids/solid_measures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <numbers>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/math/constants.h"
#include "alhazen/solids/stratified_chords.h"
#include "closed_forms.h"
#include "one_solid.h"
#include "support/random.h"
#include "support/random_patches.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::known_solids;
using testing::KnownSolid;
using testing::LoneScene;
using testing::OneSolid;
using testing::SceneMaker;

/// A tetrahedron of volume 4.5 in a cube of side 3, as operands of an intersection.
const std::string kFourHalfSpaces =
    "half_space { point = (1,1,1) normal = (1,1,1) } half_space { normal = (-1,0,0) }\n"
    "half_space { normal = (0,-1,0) } half_space { normal = (0,0,-1) }\n";

TEST(SolidMeasures, HalfSpacesThatBoundASolidGiveItsBox) {
    const auto expect_box = [](const Box3& box, const Vec3& lo, const Vec3& hi) {
        EXPECT_LE(length(box.lo - lo) + length(box.hi - hi), 1e-9);
        EXPECT_TRUE(box.lo.x <= lo.x && box.lo.y <= lo.y && box.lo.z <= lo.z);
        EXPECT_TRUE(box.hi.x >= hi.x && box.hi.y >= hi.y && box.hi.z >= hi.z);
    };
    const OneSolid four("intersection { " + kFourHalfSpaces + "}");
    expect_box(four.solid.box(), {0, 0, 0}, {3, 3, 3});
    const SolidMeasures m = measure(four.solid, {.relative_error = 1e-3, .seconds = 20});
    EXPECT_NEAR(m.volume.value, 4.5, 2 * m.volume.half_width);
    // Placed, two of them subtracted, and as one part of a union.
    const OneSolid moved("intersection { transform = translate(1,0,0)\n" + kFourHalfSpaces + "}");
    expect_box(moved.solid.box(), {1, 0, 0}, {4, 3, 3});
    const OneSolid cut(
        "difference { intersection { half_space { point = (1,1,1) normal = (1,1,1) }\n"
        "half_space { normal = (-1,0,0) } } half_space { normal = (0,1,0) }\n"
        "half_space { normal = (0,0,1) } }");
    expect_box(cut.solid.box(), {0, 0, 0}, {3, 3, 3});
    const OneSolid both("union { sphere { center = (-5,0,0) } intersection { " + kFourHalfSpaces +
                        "} }");
    expect_box(both.solid.box(), {-6, -1, -1}, {3, 3, 3});
    // Three half spaces reach to infinity.
    const OneSolid three(
        "intersection { half_space { point = (1,1,1) normal = (1,1,1) }\n"
        "half_space { normal = (-1,0.1,0) } half_space { normal = (0,-1,0) } }");
    EXPECT_FALSE(three.solid.box().bounded());
    EXPECT_THROW((void)measure(three.solid, {}), Error);
}

TEST(SolidMeasures, SolidsWithKnownFiguresHaveThem) {
    for (const KnownSolid& known : known_solids()) {
        const LoneScene scene(known);
        const SolidMeasures m = measure(scene.solid, {.relative_error = 4e-4, .seconds = 20});
        EXPECT_TRUE(m.reached) << known.name;
        // Twice the interval: of about fifty numbers a few miss their own.
        const auto near = [&](const Estimate& e, double truth, const char* what) {
            EXPECT_NEAR(e.value, truth, 2 * e.half_width) << known.name << " " << what;
        };
        near(m.volume, known.volume, "volume");
        near(m.area, known.area, "area");
        near(m.area_by_crofton, known.area, "Crofton");
        for (int k = 0; k < 3; ++k) {
            near(m.centroid[std::size_t(k)], known.centroid[k], "centroid");
            near(m.volume_by_direction[std::size_t(k)], known.volume, "one direction");
            if (known.inertia.x > 0) {
                near(m.inertia[std::size_t(k)], known.inertia[k], "inertia");
                near(m.inertia[std::size_t(k) + 3], 0, "product");
            }
        }
        EXPECT_LT(m.volume.half_width, 5e-4 * known.volume) << known.name;
        EXPECT_LT(m.area_by_crofton.half_width, 0.02 * known.area) << known.name;
        EXPECT_TRUE(m.directions_agree) << known.name;
        EXPECT_TRUE(m.areas_agree) << known.name;
        EXPECT_EQ(m.inconsistent_lines, 0u);
    }
}

/// All sets of lines may count the same number of crossings.
TEST(SolidMeasures, CroftonsCountIsNoFinerThanItsLines) {
    const double area = 4 * std::numbers::pi;
    int missed = 0;
    for (int k = 0; k < 60; ++k) {
        const LoneScene scene({"ball",
                               Sphere{{0.3, 0.2, 0.1}, 1},
                               Affine::rotate({1, 2, 3}, 0.38 * k),
                               area / 3,
                               area,
                               {},
                               {}});
        const SolidMeasures m = measure(scene.solid);
        EXPECT_TRUE(m.areas_agree) << k;
        EXPECT_NEAR(m.area_by_crofton.value, area, 3 * m.area_by_crofton.half_width) << k;
        missed += m.area_by_crofton.holds(area) ? 0 : 1;
    }
    EXPECT_LE(missed, 7);  // binomial, 60 of 5 %: 1 in 80 has more than 7
}

TEST(SolidMeasures, ABoxAlongTheAxesIsExact) {
    const LoneScene scene(known_solids()[1]);
    const SolidMeasures m = measure(scene.solid);
    EXPECT_NEAR(m.volume.value, 6, 1e-13);
    // No variance. The width is the bound of rounding, 2.9e-12: 64 roundings of the largest
    // coordinate, 8, times the area, 22; and 300 roundings of the sum, 6.
    EXPECT_NEAR(m.volume.half_width, 0x1p-52 * (64 * 8 * 22 + 300 * 6), 1e-14);
    EXPECT_EQ(m.volume.half_width, m.volume.rounding);
    EXPECT_NEAR(m.area.value, 22, 1e-12);
}

TEST(SolidMeasures, IntervalsOfBlocksHoldTheirRounding) {
    // All chords of a block along the axes are equal: the width is rounding alone, which depends on
    // the coordinates, not on the volume.
    testing::Random random(19);
    for (int i = 0; i < 40; ++i) {
        const double scale = random.log_uniform(1e-3, 1e4), far = random.log_uniform(0.1, 1e3);
        Vec3 lo, hi;
        long double w[3];
        for (int k = 0; k < 3; ++k) {
            lo[k] = scale * far * random.uniform(-1, 1);
            hi[k] = lo[k] + scale * random.log_uniform(0.01, 10);
            w[k] = static_cast<long double>(hi[k]) - lo[k];
        }
        const auto [lo_x, lo_y, lo_z] = lo;
        const auto [hi_x, hi_y, hi_z] = hi;
        SceneMaker maker;
        const int kind = i < 30 ? i % 3 : 3;
        if (kind == 0) {
            maker.add(BoxShape{lo, hi});
        } else if (kind == 3) {
            maker.add(testing::patch_block(lo, hi));
        } else if (kind == 1) {
            Polyhedron block;
            for (int k = 0; k < 3; ++k) {
                Vec3 normal;
                normal[k] = 1;
                block.planes.push_back({hi, normal});
                block.planes.push_back({lo, -normal});
            }
            maker.add(block);
        } else {
            TriangleMesh mesh;
            for (int corner = 0; corner < 8; ++corner) {
                mesh.positions.push_back(
                    {corner & 1 ? hi_x : lo_x, corner & 2 ? hi_y : lo_y, corner & 4 ? hi_z : lo_z});
            }
            mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
            maker.add(maker.mesh(mesh));
        }
        const SolidList solids(maker.compile().aggregate);
        ASSERT_EQ(solids.count(), 1u) << i;
        const IsolatedSolid solid(solids, SolidId{0});
        const SolidMeasures m = measure(solid, {.seconds = 20, .seed = 1 + unsigned(i)});
        const long double volume = w[0] * w[1] * w[2];
        const long double area = 2 * (w[0] * w[1] + w[1] * w[2] + w[2] * w[0]);
        EXPECT_LE(std::abs(m.volume.value - volume), m.volume.half_width) << i;
        EXPECT_LE(std::abs(m.area.value - area), m.area.half_width) << i;
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(std::abs(m.volume_by_direction[std::size_t(k)].value - volume),
                      m.volume_by_direction[std::size_t(k)].half_width)
                << i;
        }
        EXPECT_TRUE(m.directions_agree && m.areas_agree) << i;
        EXPECT_LT(m.volume.half_width, 1e-4 * m.volume.value) << i;
        Vec3 up;
        up[i % 3] = 1;
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const SectionArea cut =
            section_area(solid, {up, lo[i % 3] + 0.3 * (hi[i % 3] - lo[i % 3])}, {.seconds = 20});
        EXPECT_LE(std::abs(cut.area.value - w[a] * w[b]), cut.area.half_width) << i;
    }
}

/// How often the interval of a bundle contains the true value.
double coverage(const Measurable& solid, const BundleFrame& frame, double truth, bool area) {
    constexpr int kRuns = 400;
    int held = 0;
    for (int run = 0; run < kRuns; ++run) {
        StratifiedChords bundle(
            solid, frame, solid.box().center(), 1000 + static_cast<unsigned>(run),
            area ? StratifiedChords::Measured::Area : StratifiedChords::Measured::Volume);
        bundle.grow_to(512);
        bundle.grow_to(1024);
        held += bundle.estimate().holds(truth);
    }
    return held / double{kRuns};
}

TEST(SolidMeasures, IntervalsOfTheBundlesHoldTheTruthAsOftenAsTheySay) {
    const Mat3 turned = Affine::rotate({3, -1, 2}, 1.1).linear;
    const BundleFrame aslant{turned.x_axis, turned.y_axis, turned.z_axis};
    const BundleFrame along_z{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (const KnownSolid& known : known_solids()) {
        const LoneScene scene(known);
        const double c = coverage(scene.solid, aslant, known.volume, false);
        EXPECT_GE(c, 0.90) << known.name;
        EXPECT_LE(c, 0.99) << known.name;
    }
    // The ends of a cylinder seen along its axis: only a silhouette is counted.
    const LoneScene cylinder(known_solids()[3]);
    const double ends = coverage(cylinder.solid, along_z, 3 * std::numbers::pi, false);
    EXPECT_GE(ends, 0.90);
    EXPECT_LE(ends, 0.99);
    const LoneScene sphere(known_solids()[0]);
    const double share = coverage(sphere.solid, along_z, 16 * std::numbers::pi / 3, true);
    EXPECT_GE(share, 0.90);
    EXPECT_LE(share, 0.99);
}

TEST(SolidMeasures, AMeshHasTheFiguresOfTheDivergenceTheorem) {
    SceneMaker maker;
    const testing::SphereMesh sphere(3);
    TriangleMesh mesh;
    mesh.positions = sphere.positions;
    mesh.triangles = sphere.triangles;
    const Affine placement =
        Affine::translate({1, 2, 3}) * Affine::rotate({1, 1, 0}, 0.4) * Affine::scale({1, 2, 0.5});
    TriangleMesh placed = mesh;
    placed.transform(placement);
    maker.add(maker.mesh(mesh), MaterialId{0}, placement);
    maker.add(Sphere{{9, 9, 9}, 1});
    const SolidList solids(maker.compile("wide_bvh").aggregate);
    ASSERT_EQ(solids.count(), 2u);
    const IsolatedSolid solid(solids, SolidId{1});
    const SolidMeasures m = measure(solid, {.relative_error = 4e-4, .seconds = 20});
    EXPECT_NEAR(m.volume.value, signed_volume(placed), 2 * m.volume.half_width);
    EXPECT_NEAR(m.area.value, area(placed), 2 * m.area.half_width);
    EXPECT_LT(m.volume.half_width, 5e-4 * m.volume.value);
    EXPECT_TRUE(m.directions_agree);
}

TEST(SolidMeasures, WhatTheCornersOfAnAlmostFullShadowLackIsInTheInterval) {
    // 8 gamma(1 + 1/p)^3 / gamma(1 + 3/p): a third of the difference to the cube is in corners that
    // one line in 25000 hits.
    constexpr double kPower = 200;
    const double truth =
        8 * std::exp(3 * std::lgamma(1 + 1 / kPower) - std::lgamma(1 + 3 / kPower));
    Superellipsoid almost_a_cube;
    almost_a_cube.east = almost_a_cube.north = 2 / kPower;
    SceneMaker maker;
    maker.add(almost_a_cube);
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const SolidMeasures m =
            measure(solid, {.relative_error = 1e-3, .seconds = 20, .area = false, .seed = seed});
        EXPECT_TRUE(m.volume.holds(truth))
            << seed << ": " << m.volume.value << " +- " << m.volume.half_width;
    }
}

TEST(SolidMeasures, LinesGoOnWhereThereAreAsManyCellsAsMayBe) {
    const LoneScene sphere(known_solids()[0]);
    const SolidMeasures m = measure(
        sphere.solid,
        {.relative_error = 5e-5, .seconds = 60, .area = false, .most_lines_of_round = 1 << 14});
    EXPECT_TRUE(m.reached);
    EXPECT_GT(m.lines, 100'000u);
    EXPECT_NEAR(m.volume.value, 32 * std::numbers::pi / 3, 2 * m.volume.half_width);
}

TEST(SolidMeasures, PartsFarApartAreAllMet) {
    const double pi = std::numbers::pi;
    for (const double distance : {30.0, 1e3, 1e6}) {
        const OneSolid two(
            fmt::format("union {{ sphere {{ radius=1 }} sphere {{ "
                        "center=({},0,0); radius=0.01 }} }}",
                        distance));
        const double volume = 4 * pi / 3 * (1 + 1e-6), area = 4 * pi * (1 + 1e-4);
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            const SolidMeasures m =
                measure(two.solid, {.relative_error = 1e-3, .seconds = 20, .seed = seed});
            EXPECT_TRUE(m.reached);
            EXPECT_TRUE(m.directions_agree && m.areas_agree) << distance << " " << seed;
            EXPECT_NEAR(m.volume.value, volume, 2 * m.volume.half_width) << distance;
            EXPECT_NEAR(m.area.value, area, 2 * m.area.half_width) << distance;
        }
    }
    // What is subtracted or cut off far away counts for nothing.
    const OneSolid cut(
        "difference { union { sphere { radius=1 } sphere { center=(300,40,-200); "
        "radius=2 } } sphere { center=(1e3,0,0); radius=20 } box { lo=(300,0,-300); "
        "hi=(400,100,-100) } }");
    const SolidMeasures m = measure(cut.solid, {.relative_error = 1e-3, .seconds = 20});
    EXPECT_TRUE(m.reached);
    EXPECT_NEAR(m.volume.value, 4 * pi / 3 * 5, 2 * m.volume.half_width);
    EXPECT_NEAR(m.area.value, 4 * pi * (1 + 2 + 1), 2 * m.area.half_width);
}

/// A corner of a box, far smaller than the rectangle around the box's shadow.
constexpr const char* kCorner =
    "intersection { box { lo=(-1,-1,-1); hi=(1,1,1) } half_space { point=(0.7,1,1); "
    "normal=(-1,-0.8,-1.4) } transform=rotate((1,2,3), 33) }";
constexpr double kVolumeOfCorner = 0.3 * (0.3 / 0.8) * (0.3 / 1.4) / 6;
/// A cap of a hyperboloid, a thirtieth as thick as its box.
constexpr const char* kSlice =
    "quadric { squares=(-1.7,1.4,1); constant=1.25; clip_box=((-0.4,-0.6,-0.4), (0.9,0.8,0.8)) }";

TEST(SolidMeasures, WhatReachesFromOneCellIntoTheNextIsInTheInterval) {
    const OneSolid corner(kCorner);
    const Box3 box = corner.solid.box();
    for (const BundleFrame& frame : {BundleFrame{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                     BundleFrame{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}) {
        constexpr int kRuns = 200;
        int held = 0;
        for (unsigned run = 0; run < kRuns; ++run) {
            StratifiedChords bundle(corner.solid, frame, box.center(), 1000 + run);
            bundle.grow_to(512);
            bundle.grow_to(4096);
            const Estimate e = bundle.estimate();
            held += e.holds(kVolumeOfCorner);
            EXPECT_NEAR(e.value, kVolumeOfCorner, 4 * e.half_width) << run;
        }
        EXPECT_GE(held, 0.90 * kRuns);
        EXPECT_LE(held, 0.99 * kRuns);
    }
}

TEST(SolidMeasures, DirectionsInWhichASolidIsSeenByFewLinesAgree) {
    // The integral of pi (1.7 x^2 - 1.25) / sqrt(1.4), from where it is 0 to x = 0.9.
    const auto from_zero = [](double x) { return 1.7 * x * x * x / 3 - 1.25 * x; };
    const double volume =
        std::numbers::pi / std::sqrt(1.4) * (from_zero(0.9) - from_zero(std::sqrt(1.25 / 1.7)));
    const OneSolid slice(kSlice);
    int held = 0;
    for (unsigned run = 0; run < 200; ++run) {
        const SolidMeasures m =
            measure(slice.solid,
                    {.relative_error = 1e-3, .seconds = 20, .area = false, .seed = 5000 + run});
        EXPECT_TRUE(m.directions_agree) << run;
        held += m.volume.holds(volume);
    }
    EXPECT_GE(held, 180);
}

TEST(SolidMeasures, ASolidThatNoLineMetHasAWideInterval) {
    // A thread along the diagonal of its box.
    const OneSolid thread("cylinder { base=(-5,-7,-3); top=(5,7,3); radius=1e-10 }");
    const SolidMeasures m = measure(
        thread.solid, {.relative_error = 1e-3, .seconds = 0.2, .most_lines_of_round = 1 << 14});
    EXPECT_FALSE(m.reached);
    EXPECT_TRUE(m.volume.holds(std::numbers::pi * 1e-20 * std::sqrt(332.0)));
    EXPECT_TRUE(m.area.holds(2 * std::numbers::pi * 1e-10 * std::sqrt(332.0)));
    EXPECT_GT(m.volume.half_width, 1e-3);
    EXPECT_GT(m.area.half_width, 1e-3);
    EXPECT_GT(m.lines, 10'000u);
    // The intersection of two solids may well be empty.
    const OneSolid other("sphere { center=(0,0,9) }");
    const SolidMeasures both =
        measure(Overlap(thread.solid, other.solid), {.seconds = 20, .area = false});
    EXPECT_TRUE(both.reached);
    EXPECT_EQ(both.volume.half_width, 0.0);
}

/// Reports an odd number of crossings on every other line.
class OddSolid final : public Measurable {
  public:
    [[nodiscard]] Box3 box() const override { return {{0, 0, 0}, {1, 1, 1}}; }
    [[nodiscard]] Interval extent(const Vec3& axis) const override {
        return alhazen::extent(box(), axis);
    }
    void cross(const Ray&, bool, LineSpans& found) const override {
        found.spans.clear();
        found.cosines = 0;
        found.consistent = asked_.fetch_add(1) % 2 == 0;
    }
    [[nodiscard]] std::uint64_t asked() const { return asked_; }

  private:
    mutable std::atomic<std::uint64_t> asked_{0};
};

TEST(SolidMeasures, LinesWhoseCrossingsComeInNoPairsAreCountedInEveryRound) {
    const OddSolid odd;
    StratifiedChords bundle(odd, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {0.5, 0.5, 0.5}, 1);
    for (const std::uint64_t lines : {1024u, 2048u, 0u}) bundle.grow_to(lines);
    EXPECT_GT(odd.asked(), 4096u);
    EXPECT_EQ(bundle.inconsistent(), odd.asked() / 2);
}

/// Counts the lines that are traced for another solid.
class CountedSolid final : public Measurable {
  public:
    explicit CountedSolid(const Measurable& solid) : solid_(solid) {}
    [[nodiscard]] Box3 box() const override { return solid_.box(); }
    [[nodiscard]] Interval extent(const Vec3& axis) const override { return solid_.extent(axis); }
    void cross(const Ray& line, bool want_cosines, LineSpans& found) const override {
        ++asked_;
        solid_.cross(line, want_cosines, found);
    }
    [[nodiscard]] std::uint64_t asked() const { return asked_; }

  private:
    const Measurable& solid_;
    mutable std::atomic<std::uint64_t> asked_{0};
};

TEST(SolidMeasures, CentroidsByTheFewestLinesAreInTheirIntervals) {
    // Of the cells of the first lines only those along the hole scatter: the centroid's interval
    // has their few degrees of freedom.
    const OneSolid block(
        "difference { box { lo=(-1,-1,-1); hi=(1,1,1) } box { lo=(0.2,0.1,-2); hi=(0.6,0.5,2) } }");
    const OneSolid cone("cone { }");
    constexpr int kRuns = 200;
    int of_block = 0, of_cone = 0;
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
        const MeasureOptions few{.seconds = 0, .seed = seed};
        of_block += measure(block.solid, few).centroid[0].holds(-0.4 * 0.32 / 7.68);
        of_cone += measure(cone.solid, few).centroid[2].holds(0.25);
    }
    EXPECT_GE(of_block, kRuns * 85 / 100);
    EXPECT_GE(of_cone, kRuns * 90 / 100);
    EXPECT_LE(of_cone, kRuns * 99 / 100);
}

TEST(SolidMeasures, WithoutTimePilotsAreShortToo) {
    const LoneScene sphere(known_solids()[0]);
    const CountedSolid counted(sphere.solid);
    const SolidMeasures m = measure(counted, {.seconds = 0});
    EXPECT_LT(counted.asked(), 8000u);
    EXPECT_NEAR(m.volume.value, 32 * std::numbers::pi / 3, 2 * m.volume.half_width);
    EXPECT_FALSE(m.reached);
}

TEST(SolidMeasures, LimitsAreNumbersFromZero) {
    const LoneScene sphere(known_solids()[0]);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [&](const MeasureOptions& options) {
        const SectionPlane beside{.normal = {0, 0, 1}, .offset = 1e3};
        EXPECT_THROW((void)section_area(sphere.solid, beside, options), Error);
        try {
            (void)measure(sphere.solid, options);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const double seconds : {kNaN, -1.0, -kInfinity}) {
        EXPECT_NE(refused({.seconds = seconds}).find("the time limit is"), std::string::npos);
    }
    for (const double error : {kNaN, -1.0}) {
        EXPECT_NE(refused({.relative_error = error}).find("the relative error is"),
                  std::string::npos);
    }
    EXPECT_TRUE(measure(sphere.solid, {.relative_error = 1e-2, .seconds = kInfinity}).reached);
}

TEST(SolidMeasures, NothingHasNoMiddle) {
    SceneMaker maker;
    const ObjectIndex nothing = maker.object("nothing");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(Sphere{}, MaterialId{0}, {}, nothing);
    maker.add(Sphere{}, MaterialId{0}, {}, nothing);
    maker.add(nothing);
    const SolidList solids(maker.compile().aggregate);
    const SolidMeasures m = measure(IsolatedSolid(solids, SolidId{0}));
    EXPECT_EQ(m.volume.value, 0);
    EXPECT_FALSE(m.has_moments);
    EXPECT_TRUE(m.in_range);
}

TEST(SolidMeasures, NumbersThatOverflowOrVanishSaySo) {
    for (const double radius : {1e69, 1e-69, 1.0}) {
        SceneMaker maker;
        maker.add(Sphere{{0, 0, 0}, radius});
        const SolidList solids(maker.compile().aggregate);
        const SolidMeasures m =
            measure(IsolatedSolid(solids, SolidId{0}), {.relative_error = 1e-2, .seconds = 20});
        EXPECT_EQ(m.in_range, radius == 1.0) << radius;
        EXPECT_TRUE(m.has_moments) << radius;
        // The volume itself and its interval are finite.
        EXPECT_TRUE(m.volume.holds(4 * std::numbers::pi / 3 * radius * radius * radius)) << radius;
        EXPECT_GT(m.volume.half_width, 0) << radius;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
