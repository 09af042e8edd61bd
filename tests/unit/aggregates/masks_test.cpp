#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "support/scratch_folder.h"
#include "support/thorough.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

constexpr RayMask kMasks[] = {1, 2, 4, 3, 0x80000000u, 0, kAllRays};

RayMask random_mask(RandomEngine& random) {
    constexpr RayMask kVisible[] = {1, 2, 3, 4, 6, 0, kAllRays, 0x80000001u};
    return kVisible[random() % 8];
}

/// Gives every mesh, shape and instance a mask; splits meshes into small ones first.
void mask_all(PrimitiveTable& table, RandomEngine& random) {
    std::vector<PlacedMesh> pieces;
    for (const PlacedMesh& placed : table.meshes) {
        const auto& triangles = placed.mesh->triangles;
        for (std::size_t begin = 0; begin < triangles.size();) {
            const std::size_t end = std::min(triangles.size(), begin + 1 + random() % 9);
            auto piece = std::make_shared<TriangleMesh>();
            piece->positions = placed.mesh->positions;
            piece->triangles.assign(triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                                    triangles.begin() + static_cast<std::ptrdiff_t>(end));
            pieces.push_back({piece, placed.material, 0, placed.mirrored, 0, random_mask(random)});
            begin = end;
        }
    }
    table.meshes = std::move(pieces);
    const auto mask_column = [&](auto& column) {
        for (std::size_t i = 0; i < column.shapes.size(); ++i) {
            column.visible_to.push_back(random_mask(random));
        }
    };
    std::apply([&](auto&... column) { (mask_column(column), ...); }, table.columns);
    for (Instance& instance : table.instances) instance.visible_to = random_mask(random);
    table.finish();
}

/// Mask of a primitive, read from the columns independently of the table's own lookup.
RayMask mask_in_columns(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id), i = table.index(id);
    if (kind == kInstanceKind) return table.instances[i].visible_to;
    if (kind == kTriangleKind) return table.mesh_of(i).visible_to;
    RayMask mask = kAllRays;
    std::uint32_t k = 0;
    const auto look = [&](const auto& column) {
        if (k++ == kind && i < column.visible_to.size()) mask = column.visible_to[i];
    };
    std::apply([&](const auto&... column) { (look(column), ...); }, table.columns);
    return mask;
}

const PrimitiveTable& innermost(const Aggregate& aggregate, const Hit& hit) {
    const PrimitiveTable* table = &aggregate.primitives();
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        table = &table->instances[table->index(hit.path[level])].aggregate->primitives();
    }
    return *table;
}

bool is_seen(const Aggregate& aggregate, const Hit& hit, RayMask mask) {
    const PrimitiveTable* table = &aggregate.primitives();
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        if ((mask_in_columns(*table, hit.path[level]) & mask) == 0) return false;
        table = &table->instances[table->index(hit.path[level])].aggregate->primitives();
    }
    return (mask_in_columns(*table, hit.primitive) & mask) != 0;
}

/// Expected results, derived from all hits of the same primitives without masks.
Answer expected(const std::vector<Hit>& unmasked, const Aggregate& masked, RayMask mask) {
    Answer answer;
    for (const Hit& hit : unmasked) {
        if (!is_seen(masked, hit, mask)) continue;
        answer.all.push_back(hit);
        answer.shadowed = answer.shadowed || innermost(masked, hit).is_opaque(hit.primitive);
    }
    answer.found = answer.occluded = !answer.all.empty();
    if (answer.found) answer.closest = answer.all.front();
    if (!answer.shadowed) answer.crossings = answer.all;
    return answer;
}

/// Compares all batch queries, and packets even if the aggregate would not choose them.
void compare_batches(const Aggregate& tested, const std::vector<Ray>& rays,
                     const std::vector<Answer>& answers, RayMask mask, const std::string& name) {
    const std::size_t n = rays.size();
    const auto room = std::make_unique<bool[]>(n);
    const std::span<bool> occluded(room.get(), n);
    std::vector<Hit> hits(n);
    const auto check = [&](const std::string& how) {
        for (std::size_t i = 0; i < n; ++i) {
            ASSERT_TRUE(same(hits[i], answers[i].closest))
                << name << ", " << how << ", ray " << i << ": " << show(rays[i]) << ": "
                << show(answers[i].closest) << " became " << show(hits[i]);
            ASSERT_EQ(occluded[i], answers[i].occluded) << name << ", " << how << ", ray " << i;
        }
    };
    for (const Coherence coherence : {Coherence::Any, Coherence::Coherent}) {
        tested.closest_batch(rays, hits, {nullptr, mask}, coherence);
        tested.occluded_batch(rays, occluded, {nullptr, mask}, coherence);
        check(coherence == Coherence::Any ? "a batch" : "a coherent batch");
    }
    const auto* tree = dynamic_cast<const WideBvhAggregate*>(&tested);
    if (tree == nullptr || !tree->box().bounded() || tree->layout().tree.empty) return;
    std::fill(hits.begin(), hits.end(), Hit{});
    const WideBvhScene scene(tree->primitives(), tree->layout(), mask);
    wide_bvh_kernels(8).plain.closest_coherent(scene, rays, hits, false, nullptr);
    check("packets");
}

/// `unmasked`: a list of the same primitives, all visible.
void compare(const Aggregate& tested, const Aggregate& unmasked, const std::vector<Ray>& rays,
             const std::string& name) {
    std::vector<std::vector<Hit>> hits(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) unmasked.all_hits(rays[i], hits[i], nullptr);
    for (const RayMask mask : kMasks) {
        std::vector<Answer> answers;
        std::size_t found = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            answers.push_back(expected(hits[i], tested, mask));
            found += answers.back().found;
            ASSERT_EQ(difference(answers.back(), ask(tested, rays[i], mask)), "")
                << name << ", mask " << mask << ", ray " << i << ": " << show(rays[i]);
        }
        EXPECT_EQ(found > 0, mask != 0) << name << ", mask " << mask;
        compare_batches(tested, rays, answers, mask, name + ", mask " + std::to_string(mask));
    }
}

/// Half of the rays start at one point with neighbouring directions, as packets need.
std::vector<Ray> rays_at(double reach, std::uint64_t seed) {
    RandomEngine random(seed);
    const MakeRay make = random_rays(reach);
    std::vector<Ray> rays;
    for (int i = 0; i < 160; ++i) rays.push_back(make(random));
    for (int i = 0; i < 160; ++i) {
        const Vec3 aim{reach * (i % 16 - 8) / 20.0, reach * (i / 16 - 5) / 20.0, 0};
        const Vec3 eye{0.1 * reach, 0.2 * reach, 3 * reach};
        rays.push_back({eye, aim - eye, 0, i % 7 == 0 ? 1.0 : 1e300});
    }
    return rays;
}

std::vector<std::pair<std::string, PrimitiveTable>> tables() {
    return {{"triangles", random_triangles(150, 1, 0.5, 1)},
            {"spheres", random_spheres(100, 1, 0.3, 2)},
            {"mixture with planes", random_mixture(100, 1, 0.4, 3)}};
}

/// Calls `use` with the name of the wide BVH and of each instruction set, for which it has kernels.
template <class Use>
void with_the_wide_bvh(const Use& use) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride override_target(target);
        use("wide_bvh", "wide_bvh on " + target);
    }
}
/// Calls `use` with the name of every other accelerator.
template <class Use>
void with_all_others(const Use& use) {
    for (const AcceleratorEntry& entry : accelerator_table()) {
        if (entry.name != std::string("wide_bvh")) use(entry.name, std::string(entry.name));
    }
}

struct MaskedTable {
    std::string name;
    std::shared_ptr<const Aggregate> unmasked;
    PrimitiveTable masked;
};
std::vector<MaskedTable> masked_tables() {
    std::vector<MaskedTable> all;
    for (const auto& [name, table] : tables()) {
        RandomEngine random(4);
        all.push_back({name, make_aggregate("list", table), table});
        mask_all(all.back().masked, random);
    }
    return all;
}

// "Masks" runs over plain C++ kernels, too (portable_kernels).
TEST(Masks, EveryQueryOfTheWideBvhSeesWhatTheMasksLetItSee) {
    for (const MaskedTable& t : masked_tables()) {
        with_the_wide_bvh([&](const char* accelerator, const std::string& name) {
            compare(*make_aggregate(accelerator, t.masked), *t.unmasked, rays_at(1, 5),
                    name + ", " + t.name);
        });
    }
}

TEST(MasksOfClassics, EveryQueryOfEveryOtherAcceleratorSeesWhatTheMasksLetItSee) {
    for (const MaskedTable& t : masked_tables()) {
        with_all_others([&](const char* accelerator, const std::string& name) {
            // Every day about half of the accelerators with each table.
            if (!is_tried(number_of(name + t.name), 2)) return;
            compare(*make_aggregate(accelerator, t.masked), *t.unmasked, rays_at(1, 5),
                    name + ", " + t.name);
        });
    }
}

TEST(Masks, TreesOfEveryBuildObeyThem) {
    const PrimitiveTable table = random_triangles(300, 1, 0.6, 6);
    RandomEngine random(7);
    PrimitiveTable masked = table;
    mask_all(masked, random);
    const auto unmasked = make_aggregate("list", table);
    const BuildOptions builds[] = {{.quality = BuildQuality::Fast},
                                   {.quality = BuildQuality::High},
                                   {.leaves = Leaves::Indices}};
    for (const BuildOptions& build : builds) {
        compare(WideBvhAggregate(masked, build), *unmasked, rays_at(1, 8), "a tree");
    }
}

/// Three levels: `leaf` in instances in instances, with primitives on every level.
std::shared_ptr<const Aggregate> nest(const char* accelerator, bool masks) {
    RandomEngine random(9);
    std::shared_ptr<const Aggregate> inner;
    for (int level = 0; level < 3; ++level) {
        PrimitiveTable table = random_mixture(30, 1, 0.5, 10 + static_cast<std::uint64_t>(level));
        std::get<ShapeColumn<Plane>>(table.columns) = {};
        for (int i = 0; inner != nullptr && i < 8; ++i) {
            Placement placement;
            placement.outer_from_inner.linear = {{0.5, 0, 0}, {0, 0.4, 0.3}, {0, -0.3, 0.4}};
            placement.outer_from_inner.translation = uniform_point(random, 1);
            placement.inner_from_outer = inverse(placement.outer_from_inner);
            table.instances.push_back({.aggregate = inner, .placement = placement});
        }
        table.finish();
        RandomEngine mask(11);
        if (masks) mask_all(table, mask);
        inner = make_aggregate(accelerator, std::move(table));
    }
    return inner;
}

TEST(Masks, ThoseOfAllLevelsOfInstancesMustLetARayThrough) {
    const auto unmasked = nest("list", false);
    with_the_wide_bvh([&](const char* accelerator, const std::string& name) {
        compare(*nest(accelerator, true), *unmasked, rays_at(1, 12), name + ", nested");
    });
}

TEST(MasksOfClassics, ThoseOfAllLevelsOfInstancesMustLetARayThrough) {
    const auto unmasked = nest("list", false);
    with_all_others([&](const char* accelerator, const std::string& name) {
        if (!is_tried(number_of(name + ", nested"), 2)) return;
        compare(*nest(accelerator, true), *unmasked, rays_at(1, 12), name + ", nested");
    });
}

/// Two sheets across the z axis; the nearer one has the mask.
PrimitiveTable two_sheets(RayMask nearer) {
    PrimitiveTable table;
    table.material_opacity = {Opacity::Opaque};
    for (const double z : {1.0, 0.0}) {
        auto sheet = std::make_shared<TriangleMesh>();
        sheet->positions = {{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}};
        sheet->triangles = {{0, 1, 2}, {0, 2, 3}};
        table.meshes.push_back({sheet, MaterialId{0}, 0, false, 0, z == 1.0 ? nearer : kAllRays});
    }
    table.finish();
    return table;
}

TEST(Masks, ASureHitThatIsNotSeenHidesNothingBehindIt) {
    const Ray ray{{0.1, 0.3, 2}, {0, 0, -1}, 0, 1e300};
    for (const Precision precision : {Precision::Robust, Precision::Fast}) {
        const WideBvhAggregate tree(two_sheets(2), {.precision = precision});
        Hit hit;
        EXPECT_TRUE(tree.closest(ray, hit, {nullptr, 1}));
        EXPECT_EQ(hit.t, 2);
        EXPECT_TRUE(tree.closest(ray, hit, {nullptr, 2}));
        EXPECT_EQ(hit.t, 1);
        Ray shorter = ray;
        shorter.t_max = 1.5;
        EXPECT_FALSE(tree.closest(shorter, hit, {nullptr, 1}));
        EXPECT_FALSE(tree.occluded(shorter, {nullptr, 1}));
        EXPECT_TRUE(tree.occluded(shorter, {nullptr, 2}));
        const std::vector<Ray> rays(64, ray);
        std::vector<Hit> hits(rays.size());
        tree.closest_batch(rays, hits, {nullptr, 1}, Coherence::Coherent);
        for (const Hit& h : hits) EXPECT_EQ(h.t, 2);
    }
}

TEST(Masks, FastModeGivesTheHitsOfATableWithoutWhatIsHidden) {
    // Hidden primitives come last and lie within the visible ones: ids and frame stay the same.
    const PrimitiveTable seen = random_triangles(200, 1, 0.5, 13);
    PrimitiveTable both = seen;
    auto hidden = std::make_shared<TriangleMesh>();
    const PrimitiveTable more = random_triangles(200, 0.5, 0.4, 14);
    *hidden = *more.meshes[0].mesh;
    both.meshes.push_back({hidden, MaterialId{0}, 0, false, 0, 2});
    both.finish();
    const WideBvhAggregate without(seen, {.precision = Precision::Fast});
    const WideBvhAggregate masked(both, {.precision = Precision::Fast});
    ASSERT_EQ(without.box(), masked.box());
    const std::vector<Ray> rays = rays_at(1, 15);
    std::vector<Hit> hits(rays.size());
    const auto occluded = std::make_unique<bool[]>(rays.size());
    masked.closest_batch(rays, hits, {nullptr, 1});
    masked.occluded_batch(rays, {occluded.get(), rays.size()}, {nullptr, 1});
    int differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit expected, all;
        const bool found = without.closest(rays[i], expected, nullptr);
        Hit hit;
        EXPECT_EQ(masked.closest(rays[i], hit, {nullptr, 1}), found) << i;
        EXPECT_TRUE(same(hit, expected)) << i << show(rays[i]);
        EXPECT_TRUE(same(hits[i], expected)) << i << show(rays[i]);
        EXPECT_EQ(occluded[i], found) << i;
        EXPECT_EQ(masked.occluded(rays[i], {nullptr, 1}), found) << i;
        (void)masked.closest(rays[i], all, nullptr);
        differ += !same(all, expected);
    }
    EXPECT_GT(differ, 20) << "too few rays meet what is hidden";
}

TEST(Masks, BelongToTheTableAndNotToTheTree) {
    const ScratchFolder folder;
    const auto file = folder.path() / "tree";
    WideBvhAggregate(two_sheets(kAllRays)).save(file);
    const auto loaded = WideBvhAggregate::load(two_sheets(2), file);
    const Ray ray{{0.1, 0.3, 2}, {0, 0, -1}, 0, 1e300};
    Hit hit;
    EXPECT_TRUE(loaded->closest(ray, hit, {nullptr, 1}));
    EXPECT_EQ(hit.t, 2);
    WideBvhAggregate refitted(two_sheets(kAllRays));
    EXPECT_TRUE(refitted.closest(ray, hit, {nullptr, 1}));
    EXPECT_EQ(hit.t, 1);
    (void)refitted.refit(two_sheets(2));
    EXPECT_TRUE(refitted.closest(ray, hit, {nullptr, 1}));
    EXPECT_EQ(hit.t, 2);
}

TEST(Masks, TakeNoMemoryWhereAllIsVisibleToAll) {
    const PrimitiveTable open = two_sheets(kAllRays), masked = two_sheets(2);
    EXPECT_TRUE(open.all_seen(1));
    EXPECT_FALSE(open.all_seen(0));
    EXPECT_FALSE(masked.all_seen(1));
    EXPECT_TRUE(masked.all_seen(2)) << "all parts have this bit";
    EXPECT_LT(open.memory_bytes(), masked.memory_bytes());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
