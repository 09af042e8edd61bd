#include "alhazen/aggregates/wide_bvh/wide_bvh_file.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/base/checksum.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "support/scene_maker.h"
#include "support/scratch_folder.h"
#include "unit/aggregates/random_tables.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using testing::RandomEngine;
using testing::ScratchFolder;
using testing::TableBuilder;
using testing::uniform;
using testing::uniform_point;

// Offsets of the format that the tests modify.
constexpr std::size_t kHeader = 512, kCounts = 32, kElementBytes = 160, kArrays = 16, kFlag = 304;

/// A table with as many boxes as discs.
PrimitiveTable table_of(int triangles, int spheres, int discs, int planes, std::uint64_t seed = 1) {
    RandomEngine random(seed);
    TableBuilder builder;
    const auto near = [&](const Vec3& p) { return p + uniform_point(random, 0.4); };
    for (int i = 0; i < triangles; ++i) {
        const Vec3 p = uniform_point(random, 2);
        builder.add_triangle(near(p), near(p), near(p), i % 3 != 0);
    }
    for (int i = 0; i < spheres; ++i) builder.add_sphere(uniform_point(random, 2), 0.2, i % 2 == 0);
    auto& column = std::get<ShapeColumn<Disc>>(builder.table.columns);
    for (int i = 0; i < discs; ++i) {
        column.shapes.push_back({});
        column.shapes.back().center = uniform_point(random, 2);
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{0});
    }
    auto& boxes = std::get<ShapeColumn<BoxShape>>(builder.table.columns);
    for (int i = 0; i < discs; ++i) {
        const Vec3 p = uniform_point(random, 2);
        boxes.shapes.push_back({.lo = p, .hi = p + Vec3{0.1, 0.2, 0.3}});
        boxes.placements.push_back(kNoPlacement);
        boxes.materials.push_back(MaterialId{0});
    }
    for (int i = 0; i < planes; ++i) builder.add_plane({0, 0, -3.0 - i}, {0, 0, 1});
    return builder.finish();
}

std::vector<Ray> rays_through(std::uint64_t seed, int count) {
    RandomEngine random(seed);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        rays.push_back({uniform_point(random, 3), uniform_point(random, 1)});
    }
    return rays;
}

/// Returns the reason why a file is not loaded; empty if it is.
std::string refusal(const PrimitiveTable& table, const std::filesystem::path& path) {
    try {
        (void)load_wide_bvh(path, table);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::File);
        return error.what();
    }
    return {};
}

/// Recomputes the checksum.
void reseal(std::string& bytes) {
    Checksum sum;
    const std::span all(reinterpret_cast<const std::byte*>(bytes.data()), bytes.size());
    sum.add(all.first(kHeader - 8));
    std::size_t at = kHeader;
    for (std::size_t i = 0; i < kArrays; ++i) {
        std::uint64_t count;
        std::uint32_t element;
        std::memcpy(&count, &bytes[kCounts + 8 * i], 8);
        std::memcpy(&element, &bytes[kElementBytes + 4 * i], 4);
        const std::size_t size = count * element;
        if (count > bytes.size() || at + size > bytes.size())
            return;  // rejected before the checksum is examined
        sum.add(all.subspan(at, size));
        at += (size + 255) / 256 * 256;
    }
    const std::uint64_t value = sum.value();
    std::memcpy(&bytes[kHeader - 8], &value, 8);
}

bool same_hit(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.primitive == b.primitive;
}

TEST(WideBvhFile, LoadedTreesGiveTheSameHits) {
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    for (const PrimitiveTable& table :
         {table_of(0, 0, 0, 0), table_of(1, 0, 0, 0), table_of(0, 1, 0, 0), table_of(0, 0, 1, 2),
          table_of(0, 0, 0, 1), table_of(3000, 300, 100, 2)}) {
        const WideBvhAggregate built(table);
        built.save(path);
        const auto loaded = WideBvhAggregate::load(table, path);
        EXPECT_EQ(loaded->box(), built.box());
        EXPECT_TRUE(loaded->layout().tree.nodes.is_mapped());
        EXPECT_TRUE(loaded->layout().triangles.is_mapped());
        EXPECT_EQ(loaded->layout().tree.nodes.size(), built.layout().tree.nodes.size());
        for (const Ray& ray : rays_through(2, 500)) {
            Hit one, other;
            ASSERT_EQ(built.closest(ray, one, nullptr), loaded->closest(ray, other, nullptr));
            ASSERT_TRUE(same_hit(one, other));
            ASSERT_EQ(built.occluded(ray, nullptr), loaded->occluded(ray, nullptr));
            std::vector<Hit> all, all_loaded;
            built.all_hits(ray, all, nullptr);
            loaded->all_hits(ray, all_loaded, nullptr);
            ASSERT_TRUE(std::ranges::equal(all, all_loaded, same_hit));
        }
    }
}

TEST(WideBvhFile, TheSameTreeMakesTheSameFile) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(200, 20, 10, 1);
    WideBvhAggregate(table).save(folder.path() / "one");
    WideBvhAggregate::load(table, folder.path() / "one")->save(folder.path() / "two");
    EXPECT_EQ(read_file(folder.path() / "one"), read_file(folder.path() / "two"));
}

TEST(WideBvhFile, EveryFlippedBitIsNoticed) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(9, 2, 1, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table).save(path);
    std::string bytes = read_file(path);
    ASSERT_GT(bytes.size(), 1500u);
    ASSERT_LT(bytes.size(), 8000u);
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const auto put = [&](std::size_t i, char byte) {
        file.seekp(std::streamoff(i)).put(byte).flush();
    };
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            put(i, char(bytes[i] ^ 1 << bit));
            ASSERT_NE(refusal(table, path), "") << "bit " << bit << " of byte " << i;
        }
        put(i, bytes[i]);
    }
    EXPECT_EQ(refusal(table, path), "");
}

TEST(WideBvhFile, EveryOtherLengthIsRefused) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(20, 3, 2, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table).save(path);
    const std::string bytes = read_file(path);
    for (const std::size_t more : {1u, 255u, 256u, 4096u}) {
        EXPECT_NE(refusal(table, folder.write("long", bytes + std::string(more, '\0'))), "");
    }
    for (std::size_t length = bytes.size(); length-- > 0;) {
        std::filesystem::resize_file(path, length);
        ASSERT_NE(refusal(table, path), "") << length;
    }
}

TEST(WideBvhFile, OtherGeometryIsRefused) {
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    const auto changed = [](const std::function<void(PrimitiveTable&, TriangleMesh&)>& change) {
        PrimitiveTable table = table_of(50, 5, 5, 1);
        auto mesh = std::make_shared<TriangleMesh>(*table.meshes[0].mesh);
        change(table, *mesh);
        table.meshes[0].mesh = mesh;
        table.finish();
        return table;
    };
    WideBvhAggregate(table_of(50, 5, 5, 1)).save(path);
    EXPECT_EQ(refusal(changed([](auto&, auto&) {}), path), "");
    const std::function<void(PrimitiveTable&, TriangleMesh&)> changes[] = {
        [](auto&, auto& mesh) { mesh.positions[7].y = std::nextafter(mesh.positions[7].y, 9); },
        [](auto&, auto& mesh) { std::swap(mesh.triangles[3][0], mesh.triangles[3][1]); },
        [](auto&, auto& mesh) { mesh.triangles.pop_back(); },
        [](auto& table, auto&) { table.meshes.pop_back(); },
        [](auto& table, auto&) { std::swap(table.meshes[0].material, table.meshes[1].material); },
        [](auto& table, auto&) {
            double& r = std::get<ShapeColumn<Sphere>>(table.columns).shapes[2].radius;
            r = std::nextafter(r, 9);
        },
        [](auto& table, auto&) {
            std::get<ShapeColumn<Disc>>(table.columns).shapes[2].center.x += 1e-9;
        },
        [](auto& table, auto&) {
            std::get<ShapeColumn<Disc>>(table.columns).materials[2] = MaterialId{1};
        },
        [](auto& table, auto&) {
            std::get<ShapeColumn<Plane>>(table.columns).shapes[0].normal = {0, 1, 1};
            std::get<ShapeColumn<Plane>>(table.columns).shapes.push_back({});
            std::get<ShapeColumn<Plane>>(table.columns).placements.push_back(kNoPlacement);
            std::get<ShapeColumn<Plane>>(table.columns).materials.push_back(MaterialId{0});
        },
    };
    std::size_t number = 0;
    for (const auto& change : changes) {
        EXPECT_NE(refusal(changed(change), path).find("other geometry"), std::string::npos)
            << number;
        ++number;
    }
}

TEST(WideBvhFile, SolidsThatOtherSpheresHoldAreRefused) {
    // Solids with equal boxes; for one the leaves store a smaller ball.
    const auto solids = [](Combine combine) {
        testing::SceneMaker maker;
        maker.material({});
        const ObjectIndex object = maker.object("solid");
        maker.description().objects[static_cast<std::size_t>(object)].combine = combine;
        maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, MaterialId{0}, {}, object);
        maker.add(Sphere{{0, 0, 0}, 1.1}, MaterialId{0}, {}, object);
        for (const double x : {-3.0, 3.0}) {
            maker.add(object, MaterialId{0}, Affine::translate({x, 0, 0}));
        }
        return maker.compile().aggregate->primitives();
    };
    const ScratchFolder folder;
    const auto path = folder.path() / "tree";
    const PrimitiveTable rounded = solids(Combine::Intersection);
    WideBvhAggregate(rounded).save(path);
    EXPECT_EQ(refusal(rounded, path), "");
    const PrimitiveTable hollow = solids(Combine::Difference);
    EXPECT_EQ(rounded.box(0), hollow.box(0));
    EXPECT_LT(rounded.sphere(0).radius, hollow.sphere(0).radius);
    EXPECT_NE(refusal(hollow, path).find("other geometry"), std::string::npos);
}

/// Saves a modified tree with a valid checksum.
std::string forged(const std::function<void(StoredWideBvh&)>& forge,
                   const BuildOptions& options = {}) {
    const ScratchFolder folder;
    // So many spheres have blocks of their own.
    const PrimitiveTable table = table_of(200, 100, 10, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table, options).save(path);
    StoredWideBvh tree = load_wide_bvh(path, table);
    forge(tree);
    save_wide_bvh(path, tree.layout, tree.box, tree.unbounded, table, tree.precision);
    return refusal(table, path);
}

/// Frees the first lane of a block with at least two used lanes.
template <class Blocks>
void free_first_lane(Blocks& blocks) {
    for (auto& block : blocks) {
        if (used_lanes(block) < 2) continue;
        block.ids[0] = BlockId::none();
        return;
    }
    throw Error(ErrorKind::Usage, "no block of two");
}

TEST(WideBvhFile, ReferencesThatLeadNowhereAreRefused) {
    EXPECT_EQ(forged([](auto&) {}), "");
    const auto slot_of = [](StoredWideBvh& t, bool leaf) -> NodeRef& {
        for (WideNode& node : t.layout.tree.nodes) {
            for (std::size_t i = 0; i < node.child_count(); ++i) {
                if (node.child[i].is_leaf() == leaf) return node.child[i];
            }
        }
        throw Error(ErrorKind::Usage, "no such slot");
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::function<void(StoredWideBvh&)> forgeries[] = {
        [&](auto& t) { slot_of(t, false) = NodeRef::node(0); },
        [&](auto& t) { slot_of(t, false) = NodeRef::node(1u << 30); },
        [&](auto& t) {
            slot_of(t, false) = NodeRef::node(std::uint32_t(t.layout.tree.nodes.size()));
        },
        [&](auto& t) { slot_of(t, true) = NodeRef::none(); },
        [&](auto& t) { slot_of(t, true) = NodeRef::leaf(0, NodeRef::kMaxOffset, 1); },
        [&](auto& t) {
            const auto last = static_cast<std::uint32_t>(t.layout.triangles.size() - 1);
            slot_of(t, true) = NodeRef::leaf(0, last, 2);
        },
        [&](auto& t) { slot_of(t, true) = slot_of(t, false); },
        [](auto& t) { t.layout.tree.root = NodeRef::node(77777); },
        [](auto& t) { t.layout.tree.root = NodeRef::none(); },
        [](auto& t) { t.layout.tree.nodes[0].order[3] = 0; },
        [](auto& t) { t.layout.tree.nodes.resize(1); },
        [](auto& t) {
            t.layout.triangles[0].ids[0] = {PrimitiveId{0}, true, false};
        },
        [](auto& t) {
            t.layout.triangles[1].ids[0] = {PrimitiveId{5000}, true, false};
        },
        [](auto& t) {
            t.layout.spheres[0].ids[0] = {PrimitiveId{120}, true, false};
        },
        [](auto& t) { t.layout.spheres[0].lanes |= 1u << 20; },
        [](auto& t) { t.layout.spheres[0].lanes = 0; },
        [](auto& t) { free_first_lane(t.layout.triangles); },
        [](auto& t) { t.layout.tree.nodes[0].set_box(0, FloatBox{}); },
        [](auto& t) {
            t.layout.others[0].ids[0] = {PrimitiveId{5000}, true, false};
        },
        [](auto& t) {
            t.layout.frustums[0].ids[0] = {PrimitiveId{0}, true, false};
        },
        [](auto& t) { t.layout.frustums[0].lanes = 0; },
        [](auto& t) { t.layout.frustums[0].balls = 1; },
        [](auto& t) { t.layout.frustums[0].certain = 1; },
        [](auto& t) { t.unbounded[0] = PrimitiveId{5000}; },
        [&](auto& t) { t.layout.frame.scale = nan; },
        [&](auto& t) { t.layout.frame.inverse_scale = 3; },
        [&](auto& t) { t.layout.frame.center.y = nan; },
    };
    std::size_t number = 0;
    for (const auto& forge : forgeries) {
        EXPECT_NE(forged(forge).find("not sound"), std::string::npos) << number;
        ++number;
    }
}

TEST(WideBvhFile, FreeLanesBeforeOthersAreRefusedInLeavesOfNumbers) {
    const BuildOptions options{.leaves = Leaves::Indices};
    EXPECT_EQ(forged([](auto&) {}, options), "");
    const auto free_first = [](auto& t) { free_first_lane(t.layout.indices); };
    EXPECT_NE(forged(free_first, options).find("not sound"), std::string::npos);
}

TEST(WideBvhFile, CountsThatAreTooLargeAreRefused) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(20, 3, 2, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table).save(path);
    const std::string bytes = read_file(path);
    for (std::size_t array = 0; array < kArrays; ++array) {
        for (const std::uint64_t count : {std::uint64_t{1} << 63, ~std::uint64_t{0},
                                          std::uint64_t{1} << 56, std::uint64_t{99}}) {
            std::string forged = bytes;
            std::memcpy(&forged[kCounts + 8 * array], &count, 8);
            reseal(forged);
            EXPECT_NE(refusal(table, folder.write("forged", forged)), "") << array;
        }
    }
}

TEST(WideBvhFile, AFlagOfNeitherYesNorNoIsRefused) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(20, 3, 2, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table).save(path);
    const std::string bytes = read_file(path);
    ASSERT_EQ(bytes.at(kFlag), 1);
    for (int value = 0; value < 256; ++value) {
        if (value == 1) continue;
        std::string forged = bytes;
        forged[kFlag] = static_cast<char>(value);
        reseal(forged);
        EXPECT_NE(refusal(table, folder.write("forged", forged)).find("not sound"),
                  std::string::npos)
            << value;
    }
}

TEST(WideBvhFile, WhatPassesCanBeTraced) {
    const ScratchFolder folder;
    const PrimitiveTable table = table_of(60, 10, 5, 1);
    const auto path = folder.path() / "tree";
    WideBvhAggregate(table).save(path);
    const std::string bytes = read_file(path);
    const std::vector<Ray> rays = rays_through(3, 40);
    RandomEngine random(11);
    int passed = 0;
    for (int round = 0; round < 2000; ++round) {
        std::string forged = bytes;
        for (int k = testing::uniform_int(random, 1, 3); k > 0; --k) {
            const auto i = std::size_t(testing::uniform_int(random, 0, int(bytes.size()) - 1));
            forged[i] = char(random());
        }
        reseal(forged);
        // Written in place: truncating and rewriting a file would wait for the disk.
        std::fstream(path, std::ios::binary | std::ios::in | std::ios::out) << forged;
        if (!refusal(table, path).empty()) continue;
        ++passed;
        const auto loaded = WideBvhAggregate::load(table, path);
        std::vector<Hit> hits(rays.size());
        loaded->closest_batch(rays, hits, nullptr);
        for (const Ray& ray : rays) {
            Hit hit;
            (void)loaded->closest(ray, hit, nullptr);
            (void)loaded->occluded(ray, nullptr);
            loaded->all_hits(ray, hits, nullptr);
        }
    }
    EXPECT_GT(passed, 200) << "the checks refuse what is only wrong, not unsafe";
    EXPECT_LT(passed, 1950);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
