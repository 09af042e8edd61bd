#include <gtest/gtest.h>

#include <array>

#include "alhazen/base/error.h"
#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/primitives/surface.h"
#include "csg_random_trees.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::all_hits;
using testing::compiled;
using testing::expect_same_hits;
using testing::kEvaluators;
using testing::SceneMaker;

ObjectIndex solid(SceneMaker& maker, Combine combine) {
    const ObjectIndex object = maker.object("solid");
    maker.description().objects[static_cast<std::size_t>(object)].combine = combine;
    return object;
}

std::vector<double> ts(const Scene& scene, const Ray& half) {
    Ray ray = half;
    ray.t_min = -std::numeric_limits<double>::infinity();
    std::vector<double> result;
    for (const Hit& hit : all_hits(scene, ray)) result.push_back(hit.t);
    return result;
}

Ray random_line(RandomStream& random, double reach) {
    const auto point = [&] {
        return Vec3{random.uniform(-reach, reach), random.uniform(-reach, reach),
                    random.uniform(-reach, reach)};
    };
    const Vec3 origin = point();
    return {origin, point() - origin};
}

TEST(Csg, ADifferenceTurnsTheSurfaceOfWhatIsTakenAway) {
    for (const char* evaluator : kEvaluators) {
        SceneMaker maker;
        const ObjectIndex d = solid(maker, Combine::Difference);
        maker.material({});
        maker.add(BoxShape{{-2, -2, -2}, {2, 2, 2}}, MaterialId{0}, {}, d);
        maker.add(Sphere{{0, 0, 2}, 1}, maker.material({.name = "cut"}), {}, d);
        maker.add(d);
        const Scene scene = compiled(maker, evaluator);
        EXPECT_EQ(ts(scene, {{0, 0, 5}, {0, 0, -1}}), (std::vector<double>{4, 7}));
        const Ray down{{0, 0, 5}, {0, 0, -1}};
        Hit hit;
        ASSERT_TRUE(scene.aggregate->closest(down, hit, nullptr));
        const Surface surface = surface_at(*scene.aggregate, down, hit);
        EXPECT_EQ(surface.normal, (Vec3{0, 0, 1}));
        EXPECT_EQ(surface.materials[0], MaterialId{1});
    }
}

TEST(Csg, TheBoxOfAnIntersectionEndsWhereAHalfSpaceDoes) {
    SceneMaker maker;
    maker.material({});
    const ObjectIndex cap = solid(maker, Combine::Intersection);
    maker.add(Sphere{}, MaterialId{0}, {}, cap);
    maker.add(HalfSpace{{0, 0.25, 0}, {0, 1, 0}}, MaterialId{0}, {}, cap);
    maker.add(HalfSpace{{-0.5, 0, 0}, {-2, 0, 0}}, MaterialId{0}, {}, cap);
    maker.add(cap);
    const Box3 box = compiled(maker, kEvaluators[0]).aggregate->box();
    const Vec3 lo{-0.5, -1, -1}, hi{1, 0.25, 1};
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.lo[k], lo[k], 1e-14);
        EXPECT_NEAR(box.hi[k], hi[k], 1e-14);
        EXPECT_LE(box.lo[k], lo[k]);
        EXPECT_GE(box.hi[k], hi[k]);
    }
}

TEST(Csg, ARayMayBeginInside) {
    for (const char* evaluator : kEvaluators) {
        SceneMaker maker;
        const ObjectIndex d = solid(maker, Combine::Difference);
        maker.add(Sphere{{0, 0, 0}, 4}, MaterialId{0}, {}, d);
        maker.add(Sphere{{0, 0, 0}, 2}, MaterialId{0}, {}, d);
        maker.add(d);
        const Scene scene = compiled(maker, evaluator);
        const auto from = [&](double x) {
            std::vector<double> result;
            for (const Hit& h : all_hits(scene, {{x, 0, 0}, {1, 0, 0}})) result.push_back(h.t);
            return result;
        };
        EXPECT_EQ(from(0), (std::vector<double>{2, 4}));  // in the hollow
        EXPECT_EQ(from(3), (std::vector<double>{1}));     // in the shell
        EXPECT_EQ(from(-3), (std::vector<double>{1, 5, 7}));
        EXPECT_EQ(from(-4), (std::vector<double>{0, 2, 6, 8})) << "t_min itself counts";
    }
}

TEST(Csg, ASolidWithoutItselfIsNothingAndWithItselfIsItself) {
    for (const char* evaluator : kEvaluators) {
        for (int shape = 0; shape < 4; ++shape) {
            const AnyShape shapes[] = {Sphere{{0.1, 0.2, 0.3}, 1.1},
                                       BoxShape{{-1, -0.7, -0.4}, {0.3, 1, 1}},
                                       Cylinder{.base = {0, 0, -1}, .top = {0.3, 0.2, 1}},
                                       Cone{.base = {0, 0, -1}, .top = {0.3, 0.2, 1}}};
            const auto scene_of = [&](Combine combine, int count) {
                SceneMaker maker;
                const ObjectIndex o = solid(maker, combine);
                const Affine turned = Affine::rotate({1, 2, 3}, 0.7);
                for (int i = 0; i < count; ++i) {
                    maker.add(shapes[shape], MaterialId{0}, turned, o);
                }
                maker.add(o);
                return compiled(maker, evaluator);
            };
            const Scene nothing = scene_of(Combine::Difference, 2);
            const Scene once = scene_of(Combine::Union, 1);
            const Scene twice = scene_of(Combine::Union, 2);
            const Scene common = scene_of(Combine::Intersection, 3);
            RandomStream random(7);
            for (int i = 0; i < 200; ++i) {
                const Ray ray = random_line(random, 2);
                EXPECT_TRUE(ts(nothing, ray).empty());
                EXPECT_EQ(ts(once, ray), ts(twice, ray));
                EXPECT_EQ(ts(once, ray), ts(common, ray));
            }
        }
    }
}

/// a - (b + c) against (a - b) & (a - c), and the operands of n-ary operators in any order.
TEST(Csg, TheLawsOfSetsHoldToTheBit) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        RandomStream random(seed);
        SceneMaker parts;
        testing::RandomSolids makes(parts, random, seed % 2 == 1);
        std::array<ObjectIndex, 4> s{};
        for (ObjectIndex& o : s) o = makes.tree(3);
        using Order = std::array<int, 4>;
        const auto scene_of = [&](auto build, Order order) {
            SceneMaker maker = parts;
            std::array<ObjectIndex, 4> sorted{};
            for (int i = 0; i < 4; ++i) {
                sorted[static_cast<std::size_t>(i)] =
                    s[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
            }
            maker.add(build(maker, sorted));
            return compiled(maker, kEvaluators[seed % 3 == 0]);
        };
        const auto combined = [](SceneMaker& m, Combine combine, std::vector<ObjectIndex> of) {
            const ObjectIndex o = solid(m, combine);
            for (const ObjectIndex part : of) m.add(part, MaterialId{0}, {}, o);
            return o;
        };
        const auto left = [&](SceneMaker& m, const auto& o) {
            return combined(m, Combine::Difference,
                            {o[0], combined(m, Combine::Union, {o[1], o[2], o[3]})});
        };
        const auto right = [&](SceneMaker& m, const auto& o) {
            return combined(m, Combine::Intersection,
                            {combined(m, Combine::Difference, {o[0], o[1]}),
                             combined(m, Combine::Difference, {o[0], o[2], o[3]})});
        };
        const auto any = [&](SceneMaker& m, const auto& o) {
            return combined(m, Combine::Union, {o[0], o[1], o[2], o[3]});
        };
        const auto all = [&](SceneMaker& m, const auto& o) {
            return combined(m, Combine::Intersection, {o[0], o[1], o[2], o[3]});
        };
        const std::array<std::pair<Scene, Scene>, 4> pairs{
            {{scene_of(left, {0, 1, 2, 3}), scene_of(right, {0, 1, 2, 3})},
             {scene_of(left, {0, 1, 2, 3}), scene_of(left, {0, 3, 2, 1})},
             {scene_of(any, {0, 1, 2, 3}), scene_of(any, {2, 0, 3, 1})},
             {scene_of(all, {0, 1, 2, 3}), scene_of(all, {3, 2, 1, 0})}}};
        for (int i = 0; i < 60; ++i) {
            const Ray ray = makes.ray();
            for (std::size_t p = 0; p < pairs.size(); ++p) {
                const std::vector<double> a = ts(pairs[p].first, ray);
                const std::vector<double> b = ts(pairs[p].second, ray);
                ASSERT_EQ(a.size(), b.size()) << "seed " << seed << " ray " << i << " law " << p;
                // Where surfaces coincide another one may be reported, at the same t up to
                // rounding.
                for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-11);
            }
        }
    }
}

/// Unit cubes on the integer lattice; the reference result is a set of voxels.
class Voxels {
  public:
    static constexpr int kSide = 4;
    std::array<bool, kSide * kSide * kSide> full{};
    bool& at(int x, int y, int z) {
        return full[static_cast<std::size_t>((z * kSide + y) * kSide + x)];
    }
};

struct VoxelTree {
    SceneMaker& maker;
    RandomStream& random;

    int below(int n) { return static_cast<int>(random.below(static_cast<std::uint64_t>(n))); }

    Voxels add_box(ObjectIndex owner) {
        int lo[3], hi[3];
        for (int k = 0; k < 3; ++k) {
            lo[k] = below(Voxels::kSide);
            hi[k] = lo[k] + 1 + below(Voxels::kSide - lo[k]);
        }
        // Some cubes are transformed unit cubes.
        if (below(2) == 0) {
            maker.add(BoxShape{{double(lo[0]), double(lo[1]), double(lo[2])},
                               {double(hi[0]), double(hi[1]), double(hi[2])}},
                      MaterialId{0}, {}, owner);
        } else {
            maker.add(BoxShape{{0, 0, 0}, {1, 1, 1}}, MaterialId{0},
                      Affine::translate({double(lo[0]), double(lo[1]), double(lo[2])}) *
                          Affine::scale({double(hi[0] - lo[0]), double(hi[1] - lo[1]),
                                         double(hi[2] - lo[2])}),
                      owner);
        }
        Voxels v;
        for (int z = lo[2]; z < hi[2]; ++z) {
            for (int y = lo[1]; y < hi[1]; ++y) {
                for (int x = lo[0]; x < hi[0]; ++x) v.at(x, y, z) = true;
            }
        }
        return v;
    }

    Voxels add_tree(ObjectIndex owner, int depth) {
        const Combine kinds[] = {Combine::Union, Combine::Intersection, Combine::Difference};
        const Combine combine = kinds[below(3)];
        const ObjectIndex object = solid(maker, combine);
        Voxels sum;
        const int operands = 2 + below(3);
        for (int i = 0; i < operands; ++i) {
            const bool is_tree = depth > 0 && below(2) == 0;
            const Voxels v = is_tree ? add_tree(object, depth - 1) : add_box(object);
            for (std::size_t k = 0; k < v.full.size(); ++k) {
                if (i == 0) {
                    sum.full[k] = v.full[k];
                } else if (combine == Combine::Union) {
                    sum.full[k] = sum.full[k] || v.full[k];
                } else if (combine == Combine::Intersection) {
                    sum.full[k] = sum.full[k] && v.full[k];
                } else {
                    sum.full[k] = sum.full[k] && !v.full[k];
                }
            }
        }
        maker.add(object, MaterialId{0}, {}, owner);
        return sum;
    }
};

TEST(Csg, CubesOnALatticeAreExactVoxels) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        RandomStream random(seed);
        SceneMaker maker;
        VoxelTree tree{maker, random};
        Voxels truth = tree.add_tree(ObjectIndex{0}, 3);
        const Scene scenes[] = {compiled(maker, "event_heap"), compiled(maker, "roth")};
        for (int axis = 0; axis < 3; ++axis) {
            for (int cell = 0; cell < Voxels::kSide * Voxels::kSide; ++cell) {
                const int i = cell % Voxels::kSide, j = cell / Voxels::kSide;
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                Ray ray{{0, 0, 0}, {0, 0, 0}};
                ray.origin[axis] = -1.0;
                ray.origin[u] = i + 0.5;
                ray.origin[v] = j + 0.25;
                ray.direction[axis] = 1.0;
                std::vector<double> expected;
                bool before = false;
                for (int k = 0; k <= Voxels::kSide; ++k) {
                    int p[3];
                    p[axis] = k;
                    p[u] = i;
                    p[v] = j;
                    const bool now = k < Voxels::kSide && truth.at(p[0], p[1], p[2]);
                    if (now != before) expected.push_back(k + 1.0);
                    before = now;
                }
                for (const Scene& scene : scenes) {
                    ASSERT_EQ(ts(scene, ray), expected)
                        << "seed " << seed << " axis " << axis << " cell " << cell;
                }
            }
        }
    }
}

TEST(Csg, ClosedMeshesAndSharedObjectsAreOperands) {
    for (const char* evaluator : kEvaluators) {
        for (const char* accelerator : {"list", "wide_bvh"}) {
            SceneMaker maker;
            TriangleMesh inward = testing::tetrahedron();
            for (auto& t : inward.triangles) std::swap(t[1], t[2]);
            const ObjectIndex shared = maker.object("shared");  // a group: the union of its parts
            maker.add(maker.mesh(testing::tetrahedron()), MaterialId{0}, {}, shared);
            maker.add(Sphere{{0, 0, 0}, 0.8}, MaterialId{0}, {}, shared);
            const ObjectIndex d = solid(maker, Combine::Difference);
            maker.add(BoxShape{{-3, -1, -1}, {3, 1, 1}}, MaterialId{0}, {}, d);
            maker.add(shared, MaterialId{0}, Affine::translate({-2, 0, 0}), d);
            maker.add(shared, MaterialId{0},
                      Affine::translate({2, 0, 0}) * Affine::scale({-1, 1, 1}), d);
            maker.add(maker.mesh(inward), MaterialId{0}, {}, d);
            maker.add(d);
            const Scene scene = compiled(maker, evaluator, accelerator);
            EXPECT_EQ(scene.census.solids, 2u);
            RandomStream random(3);
            int with_hits = 0;
            for (int i = 0; i < 300; ++i) {
                Ray ray = random_line(random, 3);
                ray.t_min = -std::numeric_limits<double>::infinity();
                const std::vector<Hit> hits = all_hits(scene, ray);
                ASSERT_EQ(hits.size() % 2, 0u);
                with_hits += hits.size() > 2;
                testing::expect_outward_normals(scene, ray, hits, std::to_string(i));
            }
            EXPECT_GT(with_hits, 50);
            // Here the tetrahedra span 0.8 along x; two of them touch at x = 1 without an internal
            // wall.
            const std::vector<double> x = ts(scene, {{-10, 0.6, 0.6}, {1, 0, 0}});
            const double expected[] = {7, 8.2, 9, 10.2, 11.8, 13};
            ASSERT_EQ(x.size(), std::size(expected));
            for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], expected[i], 1e-12);
        }
    }
}

TEST(Csg, NestingThatIsNotInstancedHasNoLimitOfItsOwn) {
    SceneMaker maker;
    ObjectIndex outer = solid(maker, Combine::Difference);
    maker.add(outer);
    for (int i = 0; i < 200; ++i) {
        const double r = 300.0 - i;
        maker.add(Sphere{{0, 0, 0}, r}, MaterialId{0}, {}, outer);
        const ObjectIndex inner = solid(maker, Combine::Difference);
        maker.add(inner, MaterialId{0}, {}, outer);
        outer = inner;
    }
    maker.add(Sphere{{0, 0, 0}, 50}, MaterialId{0}, {}, outer);
    for (const char* evaluator : kEvaluators) {
        // Nested spheres: in at 300, out at 299, ...
        const std::vector<double> t = ts(compiled(maker, evaluator), {{-400, 0, 0}, {1, 0, 0}});
        ASSERT_EQ(t.size(), 2u * 201u);
        for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(t[i], 100.0 + static_cast<double>(i));
    }
}

TEST(Csg, ShadowsKnowWhatIsOpaque) {
    for (const char* evaluator : kEvaluators) {
        SceneMaker maker;
        Material glass;
        glass.transmissive.color = {1, 1, 1};
        const ObjectIndex d = solid(maker, Combine::Difference);
        maker.material(glass);
        maker.add(Sphere{{0, 0, 0}, 2}, MaterialId{0}, {}, d);
        maker.add(BoxShape{{-3, -3, 0}, {3, 3, 3}}, maker.material({}), {}, d);
        maker.add(d);
        const Scene scene = compiled(maker, evaluator);
        std::vector<Hit> crossings;
        // Sideways only through glass; downward through the opaque cut.
        EXPECT_FALSE(scene.aggregate->shadowed({{-5, 0, -1}, {1, 0, 0}}, crossings, nullptr));
        EXPECT_EQ(crossings.size(), 2u);
        EXPECT_TRUE(scene.aggregate->shadowed({{0, 0, 5}, {0, 0, -1}}, crossings, nullptr));
        crossings.clear();
        EXPECT_FALSE(scene.aggregate->shadowed({{0, 0, 5}, {0, 0, -1}, 0, 4}, crossings, nullptr));
        EXPECT_TRUE(crossings.empty());
    }
}

TEST(Csg, AnOperandThatRaysDoNotSeeIsEmptyToThem) {
    for (const char* evaluator : kEvaluators) {
        PrimitiveTable table;
        auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns);
        for (const double radius : {2.0, 1.0}) {
            spheres.shapes.push_back({{0, 0, 0}, radius});
            spheres.placements.push_back(kNoPlacement);
            spheres.materials.push_back(MaterialId{0});
        }
        spheres.visible_to = {kAllRays, 1};
        table.material_opacity = {Opacity::Opaque};
        table.finish();
        CsgExpression expression;
        expression.nodes = {{Combine::Difference, {CsgOperand::leaf(0), CsgOperand::leaf(1)}}};
        expression.leaves = {PrimitiveId{0}, PrimitiveId{1}};
        const CsgAggregate ball(std::move(table), std::move(expression), evaluator);
        std::vector<Hit> hits;
        ball.all_hits({{-5, 0, 0}, {1, 0, 0}}, hits, {nullptr, 1});
        EXPECT_EQ(hits.size(), 4u);
        hits.clear();
        ball.all_hits({{-5, 0, 0}, {1, 0, 0}}, hits, {nullptr, 2});
        EXPECT_EQ(hits.size(), 2u);
    }
}

TEST(Csg, UnknownEvaluatorsAreUsageErrorsWithTheNames) {
    SceneMaker maker;
    maker.material({});
    try {
        (void)compile(maker.description(), {.csg = "none"});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        EXPECT_NE(std::string(error.what()).find("event_heap, roth"), std::string::npos);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
