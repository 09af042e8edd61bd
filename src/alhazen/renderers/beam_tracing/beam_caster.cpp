#include "alhazen/renderers/beam_tracing/beam_caster.h"

#include <algorithm>
#include <cmath>

#include "alhazen/geometry/polygon_sets/mending.h"
#include "alhazen/geometry/polygon_sets/partition.h"

namespace alhazen {

namespace {

/// A remainder with more corners is divided.
constexpr std::size_t kManyRegionCorners = 120;
/// Largest number of edges of a convex hull for which a beam has a side each; beyond, it has the
/// sides of the bounding box.
constexpr std::size_t kHullSides = 8;
/// Distance below which facets touch, in units of the rounding of the tree.
constexpr double kTouch = 8;

std::int32_t on_lattice_line(double x) {
    const double limit = kLatticeLimit;
    return static_cast<std::int32_t>(std::lround(std::clamp(x, -limit, limit)));
}

/// Replaces points by the corners of their convex hull, counter-clockwise (Andrew's monotone chain,
/// Information Processing Letters 9, 1979).
void reduce_to_flat_hull(std::vector<LatticePoint>& points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return;
    std::vector<LatticePoint> chain;
    const auto add = [&](const LatticePoint& p, std::size_t least) {
        while (chain.size() >= least + 2 && turn(chain[chain.size() - 2], chain.back(), p) <= 0) {
            chain.pop_back();
        }
        chain.push_back(p);
    };
    for (const LatticePoint& p : points) add(p, 0);
    const std::size_t lower = chain.size() - 1;
    for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
    chain.pop_back();
    points.swap(chain);
}

/// Removes repeated points and those on straight lines.
void straighten(std::vector<LatticePoint>& loop) {
    std::size_t begin = 0, end = 0;
    for (const LatticePoint p : loop) {
        while (end >= 2 && turn(loop[end - 2], loop[end - 1], p) == 0) --end;
        if (end == 1 && loop[0] == p) continue;
        loop[end++] = p;
    }
    while (end - begin >= 3) {
        if (turn(loop[end - 2], loop[end - 1], loop[begin]) == 0) {
            --end;
        } else if (turn(loop[end - 1], loop[begin], loop[begin + 1]) == 0) {
            ++begin;
        } else {
            break;
        }
    }
    loop.resize(end);
    loop.erase(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(begin));
}

/// Straightens a loop. False if it is not convex and counter-clockwise afterwards.
bool make_canonical(std::vector<LatticePoint>& loop) {
    straighten(loop);
    if (loop.size() < 3) {
        loop.clear();
        return true;
    }
    if (twice_area(std::span<const LatticePoint>(loop)) < 0) std::reverse(loop.begin(), loop.end());
    int turns_back = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::size_t n = loop.size();
        const LatticePoint a = loop[k], b = loop[(k + 1) % n], c = loop[(k + 2) % n];
        if (turn(a, b, c) <= 0) return false;
        turns_back += (a < b) != (b < c);
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    return turns_back <= 2;
}

}  // namespace

BeamCounts& BeamCounts::operator+=(const BeamCounts& other) {
    beams += other.beams;
    shadow_beams += other.shadow_beams;
    pieces += other.pieces;
    cuts += other.cuts;
    seen += other.seen;
    shadow += other.shadow;
    return *this;
}

void BeamCaster::set_sides(const BeamProjection& projection, const PolygonSet& region) {
    sides_ = limits_;
    if (set_hull_sides(projection, region)) return;
    const LatticeBox& box = region.bounds();
    sides_.push_back(projection.plane(1, 0, -box.lo.x));
    sides_.push_back(projection.plane(-1, 0, box.hi.x));
    sides_.push_back(projection.plane(0, 1, -box.lo.y));
    sides_.push_back(projection.plane(0, -1, box.hi.y));
}

bool BeamCaster::set_hull_sides(const BeamProjection& projection, const PolygonSet& region) {
    hull_.clear();
    for (std::size_t k = 0; k < region.loop_count(); ++k) {
        const std::span<const LatticePoint> loop = region.loop(k);
        hull_.insert(hull_.end(), loop.begin(), loop.end());
    }
    reduce_to_flat_hull(hull_);
    if (hull_.size() < 3 || hull_.size() > kHullSides) return false;
    for (std::size_t k = 0; k < hull_.size(); ++k) {
        const LatticePoint a = hull_[k], b = hull_[k + 1 == hull_.size() ? 0 : k + 1];
        const double dx = double(b.x) - a.x, dy = double(b.y) - a.y;
        sides_.push_back(projection.plane(-dy, dx, dy * a.x - dx * a.y));
    }
    return true;
}

bool BeamCaster::project(const BeamProjection& projection, std::span<const Vec3> corners,
                         PolygonSet& result) {
    const double margin = kTouch * scene_.tree.margin();
    loop_.assign(corners.begin(), corners.end());
    const auto clip = [&](const FacetPlane& plane, double least) {
        if (loop_.empty() || side_range(plane, loop_).least >= least) return;
        clip_before(plane, least, loop_, clipped_);
        loop_.swap(clipped_);
    };
    for (const FacetPlane& plane : limits_) clip(plane, margin);
    const double limit = kLatticeLimit;
    clip(projection.plane(1, 0, limit), 0.0);
    clip(projection.plane(-1, 0, limit), 0.0);
    clip(projection.plane(0, 1, limit), 0.0);
    clip(projection.plane(0, -1, limit), 0.0);
    if (loop_.empty()) return false;
    flat_.clear();
    for (const Vec3& p : loop_) {
        const Vec3 w = projection(p);
        flat_.push_back({on_lattice_line(w.x / w.z), on_lattice_line(w.y / w.z)});
    }
    if (!make_canonical(flat_)) {
        result = polygon_set(flat_);
        return !result.empty();
    }
    if (flat_.empty()) return false;
    result.clear();
    for (const LatticePoint& p : flat_) result.add_vertex(p);
    result.end_loop();
    return true;
}

bool BeamCaster::is_seen(const BeamView& view, std::uint32_t facet) const {
    const BeamFacet& f = scene_.facets[facet];
    if (facet == view.from) return false;
    if ((scene_.sources[f.source].visible_to & mask_of(view.kind)) == 0) return false;
    return !f.one_sided || view.apex.side(scene_.plane(facet)) > 0.0;
}

std::span<const FacetPiece> BeamCaster::next(Order& order, const BeamSides& sides) {
    if (options_.tree) return order.walk.next(sides, counts_.seen);
    if (order.next == list_.size()) return {};
    ++counts_.seen.polygons;
    return std::span(list_).subspan(order.next++, 1);
}

void BeamCaster::see(const BeamView& view, PolygonSet region, std::vector<SeenFacet>& result) {
    ++counts_.beams;
    const PolygonSet whole = region;
    const std::size_t first = result.size();
    limits_ = {view.projection.plane(0, 0, 1)};
    if (view.has_start) limits_.push_back(view.start);
    if (!options_.tree) {
        set_sides(view.projection, region);
        list_pool_ = scene_.tree.pool();
        DepthOrderReport report;
        list_ = depth_order(list_pool_, scene_.tree.pieces(), view.apex, view.projection, sides_,
                            scene_.tree.margin(), report);
        counts_.seen.polygons += report.polygons;
    }
    std::vector<Rest> waiting;
    waiting.push_back({std::move(region), {FacetWalk(scene_.tree, view.apex, options_.hulls), 0}});
    while (!waiting.empty()) {
        Rest rest = std::move(waiting.back());
        waiting.pop_back();
        see_rest(view, rest, waiting, result);
        if (!rest.region.empty()) result.push_back({kNoFacet, std::move(rest.region)});
    }
    fit_together(whole, std::span(result).subspan(first));
    std::erase_if(result, [](const SeenFacet& s) { return s.region.empty(); });
    for (const SeenFacet& s : std::span(result).subspan(first)) {
        counts_.pieces += s.facet != kNoFacet;
    }
}

void BeamCaster::fit_together(const PolygonSet& whole, std::span<SeenFacet> pieces) {
    parts_.clear();
    for (SeenFacet& piece : pieces) parts_.push_back(std::move(piece.region));
    make_partition(whole, parts_);
    for (std::size_t k = 0; k < pieces.size(); ++k) pieces[k].region = std::move(parts_[k]);
}

void BeamCaster::see_rest(const BeamView& view, Rest& rest, std::vector<Rest>& waiting,
                          std::vector<SeenFacet>& result) {
    set_sides(view.projection, rest.region);
    const FacetPool& pool = options_.tree ? scene_.tree.pool() : list_pool_;
    const double margin = scene_.tree.margin();
    while (true) {
        const std::span<const FacetPiece> pieces = next(rest.order, sides_);
        if (pieces.empty()) return;
        for (const FacetPiece& piece : pieces) {
            if (!is_seen(view, piece.facet)) continue;
            const std::span<const Vec3> corners = pool.corners(piece);
            if (misses(corners, sides_, margin)) continue;
            if (!project(view.projection, corners, shape_)) continue;
            if (!shape_.bounds().meets(rest.region.bounds())) continue;
            ++counts_.cuts;
            cut(rest.region, shape_, cut_);
            if (cut_.inside.empty()) continue;
            take_slivers(cut_);
            result.push_back({piece.facet, std::move(cut_.inside)});
            std::swap(rest.region, cut_.outside);
            if (rest.region.empty()) return;
            set_sides(view.projection, rest.region);
        }
        if (rest.region.vertex_count() > kManyRegionCorners) {
            divide(rest, waiting);
            set_sides(view.projection, rest.region);
        }
    }
}

void BeamCaster::take_slivers(PolygonCut& parts) {
    PolygonSet slivers;
    for (std::size_t k = 0; k < parts.outside.loop_count(); ++k) {
        const std::span<const LatticePoint> loop = parts.outside.loop(k);
        LatticeBox box;
        for (const LatticePoint& p : loop) box.extend(p);
        const Int128 sides = Int128{box.hi.x} - box.lo.x + box.hi.y - box.lo.y;
        const Int128 area = twice_area(loop);
        if (area < 0 || area > 4 * sides) continue;
        for (const LatticePoint& p : loop) slivers.add_vertex(p);
        slivers.end_loop();
    }
    if (slivers.empty()) return;
    counts_.cuts += 2;
    const PolygonCut thin = cut(parts.outside, slivers);
    parts.inside = union_of(parts.inside, thin.inside);
    parts.outside = thin.outside;
}

void BeamCaster::divide(Rest& rest, std::vector<Rest>& waiting) {
    const LatticeBox& box = rest.region.bounds();
    const std::int32_t wide = box.hi.x - box.lo.x, high = box.hi.y - box.lo.y;
    if (std::max(wide, high) < 4096) return;
    LatticePoint hi = box.hi;
    (wide >= high ? hi.x : hi.y) -= std::max(wide, high) / 2;
    ++counts_.cuts;
    cut(rest.region, lattice_rectangle(box.lo, hi), cut_);
    if (cut_.inside.empty() || cut_.outside.empty()) return;
    waiting.push_back({std::move(cut_.outside), rest.order});
    rest.region = std::move(cut_.inside);
}

std::vector<LitPart> BeamCaster::lit(const BeamView& view, const SeenFacet& piece,
                                     const BeamApex& light, bool opaque) {
    ++counts_.shadow_beams;
    const FacetPlane& outer = scene_.plane(piece.facet);
    const double side = light.side(outer);
    const FacetPlane plane = side < 0.0 ? outer.reversed() : outer;
    if (!(std::abs(side) > kTouch * scene_.tree.margin() * light.weight)) return {};
    const BeamProjection projection = view.projection.after(SpaceMap::shadow(plane, light));
    limits_ = {plane, projection.plane(0, 0, 1)};
    if (light.weight != 0.0) {
        limits_.push_back({-plane.normal, -(plane.offset + std::abs(side))});
    }
    std::vector<LitPart> parts;
    parts.push_back({piece.region, {}});
    part_boxes_.reset(piece.region.bounds());
    part_boxes_.add(piece.region.bounds());
    lit_parts_ = 1;
    set_sides(projection, piece.region);
    FacetWalk walk(scene_.tree, light, options_.hulls);
    while (lit_parts_ > 0) {
        const std::span<const FacetPiece> pieces = walk.next(sides_, counts_.shadow);
        if (pieces.empty()) break;
        for (const FacetPiece& occluder : pieces) {
            const BeamFacet& facet = scene_.facets[occluder.facet];
            if (occluder.facet == piece.facet) continue;
            if ((scene_.sources[facet.source].visible_to & mask_of(RayKind::Shadow)) == 0) continue;
            if (facet.one_sided && light.side(scene_.plane(occluder.facet)) < 0.0) continue;
            const std::span<const Vec3> corners = scene_.tree.pool().corners(occluder);
            if (misses(corners, sides_, scene_.tree.margin())) continue;
            if (!project(projection, corners, shape_)) continue;
            darken(shape_, occluder.facet, opaque || facet.blocks_light, parts);
        }
    }
    std::erase_if(parts, [](const LitPart& part) { return part.region.empty(); });
    return parts;
}

void BeamCaster::darken(const PolygonSet& shadow, std::uint32_t facet, bool opaque,
                        std::vector<LitPart>& parts) {
    const bool divides = opaque || options_.most_parts == 0 || lit_parts_ < options_.most_parts;
    for (const std::uint32_t k : part_boxes_.near(shadow.bounds())) {
        if (!shadow.bounds().meets(parts[k].region.bounds())) continue;
        ++counts_.cuts;
        cut(parts[k].region, shadow, cut_);
        if (cut_.inside.empty()) continue;
        if (!divides) {
            const bool most = twice_area(cut_.inside) > twice_area(cut_.outside);
            if (most) parts[k].through.push_back(facet);
            continue;
        }
        parts[k].region = std::move(cut_.outside);
        if (parts[k].region.empty()) --lit_parts_;
        if (opaque) continue;
        LitPart tinted{std::move(cut_.inside), parts[k].through};
        tinted.through.push_back(facet);
        part_boxes_.add(tinted.region.bounds());
        parts.push_back(std::move(tinted));
        ++lit_parts_;
    }
}

}  // namespace alhazen
