#include "alhazen/verification/verify_query_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <span>

#include "alhazen/parallel/parallel.h"
#include "alhazen/verification/shared_progress.h"

namespace alhazen {

namespace {

bool same_hit(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.part == b.part &&
           a.primitive == b.primitive && a.path == b.path;
}

/// True if both are the same hit or both are no hit.
bool same_answer(const Hit& a, const Hit& b) {
    return a.found() == b.found() && (!a.found() || same_hit(a, b));
}

const char* state_of(bool occluded) {
    return occluded ? "occluded" : "free";
}

/// A hit that no query gives: its primitive is in no table.
Hit wrong_hit() {
    Hit hit;
    hit.t = -std::numeric_limits<double>::infinity();
    hit.primitive = PrimitiveId{static_cast<std::uint32_t>(kNoPrimitive) - 1};
    return hit;
}

/// Name of the kind of ray that has the mask; empty for all rays.
std::string name_of(RayMask mask) {
    for (std::size_t k = 0; mask != kAllRays && k < kRayKindCount; ++k) {
        if (mask == mask_of(static_cast<RayKind>(k))) return kRayKindNames[k];
    }
    return {};
}

}  // namespace

std::string describe(const Hit& hit) {
    if (!hit.found()) return "no hit";
    return fmt::format("t={:.17g} primitive={} part={} u={:.17g} v={:.17g} level={}", hit.t,
                       static_cast<std::uint32_t>(hit.primitive), hit.part, hit.u, hit.v,
                       hit.path.size());
}

std::string describe(const std::vector<Hit>& hits) {
    std::string text = fmt::format("{} hits", hits.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(hits.size(), 4); ++i) {
        text += "; " + describe(hits[i]);
    }
    return text;
}

/// Traces the rays of one block by all calls.
class QueryPathComparison::BlockComparison {
  public:
    /// Units of progress per ray: single calls, and all others.
    static constexpr std::size_t kUnitsOfRay = 2;

    BlockComparison(const QueryPathComparison& all, const Block& block)
        : tested_(all.tested_),
          brute_(all.brute_),
          masked_(all.masked_),
          samples_(block.samples),
          masks_(block.masks),
          sets_(block.sets),
          occluded_(std::make_unique<bool[]>(kBlockRays)) {}

    /// Finishes kUnitsOfRay units of each ray.
    [[nodiscard]] VerifyReport run(SharedProgress& progress) {
        shoot_brute();
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            compare_single(i);
            progress.add(1);
        }
        shoot_stream();
        shoot_coherent();
        progress.add(samples_.size());
        return std::move(report_);
    }

  private:
    void shoot_brute();
    void compare_single(std::size_t i);
    void shoot_stream();
    void shoot_coherent();
    /// Traces the rays of `chosen_` by the batch calls, those of each mask together.
    void shoot_by_mask(QueryPath path);
    void shoot_batch(QueryPath path, std::span<const std::size_t> chosen, RayMask mask);
    void disagree(std::size_t i, QueryPath path, const char* query, std::string found,
                  std::string expected);
    [[nodiscard]] QueryPathCounts& counts(QueryPath path) {
        return report_.query_paths[static_cast<std::size_t>(path)];
    }

    const Aggregate& tested_;
    const BruteForce& brute_;
    bool masked_;
    VerifyReport report_;

    // [ray] of the block.
    const std::vector<VerifyRays::Sample>& samples_;
    const std::vector<RayMask>& masks_;
    std::vector<std::vector<Hit>> all_;  ///< by brute force
    std::vector<Hit> expected_;          ///< the nearest of them

    const std::vector<RaySet>& sets_;
    std::vector<Hit> tested_hits_, brute_hits_;
    // Of a batch.
    std::vector<std::size_t> chosen_, of_mask_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::unique_ptr<bool[]> occluded_;
};

QueryPathComparison::QueryPathComparison(const Aggregate& tested, const BruteForce& brute,
                                         const VerifyOptions& options, VerifyReport& report)
    : tested_(tested), brute_(brute), options_(options), report_(report) {}

void QueryPathComparison::run(VerifyRays& rays, bool masked) {
    masked_ = masked;
    SharedProgress progress(options_.progress, "verify " + options_.accelerator,
                            BlockComparison::kUnitsOfRay * options_.rays);
    const auto at_once = static_cast<std::size_t>(2 * available_cores());
    for (std::uint64_t done = 0; done < options_.rays;) {
        std::vector<Block> blocks;
        for (; blocks.size() < at_once && done < options_.rays;
             done += blocks.back().samples.size()) {
            blocks.push_back(make_block(rays, static_cast<std::size_t>(std::min<std::uint64_t>(
                                                  options_.rays - done, kBlockRays))));
        }
        std::vector<VerifyReport> reports(blocks.size());
        parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                reports[i] = BlockComparison(*this, blocks[i]).run(progress);
            }
        });
        for (VerifyReport& report : reports) add(std::move(report));
    }
}

void QueryPathComparison::add(VerifyReport block) {
    report_.rays += block.rays;
    report_.hits += block.hits;
    report_.disagreements += block.disagreements;
    for (std::size_t i = 0; i < kQueryPathCount; ++i) {
        report_.query_paths[i].rays += block.query_paths[i].rays;
        report_.query_paths[i].disagreements += block.query_paths[i].disagreements;
    }
    for (Disagreement& one : block.reported) {
        if (report_.reported.size() < kMostReported) {
            report_.reported.push_back(std::move(one));
        }
    }
}

// ---- Blocks.

RayMask QueryPathComparison::next_mask(std::uint64_t number) const {
    return masked_ ? mask_of(static_cast<RayKind>(number % kRayKindCount)) : kAllRays;
}

QueryPathComparison::Block QueryPathComparison::make_block(VerifyRays& rays, std::size_t count) {
    Block block;
    while (block.samples.size() < count) {
        // Three quarters of the rays are of mixed kinds.
        const RayMask mask = next_mask(set_count_++);
        rays.append_tile(block.samples);
        end_set(mask, block);
        const std::vector<Vec3> origins = origins_on(block.sets.back(), mask, block);
        add_mixed(rays, block);
        rays.append_shadow_rays(origins, block.samples);
        end_set(mask, block);
        add_mixed(rays, block);
    }
    block.samples.resize(count);
    block.masks.resize(count);
    std::vector<RaySet>& sets = block.sets;
    while (sets.back().first >= count) sets.pop_back();
    sets.back().count = std::min(sets.back().count, count - sets.back().first);
    return block;
}

void QueryPathComparison::add_mixed(VerifyRays& rays, Block& block) {
    constexpr std::size_t kMixedRays = 3 * VerifyRays::kTileRays;
    for (std::size_t i = 0; i < kMixedRays; ++i) {
        block.samples.push_back(rays.next());
        // The mask changes after one ray of each of the four kinds.
        block.masks.push_back(next_mask(mixed_count_++ / 4));
    }
}

void QueryPathComparison::end_set(RayMask mask, Block& block) {
    block.sets.push_back({block.masks.size(), block.samples.size() - block.masks.size()});
    block.masks.resize(block.samples.size(), mask);
}

/// The points where the rays of the tile end; for a ray that hits nothing the point at t = 1.
std::vector<Vec3> QueryPathComparison::origins_on(const RaySet& tile, RayMask mask,
                                                  const Block& block) const {
    std::vector<Vec3> origins;
    for (std::size_t i = tile.first; i < tile.first + tile.count; ++i) {
        const Ray& ray = block.samples[i].ray;
        Hit hit;
        const bool found = tested_.closest(ray, hit, {nullptr, mask});
        origins.push_back(ray.at(found ? hit.t : 1.0));
    }
    return origins;
}

// ---- Comparisons.

void QueryPathComparison::BlockComparison::shoot_brute() {
    all_.resize(samples_.size());
    std::vector<BruteForce::Shot> shots;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        shots.push_back({samples_[i].ray, masks_[i], &all_[i]});
    }
    brute_.all_hits(shots);
    for (const std::vector<Hit>& hits : all_) {
        expected_.push_back(hits.empty() ? Hit{} : hits.front());
    }
}

void QueryPathComparison::BlockComparison::compare_single(std::size_t i) {
    const Ray& ray = samples_[i].ray;
    const RayQuery query{nullptr, masks_[i]};
    const auto differ = [&](const char* name, std::string found, std::string expected) {
        disagree(i, QueryPath::Single, name, std::move(found), std::move(expected));
    };
    ++report_.rays;
    ++counts(QueryPath::Single).rays;
    Hit found;
    const Hit& expected = expected_[i];
    (void)tested_.closest(ray, found, query);
    report_.hits += expected.found();
    if (!same_answer(found, expected)) differ("closest", describe(found), describe(expected));
    const bool occluded = tested_.occluded(ray, query);
    if (occluded != expected.found()) {
        differ("occluded", state_of(occluded), state_of(expected.found()));
    }
    tested_hits_.clear();
    tested_.all_hits(ray, tested_hits_, query);
    if (!std::ranges::equal(tested_hits_, all_[i], same_hit)) {
        differ("all_hits", describe(tested_hits_), describe(all_[i]));
    }
    tested_hits_.clear();
    brute_hits_.clear();
    const bool shadowed = tested_.shadowed(ray, tested_hits_, query);
    const bool expect_shadow = brute_.shadowed(ray, masks_[i], all_[i], brute_hits_);
    if (shadowed != expect_shadow ||
        (!shadowed && !std::ranges::equal(tested_hits_, brute_hits_, same_hit))) {
        differ("shadowed", describe(tested_hits_), describe(brute_hits_));
    }
}

void QueryPathComparison::BlockComparison::shoot_stream() {
    counts(QueryPath::Stream).rays += samples_.size();
    chosen_.resize(samples_.size());
    std::iota(chosen_.begin(), chosen_.end(), std::size_t{0});
    shoot_by_mask(QueryPath::Stream);
}

void QueryPathComparison::BlockComparison::shoot_coherent() {
    std::vector<std::size_t> all;
    for (const RaySet& set : sets_) {
        counts(QueryPath::Coherent).rays += set.count;
        chosen_.resize(set.count);
        std::iota(chosen_.begin(), chosen_.end(), set.first);
        all.insert(all.end(), chosen_.begin(), chosen_.end());
        shoot_by_mask(QueryPath::Coherent);
    }
    chosen_.swap(all);
    shoot_by_mask(QueryPath::Coherent);
}

void QueryPathComparison::BlockComparison::shoot_by_mask(QueryPath path) {
    if (!masked_) return shoot_batch(path, chosen_, kAllRays);
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        const RayMask mask = mask_of(static_cast<RayKind>(k));
        of_mask_.clear();
        std::ranges::copy_if(chosen_, std::back_inserter(of_mask_),
                             [&](std::size_t i) { return masks_[i] == mask; });
        if (!of_mask_.empty()) shoot_batch(path, of_mask_, mask);
    }
}

void QueryPathComparison::BlockComparison::shoot_batch(QueryPath path,
                                                       std::span<const std::size_t> chosen,
                                                       RayMask mask) {
    const Coherence coherence = path == QueryPath::Coherent ? Coherence::Coherent : Coherence::Any;
    const RayQuery query{nullptr, mask};
    rays_.clear();
    hits_.assign(chosen.size(), wrong_hit());
    for (std::size_t n = 0; n < chosen.size(); ++n) {
        rays_.push_back(samples_[chosen[n]].ray);
        occluded_[n] = !expected_[chosen[n]].found();
    }
    tested_.closest_batch(rays_, hits_, query, coherence);
    tested_.occluded_batch(rays_, {occluded_.get(), chosen.size()}, query, coherence);
    for (std::size_t n = 0; n < chosen.size(); ++n) {
        const std::size_t i = chosen[n];
        const Hit& expected = expected_[i];
        if (!same_answer(hits_[n], expected)) {
            disagree(i, path, "closest", describe(hits_[n]), describe(expected));
        }
        if (occluded_[n] != expected.found()) {
            disagree(i, path, "occluded", state_of(occluded_[n]), state_of(expected.found()));
        }
    }
}

void QueryPathComparison::BlockComparison::disagree(std::size_t i, QueryPath path,
                                                    const char* query, std::string found,
                                                    std::string expected) {
    ++report_.disagreements;
    ++counts(path).disagreements;
    if (report_.reported.size() >= kMostReported) return;
    const VerifyRays::Sample& sample = samples_[i];
    const std::string seen_by = name_of(masks_[i]);
    report_.reported.push_back(
        {seen_by.empty() ? sample.kind : fmt::format("{} for {}", sample.kind, seen_by), query,
         sample.ray, std::move(found), std::move(expected),
         kQueryPathNames[static_cast<std::size_t>(path)]});
}

}  // namespace alhazen
