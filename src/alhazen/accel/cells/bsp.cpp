#include "alhazen/accel/cells/bsp.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "alhazen/accel/cells/convex_cell.h"
#include "alhazen/accel/core/bounding_proxies.h"
#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

/// Number of evenly selected primitives of a node whose bounds are candidates.
constexpr std::size_t kSampled = 256;
/// Maximum number of successive splits that do not reduce the cost by themselves.
constexpr int kForgivenSplits = 4;

/// A primitive; of a flat polygon, the part in the node.
struct Piece {
    std::uint32_t primitive;
    std::vector<Vec3> outline;  ///< empty if it is not a flat polygon
};

struct Plane {
    std::uint32_t direction;  ///< index of a common direction, or Bsp::Node::kLeaf: its own
    Vec3 normal;
    double offset;
};

struct Candidate {
    Plane plane;
    std::size_t lower = 0, upper = 0;  ///< number of pieces on each side
    double least = 0;                  ///< lower bound of the cost
};

/// The unit normal; empty if the cross product vanishes.
std::optional<Vec3> unit_normal(const Vec3& a, const Vec3& b) {
    const double scale_a = max_component(abs(a)), scale_b = max_component(abs(b));
    if (!(scale_a > 0.0) || !(scale_b > 0.0)) return std::nullopt;
    const Vec3 n = cross(a / scale_a, b / scale_b);
    const double size = length(n);
    if (!(size > 1e-9)) return std::nullopt;
    return n / size;
}

}  // namespace

class BspBuilder {
  public:
    BspBuilder(const BoundsSource& source, Bsp& tree)
        : source_(source),
          tree_(tree),
          config_(tree.config_),
          fixed_(static_cast<std::uint32_t>(tree.config_.directions)),
          margin_(0.25 * tree.space_.pad),
          center_(tree.space_.box.center()),
          scale_(1.0 / max_component(tree.space_.box.size())) {}

    void run() {
        const auto& directions = SlabDirections<13>::all();
        tree_.normals_.assign(directions.begin(), directions.begin() + fixed_);
        std::vector<Piece> pieces;
        for (std::uint32_t i = 0; i < source_.size(); ++i) {
            pieces.push_back({i, {}});
            pieces.back().outline = outline_of(source_, i);
        }
        max_depth_ = config_.max_depth > 0
                         ? config_.max_depth
                         : static_cast<int>(8.5 + 1.3 * std::log2(double(source_.size())));
        const Box3& box = tree_.space_.box;
        build(std::move(pieces),
              ConvexCell({scale_ * (box.lo - center_), scale_ * (box.hi - center_)}), 0, 0);
    }

  private:
    [[nodiscard]] Interval extent(const Piece& piece, const Vec3& normal) const {
        if (piece.outline.empty()) return source_.extent(piece.primitive, normal);
        Interval range;
        for (const Vec3& p : piece.outline) range.include(dot(normal, p));
        return range;
    }
    /// The offset in the frame of the cells, where coordinates are of order 1.
    [[nodiscard]] double local_offset(const Plane& plane) const {
        return scale_ * (plane.offset - dot(plane.normal, center_));
    }
    [[nodiscard]] Interval extent(const ConvexCell& cell, const Vec3& normal) const {
        const Interval local = cell.extent(normal);
        const double shift = dot(normal, center_);
        return {local.lo / scale_ + shift, local.hi / scale_ + shift};
    }
    [[nodiscard]] double step_cost(const Plane& plane) const {
        return plane.direction < 3 ? config_.axis_cost : config_.traversal_cost;
    }
    [[nodiscard]] double cost(const Candidate& c, double p_lower, double p_upper) const {
        // Restricted to axis-aligned planes: any direction can cut off empty space, and with a
        // bonus for all of them the builder would only do that.
        const bool bonus = c.plane.direction < 3 && (c.lower == 0 || c.upper == 0);
        const double factor = bonus ? config_.empty_factor : 1.0;
        return factor * (step_cost(c.plane) + config_.test_cost * (p_lower * double(c.lower) +
                                                                   p_upper * double(c.upper)));
    }

    /// Adds a candidate that divides the pieces; the probabilities of both parts sum to at least 1.
    void offer(const Candidate& c, std::size_t size, std::vector<Candidate>& candidates) const {
        if (c.lower == size && c.upper == size) return;
        candidates.push_back(c);
        candidates.back().least = c.lower < c.upper ? cost(c, 1.0, 0.0) : cost(c, 0.0, 1.0);
    }

    /// Adds planes at the bounds of pieces, by rank, and planes that cut off empty space.
    void add_candidates_across(std::uint32_t k, const std::vector<Piece>& pieces,
                               const ConvexCell& cell, std::vector<Candidate>& candidates) const {
        interruption_point();
        const Vec3& normal = tree_.normals_[k];
        std::vector<Interval> extents;
        extents.reserve(pieces.size());
        Interval all;
        for (const Piece& piece : pieces) {
            extents.push_back(extent(piece, normal));
            all = hull(all, extents.back());
        }
        std::vector<double> bounds;
        const std::size_t stride = (pieces.size() + kSampled - 1) / kSampled;
        for (std::size_t i = 0; i < pieces.size(); i += stride) {
            bounds.push_back(extents[i].lo - 2 * margin_);
            bounds.push_back(extents[i].hi + 2 * margin_);
        }
        std::sort(bounds.begin(), bounds.end());
        std::vector<double> offsets{all.lo - 2 * margin_, all.hi + 2 * margin_};
        const auto most = static_cast<std::size_t>(config_.candidates);
        for (std::size_t c = 0; c < std::min(most, bounds.size()); ++c) {
            offsets.push_back(
                bounds[(2 * c + 1) * bounds.size() / (2 * std::min(most, bounds.size()))]);
        }
        const Interval inside = extent(cell, normal);
        std::erase_if(offsets, [&](double x) {
            return !(x > inside.lo + 4 * margin_ && x < inside.hi - 4 * margin_);
        });
        std::sort(offsets.begin(), offsets.end());
        offsets.erase(std::unique(offsets.begin(), offsets.end()), offsets.end());
        // Counts of the pieces that begin below an offset, and of those that end above it.
        std::vector<std::size_t> lower(offsets.size() + 1, 0), upper(offsets.size() + 1, 0);
        for (const Interval& e : extents) {
            ++lower[static_cast<std::size_t>(
                std::lower_bound(offsets.begin(), offsets.end(), e.lo - margin_) -
                offsets.begin())];
            ++upper[static_cast<std::size_t>(
                std::upper_bound(offsets.begin(), offsets.end(), e.hi + margin_) -
                offsets.begin())];
        }
        std::size_t below = 0, not_above = 0;
        for (std::size_t c = 0; c < offsets.size(); ++c) {
            below += lower[c];
            not_above += upper[c];
            offer({{k, normal, offsets[c]}, below, pieces.size() - not_above, 0}, pieces.size(),
                  candidates);
        }
    }

    /// Adds the planes of flat polygons, and planes through their edges, perpendicular to them.
    void add_polygon_candidates(const std::vector<Piece>& pieces,
                                std::vector<Candidate>& candidates) const {
        const auto most = static_cast<std::size_t>(config_.candidates);
        const std::size_t stride = (pieces.size() + most - 1) / most;
        for (std::size_t i = 0; i < pieces.size(); i += stride) {
            const std::vector<Vec3> corners = outline_of(source_, pieces[i].primitive);
            if (corners.empty()) continue;
            const auto normal = unit_normal(corners[1] - corners[0], corners[2] - corners[0]);
            if (!normal) continue;
            add_beside(*normal, pieces[i], pieces, candidates);
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const Vec3 edge = corners[(k + 1) % corners.size()] - corners[k];
                if (const auto across = unit_normal(edge, *normal)) {
                    add_beside(*across, pieces[i], pieces, candidates);
                }
            }
        }
    }

    /// Adds the planes that bound a piece on both sides.
    void add_beside(const Vec3& normal, const Piece& piece, const std::vector<Piece>& pieces,
                    std::vector<Candidate>& candidates) const {
        const Interval own = extent(piece, normal);
        const double offsets[2] = {own.lo - 2 * margin_, own.hi + 2 * margin_};
        Candidate made[2];
        for (std::size_t c = 0; c < 2; ++c) {
            made[c].plane = {Bsp::Node::kLeaf, normal, offsets[c]};
        }
        for (const Piece& other : pieces) {
            const Interval e = extent(other, normal);
            for (Candidate& c : made) {
                c.lower += e.lo <= c.plane.offset + margin_;
                c.upper += e.hi >= c.plane.offset - margin_;
            }
        }
        for (const Candidate& c : made) offer(c, pieces.size(), candidates);
    }

    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        Plane plane{Bsp::Node::kLeaf, {}, 0};
    };

    [[nodiscard]] Split find_split(const std::vector<Piece>& pieces, const ConvexCell& cell) const {
        std::vector<Candidate> candidates;
        for (std::uint32_t k = 0; k < fixed_; ++k) {
            add_candidates_across(k, pieces, cell, candidates);
        }
        if (config_.polygons) add_polygon_candidates(pieces, candidates);
        // Sorted by lower bound, so that most candidates are rejected before their areas are
        // computed.
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.least < b.least; });
        Split best;
        for (const Candidate& c : candidates) {
            if (!(c.least < best.cost)) break;
            const ConvexCell::Areas areas =
                cell.areas_of_parts(c.plane.normal, local_offset(c.plane));
            // The plane misses the cell.
            if (!(areas.lower > 1e-12 * cell.area()) || !(areas.upper > 1e-12 * cell.area())) {
                continue;
            }
            const double paid = cost(c, areas.lower / cell.area(), areas.upper / cell.area());
            if (paid < best.cost) best = {paid, c.plane};
        }
        return best;
    }

    /// The part of an outline below a plane.
    [[nodiscard]] std::vector<Vec3> clipped(const std::vector<Vec3>& outline, const Vec3& normal,
                                            double offset) const {
        std::vector<Vec3> part;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
            const double from = dot(normal, a) - offset, to = dot(normal, b) - offset;
            if (from <= 0.0) part.push_back(a);
            if ((from <= 0.0) != (to <= 0.0)) part.push_back(a + (from / (from - to)) * (b - a));
        }
        return part;
    }

    void deal(std::vector<Piece> pieces, const Plane& plane, std::vector<Piece>& lower,
              std::vector<Piece>& upper) const {
        for (Piece& piece : pieces) {
            const Interval e = extent(piece, plane.normal);
            const bool below = e.lo <= plane.offset + margin_;
            const bool above = e.hi >= plane.offset - margin_;
            if (!below) {
                upper.push_back(std::move(piece));
            } else if (!above) {
                lower.push_back(std::move(piece));
            } else if (piece.outline.empty()) {
                lower.push_back(piece);
                upper.push_back(std::move(piece));
            } else {
                lower.push_back({piece.primitive,
                                 clipped(piece.outline, plane.normal, plane.offset + margin_)});
                upper.push_back({piece.primitive,
                                 clipped(piece.outline, -plane.normal, -(plane.offset - margin_))});
            }
        }
    }

    /// Removes pieces that are not flat polygons and do not overlap the cell: single planes do not
    /// separate them at corners.
    void drop_beside(const ConvexCell& cell, std::vector<Piece>& pieces) const {
        std::array<Interval, 13> ranges;
        for (std::uint32_t k = 0; k < fixed_; ++k) {
            const Interval inside = extent(cell, tree_.normals_[k]);
            if (inside.empty()) return;
            ranges[k] = {inside.lo - tree_.space_.pad, inside.hi + tree_.space_.pad};
        }
        Box3 box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = ranges[static_cast<std::size_t>(k)].lo;
            box.hi[k] = ranges[static_cast<std::size_t>(k)].hi;
        }
        std::erase_if(pieces, [&](const Piece& piece) {
            if (!piece.outline.empty()) return false;
            if (!source_.overlaps(piece.primitive, box)) return true;
            for (std::uint32_t k = 3; k < fixed_; ++k) {
                const Interval e = source_.extent(piece.primitive, tree_.normals_[k]);
                if (intersection(e, ranges[k]).empty()) return true;
            }
            return false;
        });
    }

    void build(std::vector<Piece> pieces, ConvexCell cell, int depth, int forgiven) {
        interruption_point();
        const std::size_t index = tree_.nodes_.size();
        tree_.nodes_.emplace_back();
        const double as_leaf = config_.test_cost * static_cast<double>(pieces.size());
        Split split;
        if (depth < max_depth_ && pieces.size() > 1) split = find_split(pieces, cell);
        if (!(split.cost < as_leaf)) ++forgiven;
        if (!std::isfinite(split.cost) || forgiven > kForgivenSplits ||
            (split.cost > 4 * as_leaf && pieces.size() < 16)) {
            make_leaf(index, pieces);
            return;
        }
        const double local = local_offset(split.plane);
        ConvexCell lower_cell = cell.lower_part(split.plane.normal, local);
        ConvexCell upper_cell = cell.upper_part(split.plane.normal, local);
        std::vector<Piece> lower, upper;
        deal(std::move(pieces), split.plane, lower, upper);
        drop_beside(lower_cell, lower);
        drop_beside(upper_cell, upper);
        std::uint32_t normal = split.plane.direction;
        if (normal == Bsp::Node::kLeaf) {
            normal = static_cast<std::uint32_t>(tree_.normals_.size());
            tree_.normals_.push_back(split.plane.normal);
        }
        build(std::move(lower), std::move(lower_cell), depth + 1, forgiven);
        tree_.nodes_[index] = {split.plane.offset, static_cast<std::uint32_t>(tree_.nodes_.size()),
                               0, normal};
        build(std::move(upper), std::move(upper_cell), depth + 1, forgiven);
    }

    void make_leaf(std::size_t index, const std::vector<Piece>& pieces) {
        const std::size_t first = tree_.entries_.size();
        if (first + pieces.size() > 0xFFFFFFFFu || tree_.nodes_.size() > 0xFFFFFFF0u) {
            throw Error(ErrorKind::Resource, "bsp: more than 4294967295 entries in its leaves");
        }
        for (const Piece& piece : pieces) tree_.entries_.push_back(piece.primitive);
        tree_.nodes_[index] = {0, static_cast<std::uint32_t>(first),
                               static_cast<std::uint32_t>(pieces.size()), Bsp::Node::kLeaf};
    }

    const BoundsSource& source_;
    Bsp& tree_;
    const Bsp::Config& config_;
    std::uint32_t fixed_;
    double margin_;
    Vec3 center_;
    double scale_;
    int max_depth_ = 0;
};

Bsp::Config Bsp::configure(SettingsReader& reader) {
    static constexpr const char* kPlanes[] = {"directions3", "directions7", "directions13",
                                              "polygons"};
    static constexpr int kDirections[] = {3, 7, 13, 3};
    Config config;
    const std::size_t planes = reader.choice(
        "planes", "number of plane directions, or the axes and the planes of polygons", 2, kPlanes);
    config.directions = kDirections[planes];
    config.polygons = planes == 3;
    config.candidates = reader.count(
        "candidates", "planes evaluated per direction, polygons that contribute planes", 16, 1,
        1000);
    config.axis_cost =
        reader.number("axis_cost", "cost of a step at an axis-aligned plane", 15, 0.001, 1e6);
    config.traversal_cost =
        reader.number("traversal_cost", "cost of a step at any other plane", 25, 0.001, 1e6);
    config.test_cost = reader.number("test_cost", "cost of testing a primitive", 20, 0.001, 1e6);
    config.empty_factor = reader.number(
        "empty_factor", "cost factor of an axis-aligned split that cuts off empty space", 0.8, 0.01,
        1);
    config.max_depth =
        reader.count("max_depth", "depth of the tree, 0: by the number of primitives", 0, 0, 64);
    config.mailbox = reader.flag("mailbox", "test a primitive in many cells once per ray", true);
    return config;
}

Bsp Bsp::build(const BoundsSource& source, const Config& config) {
    Bsp tree;
    tree.config_ = config;
    tree.primitives_ = static_cast<std::uint32_t>(source.size());
    if (source.size() == 0) return tree;
    tree.space_ = PaddedBox(source);
    BspBuilder(source, tree).run();
    return tree;
}

}  // namespace alhazen
