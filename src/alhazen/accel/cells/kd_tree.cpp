#include "alhazen/accel/cells/kd_tree.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

/// A primitive, or its part in the box of a node.
struct ClippedPrimitive {
    std::uint32_t primitive;
    Box3 box;
};

/// An event of the sweep along an axis. At equal positions ends come before flat pieces, flat
/// pieces before begins.
struct Event {
    enum Type : std::uint8_t { End, Planar, Begin };
    double position;
    std::uint32_t piece;  ///< index in the node's list of pieces
    std::uint8_t axis;
    Type type;

    [[nodiscard]] bool before(const Event& other) const {
        if (position != other.position) return position < other.position;
        if (axis != other.axis) return axis < other.axis;
        if (type != other.type) return type < other.type;
        return piece < other.piece;
    }
};

struct Split {
    double cost = std::numeric_limits<double>::infinity();
    double position = 0;
    std::uint8_t axis = 3;
    bool planar_low = true;  ///< flat pieces in the plane go to the lower side

    [[nodiscard]] bool found() const { return axis < 3; }
};

enum class CellSide : std::uint8_t { Low, High, Both };

}  // namespace

/// Builds depth first. Both methods of finding a plane examine the same candidates with the same
/// counts and thus find the same plane.
class KdTreeBuilder {
  public:
    KdTreeBuilder(const BoundsSource& source, KdTree& tree)
        : source_(source), tree_(tree), config_(tree.config_) {}

    void run() {
        std::vector<ClippedPrimitive> pieces;
        for (std::size_t i = 0; i < source_.size(); ++i) {
            pieces.push_back({static_cast<std::uint32_t>(i), widened(source_.box(i))});
        }
        root_area_ = area(tree_.box());
        max_depth_ = config_.max_depth > 0
                         ? config_.max_depth
                         : static_cast<int>(8.5 + 1.3 * std::log2(double(source_.size())));
        std::vector<Event> events;
        if (!config_.quadratic) {
            for (std::uint32_t i = 0; i < pieces.size(); ++i) add_events(pieces[i].box, i, events);
            sort(events);
        }
        build(std::move(pieces), std::move(events), tree_.box(), 0, 0);
    }

  private:
    static constexpr int kForgivenSplits =
        4;  // maximum number of successive splits that do not pay

    [[nodiscard]] static double area(const Box3& b) {
        const Vec3 s = b.size();
        return s.x * s.y + s.y * s.z + s.z * s.x;
    }
    [[nodiscard]] Box3 widened(const Box3& b) const { return tree_.space_.widened(b); }
    /// Sorts in parts that are merged, to allow interruption: no two events are equal, so the order
    /// is that of a single sort.
    static void sort(std::vector<Event>& events) {
        constexpr std::size_t kPart = 1 << 16;
        const auto before = [](const Event& a, const Event& b) { return a.before(b); };
        const auto at = [&](std::size_t i) {
            return events.begin() + static_cast<std::ptrdiff_t>(std::min(i, events.size()));
        };
        for (std::size_t i = 0; i < events.size(); i += kPart) {
            interruption_point();
            std::sort(at(i), at(i + kPart), before);
        }
        for (std::size_t part = kPart; part < events.size(); part *= 2) {
            for (std::size_t i = 0; i < events.size(); i += 2 * part) {
                interruption_point();
                std::inplace_merge(at(i), at(i + part), at(i + 2 * part), before);
            }
        }
    }
    static void add_events(const Box3& box, std::uint32_t piece, std::vector<Event>& events) {
        for (std::uint8_t axis = 0; axis < 3; ++axis) {
            if (box.lo[axis] == box.hi[axis]) {
                events.push_back({box.lo[axis], piece, axis, Event::Planar});
            } else {
                events.push_back({box.lo[axis], piece, axis, Event::Begin});
                events.push_back({box.hi[axis], piece, axis, Event::End});
            }
        }
    }

    /// Evaluates a plane with these numbers of pieces below, in and above it; improves `best`.
    void weigh(const Box3& box, std::uint8_t axis, double position, std::size_t low,
               std::size_t planar, std::size_t high, Split& best) const {
        if (position <= box.lo[axis] || position >= box.hi[axis]) return;
        Box3 below = box, above = box;
        below.hi[axis] = above.lo[axis] = position;
        const double whole = area(box);
        const double p_low = area(below) / whole, p_high = area(above) / whole;
        const auto cost = [&](std::size_t n_low, std::size_t n_high) {
            const double factor = n_low == 0 || n_high == 0 ? config_.empty_factor : 1.0;
            return factor * (config_.traversal_cost +
                             config_.test_cost * (p_low * double(n_low) + p_high * double(n_high)));
        };
        const auto offer = [&](double c, bool planar_low) {
            // Strict comparison and a fixed order of candidates: both builders resolve ties alike.
            if (c < best.cost) best = {c, position, axis, planar_low};
        };
        offer(cost(low + planar, high), true);
        if (planar > 0) offer(cost(low, planar + high), false);
    }

    /// One sweep over the sorted events.
    [[nodiscard]] Split sweep(const std::vector<Event>& events, std::size_t size,
                              const Box3& box) const {
        Split best;
        std::array<std::size_t, 3> low{}, high{size, size, size};
        for (std::size_t i = 0; i < events.size();) {
            const double position = events[i].position;
            const std::uint8_t axis = events[i].axis;
            std::array<std::size_t, 3> count{};  // by type
            for (; i < events.size() && events[i].position == position && events[i].axis == axis;
                 ++i) {
                ++count[events[i].type];
            }
            high[axis] -= count[Event::Planar] + count[Event::End];
            weigh(box, axis, position, low[axis], count[Event::Planar], high[axis], best);
            low[axis] += count[Event::Begin] + count[Event::Planar];
        }
        return best;
    }

    /// Finds the same plane by recounting the pieces at every candidate.
    [[nodiscard]] Split count_all(const std::vector<ClippedPrimitive>& pieces,
                                  const Box3& box) const {
        std::vector<Event> candidates;
        for (std::uint32_t i = 0; i < pieces.size(); ++i) add_events(pieces[i].box, i, candidates);
        sort(candidates);
        Split best;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            interruption_point();
            const Event& e = candidates[c];
            if (c > 0 && candidates[c - 1].position == e.position &&
                candidates[c - 1].axis == e.axis)
                continue;
            std::size_t low = 0, planar = 0, high = 0;
            for (const ClippedPrimitive& p : pieces) {
                const double lo = p.box.lo[e.axis], hi = p.box.hi[e.axis];
                if (lo == hi && lo == e.position) {
                    ++planar;
                } else {
                    low += lo < e.position;
                    high += hi > e.position;
                }
            }
            weigh(box, e.axis, e.position, low, planar, high, best);
        }
        return best;
    }

    [[nodiscard]] static CellSide side_of(const Box3& b, const Split& split) {
        const double lo = b.lo[split.axis], hi = b.hi[split.axis];
        if (lo == hi && lo == split.position)
            return split.planar_low ? CellSide::Low : CellSide::High;
        if (hi <= split.position) return CellSide::Low;
        return lo >= split.position ? CellSide::High : CellSide::Both;
    }

    /// The part of a piece in the box of a child; empty parts are dropped by the caller.
    [[nodiscard]] Box3 clipped(const ClippedPrimitive& piece, const Box3& box) const {
        Box3 b = widened(source_.clipped_box(piece.primitive, widened(box)));
        for (int k = 0; k < 3; ++k) {
            b.lo[k] = std::max(b.lo[k], std::max(piece.box.lo[k], box.lo[k]));
            b.hi[k] = std::min(b.hi[k], std::min(piece.box.hi[k], box.hi[k]));
        }
        return b;
    }

    struct Half {
        std::vector<ClippedPrimitive> pieces;
        std::vector<Event> events;
    };

    /// Distributes the pieces and splits their events: events of whole pieces stay in order, those
    /// of clipped pieces are sorted and merged.
    void deal(const std::vector<ClippedPrimitive>& pieces, const std::vector<Event>& events,
              const Split& split, const Box3& low_box, const Box3& high_box, Half& low,
              Half& high) const {
        constexpr std::uint32_t kGone = 0xFFFFFFFFu;
        std::vector<std::uint32_t> place_low(pieces.size(), kGone),
            place_high(pieces.size(), kGone);
        std::vector<Event> new_low, new_high;
        const auto take = [&](const ClippedPrimitive& piece, const Box3& b, Half& half) {
            half.pieces.push_back({piece.primitive, b});
            return static_cast<std::uint32_t>(half.pieces.size() - 1);
        };
        const auto take_clipped = [&](const ClippedPrimitive& piece, const Box3& box, Half& half,
                                      std::vector<Event>& fresh) {
            const Box3 b = clipped(piece, box);
            if (!b.empty()) add_events(b, take(piece, b, half), fresh);
        };
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            switch (side_of(pieces[i].box, split)) {
                case CellSide::Low:
                    place_low[i] = take(pieces[i], pieces[i].box, low);
                    break;
                case CellSide::High:
                    place_high[i] = take(pieces[i], pieces[i].box, high);
                    break;
                case CellSide::Both:
                    take_clipped(pieces[i], low_box, low, new_low);
                    take_clipped(pieces[i], high_box, high, new_high);
            }
        }
        if (config_.quadratic) return;
        for (Event e : events) {
            const std::uint32_t l = place_low[e.piece], h = place_high[e.piece];
            if (l != kGone) {
                e.piece = l;
                low.events.push_back(e);
            } else if (h != kGone) {
                e.piece = h;
                high.events.push_back(e);
            }
        }
        splice(low.events, new_low);
        splice(high.events, new_high);
    }
    static void splice(std::vector<Event>& events, std::vector<Event>& fresh) {
        sort(fresh);
        const auto middle = static_cast<std::ptrdiff_t>(events.size());
        events.insert(events.end(), fresh.begin(), fresh.end());
        std::inplace_merge(events.begin(), events.begin() + middle, events.end(),
                           [](const Event& a, const Event& b) { return a.before(b); });
    }

    void build(std::vector<ClippedPrimitive> pieces, std::vector<Event> events, const Box3& box,
               int depth, int forgiven) {
        interruption_point();
        const std::size_t index = tree_.nodes_.size();
        tree_.nodes_.emplace_back();
        const double as_leaf = config_.test_cost * static_cast<double>(pieces.size());
        Split split;
        if (depth < max_depth_ && pieces.size() > 1 && area(box) > 0.0) {
            split = config_.quadratic ? count_all(pieces, box) : sweep(events, pieces.size(), box);
        }
        if (!(split.cost < as_leaf)) ++forgiven;
        if (!split.found() || forgiven > kForgivenSplits ||
            (split.cost > 4 * as_leaf && pieces.size() < 16)) {
            make_leaf(index, pieces, box);
            return;
        }
        Box3 low_box = box, high_box = box;
        low_box.hi[split.axis] = high_box.lo[split.axis] = split.position;
        Half low, high;
        deal(pieces, events, split, low_box, high_box, low, high);
        // Freed before the recursion: only the lists of one path are in memory at a time.
        pieces = {};
        events = {};
        tree_.expected_cost_ += config_.traversal_cost * share(box);
        build(std::move(low.pieces), std::move(low.events), low_box, depth + 1, forgiven);
        const std::size_t upper = tree_.nodes_.size();
        tree_.nodes_[index] = {split.position, static_cast<std::uint32_t>(upper), 0, split.axis};
        build(std::move(high.pieces), std::move(high.events), high_box, depth + 1, forgiven);
    }

    [[nodiscard]] double share(const Box3& box) const {
        return root_area_ > 0.0 ? area(box) / root_area_ : 1.0;
    }

    void make_leaf(std::size_t index, const std::vector<ClippedPrimitive>& pieces,
                   const Box3& box) {
        const std::size_t first = tree_.entries_.size();
        if (first + pieces.size() > 0xFFFFFFFFu) {
            throw Error(ErrorKind::Resource, "kd_tree: more than 4294967295 entries in its leaves");
        }
        for (const ClippedPrimitive& piece : pieces) tree_.entries_.push_back(piece.primitive);
        tree_.nodes_[index] = {0, static_cast<std::uint32_t>(first),
                               static_cast<std::uint32_t>(pieces.size()), 3};
        tree_.expected_cost_ += config_.test_cost * static_cast<double>(pieces.size()) * share(box);
    }

    const BoundsSource& source_;
    KdTree& tree_;
    const KdTree::Config& config_;
    double root_area_ = 0;
    int max_depth_ = 0;
};

KdTree::Config KdTree::configure(SettingsReader& reader) {
    Config config;
    config.traversal_cost =
        reader.number("traversal_cost", "cost of a step to a child", 15, 0.001, 1e6);
    config.test_cost = reader.number("test_cost", "cost of testing a primitive", 20, 0.001, 1e6);
    config.empty_factor = reader.number(
        "empty_factor", "cost factor of a split that cuts off empty space", 0.8, 0.01, 1);
    config.max_depth =
        reader.count("max_depth", "depth of the tree, 0: by the number of primitives", 0, 0, 64);
    static constexpr const char* kBuilders[] = {"nlogn", "n2"};
    config.quadratic =
        reader.choice("build", "method of finding the cheapest planes", 0, kBuilders) == 1;
    config.mailbox = reader.flag("mailbox", "test a primitive in many cells once per ray", true);
    return config;
}

KdTree KdTree::build(const BoundsSource& source, const Config& config) {
    KdTree tree;
    tree.config_ = config;
    tree.primitives_ = static_cast<std::uint32_t>(source.size());
    if (source.size() == 0) return tree;
    tree.space_ = PaddedBox(source);
    KdTreeBuilder(source, tree).run();
    return tree;
}

}  // namespace alhazen
