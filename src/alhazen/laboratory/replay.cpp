#include "alhazen/laboratory/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>

#include "alhazen/laboratory/cpu_clock.h"
#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

constexpr std::size_t kPiece = 64;
/// Number of rays between readings of the clock.
constexpr std::size_t kRaysBetweenClocks = 256;
constexpr std::uint64_t kNothing = 0x6E6F7468696E67;

class Digest {
  public:
    void add(std::uint64_t bits) { state_ = mix64(state_ ^ bits); }
    void add(const Hit& hit) {
        add(std::bit_cast<std::uint64_t>(hit.t));
        add(std::bit_cast<std::uint64_t>(hit.u));
        add(std::bit_cast<std::uint64_t>(hit.v));
        add(hit.part);
        add(static_cast<std::uint64_t>(hit.primitive));
        for (const PrimitiveId id : hit.path) add(static_cast<std::uint64_t>(id));
    }
    [[nodiscard]] std::uint64_t value() const { return state_ == 0 ? 1 : state_; }

  private:
    std::uint64_t state_ = 1;
};

std::uint64_t answer_of(const Hit& hit) {
    if (!hit.found()) return kNothing;
    Digest digest;
    digest.add(hit);
    return digest.value();
}

/// Traces the rays of a batch, or of a part of one.
class Questioner {
  public:
    Questioner(const RayStream& stream, const Aggregate& asked, RayMask mask)
        : stream_(stream), asked_(asked), mask_(mask) {}

    void ask(const RayBatch& batch, TraversalStats* stats) {
        const std::span<const Ray> rays(&stream_.rays[batch.first], batch.count);
        const RayQuery query{stats, mask_ != 0 ? mask_ : mask_of(batch.kind)};
        switch (batch.question) {
            case RayQuestion::Closest:
                if (hits_.size() < rays.size()) hits_.resize(rays.size());
                asked_.closest_batch(rays, std::span(hits_).first(rays.size()), query,
                                     batch.coherence);
                return;
            case RayQuestion::Occluded:
                make_room(rays.size());
                asked_.occluded_batch(rays, {met_.get(), rays.size()}, query, batch.coherence);
                return;
            case RayQuestion::Shadowed:
                make_room(rays.size());
                if (crossings_.size() < rays.size()) crossings_.resize(rays.size());
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    crossings_[i].clear();
                    met_[i] = asked_.shadowed(rays[i], crossings_[i], query);
                }
                return;
        }
    }
    /// The hashed result of ray i of the last batch.
    [[nodiscard]] std::uint64_t answer(const RayBatch& batch, std::size_t i) const {
        if (batch.question == RayQuestion::Closest) return answer_of(hits_[i]);
        if (met_[i]) return 1;
        if (batch.question == RayQuestion::Occluded || crossings_[i].empty()) return kNothing;
        Digest digest;
        for (const Hit& crossing : crossings_[i]) digest.add(crossing);
        return digest.value();
    }

  private:
    void make_room(std::size_t count) {
        if (count <= room_) return;
        met_ = std::make_unique<bool[]>(count);
        room_ = count;
    }

    const RayStream& stream_;
    const Aggregate& asked_;
    RayMask mask_;
    std::vector<Hit> hits_;
    std::unique_ptr<bool[]> met_;
    std::size_t room_ = 0;
    std::vector<std::vector<Hit>> crossings_;
};

/// The batches, cut into pieces unless `whole`.
std::vector<RayBatch> pieces_of(const RayStream& stream, bool whole) {
    if (whole) return stream.batches;
    std::vector<RayBatch> pieces;
    for (const RayBatch& batch : stream.batches) {
        for (std::size_t at = 0; at < batch.count; at += kPiece) {
            RayBatch piece = batch;
            piece.first += at;
            piece.count = std::min(kPiece, batch.count - at);
            pieces.push_back(piece);
        }
    }
    return pieces;
}

/// Shuffles the pieces, except for the first piece of each kind, which come first so that the
/// shortest sample has all kinds. Returns the number of these.
std::size_t shuffle(std::vector<RayBatch>& pieces) {
    RandomStream random(1);
    for (std::size_t i = pieces.size(); i > 1; --i) {
        std::swap(pieces[i - 1], pieces[random.below(i)]);
    }
    std::size_t first = 0;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        const auto piece = std::find_if(
            pieces.begin() + static_cast<std::ptrdiff_t>(first), pieces.end(),
            [&](const RayBatch& at) { return static_cast<std::size_t>(at.kind) == k; });
        if (piece != pieces.end()) std::swap(*piece, pieces[first++]);
    }
    return first;
}

std::string name_of(const RayBatch& batch, const Ray& ray) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    return fmt::format(
        "{} ray, origin {:.17g} {:.17g} {:.17g} direction {:.17g} {:.17g} {:.17g} t {:.17g} to "
        "{:.17g}",
        kRayKindNames[static_cast<std::size_t>(batch.kind)], o.x, o.y, o.z, d.x, d.y, d.z,
        ray.t_min, ray.t_max);
}

/// Counts and compares at least the first `begin` pieces; returns the number of pieces traced.
std::size_t count(const RayStream& stream, const std::vector<RayBatch>& pieces, std::size_t begin,
                  double seconds, Questioner& questioner, Answers& expected,
                  ReplayFigures& figures) {
    const bool fill = expected.empty();
    if (fill) expected.resize(stream.rays.size());
    const CpuClock clock;
    std::size_t asked = 0, rays = 0;
    for (const RayBatch& piece : pieces) {
        KindFigures& kind = figures.kinds[static_cast<std::size_t>(piece.kind)];
        questioner.ask(piece, &kind.tests);
        kind.counted += piece.count;
        for (std::size_t i = 0; i < piece.count; ++i) {
            const std::uint64_t answer = questioner.answer(piece, i);
            std::uint64_t& right = expected[piece.first + i];
            kind.hits += answer != kNothing;
            if (fill) right = answer;
            if (answer == right) continue;
            if (figures.disagreements++ == 0) {
                figures.first_disagreement = name_of(piece, stream.rays[piece.first + i]);
            }
        }
        ++asked;
        rays += piece.count;
        if (fill || rays < kPiece || asked < begin) continue;
        rays = 0;
        if (clock.seconds() > seconds) break;
    }
    return asked;
}

/// Times the first `asked` pieces, kind by kind; false if time ran out.
bool time(const std::vector<RayBatch>& pieces, std::size_t asked, double seconds,
          Questioner& questioner, std::array<KindFigures, kRayKindCount>& kinds) {
    const CpuClock clock;
    double before = 0;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        KindFigures& kind = kinds[k];
        std::size_t rays = 0;
        before = clock.seconds();
        for (std::size_t i = 0; i < asked; ++i) {
            if (static_cast<std::size_t>(pieces[i].kind) != k) continue;
            questioner.ask(pieces[i], nullptr);
            rays += pieces[i].count;
            if (rays < kRaysBetweenClocks) continue;
            const double now = clock.seconds();
            kind.seconds += now - before;
            kind.timed += rays;
            before = now;
            rays = 0;
            // Each kind gets its share of the time.
            if (now > seconds * static_cast<double>(k + 1) / kRayKindCount) break;
        }
        kind.seconds += clock.seconds() - before;
        kind.timed += rays;
    }
    return clock.seconds() <= seconds;
}

}  // namespace

KindFigures& KindFigures::operator+=(const KindFigures& other) {
    counted += other.counted;
    hits += other.hits;
    tests += other.tests;
    timed += other.timed;
    seconds += other.seconds;
    return *this;
}

double KindFigures::each(std::uint64_t count) const {
    return counted == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(counted);
}

double KindFigures::nanoseconds() const {
    return timed == 0 ? 0.0 : 1e9 * seconds / static_cast<double>(timed);
}

KindFigures ReplayFigures::total() const {
    KindFigures sum;
    for (const KindFigures& kind : kinds) sum += kind;
    return sum;
}

double ReplayFigures::each(std::uint64_t TraversalStats::*count) const {
    double sum = 0, rays = 0;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (kinds[k].counted == 0) continue;
        const auto weight = static_cast<double>(recorded[k]);
        sum += weight * kinds[k].each(kinds[k].tests.*count);
        rays += weight;
    }
    return rays == 0 ? 0 : sum / rays;
}

double ReplayFigures::nanoseconds() const {
    double sum = 0, rays = 0;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (kinds[k].timed == 0) continue;
        const auto weight = static_cast<double>(recorded[k]);
        sum += weight * kinds[k].nanoseconds();
        rays += weight;
    }
    return rays == 0 ? 0 : sum / rays;
}

ReplayFigures replay(const RayStream& stream, const Aggregate& asked, const ReplayOptions& options,
                     Answers& expected) {
    ReplayFigures figures;
    figures.recorded = stream.by_kind();
    Questioner questioner(stream, asked, options.mask);
    std::vector<RayBatch> pieces = pieces_of(stream, options.in_batches);
    const std::vector<RayBatch> in_order = pieces;
    const std::size_t begin = !expected.empty() && !options.in_order ? shuffle(pieces) : 1;
    const std::size_t counted =
        count(stream, pieces, begin, options.seconds, questioner, expected, figures);
    figures.all_counted = counted == pieces.size();
    if (options.repetitions == 0) {
        figures.all_timed = false;
        return figures;
    }
    // Picture order if all rays are traced: neighbouring rays share cached data.
    std::array<KindFigures, kRayKindCount> best;
    double least = std::numeric_limits<double>::infinity(), spent = 0;
    for (int i = 0; i < options.repetitions && spent <= options.seconds; ++i) {
        std::array<KindFigures, kRayKindCount> kinds;
        const bool all = time(figures.all_counted ? in_order : pieces, counted,
                              options.seconds - spent, questioner, kinds);
        if (i > 0 && !all) break;
        double sum = 0;
        for (const KindFigures& kind : kinds) sum += kind.seconds;
        spent += sum;
        if (sum >= least) continue;
        least = sum;
        best = kinds;
    }
    figures.all_timed = figures.all_counted;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        figures.kinds[k].timed = best[k].timed;
        figures.kinds[k].seconds = best[k].seconds;
        figures.all_timed = figures.all_timed && best[k].timed == figures.kinds[k].counted;
    }
    return figures;
}

}  // namespace alhazen
