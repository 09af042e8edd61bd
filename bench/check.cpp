#include "check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/parallel/parallel.h"
#include "embree/embree_packets.h"

namespace alhazen::bench {

namespace {

constexpr std::size_t kFaultsShown = 10;
constexpr std::size_t kSamples = 64;

/// Answers of wide_bvh by single rays: t, or 0 for any hit; infinite for a miss.
std::vector<double> our_answers(const Aggregate& aggregate, const RaySet& set) {
    std::vector<double> t(set.rays.size(), HUGE_VAL);
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        if (set.any_hit) {
            if (aggregate.occluded(set.rays[i], nullptr)) t[i] = 0;
            continue;
        }
        Hit hit;
        if (aggregate.closest(set.rays[i], hit, nullptr)) t[i] = hit.t;
    }
    return t;
}

std::size_t count_batch_differences(const Aggregate& aggregate, const RaySet& set) {
    const auto occluded = std::make_unique<bool[]>(kBatch);
    std::vector<Hit> hits(kBatch);
    std::size_t count = 0;
    const Coherence coherence = set.coherent ? Coherence::Coherent : Coherence::Any;
    for (std::size_t i = 0; i < set.rays.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, set.rays.size() - i);
        const std::span<const Ray> rays(&set.rays[i], n);
        if (set.any_hit) {
            aggregate.occluded_batch(rays, {occluded.get(), n}, nullptr, coherence);
        } else {
            aggregate.closest_batch(rays, std::span(hits).first(n), nullptr, coherence);
        }
        for (std::size_t k = 0; k < n; ++k) {
            if (set.any_hit) {
                count += occluded[k] != aggregate.occluded(rays[k], nullptr);
                continue;
            }
            Hit hit;
            (void)aggregate.closest(rays[k], hit, nullptr);
            const Hit& other = hits[k];
            count += hit.primitive != other.primitive || hit.t != other.t || hit.u != other.u ||
                     hit.v != other.v;
        }
    }
    return count;
}

std::string describe(const Ray& r, double ours, double peer, const Verdict& verdict) {
    return fmt::format(
        "origin {:a} {:a} {:a} direction {:a} {:a} {:a} t [{:a}, {:a}]: ours {}, Embree {}, "
        "truth {}",
        r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y, r.direction.z, r.t_min,
        r.t_max, ours, peer, verdict.true_t);
}

void decide_all(const Judge& judge, const RaySet& set, const std::vector<double>& ours,
                const EmbreePackets& peer, CheckResult& result) {
    std::vector<std::size_t> doubtful;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        if (judge.disagree(set.rays[i], set.any_hit, ours[i], peer.t(i))) doubtful.push_back(i);
    }
    std::vector<Verdict> verdicts(doubtful.size());
    parallel_for(doubtful.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = doubtful[k];
            verdicts[k] = judge.decide(set.rays[i], set.any_hit, ours[i], peer.t(i));
        }
    });
    result.disagreements = doubtful.size();
    for (std::size_t k = 0; k < doubtful.size(); ++k) {
        const Verdict& v = verdicts[k];
        const std::size_t i = doubtful[k];
        result.peer_wrong += v.peer_wrong;
        result.both_right += !v.peer_wrong && !v.ours_wrong;
        if (!v.ours_wrong) continue;
        ++result.ours_wrong;
        if (result.our_faults.size() < kFaultsShown) {
            result.our_faults.push_back(describe(set.rays[i], ours[i], peer.t(i), v));
        }
    }
}

/// Replaces our answer by a wrong one, which the judge must detect.
void plant(const Judge& judge, const RaySet& set, std::size_t i, double ours, double wrong,
           CheckResult& result) {
    const Verdict verdict = judge.decide(set.rays[i], set.any_hit, ours, wrong);
    result.ours_wrong += verdict.ours_wrong;
    if (verdict.peer_wrong) return;
    ++result.planted_unseen;
    if (result.unseen.size() < kFaultsShown) {
        result.unseen.push_back(describe(set.rays[i], ours, wrong, verdict));
    }
}

/// Judges our answers to some rays of the set, and planted wrong ones.
void judge_samples(const Judge& judge, const RaySet& set, const std::vector<double>& ours,
                   CheckResult& result) {
    const std::size_t step = std::max<std::size_t>(1, set.rays.size() / kSamples);
    for (std::size_t i = 0; i < set.rays.size(); i += step) {
        const bool hit = std::isfinite(ours[i]);
        // A miss in place of a hit, or a hit in place of a miss.
        plant(judge, set, i, ours[i], hit ? HUGE_VAL : 0.5 * (length(set.rays[i].origin) + 1),
              result);
        ++result.samples;
        if (!hit || set.any_hit) continue;
        // Farther by more than the rounding error, which near the origin exceeds a hundredth of t.
        const double farther =
            std::max(1.01 * ours[i], ours[i] + 2 * judge.float_noise(set.rays[i], ours[i]));
        plant(judge, set, i, ours[i], farther, result);
    }
}

}  // namespace

std::vector<CheckResult> check(const KernelScene& scene, const Aggregate& aggregate,
                               const RaySet& set, const std::vector<PeerScene>& peers) {
    const Judge judge(scene);
    const std::vector<double> ours = our_answers(aggregate, set);
    const std::size_t batch_differs = count_batch_differences(aggregate, set);
    std::vector<CheckResult> results;
    for (const PeerScene& peer : peers) {
        for (const int width : {1, 16}) {
            const auto packets = make_embree_packets(set, width);
            packets->trace(peer.scene->handle(), set.coherent);
            CheckResult result;
            result.scene = scene.name;
            result.rays = set.name;
            result.peer = fmt::format("{} {}{}", peer.group, width, peer.suffix);
            result.count = set.rays.size();
            result.batch_differs = batch_differs;
            decide_all(judge, set, ours, *packets, result);
            if (results.empty()) judge_samples(judge, set, ours, result);
            results.push_back(std::move(result));
        }
    }
    return results;
}

std::string as_markdown(const std::vector<CheckResult>& results) {
    std::string text =
        "| scene | rays | Embree | number | disagreements | Embree wrong | ours wrong | both right "
        "| batch not single |\n|---|---|---|---|---|---|---|---|---|\n";
    std::size_t samples = 0, unseen = 0;
    for (const CheckResult& r : results) {
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", r.scene, r.rays,
                            r.peer, r.count, r.disagreements, r.peer_wrong, r.ours_wrong,
                            r.both_right, r.batch_differs);
        samples += r.samples;
        unseen += r.planted_unseen;
    }
    return text + fmt::format(
                      "\n{} further answers were judged without a disagreement "
                      "(those found wrong are in the table), and wrong answers put in "
                      "their place: {} of those were not seen.\n",
                      samples, unseen);
}

}  // namespace alhazen::bench
