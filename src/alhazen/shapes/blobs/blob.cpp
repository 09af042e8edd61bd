#include "alhazen/shapes/blobs/blob.h"

#include <algorithm>
#include <utility>

#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/blobs/blob_pieces.h"

namespace alhazen {

namespace {

using namespace blob;

struct Event {
    double t;
    std::uint32_t piece;
    bool begins;
};

/// Buffers for one ray; kept between rays to avoid allocation.
struct Workspace {
    std::vector<Piece> pieces;
    std::vector<Event> events;
    std::vector<std::uint32_t> active;
};

/// Collects the crossings of consecutive spans.
class SpanWalk {
  public:
    SpanWalk(const LocalRay& ray, const Workspace& work, ShapeHits& hits)
        : ray_(ray), work_(work), hits_(hits) {}

    /// The components in work.active are active on [t0, t1].
    void span(double t0, double t1) {
        gap(t0);
        last_ = t1;
        if (is_weak(t0, t1)) {
            if (skipped_) inside_ = skipped_ = false;
            return leave(t0);
        }
        double most = 0.0;
        for (const std::uint32_t i : work_.active) {
            most += std::max(0.0, ray_.blob.components[work_.pieces[i].component].strength);
        }
        SignChanges<4> changes;
        find_certified_sign_changes<4>(
            [&]<class Real>(BernsteinPolynomial<Real, 4>& p) {
                p.degree = 4;
                p.error = 0.0;
                for (int k = 0; k <= 4; ++k) p.b[k] = Real(ray_.blob.threshold);
                for (const std::uint32_t i : work_.active) ray_.add(work_.pieces[i], t0, t1, p);
                const double terms = ray_.blob.threshold + most;
                p.error *= 1.0 + kRounding<Real> * double(work_.active.size());
                p.error += kRounding<Real> * 4.0 * double(work_.active.size()) * terms;
            },
            changes);
        if (skipped_) inside_ = changes.negative_at_start;
        skipped_ = false;
        if (changes.negative_at_start != inside_) turn(t0);
        for (int k = 0; k < changes.count; ++k) turn(t0 + changes.u[k] * (t1 - t0));
    }
    /// Skips a span that ends before the ray begins.
    void skip(double t1) {
        last_ = t1;
        skipped_ = true;
    }
    /// The density is zero between the last span and t.
    void gap(double t) {
        if (t == last_) return;
        if (skipped_) inside_ = skipped_ = false;
        leave(last_);
    }
    /// Beyond t the density is zero.
    void leave(double t) {
        if (inside_) turn(t);
    }

  private:
    /// True if the sum of the components in work.active is below the threshold on all of [t0, t1].
    [[nodiscard]] bool is_weak(double t0, double t1) const {
        double here = 0.0;
        for (const std::uint32_t i : work_.active) {
            const Piece& piece = work_.pieces[i];
            const double s = std::max(0.0, ray_.blob.components[piece.component].strength);
            if (piece.bump.known()) {
                const double q = std::max(0.0, piece.bump.largest(t0, t1)) + piece.room;
                here += s * q * q;
            } else {
                here += s;
            }
            // Written so that NaN is not skipped.
            if (!(here < 0.999 * ray_.blob.threshold)) return false;
        }
        return true;
    }
    void turn(double t) {
        const double at = ray_.shift + t;
        inside_ = !inside_;
        if (ray_.given.covers(at)) hits_.push_back({at, 0, inside_ ? -1.0 : 1.0, 0});
    }

    const LocalRay& ray_;
    const Workspace& work_;
    ShapeHits& hits_;
    double last_ = -kInfinity;
    bool inside_ = false;
    bool skipped_ = false;  ///< whether it is inside here is unknown
};

}  // namespace

void Blob::prepare() {
    std::vector<Box3> boxes;
    bounds = {};
    for (const BlobComponent& c : components) {
        const Vec3 half{c.radius, c.radius, c.radius};
        Box3 box = outward_box(c.base, half);
        if (c.rod) box.include(outward_box(c.top, half));
        bounds.include(box);
        boxes.push_back(box);
    }
    reach = std::max(max_component(abs(bounds.lo)), max_component(abs(bounds.hi)));
    auto made = std::make_shared<BlobTree>(boxes);
    if (components.size() <= BlobTree::kFew) {
        for (const BlobComponent& c : components) {
            const Vec3 along = c.rod ? 0.5 * (c.top - c.base) : Vec3{};
            made->add_sphere(c.base + along, c.radius + length(along));
        }
    }
    tree = std::move(made);
}

void Blob::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    if (components.empty()) return checks.fail("at least one sphere or cylinder must be given");
    checks.length("threshold", threshold);
    for (const BlobComponent& c : components) {
        checks.point("center or base of a component", c.base);
        if (c.rod) checks.point("top of a component", c.top);
        checks.length("radius of a component", c.radius);
        if (!(std::abs(c.strength) <= kMaxCoordinate)) {
            checks.fail("strength of a component must be a number below 1e70");
        }
        if (checks.ok() && c.rod) {
            checks.length("distance from base to top of a component", length(c.top - c.base));
        }
        if (!checks.ok()) return;
    }
}

Interval Blob::extent(const Vec3& axis) const {
    Interval range;
    for (const BlobComponent& c : components) {
        const double half = c.radius * length(axis);
        range = hull(range, outward_extent(axis, c.base, half));
        if (c.rod) range = hull(range, outward_extent(axis, c.top, half));
    }
    return range;
}

namespace {

/// Collects the pieces of all components that the line may intersect.
void collect_pieces(const LocalRay& local, std::vector<Piece>& pieces) {
    const Blob& blob = local.blob;
    const auto add = [&](std::uint32_t i) { add_pieces(local, i, pieces); };
    if (blob.components.size() > BlobTree::kFew) {
        const double pad = 0x1p-48 * (local.far + blob.reach);
        return blob.tree->for_line(local.o, local.given.direction, pad, add);
    }
    for (std::uint32_t i = 0; i < blob.components.size(); ++i) {
        if (!misses_ball(local, blob.components[i])) add(i);
    }
}

/// True if the sum of all pieces is below the threshold for any overlap.
bool all_weak(const LocalRay& local, const std::vector<Piece>& pieces) {
    double most = 0.0;
    for (const Piece& piece : pieces) {
        const double s = std::max(0.0, local.blob.components[piece.component].strength);
        const double q = piece.bump.known() ? std::max(0.0, piece.bump.peak) + piece.room : 1.0;
        most += s * q * q;
    }
    return most < 0.999 * local.blob.threshold;
}

/// Sorts the events of the pieces. The events of the previous ray are the initial order, which for
/// coherent rays needs few changes.
void order_events(const std::vector<Piece>& pieces, std::vector<Event>& events) {
    const auto is_before = [](const Event& a, const Event& b) {
        return a.t != b.t ? a.t < b.t : a.piece < b.piece;
    };
    if (events.size() == 2 * pieces.size()) {
        for (Event& event : events) {
            const Piece& piece = pieces[event.piece];
            event.t = event.begins ? piece.in : piece.out;
        }
    } else {
        events.clear();
        for (std::uint32_t i = 0; i < pieces.size(); ++i) {
            events.push_back({pieces[i].in, i, true});
            events.push_back({pieces[i].out, i, false});
        }
        std::sort(events.begin(), events.end(), is_before);
    }
    constexpr std::size_t kFewMoves = 64;
    std::size_t moves = 0;
    for (std::size_t i = 1; i < events.size(); ++i) {
        const Event event = events[i];
        std::size_t to = i;
        for (; to > 0 && is_before(event, events[to - 1]); --to) events[to] = events[to - 1];
        events[to] = event;
        moves += i - to;
        if (moves > kFewMoves) return std::sort(events.begin(), events.end(), is_before);
    }
}

/// The crossings of the pieces in `work`; `events` are those of the previous ray.
void walk_pieces_body(const LocalRay& local, Workspace& work, std::vector<Event>& events,
                      ShapeHits& hits) {
    const Ray& ray = local.given;
    if (all_weak(local, work.pieces)) return;
    work.active.clear();
    order_events(work.pieces, events);
    SpanWalk walk(local, work, hits);
    double last = 0.0;
    for (const Event& event : events) {
        if (!work.active.empty() && last < event.t) {
            if (event.t + local.shift < ray.t_min) {
                walk.skip(event.t);
            } else if (last + local.shift > ray.t_max || hits.enough()) {
                return walk.gap(last);
            } else {
                walk.span(last, event.t);
            }
        }
        last = event.t;
        // In the order of the pieces, so that sums do not depend on where the pieces begin.
        const auto at = std::lower_bound(work.active.begin(), work.active.end(), event.piece);
        if (event.begins) {
            work.active.insert(at, event.piece);
        } else {
            work.active.erase(at);
        }
    }
    walk.gap(kInfinity);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(void walk_pieces(const LocalRay& local, Workspace& work,
                                                  std::vector<Event>& events, ShapeHits& hits),
                                 walk_pieces_body(local, work, events, hits))

void intersect_blob(const Blob& blob, const Ray& ray, Workspace& work, ShapeHits& hits) {
    work.pieces.clear();
    const LocalRay local(blob, ray);
    if (!is_finite(local.o)) return;
    collect_pieces(local, work.pieces);
    walk_pieces(local, work, work.events, hits);
}

}  // namespace

void Blob::intersect(const Ray& ray, ShapeHits& hits) const {
    static thread_local Workspace work;
    intersect_blob(*this, ray, work, hits);
}

}  // namespace alhazen
