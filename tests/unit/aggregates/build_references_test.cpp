// The references passed to the builders of the wide BVH have the boxes of the table.

#include "alhazen/aggregates/wide_bvh/leaves/build_references.h"

#include <gtest/gtest.h>

#include <cstring>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// Coordinates of many kinds: those that float holds, those that it does not, zeros of both signs,
/// the least numbers.
double odd_coordinate(RandomEngine& random, double size) {
    switch (random() % 6) {
        case 0:
            return 0.0;
        case 1:
            return -0.0;
        case 2:
            return size * static_cast<double>(static_cast<float>(uniform_point(random, 1).x));
        case 3:
            return (random() % 2 == 0 ? 1 : -1) * 1e-310;
        case 4:
            return size * 1e-42 * uniform_point(random, 1).x;
        default:
            return size * uniform_point(random, 1).x;
    }
}

PrimitiveTable odd_table(double size, const Vec3& shift, std::uint64_t seed) {
    RandomEngine random(seed);
    TableBuilder builder;
    const auto corner = [&] {
        const double x = odd_coordinate(random, size), y = odd_coordinate(random, size);
        return shift + Vec3{x, y, odd_coordinate(random, size)};
    };
    for (int i = 0; i < 3000; ++i) {
        const Vec3 a = corner(), b = corner(), c = corner();
        // None with equal corners: these are not bounded.
        if (a == b || b == c || c == a) continue;
        builder.add_triangle(a, b, c, i % 3 != 0);
        if (i % 100 == 0) builder.add_sphere(corner(), size * 0.01);
    }
    return builder.finish();
}

void expect_boxes_of_table(const PrimitiveTable& table, const std::string& name) {
    const BoundedPrimitives bounded(table);
    Box3 all;
    std::size_t count = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Box3 box = table.box(i);
        all.include(box);
        const bool is_bounded = !box.empty() && box.bounded() &&
                                max_component(abs(box.lo)) <= BoundedPrimitives::kReach &&
                                max_component(abs(box.hi)) <= BoundedPrimitives::kReach;
        if (!is_bounded) continue;
        ASSERT_LT(count, bounded.size()) << name;
        EXPECT_EQ(bounded.id(count++), i) << name;
    }
    ASSERT_EQ(bounded.size(), count) << name;
    EXPECT_EQ(bounded.all(), all) << name;
    const LocalFrame frame(all.bounded() ? all : Box3{{-1, -1, -1}, {1, 1, 1}});
    std::vector<BuildReference> references(count);
    make_references(table, bounded, frame, references);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t id = bounded.id(i);
        ASSERT_EQ(references[i].id, id) << name;
        ASSERT_EQ(references[i].kind,
                  static_cast<std::uint32_t>(leaf_type(table, PrimitiveId{id})));
        ASSERT_EQ(references[i].box(), frame.local(table.box(id))) << name << ", " << id;
    }
}

TEST(BuildReferences, HaveTheBoxesOfTheTableRoundedOutwards) {
    for (const double size : {1e-30, 1.0, 3e7, 1e100}) {
        for (const double shift : {0.0, -5.0, 1e5}) {
            const std::string name = std::to_string(size) + " at " + std::to_string(shift);
            expect_boxes_of_table(
                odd_table(size, {shift * size, -shift * size, 2 * shift * size}, 51), name);
        }
    }
}

TEST(BuildReferences, AreMadeOfWhatIsBounded) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0.5};
    const Vec3 odd[] = {a, b, {kInf, 0, 1}, {0, -kInf, 1}, {0, 0, 1e200}, {1e150, 0, 0}};
    for (const Vec3& corner : odd) {
        for (const int place : {0, 1, 2}) {
            TableBuilder builder;
            for (int i = 0; i < 20; ++i) {
                Vec3 corners[3] = {a, b, c};
                if (i == 7) corners[place] = corner;
                builder.add_triangle(corners[0], corners[1], corners[2], i % 2 == 0);
            }
            expect_boxes_of_table(builder.finish(), std::to_string(place));
        }
    }
}

/// Calls f(node's box, id) for every primitive in a leaf.
template <class F>
void for_primitives(const WideBvhLayout& layout, F&& f) {
    for (const WideNode& node : layout.tree.nodes) {
        for (std::uint32_t slot = 0; slot < node.child_count(); ++slot) {
            const NodeRef ref = node.child[slot];
            const auto visit = [&](const auto& blocks) {
                for (std::uint32_t i = 0; i < ref.count(); ++i) {
                    for (const BlockId id : blocks[ref.offset() + i].ids) {
                        if (id.used()) f(node.box(slot), id.id());
                    }
                }
            };
            if (!ref.is_leaf()) continue;
            switch (static_cast<LeafType>(ref.kind())) {
                case LeafType::Triangles:
                    visit(layout.triangles);
                    break;
                case LeafType::Spheres:
                    visit(layout.spheres);
                    break;
                default:
                    FAIL();
            }
        }
    }
}

/// The blocks of a tree are those of fill_block, and their boxes contain the triangles of the
/// table.
void expect_blocks_of_table(const PrimitiveTable& table, const std::string& name,
                            BuildQuality quality) {
    const BoundedPrimitives bounded(table);
    const WideBvhLayout layout = build_wide_bvh(table, bounded, {quality});
    for (const TriangleBlock& block : layout.triangles) {
        std::vector<PrimitiveId> ids;
        for (const BlockId id : block.ids) {
            if (id.used()) ids.push_back(id.id());
        }
        TriangleBlock expected;
        fill_block(expected, ids, table, layout.frame);
        ASSERT_EQ(std::memcmp(&block, &expected, sizeof(block)), 0) << name;
    }
    std::vector<int> seen(table.size());
    for_primitives(layout, [&](const FloatBox& box, PrimitiveId id) {
        ++seen[static_cast<std::uint32_t>(id)];
        FloatBox with = box;
        with.include(layout.frame.local(table.box(static_cast<std::uint32_t>(id))));
        EXPECT_EQ(with, box) << name << ", " << static_cast<std::uint32_t>(id);
    });
    for (std::size_t i = 0; i < bounded.size(); ++i) EXPECT_EQ(seen[bounded.id(i)], 1) << name;
}

TEST(BuildReferences, BlocksOfFastTreesHoldTheTableWithinTheirBoxes) {
    for (const double size : {1e-30, 1.0, 3e7, 1e100}) {
        for (const double shift : {0.0, -5.0, 1e5, 1e10}) {
            const std::string name = std::to_string(size) + " at " + std::to_string(shift);
            PrimitiveTable table =
                odd_table(size, {shift * size, -shift * size, 2 * shift * size}, 57);
            expect_blocks_of_table(table, name, BuildQuality::Fast);
            // A vertex without a triangle.
            TriangleMesh mesh = *table.meshes[0].mesh;
            mesh.positions.push_back({1e300, -1e300, 1e300});
            table.meshes[0].mesh = std::make_shared<TriangleMesh>(mesh);
            expect_blocks_of_table(table, name, BuildQuality::Fast);
        }
    }
}

PrimitiveTable table_of(TriangleMesh mesh) {
    PrimitiveTable table;
    table.meshes.push_back(
        {std::make_shared<TriangleMesh>(std::move(mesh)), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

/// Many triangles, `together` of them at a place and the others far away.
TriangleMesh groups_of_triangles(std::uint32_t count, std::uint32_t together) {
    RandomEngine random(61);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t group = i / together;
        const Vec3 place{group % 512 + 0.5, group / 512 + 0.5, 0};
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(place + uniform_point(random, 0.01));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

TEST(BuildReferences, BlocksOfLargeTreesAreMadeInTheRoomOfTheReferencesOrBeside) {
    constexpr std::uint32_t kCount = 1u << 20;
    for (const std::uint32_t together : {8u, 4u}) {
        const PrimitiveTable table = table_of(groups_of_triangles(kCount, together));
        const std::string name = std::to_string(together);
        expect_blocks_of_table(table, name, BuildQuality::Default);
        const WideBvhLayout layout = build_wide_bvh(table, BoundedPrimitives(table));
        // Full blocks leave room; those with half of the lanes in use need more.
        EXPECT_EQ(layout.triangles.capacity() > layout.triangles.size(), together == 8) << name;
        EXPECT_LT(layout.memory_bytes(), 112 * std::size_t{kCount}) << name;
    }
}

template <class T>
std::vector<std::byte> bytes_of(const MappableVector<T>& values) {
    const auto* const first = reinterpret_cast<const std::byte*>(values.data());
    return {first, first + values.size() * sizeof(T)};
}

/// A mesh alone, whose leaves are mostly not full, and several meshes and shapes.
std::vector<PrimitiveTable> tables_of_fast_trees() {
    std::vector<PrimitiveTable> tables;
    RandomEngine random(59);
    for (const std::size_t count : {1, 2, 5, 9, 700, 30000}) {
        TriangleMesh mesh;
        for (std::uint32_t i = 0; i < count; ++i) {
            // Some triangles have the same place on the curve.
            const Vec3 at = i % 7 == 0 ? Vec3{} : uniform_point(random, 1);
            for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + uniform_point(random, 0.01));
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        tables.push_back(table_of(std::move(mesh)));
    }
    tables.push_back(odd_table(1, {}, 60));
    return tables;
}

TEST(BuildReferences, FastTreesDependNeitherOnTheInstructionSetNorOnTheThreads) {
    for (const PrimitiveTable& table : tables_of_fast_trees()) {
        const std::string name = std::to_string(table.size());
        Box3 box;
        std::vector<std::byte> nodes, blocks, indices;
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride forced(target);
            for (const int threads : {0, 1}) {
                WideBvhLayout layout, indexed;
                ThreadLimit(threads).run([&] {
                    const BoundedPrimitives bounded(table);
                    if (blocks.empty()) box = bounded.all();
                    EXPECT_EQ(bounded.all(), box) << name << ", " << target;
                    layout = build_wide_bvh(table, bounded, {BuildQuality::Fast});
                    indexed = build_wide_bvh(
                        table, bounded, {BuildQuality::Fast, Precision::Robust, Leaves::Indices});
                });
                if (blocks.empty()) {
                    nodes = bytes_of(layout.tree.nodes);
                    blocks = bytes_of(layout.triangles);
                    indices = bytes_of(indexed.indices);
                }
                EXPECT_TRUE(bytes_of(layout.tree.nodes) == nodes) << name << ", " << target;
                EXPECT_TRUE(bytes_of(layout.triangles) == blocks) << name << ", " << target;
                EXPECT_TRUE(bytes_of(indexed.tree.nodes) == nodes) << name << ", " << target;
                EXPECT_TRUE(bytes_of(indexed.indices) == indices) << name << ", " << target;
            }
        }
    }
}

// Its references keep only their ids while leaves are made.
TEST(BuildReferences, BlocksOfALargeTableHoldItWithinTheirBoxes) {
    constexpr std::uint32_t kSide = 740;
    TriangleMesh mesh;
    RandomEngine random(58);
    for (std::uint32_t i = 0; i <= kSide; ++i) {
        for (std::uint32_t k = 0; k <= kSide; ++k) {
            mesh.positions.push_back(Vec3{double(i), double(k), 0} + uniform_point(random, 0.4));
        }
    }
    for (std::uint32_t i = 0; i < kSide; ++i) {
        for (std::uint32_t k = 0; k < kSide; ++k) {
            const std::uint32_t a = i * (kSide + 1) + k, b = a + kSide + 1;
            mesh.triangles.push_back({a, b, a + 1});
            mesh.triangles.push_back({b, b + 1, a + 1});
        }
    }
    PrimitiveTable table;
    table.meshes.push_back({std::make_shared<TriangleMesh>(mesh), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    expect_blocks_of_table(table, "grid", BuildQuality::Default);
}

// Blocks hold the spheres that float holds unrounded, and say which.
TEST(BuildReferences, BlocksHoldSpheresOfFloatUnrounded) {
    RandomEngine random(53);
    TableBuilder builder;
    const auto in_float = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    for (int i = 0; i < 300; ++i) {
        Vec3 center = uniform_point(random, 4);
        double radius = uniform(random, 0.01, 0.2);
        if (i % 3 != 1) center = {in_float(center.x), in_float(center.y), in_float(center.z)};
        if (i % 3 != 2) radius = in_float(radius);
        builder.add_sphere(center, radius);
    }
    const PrimitiveTable table = builder.finish();
    const auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns).shapes;
    const WideBvhLayout layout = build_wide_bvh(table, BoundedPrimitives(table));
    std::size_t count = 0;
    for (const SphereBlock& block : layout.spheres) {
        for (std::size_t lane = 0; lane < used_lanes(block); ++lane) {
            const std::size_t i = table.index(block.ids[lane].id());
            ASSERT_EQ(block.ids[lane].exact(), i % 3 == 0) << i;
            if (!block.ids[lane].exact()) continue;
            const Sphere held = block.sphere(lane, layout.frame);
            EXPECT_EQ(held.center, spheres[i].center);
            EXPECT_EQ(held.radius, spheres[i].radius);
            ++count;
        }
    }
    EXPECT_EQ(count, 100u);
}

TEST(BuildReferences, BoxesOfLeavesBuiltAlongACurveContainThoseOfTheTable) {
    for (const double size : {1e-30, 1.0, 3e7, 1e100}) {
        for (const double shift : {0.0, -5.0, 1e5}) {
            const PrimitiveTable table =
                odd_table(size, {shift * size, -shift * size, 2 * shift * size}, 52);
            const BoundedPrimitives bounded(table);
            const WideBvhLayout layout = build_wide_bvh(table, bounded, {BuildQuality::Fast});
            std::size_t count = 0;
            for_primitives(layout, [&](const FloatBox& box, PrimitiveId id) {
                const FloatBox its = layout.frame.local(table.box(static_cast<std::uint32_t>(id)));
                FloatBox both = box;
                both.include(its);
                ASSERT_EQ(both, box) << size << ", " << shift;
                ++count;
            });
            EXPECT_EQ(count, bounded.size());
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
