#include "alhazen/geometry/polygon_sets/snap_rounding.h"

#include <algorithm>

namespace alhazen {

namespace {

/// Number of points between the ends of a sub-edge above which the pixels on it are found by a
/// tree.
constexpr std::uint32_t kManyPoints = 96;
constexpr std::uint32_t kTreeLeaf = 8;

}  // namespace

void SnapRounding::round(const Arrangement& arrangement) {
    arrangement_ = &arrangement;
    rounds_ = arrangement.rounds;
    merges_ = false;
    tree_.clear();
    const auto n = static_cast<std::uint32_t>(arrangement.points.size());
    pixels_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const LatticePlace& p = arrangement.points[i];
        pixels_[i] = p.den == 1 ? p.from : rounded(p);
    }
    if (rounds_) {
        merge_columns();
    }
}

void SnapRounding::merge_columns() {
    const auto n = static_cast<std::uint32_t>(pixels_.size());
    representative_.resize(n);
    for (std::uint32_t begin = 0, end = 0; begin < n; begin = end) {
        representative_[begin] = begin;
        bool between_lattice = arrangement_->points[begin].den != 1;
        for (end = begin + 1; end < n && pixels_[end].x == pixels_[begin].x; ++end) {
            representative_[end] = end;
            between_lattice = between_lattice || arrangement_->points[end].den != 1;
        }
        if (end - begin > 1 && between_lattice) {
            merge_column(begin, end);
        }
    }
}

// Merges the points of one column of pixels: those of one pixel get one representative.
void SnapRounding::merge_column(std::uint32_t begin, std::uint32_t end) {
    column_.clear();
    for (std::uint32_t i = begin; i < end; ++i) {
        column_.push_back(i);
    }
    std::ranges::sort(column_, [this](std::uint32_t a, std::uint32_t b) {
        return pixels_[a].y != pixels_[b].y ? pixels_[a].y < pixels_[b].y : a < b;
    });
    for (std::size_t i = 1; i < column_.size(); ++i) {
        if (pixels_[column_[i]].y == pixels_[column_[i - 1]].y) {
            representative_[column_[i]] = representative_[column_[i - 1]];
            merges_ = true;
        }
    }
}

std::span<const std::uint32_t> SnapRounding::between(const SubEdge& sub_edge) {
    between_.clear();
    if (!rounds_) {
        return between_;
    }
    edge_ = arrangement_->edges[sub_edge.edge];
    ends_[0] = pixels_[sub_edge.begin];
    ends_[1] = pixels_[sub_edge.end];
    box_ = {};
    box_.extend(ends_[0]);
    box_.extend(ends_[1]);
    const auto n = static_cast<std::uint32_t>(pixels_.size());
    if (sub_edge.end - sub_edge.begin > kManyPoints) {
        if (tree_.empty()) {
            for (std::uint32_t i = 0; i < n; ++i) {
                if (representative_[i] == i) {
                    tree_.push_back(i);
                }
            }
            build_tree(0, static_cast<std::uint32_t>(tree_.size()), true);
        }
        search_tree(0, static_cast<std::uint32_t>(tree_.size()), true);
    } else {
        std::uint32_t i = sub_edge.begin;
        while (i > 0 && pixels_[i - 1].x == box_.lo.x) {
            --i;
        }
        for (; i < n && pixels_[i].x <= box_.hi.x; ++i) {
            if (representative_[i] == i) {
                try_pixel(i);
            }
        }
    }
    if (between_.size() > 1) {
        const bool falls = ends_[1].y < ends_[0].y;
        std::ranges::sort(between_, [this, falls](std::uint32_t a, std::uint32_t b) {
            const LatticePoint pa = pixels_[a];
            const LatticePoint pb = pixels_[b];
            return pa.x != pb.x ? pa.x < pb.x : (falls ? pa.y > pb.y : pa.y < pb.y);
        });
    }
    merges_ = merges_ || !between_.empty();
    return between_;
}

void SnapRounding::try_pixel(std::uint32_t point) {
    const LatticePoint p = pixels_[point];
    if (p.y >= box_.lo.y && p.y <= box_.hi.y && p.x >= box_.lo.x && p.x <= box_.hi.x &&
        p != ends_[0] && p != ends_[1] && meets_pixel(edge_.lo, edge_.hi, p)) {
        between_.push_back(point);
    }
}

void SnapRounding::build_tree(std::uint32_t begin, std::uint32_t end, bool by_x) {
    if (end - begin <= kTreeLeaf) {
        return;
    }
    const std::uint32_t mid = begin + (end - begin) / 2;
    std::nth_element(tree_.begin() + begin, tree_.begin() + mid, tree_.begin() + end,
                     [this, by_x](std::uint32_t a, std::uint32_t b) {
                         return by_x ? pixels_[a].x < pixels_[b].x : pixels_[a].y < pixels_[b].y;
                     });
    build_tree(begin, mid, !by_x);
    build_tree(mid + 1, end, !by_x);
}

// Only the part of a long edge within each cell counts: box_ shrinks on the way down.
void SnapRounding::search_tree(std::uint32_t begin, std::uint32_t end, bool by_x) {
    if (end - begin <= kTreeLeaf) {
        for (std::uint32_t i = begin; i < end; ++i) {
            try_pixel(tree_[i]);
        }
        return;
    }
    const std::uint32_t mid = begin + (end - begin) / 2;
    const LatticePoint p = pixels_[tree_[mid]];
    try_pixel(tree_[mid]);
    const std::int32_t split = by_x ? p.x : p.y;
    if ((by_x ? box_.lo.x : box_.lo.y) <= split) {
        search_tree(begin, mid, !by_x);
    }
    if ((by_x ? box_.hi.x : box_.hi.y) >= split) {
        search_tree(mid + 1, end, !by_x);
    }
}

}  // namespace alhazen
