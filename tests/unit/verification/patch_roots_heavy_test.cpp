/// `certified_newton` against 113 bits: random lines, tangents at 1e-1 to 1e-12, lines through
/// borders and corners. No crossing missed, none invented, t within its bound. By default 10^7
/// lines a model, a quarter of each kind; ALHAZEN_PATCH_RAYS sets the number of each kind.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "alhazen/base/file.h"
#include "alhazen/formats/bpt/bpt_reader.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/verification/patch_trials.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

long rays_of_a_kind() {
    const char* const asked = std::getenv("ALHAZEN_PATCH_RAYS");
    return asked != nullptr ? std::atol(asked) : 2'500'000;
}

std::string in_hex(const Ray& ray) {
    char text[256];
    std::snprintf(text, sizeof text, "{{%a, %a, %a}, {%a, %a, %a}}", ray.origin.x, ray.origin.y,
                  ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z);
    return text;
}

/// Blocks of rays with a seed each: the same for any number of threads.
PatchTally tally_of(const PatchModel& model, PatchRayKind kind, long rays) {
    constexpr long kBlock = 1000;
    const auto blocks = static_cast<std::uint64_t>((rays + kBlock - 1) / kBlock);
    PatchTally tally;
    std::atomic<std::uint64_t> next{0};
    std::mutex mutex;
    const auto work = [&] {
        const auto method = patch_method("certified_newton").make(model.nets);
        for (std::uint64_t block = next++; block < blocks; block = next++) {
            RandomStream random(mix64(block) + static_cast<std::uint64_t>(kind));
            const long last = std::min(kBlock, rays - static_cast<long>(block) * kBlock);
            for (long k = 0; k < last; ++k) {
                const Ray ray = patch_ray(model, kind, random);
                std::vector<PatchCrossing> found;
                PatchMethodCounts counts;
                method->crossings(ray, found, counts);
                const PatchJudgement one =
                    judge_crossings(model, ray, exact_patch_roots(model.nets, ray), found,
                                    1e-3 * length(model.box.size()));
                const std::scoped_lock lock(mutex);
                tally.add(one);
                if (one.missed + one.invented > 0 || one.worst_of_bound > 1.0) {
                    ADD_FAILURE() << model.name << ' ' << patch_ray_name(kind) << ": missed "
                                  << one.missed << ", invented " << one.invented << ", t off by "
                                  << one.worst_of_bound << " of its bound: " << in_hex(ray);
                }
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k) {
        threads.emplace_back(work);
    }
    for (std::thread& thread : threads) thread.join();
    return tally;
}

void check_model(const PatchModel& model) {
    for (int kind = 0; kind < kPatchRayKinds; ++kind) {
        const auto which = static_cast<PatchRayKind>(kind);
        const PatchTally tally = tally_of(model, which, rays_of_a_kind());
        std::printf(
            "%s, %s: %ld lines, %ld crossings, missed %ld, invented %ld; decided by "
            "rounding: %ld pairs, %ld at open sides; undecided lines: %ld; largest error "
            "of t: %.2g, of its bound: %.3f\n",
            model.name.c_str(), patch_ray_name(which), tally.rays, tally.exact, tally.missed,
            tally.invented, tally.pairs, tally.at_sides, tally.undecided, tally.worst_t,
            tally.worst_of_bound);
        std::fflush(stdout);
        EXPECT_EQ(tally.missed + tally.invented, 0);
        EXPECT_LE(tally.undecided * 1000, tally.rays);
    }
}

void check_file(const std::string& file) {
    Diagnostics found;
    const std::string text = read_file(testing::test_data() / "patches" / file);
    std::vector<BezierNet> nets;
    for (const BptMesh& part : read_bpt(text, file, {}, found)) {
        for (std::size_t k = 0; k < part.mesh.patch_count(); ++k) nets.push_back(part.mesh.net(k));
    }
    check_model({file, nets});
}

TEST(PatchRoots, Torus) {
    Torus torus{.major_radius = 1.2, .minor_radius = 0.5};
    torus.prepare();
    std::vector<BezierPiece> pieces;
    append_pieces(torus, pieces);
    std::vector<BezierNet> nets;
    for (const BezierPiece& piece : pieces) nets.push_back(piece.net);
    check_model({"torus", nets});
}

TEST(PatchRoots, Teapot) {
    ALHAZEN_NEEDS_DATA("patches/teapot.bpt");
    check_file("teapot.bpt");
}

TEST(PatchRoots, Teacup) {
    ALHAZEN_NEEDS_DATA("patches/teacup_sjbaker.bpt");
    check_file("teacup_sjbaker.bpt");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
