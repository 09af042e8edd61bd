#include "alhazen/solids/triangles/surface_cells.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/interruption.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/solids/triangles/cell_sheets.h"

namespace alhazen {

namespace {

/// Cells along the root if none is divided more than the box asks for.
constexpr std::uint32_t kRootCells = 32;
/// The largest number of cells that the box of a part, and those of all, are divided into. Each
/// part gets at least the smaller number: half its least side in a cube.
constexpr double kMostOfPart = 4096, kMostOfParts = 262144, kLeastOfPart = 8;
/// The largest number of lines along an axis through a part, and through all that have several.
constexpr double kMostLinesInPart = 1024, kMostLinesInParts = 65536;
/// How far from its cell a vertex may be, in cells, where triangles are tested: an edge of the
/// surface beside a cell is met.
constexpr double kVertexBeyond = 0.5;
/// Of so many faces that are not near, the distance of one is measured.
constexpr std::size_t kFacesPerDistance = 64;
/// Faces that are tested at once.
constexpr std::size_t kFacesOfBlock = 4096;
/// Distance of lines that are not edges of cells, in cells of the largest size.
constexpr double kLineSpacing = 0.25;

Vec3 axis_vector(std::size_t axis) {
    Vec3 along;
    along[static_cast<int>(axis)] = 1.0;
    return along;
}

}  // namespace

SurfaceCells::SurfaceCells(const IsolatedSolid& solid, double cell, int halvings, double tolerance,
                           SolidCoordinates* coordinates)
    : solid_(solid),
      line_(solid),
      cell_(cell),
      unit_(std::ldexp(cell, -halvings)),
      limit_(0.5 * tolerance),
      spacing_(std::max(kLineSpacing * cell, tolerance)),
      box_(solid.box()),
      // Irrational shifts keep planes of cells off likely planes of the solid; outermost nodes are
      // outside.
      origin_(box_.lo - cell * Vec3{0.6180339887, 0.7548776662, 0.5698402910}),
      tree_(kRootCells << halvings),
      tests_(solid, vertices_, limit_),
      coordinates_(coordinates) {
    split_to(0, box_, std::uint32_t{1} << halvings);
    const std::vector<IsolatedSolid::SurfacePart> parts = solid.surface_parts();
    const double count = static_cast<double>(parts.size());
    const double cells = std::clamp(kMostOfParts / count, kLeastOfPart, kMostOfPart);
    const double lines = std::clamp(kMostLinesInParts / count, 1.0, kMostLinesInPart);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        interruption_point();
        split_part(parts[k].box, cells);
        start_part(parts[k], k, lines);
    }
}

bool SurfaceCells::divide(std::uint64_t max_triangles) {
    do {
        drop_edges();
        find_edges(max_triangles);
        if (2 * edges_.size() > max_triangles) return false;
        place_vertices();
        test_faces();
        if (asked_.empty()) test_lines();
    } while (split_cells());
    return true;
}

// ---- Division.
void SurfaceCells::split_to(std::uint32_t cell, const Box3& box, std::uint32_t size) {
    const CellTree::Cell own = tree_[cell];
    if (own.size <= size) return;
    const Vec3 lo = position(own.at);
    for (int k = 0; k < 3; ++k) {
        if (lo[k] > box.hi[k] || lo[k] + unit_ * own.size < box.lo[k]) return;
    }
    if (tree_.is_leaf(cell)) tree_.split(cell);
    for (std::uint32_t k = 0; k < 8; ++k) split_to(tree_[cell].first_child + k, box, size);
}

void SurfaceCells::split_part(const Box3& part, double most) {
    const Vec3 sides = part.size();
    double cell = std::max(0.5 * std::min({sides.x, sides.y, sides.z}), unit_);
    const auto count = [&] {
        double product = 1;
        for (int k = 0; k < 3; ++k) product *= std::max(1.0, sides[k] / cell);
        return product;
    };
    while (count() > most) cell *= 1.25;
    std::uint32_t size = 1;
    while (2.0 * size * unit_ <= cell && size < tree_[0].size) size *= 2;
    split_to(0, part, size);
}

void SurfaceCells::start_part(const IsolatedSolid::SurfacePart& part, std::size_t number,
                              double most) {
    if (part.own.empty() || !part.own.bounded()) return;
    const Vec3 sides = part.own.size();
    const double least = std::min({sides.x, sides.y, sides.z});
    if (!(least > 0.0)) return;
    std::array<Vec3, 3> along;
    Vec3 corner;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = part.axes[static_cast<std::size_t>(k)];
        along[static_cast<std::size_t>(k)] = sides[k] * axis;
        corner = corner + part.own.lo[k] * axis;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto lines = [&](std::size_t side, double step) {
            return std::max(1.0, std::ceil(sides[static_cast<int>(side)] / step - 1e-6));
        };
        double step = least;
        while (lines(u, step) * lines(v, step) > most) step *= 1.25;
        const double across = lines(u, step), down = lines(v, step);
        for (double i = 0.5; i < across; ++i) {
            for (double k = 0.5; k < down; ++k) {
                const Vec3 from = corner + (i / across) * along[u] + (k / down) * along[v];
                const auto start = [&](double lo, double hi) {
                    lo = std::max(lo, 0.0), hi = std::min(hi, 1.0);
                    if (!(lo < hi)) return;
                    const Vec3 p = from + 0.5 * (lo + hi) * along[axis];
                    if (!start_at(p)) thin_points_.push_back({p, number});
                };
                double last = kInfinity;
                const std::vector<Interval> spans = line_.spans(from, along[axis]);
                for (const Interval& span : spans) {
                    start(last, span.lo);
                    start(span.lo, span.hi);
                    last = span.hi;
                }
            }
        }
    }
}

bool SurfaceCells::start_at(const Vec3& p) {
    // In all directions the surface is at least 0.88 times as far as along the nearest of these.
    constexpr double kCellsPerDistance = 0.5;
    const double c = std::sqrt(1.0 / 3.0);
    double nearest = cell_ / kCellsPerDistance;
    for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{c, c, c},
                              Vec3{-c, c, c}, Vec3{c, -c, c}, Vec3{c, c, -c}}) {
        nearest = std::min(nearest, line_.distance(p, along, nearest));
        if (nearest <= limit_) return false;
    }
    std::uint32_t size = 1;
    while (2.0 * size * unit_ <= kCellsPerDistance * nearest && size < tree_[0].size) size *= 2;
    split_to(0, {p, p}, size);
    return true;
}

void SurfaceCells::ask(const CellTree::Edge& edge) {
    std::uint32_t largest = 2;
    for (const std::uint32_t c : edge.cells) largest = std::max(largest, tree_[c].size);
    for (const std::uint32_t c : edge.cells) {
        if (tree_[c].size == largest) ask(c);
    }
}

void SurfaceCells::ask(std::uint32_t cell) {
    if (is_asked_[cell] != 0) return;
    is_asked_[cell] = 1;
    asked_.push_back(cell);
}

bool SurfaceCells::split_cells() {
    if (asked_.empty()) return false;
    for (const std::uint32_t c : asked_) tree_.split(c);
    asked_.clear();
    return true;
}

// ---- Lines along the edges of cells.
std::span<const double> SurfaceCells::ends_of(const Node& through, std::size_t axis) {
    Node from = through;
    from[axis] = 0;
    const std::uint64_t key = std::uint64_t{from[(axis + 1) % 3]} << 32 | from[(axis + 2) % 3];
    const auto [found, is_new] = lines_[axis].try_emplace(key);
    if (is_new) {
        found->second.first = ends_.size();
        for (const Interval& span : line_.spans(position(from), axis_vector(axis))) {
            ends_.push_back(span.lo);
            ends_.push_back(span.hi);
        }
        found->second.second = ends_.size();
    }
    return std::span(ends_).subspan(found->second.first,
                                    found->second.second - found->second.first);
}

bool SurfaceCells::is_in(const Node& n) {
    const std::span<const double> ends = ends_of(n, 2);
    const auto passed = std::upper_bound(ends.begin(), ends.end(), unit_ * n[2]);
    return (passed - ends.begin()) % 2 != 0;
}

bool SurfaceCells::sees_all(const CellTree::Edge& edge) {
    const std::span<const double> ends = ends_of(edge.from, edge.axis);
    const double begin = unit_ * edge.from[edge.axis], end = begin + unit_ * edge.length;
    auto k =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), begin) - ends.begin());
    if (k + 1 >= ends.size() || !(ends[k + 1] <= end)) return true;
    Node from = edge.from;
    from[edge.axis] = 0;
    for (; k + 1 < ends.size() && ends[k + 1] <= end; ++k) {
        if (!line_.is_thin(position(from), axis_vector(edge.axis), {ends[k], ends[k + 1]},
                           limit_)) {
            return false;
        }
    }
    return true;
}

// ---- Edges.
void SurfaceCells::drop_edges() {
    is_changed_.assign(tree_.count(), 0);
    is_asked_.assign(tree_.count(), 0);
    vertex_of_.resize(tree_.count(), kNone);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
        const auto& cells = edges_[k].at.cells;
        if (std::all_of(cells.begin(), cells.end(),
                        [&](std::uint32_t c) { return tree_.is_leaf(c); })) {
            if (kept != k) edges_[kept] = edges_[k];
            ++kept;
            continue;
        }
        for (const std::uint32_t c : cells) is_changed_[c] = 1;
    }
    edges_.resize(kept);
}

void SurfaceCells::find_edges(std::uint64_t max_triangles) {
    tree_.visit_new_edges([&](const CellTree::Edge& at) {
        if (2 * edges_.size() > max_triangles) return;
        interruption_point();
        const bool may_split = std::any_of(at.cells.begin(), at.cells.end(),
                                           [&](std::uint32_t c) { return !is_least(c); });
        if (may_split && !sees_all(at)) ask(at);
        Node to = at.from;
        to[at.axis] += at.length;
        const bool in = is_in(at.from);
        if (in == is_in(to)) return;
        edges_.push_back({at, find_crossing(at, in), in});
        for (const std::uint32_t c : at.cells) is_changed_[c] = 1;
    });
    forget_lines();
}

void SurfaceCells::forget_lines() {
    for (auto& lines : lines_) lines.clear();
    ends_.clear();
}

SurfaceCells::Crossing SurfaceCells::find_crossing(const CellTree::Edge& edge, bool starts_in) {
    Node to = edge.from;
    to[edge.axis] += edge.length;
    Vec3 inner = position(edge.from), outer = position(to);
    if (!starts_in) std::swap(inner, outer);
    const Vec3 along = outer - inner;
    const bool with_uvs = coordinates_ != nullptr;
    const auto& found = line_.cross(inner, along, 0.0, 1.0, with_uvs);
    for (std::size_t k = 0; k < found.size(); ++k) {
        const IsolatedSolid::SurfacePoint& p = found[k];
        if (!(dot(p.normal, along) > 0.0)) continue;
        Crossing met{p.point, p.normal, static_cast<std::uint32_t>(p.material), {}};
        if (with_uvs) met.place = coordinates_->place(line_.hit(k));
        return met;
    }
    // Down to rounding of the surface.
    for (int round = 0; round < 40; ++round) {
        const Vec3 middle = 0.5 * (inner + outer);
        (line_.inside(middle) ? inner : outer) = middle;
    }
    return {inner, normalize(along), 0, {}};
}

// ---- A vertex for each sheet of the surface in a cell.
void SurfaceCells::place_vertices() {
    struct Use {
        std::uint32_t cell, edge;
    };
    std::vector<Use> uses;
    for (std::uint32_t k = 0; k < edges_.size(); ++k) {
        for (const std::uint32_t c : edges_[k].at.cells) {
            if (is_changed_[c] == 0) continue;
            edges_[k].is_near = false;
            uses.push_back({c, k});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.edge < b.edge;
    });
    CellSheets sheets(tree_, edges_);
    std::vector<std::uint32_t> own;
    for (std::size_t k = 0; k < uses.size();) {
        const std::uint32_t cell = uses[k].cell;
        own.clear();
        for (; k < uses.size() && uses[k].cell == cell; ++k) {
            if (own.empty() || own.back() != uses[k].edge) own.push_back(uses[k].edge);
        }
        const std::size_t count = sheets.find(cell, own);
        for (std::uint32_t sheet = 0; sheet < count; ++sheet) {
            place_vertex(cell, own, sheets, sheet);
        }
    }
}

void SurfaceCells::place_vertex(std::uint32_t cell, std::span<const std::uint32_t> uses,
                                const CellSheets& sheets, std::uint32_t sheet) {
    // The vertices of other sheets are new in each round.
    std::uint32_t number = sheet == 0 ? vertex_of_[cell] : kNone;
    if (number == kNone) {
        number = static_cast<std::uint32_t>(vertices_.size());
        vertices_.emplace_back();
    }
    if (sheet == 0) vertex_of_[cell] = number;
    crossings_.clear();
    std::uint32_t least = tree_[cell].size;
    for (std::size_t use = 0; use < uses.size(); ++use) {
        if (sheets.sheet(use) != sheet) continue;
        Edge& edge = edges_[uses[use]];
        crossings_.push_back(edge.met);
        least = std::min(least, edge.at.length);
        for (std::size_t side = 0; side < 4; ++side) {
            if (edge.at.cells[side] == cell) edge.vertices[side] = number;
        }
    }
    const double beyond = is_least(cell) ? 0.0 : kVertexBeyond * unit_ * least;
    const double size = unit_ * tree_[cell].size + beyond;
    const Vec3 lo = position(tree_[cell].at);
    vertices_[number] = make_vertex(crossings_, crossings_.size() == uses.size(),
                                    lo - Vec3{beyond, beyond, beyond}, lo + Vec3{size, size, size});
}

// ---- Faces: a polygon of three or four vertices around each edge that the surface crosses.
SurfaceCells::Face SurfaceCells::face(const Edge& edge) const {
    Face made;
    const std::array<std::size_t, 4> ring = edge.ring();
    std::array<bool, 4> is_small{};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t cell = edge.at.cells[ring[k]];
        // A cell on two sides is one corner.
        if (cell == edge.at.cells[ring[(k + 3) % 4]]) continue;
        is_small[made.count] = tree_[cell].size == edge.at.length;
        made.vertices[made.count++] = edge.vertices[ring[k]];
    }
    std::size_t s = 0;
    if (made.count == 4) {
        // Larger cells may be opposite at other edges too: a diagonal between them could be twice.
        const bool first = is_small[0] || is_small[2], second = is_small[1] || is_small[3];
        const bool is_better =
            badness(made, 1, edge.met.normal) < badness(made, 0, edge.met.normal);
        s = first && second ? (is_better ? 1 : 0) : (second ? 1 : 0);
    }
    made.triangles = {{{s, s + 1, s + 2}, {s, s + 2, (s + 3) % 4}}};
    return made;
}

double SurfaceCells::badness(const Face& face, std::size_t first, const Vec3& normal) const {
    const auto p = [&](std::size_t k) { return vertices_[face.vertices[(first + k) % 4]].point; };
    const Vec3 one = cross(p(1) - p(0), p(2) - p(0)), two = cross(p(2) - p(0), p(3) - p(0));
    return -std::min(dot(unit_or(one, normal), normal), dot(unit_or(two, normal), normal));
}

void SurfaceCells::test_faces() {
    distances_.clear();
    std::size_t count = 0;
    std::vector<std::uint32_t> tested;
    for (std::size_t begin = 0; begin < edges_.size();) {
        // Faces of cells that faces before have asked for need no test, block by block.
        tested.clear();
        for (; begin < edges_.size() && tested.size() < kFacesOfBlock; ++begin) {
            const Edge& edge = edges_[begin];
            const auto& cells = edge.at.cells;
            if (edge.is_near || std::all_of(cells.begin(), cells.end(), [&](std::uint32_t c) {
                    return is_least(c) || is_asked_[c] != 0;
                })) {
                continue;
            }
            tested.push_back(static_cast<std::uint32_t>(begin));
        }
        tests_.test(tested, edges_, [&](const Edge& edge) { return face(edge); });
        for (const std::uint32_t k : tested) {
            if (edges_[k].is_near) continue;
            ask(edges_[k].at);
            if (count++ % kFacesPerDistance == 0) {
                distances_.push_back(tests_.distance_of(face(edges_[k]), line_, 2 * cell_));
            }
        }
    }
}

double SurfaceCells::larger_tolerance() const {
    if (distances_.empty()) return 0;
    return 2 * std::max(*std::max_element(distances_.begin(), distances_.end()), 2 * limit_);
}

// ---- Lines that are not edges of cells.
void SurfaceCells::test_lines() {
    if (!has_parts_) find_parts();
    std::size_t kept = 0;
    for (const Part& part : parts_) {
        const Vec3 along = axis_vector(part.axis);
        const Vec3 middle = part.from + 0.5 * (part.range.lo + part.range.hi) * along;
        const std::uint32_t cell = leaf_at(middle);
        if (is_least(cell) || vertex_of_[cell] != kNone ||
            is_in(tree_[cell].at) == part.is_inside ||
            line_.is_thin(part.from, along, part.range, limit_)) {
            continue;
        }
        ask(cell);
        parts_[kept++] = part;
    }
    parts_.resize(kept);
    forget_lines();
}

void SurfaceCells::find_parts() {
    has_parts_ = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        interruption_point();
        const int u = static_cast<int>(axis + 1) % 3, v = static_cast<int>(axis + 2) % 3;
        for (double x = 0.5 * spacing_; x < box_.size()[u]; x += spacing_) {
            for (double y = 0.5 * spacing_; y < box_.size()[v]; y += spacing_) {
                Vec3 from = box_.lo;
                from[u] += x;
                from[v] += y;
                double last = kInfinity;
                for (const Interval& span : line_.spans(from, axis_vector(axis))) {
                    if (span.lo > last) {
                        parts_.push_back({from, axis, {last, span.lo}, false});
                    }
                    parts_.push_back({from, axis, span, true});
                    last = span.hi;
                }
            }
        }
    }
}

std::uint32_t SurfaceCells::leaf_at(const Vec3& p) const {
    std::uint32_t cell = 0;
    while (!tree_.is_leaf(cell)) {
        const CellTree::Cell& own = tree_[cell];
        const Vec3 middle = position(own.at) + 0.5 * unit_ * own.size * Vec3{1, 1, 1};
        std::uint32_t child = own.first_child;
        for (int k = 0; k < 3; ++k) child += p[k] >= middle[k] ? 1u << k : 0u;
        cell = child;
    }
    return cell;
}

bool SurfaceCells::any_vertex(std::uint32_t cell, const Box3& box) const {
    const CellTree::Cell& own = tree_[cell];
    const Vec3 lo = position(own.at);
    for (int k = 0; k < 3; ++k) {
        if (lo[k] > box.hi[k] || lo[k] + unit_ * own.size < box.lo[k]) return false;
    }
    if (tree_.is_leaf(cell)) return vertex_of_[cell] != kNone;
    for (std::uint32_t k = 0; k < 8; ++k) {
        if (any_vertex(own.first_child + k, box)) return true;
    }
    return false;
}

std::size_t SurfaceCells::lost_parts() const {
    std::size_t count = 0, last = 0;
    const Vec3 aside = 2 * limit_ * Vec3{1, 1, 1};
    for (const ThinPoint& thin : thin_points_) {
        if (count > 0 && thin.part == last) continue;
        if (any_vertex(0, {thin.point - aside, thin.point + aside})) continue;
        ++count;
        last = thin.part;
    }
    return count;
}

}  // namespace alhazen
