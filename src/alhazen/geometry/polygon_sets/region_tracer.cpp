#include "alhazen/geometry/polygon_sets/region_tracer.h"

#include <algorithm>
#include <tuple>

namespace alhazen {

void RegionTracer::prepare(const Arrangement& arrangement) {
    arrangement_ = &arrangement;
    rounding_.round(arrangement);
    leaving_.assign(arrangement.points.size(), kNone);
    where_.assign(arrangement.points.size(), kNone);
}

void RegionTracer::trace(const States& inside, PolygonSet& region) {
    collect_links(inside);
    trace_links(region);
}

void RegionTracer::trace(std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
                         PolygonSet& region) {
    links_.clear();
    for (const auto& [from, to] : links) {
        links_.push_back({from, to});
    }
    trace_links(region);
}

void RegionTracer::trace_links(PolygonSet& region) {
    touches_ = 0;
    points_.clear();
    loops_.clear();
    if (rounding_.merges()) {
        cancel_links();
    }
    if (!links_.empty()) {
        connect_links();
        for (std::uint32_t link = 0; link < links_.size(); ++link) {
            if (!links_[link].visited) {
                walk(link);
            }
        }
        for (const Link& link : links_) {
            leaving_[link.from] = kNone;
        }
    }
    write(region);
}

void RegionTracer::collect_links(const States& inside) {
    links_.clear();
    for (const SubEdge& e : arrangement_->sub_edges) {
        if (inside[e.below] == inside[e.above]) {
            continue;
        }
        const auto add = [this, leftward = inside[e.below]](std::uint32_t a, std::uint32_t b) {
            if (a != b) {
                links_.push_back(leftward ? Link{b, a} : Link{a, b});
            }
        };
        const std::span<const std::uint32_t> way = way_of(e);
        for (std::size_t i = 0; i + 1 < way.size(); ++i) {
            add(way[i], way[i + 1]);
        }
    }
}

std::span<const std::uint32_t> RegionTracer::way_of(const SubEdge& sub_edge) {
    way_.assign(1, rounding_.representative(sub_edge.begin));
    const std::span<const std::uint32_t> between = rounding_.between(sub_edge);
    way_.insert(way_.end(), between.begin(), between.end());
    way_.push_back(rounding_.representative(sub_edge.end));
    return way_;
}

// Keeps one of each group of overlapping links, in the direction that remains after cancellation.
void RegionTracer::cancel_links() {
    const auto ends = [](const Link& a) { return std::minmax(a.from, a.to); };
    std::ranges::sort(links_, [&](const Link& a, const Link& b) {
        const std::pair<std::uint32_t, std::uint32_t> ea = ends(a);
        const std::pair<std::uint32_t, std::uint32_t> eb = ends(b);
        return std::tie(ea, a.from) < std::tie(eb, b.from);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < links_.size();) {
        const Link first = links_[i];
        int forward = 0;
        int backward = 0;
        for (; i < links_.size() && ends(links_[i]) == ends(first); ++i) {
            ++(links_[i].from < links_[i].to ? forward : backward);
        }
        if (forward != backward) {
            const auto [lo, hi] = std::minmax(first.from, first.to);
            links_[kept++] = forward > backward ? Link{lo, hi} : Link{hi, lo};
        }
    }
    links_.resize(kept);
}

void RegionTracer::connect_links() {
    bool fans = false;
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        std::uint32_t& head = leaving_[links_[i].from];
        fans = fans || head != kNone;
        links_[i].next = head;
        head = i;
    }
    after_.resize(links_.size());
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        after_[i] = leaving_[links_[i].to];
    }
    if (fans) {
        connect_fans();
    }
}

void RegionTracer::connect_fans() {
    fans_.clear();
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        if (links_[after_[i]].next != kNone) {
            fans_.push_back(i);
        }
    }
    std::ranges::sort(fans_, [this](std::uint32_t a, std::uint32_t b) {
        return std::tie(links_[a].to, a) < std::tie(links_[b].to, b);
    });
    for (std::size_t begin = 0, end = 0; begin < fans_.size(); begin = end) {
        const std::uint32_t point = links_[fans_[begin]].to;
        while (end < fans_.size() && links_[fans_[end]].to == point) {
            ++end;
        }
        connect_fan(point, std::span(fans_).subspan(begin, end - begin));
        ++touches_;
    }
}

// Connects each arriving link to the clockwise next leaving one: the interior lies between the two.
void RegionTracer::connect_fan(std::uint32_t point, std::span<const std::uint32_t> arriving) {
    const std::span<const LatticePoint> at = rounding_.pixels();
    rays_.clear();
    for (const std::uint32_t link : arriving) {
        rays_.push_back({at[links_[link].from], link, false});
    }
    for (std::uint32_t link = leaving_[point]; link != kNone; link = links_[link].next) {
        rays_.push_back({at[links_[link].to], link, true});
    }
    const LatticePoint center = at[point];
    std::ranges::sort(rays_, [center](const Ray& a, const Ray& b) {
        const bool upper_a = a.tip.y > center.y || (a.tip.y == center.y && a.tip.x > center.x);
        const bool upper_b = b.tip.y > center.y || (b.tip.y == center.y && b.tip.x > center.x);
        return upper_a != upper_b ? upper_a : turn(center, a.tip, b.tip) > 0;
    });
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Ray& next = rays_[(i + 1) % rays_.size()];
        if (rays_[i].leaves && !next.leaves) {
            after_[next.link] = rays_[i].link;
        }
    }
}

void RegionTracer::walk(std::uint32_t first) {
    path_.clear();
    for (std::uint32_t link = first; !links_[link].visited; link = after_[link]) {
        links_[link].visited = true;
        where_[links_[link].from] = static_cast<std::uint32_t>(path_.size());
        path_.push_back(links_[link].from);
        const std::uint32_t at = where_[links_[link].to];
        if (at != kNone) {
            take_loop(at);
            for (std::size_t i = at; i < path_.size(); ++i) {
                where_[path_[i]] = kNone;
            }
            path_.resize(at);
        }
    }
}

// Writes the path from `begin` on as a loop, without vertices within straight lines.
void RegionTracer::take_loop(std::size_t begin) {
    const std::span<const LatticePoint> at = rounding_.pixels();
    const auto start = static_cast<std::uint32_t>(points_.size());
    LatticePoint before = at[path_.back()];
    for (std::size_t i = begin; i < path_.size(); ++i) {
        const LatticePoint p = at[path_[i]];
        const LatticePoint next = at[path_[i + 1 < path_.size() ? i + 1 : begin]];
        if (turn(before, p, next) != 0) {
            points_.push_back(p);
        }
        before = p;
    }
    const auto loop = std::span(points_).subspan(start);
    if (loop.size() < 3) {
        points_.resize(start);
        return;
    }
    std::rotate(loop.begin(), std::ranges::min_element(loop), loop.end());
    loops_.emplace_back(start, static_cast<std::uint32_t>(points_.size()));
}

void RegionTracer::write(PolygonSet& region) {
    region.clear();
    if (loops_.size() > 1) {
        std::ranges::sort(loops_, {}, [this](const auto& loop) {
            return std::pair{points_[loop.first], points_[loop.first + 1]};
        });
    }
    region.reserve(points_.size());
    for (const auto& [begin, end] : loops_) {
        for (std::uint32_t i = begin; i < end; ++i) {
            region.add_vertex(points_[i]);
        }
        region.end_loop();
    }
    region.set_touching(touches_ > 0);
}

}  // namespace alhazen
