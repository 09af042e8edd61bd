#include "alhazen/verification/verify_roads.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace alhazen {

namespace {

bool same_hit(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.part == b.part &&
           a.primitive == b.primitive && a.path == b.path;
}

/// Also where there is none.
bool same_answer(const Hit& a, const Hit& b) {
    return a.found() == b.found() && (!a.found() || same_hit(a, b));
}

const char* state_of(bool occluded) {
    return occluded ? "occluded" : "free";
}

/// What no query gives: of a primitive that no table has.
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

RoadComparison::RoadComparison(const Aggregate& tested, const Aggregate& brute,
                               const VerifyOptions& options, VerifyReport& report)
    : tested_(tested),
      brute_(brute),
      options_(options),
      report_(report),
      occluded_(std::make_unique<bool[]>(kBlockRays)) {}

void RoadComparison::run(VerifyRays& rays, bool masked) {
    masked_ = masked;
    for (std::uint64_t done = 0; done < options_.rays; done += samples_.size()) {
        make_block(rays, static_cast<std::size_t>(
                             std::min<std::uint64_t>(options_.rays - done, kBlockRays)));
        shoot_singles(done);
        shoot_stream();
        shoot_coherent();
    }
}

// ---- Make a block.

RayMask RoadComparison::next_mask(std::uint64_t number) const {
    return masked_ ? mask_of(static_cast<RayKind>(number % kRayKindCount)) : kAllRays;
}

void RoadComparison::make_block(VerifyRays& rays, std::size_t count) {
    samples_.clear();
    masks_.clear();
    sets_.clear();
    while (samples_.size() < count) {
        // Three quarters of the rays are of mixed kinds.
        const RayMask mask = next_mask(set_count_++);
        rays.append_tile(samples_);
        end_set(mask);
        find_origins(sets_.back(), mask);
        add_mixed(rays);
        rays.append_shadow_rays(origins_, samples_);
        end_set(mask);
        add_mixed(rays);
    }
    samples_.resize(count);
    masks_.resize(count);
    while (sets_.back().first >= count) sets_.pop_back();
    sets_.back().count = std::min(sets_.back().count, count - sets_.back().first);
}

void RoadComparison::add_mixed(VerifyRays& rays) {
    constexpr std::size_t kMixedRays = 3 * VerifyRays::kTileRays;
    for (std::size_t i = 0; i < kMixedRays; ++i) {
        samples_.push_back(rays.next());
        // Rays of one sort come every fourth time.
        masks_.push_back(next_mask(mixed_count_++ / 4));
    }
}

void RoadComparison::end_set(RayMask mask) {
    sets_.push_back({masks_.size(), samples_.size() - masks_.size()});
    masks_.resize(samples_.size(), mask);
}

/// Where the rays of the tile end; a ray that hits nothing gives the point at t = 1.
void RoadComparison::find_origins(const RaySet& tile, RayMask mask) {
    origins_.clear();
    for (std::size_t i = tile.first; i < tile.first + tile.count; ++i) {
        const Ray& ray = samples_[i].ray;
        Hit hit;
        const bool found = tested_.closest(ray, hit, {nullptr, mask});
        origins_.push_back(ray.at(found ? hit.t : 1.0));
    }
}

// ---- Compare.

void RoadComparison::shoot_singles(std::uint64_t done) {
    expected_.resize(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (options_.progress != nullptr && i % 256 == 0) {
            options_.progress->update("verify", done + i, options_.rays);
        }
        compare_single(i);
    }
}

void RoadComparison::compare_single(std::size_t i) {
    const Ray& ray = samples_[i].ray;
    const RayQuery query{nullptr, masks_[i]};
    const auto differ = [&](const char* name, std::string found, std::string expected) {
        disagree(i, Road::Single, name, std::move(found), std::move(expected));
    };
    ++report_.rays;
    ++counts(Road::Single).rays;
    Hit found;
    Hit& expected = expected_[i];
    (void)tested_.closest(ray, found, query);
    (void)brute_.closest(ray, expected, query);
    report_.hits += expected.found();
    if (!same_answer(found, expected)) differ("closest", describe(found), describe(expected));
    const bool occluded = tested_.occluded(ray, query);
    if (occluded != expected.found()) {
        differ("occluded", state_of(occluded), state_of(expected.found()));
    }
    const auto same_hits = [&] { return std::ranges::equal(tested_hits_, brute_hits_, same_hit); };
    tested_hits_.clear();
    brute_hits_.clear();
    tested_.all_hits(ray, tested_hits_, query);
    brute_.all_hits(ray, brute_hits_, query);
    if (!same_hits()) differ("all_hits", describe(tested_hits_), describe(brute_hits_));
    // The nearest of all hits must be the closest hit.
    if (!brute_hits_.empty() && !same_hit(brute_hits_.front(), expected)) {
        differ("all_hits", "first: " + describe(brute_hits_.front()), describe(expected));
    }
    tested_hits_.clear();
    brute_hits_.clear();
    const bool shadowed = tested_.shadowed(ray, tested_hits_, query);
    const bool expect_shadow = brute_.shadowed(ray, brute_hits_, query);
    if (shadowed != expect_shadow || (!shadowed && !same_hits())) {
        differ("shadowed", describe(tested_hits_), describe(brute_hits_));
    }
}

void RoadComparison::shoot_stream() {
    counts(Road::Stream).rays += samples_.size();
    chosen_.resize(samples_.size());
    std::iota(chosen_.begin(), chosen_.end(), std::size_t{0});
    shoot_by_mask(Road::Stream);
}

void RoadComparison::shoot_coherent() {
    std::vector<std::size_t> all;
    for (const RaySet& set : sets_) {
        counts(Road::Coherent).rays += set.count;
        chosen_.resize(set.count);
        std::iota(chosen_.begin(), chosen_.end(), set.first);
        all.insert(all.end(), chosen_.begin(), chosen_.end());
        shoot_by_mask(Road::Coherent);
    }
    chosen_.swap(all);
    shoot_by_mask(Road::Coherent);
}

void RoadComparison::shoot_by_mask(Road road) {
    if (!masked_) return shoot_batch(road, chosen_, kAllRays);
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        const RayMask mask = mask_of(static_cast<RayKind>(k));
        of_mask_.clear();
        std::ranges::copy_if(chosen_, std::back_inserter(of_mask_),
                             [&](std::size_t i) { return masks_[i] == mask; });
        if (!of_mask_.empty()) shoot_batch(road, of_mask_, mask);
    }
}

void RoadComparison::shoot_batch(Road road, std::span<const std::size_t> chosen, RayMask mask) {
    const Coherence coherence = road == Road::Coherent ? Coherence::Coherent : Coherence::Any;
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
            disagree(i, road, "closest", describe(hits_[n]), describe(expected));
        }
        if (occluded_[n] != expected.found()) {
            disagree(i, road, "occluded", state_of(occluded_[n]), state_of(expected.found()));
        }
    }
}

void RoadComparison::disagree(std::size_t i, Road road, const char* query, std::string found,
                              std::string expected) {
    ++report_.disagreements;
    ++counts(road).disagreements;
    if (report_.reported.size() >= options_.max_reported) return;
    const VerifyRays::Sample& sample = samples_[i];
    const std::string seen_by = name_of(masks_[i]);
    report_.reported.push_back(
        {seen_by.empty() ? sample.kind : fmt::format("{} for {}", sample.kind, seen_by), query,
         sample.ray, std::move(found), std::move(expected),
         kRoadNames[static_cast<std::size_t>(road)]});
}

}  // namespace alhazen
