#include "alhazen/renderers/cone_tracing/cone_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "alhazen/geometry/cones/coverage_tables.h"

namespace alhazen {

namespace {

/// Smaller coverages are ignored.
constexpr double kLeastCover = 1e-9;

constexpr auto kFartherNode = [](const auto& a, const auto& b) { return a.z > b.z; };
constexpr auto kFartherPiece = [](const ConePiece& a, const ConePiece& b) {
    return std::tie(a.z, a.source, a.part) > std::tie(b.z, b.source, b.part);
};

}  // namespace

void ConeSearch::begin(const ConeRay& cone, const ConeStart& start) {
    cone_ = &cone;
    start_ = &start;
    ex_ = perpendicular(cone.axis);
    ey_ = cross(cone.axis, ex_);
    levels_.clear();
    waiting_.clear();
    pieces_.clear();
    for (const std::uint32_t source : scene_.planes) add_plane(source);
    if (scene_.tree.empty()) return;
    levels_.push_back({&scene_.tree, ConeMap(cone), kScene});
    push_node(0, 0);
}

bool ConeSearch::next(ConePiece& piece) {
    while (!waiting_.empty() && (pieces_.empty() || waiting_.front().z <= pieces_.front().z)) {
        std::pop_heap(waiting_.begin(), waiting_.end(), kFartherNode);
        const Waiting nearest = waiting_.back();
        waiting_.pop_back();
        open(nearest);
    }
    if (pieces_.empty()) return false;
    std::pop_heap(pieces_.begin(), pieces_.end(), kFartherPiece);
    piece = pieces_.back();
    pieces_.pop_back();
    return true;
}

void ConeSearch::push_node(std::uint32_t level, std::uint32_t node) {
    const Level& in = levels_[level];
    const ConeTree::Node& n = in.tree->node(node);
    const ConeBoxTest test =
        test_box(in.map, n.center, n.half, start_->range.z_min, start_->range.z_max);
    if (!test.may_meet) return;
    waiting_.push_back({test.z, level, node});
    std::push_heap(waiting_.begin(), waiting_.end(), kFartherNode);
}

void ConeSearch::open(const Waiting& waiting) {
    const ConeTree& tree = *levels_[waiting.level].tree;
    const ConeTree::Node& node = tree.node(waiting.node);
    if (node.count == 0) {
        push_node(waiting.level, node.first);
        push_node(waiting.level, node.first + 1);
        return;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        if (waiting.level == 0) {
            add_item(scene_.items[tree.item(k)]);
        } else {
            add_triangle(levels_[waiting.level], tree.item(k));
        }
    }
}

bool ConeSearch::is_seen(const ConeSource& source) const {
    return (source.visible_to & mask_of(start_->kind)) != 0;
}

void ConeSearch::add_item(const ConeItem& item) {
    const ConeSource& source = scene_.sources[item.source];
    if (!is_seen(source)) return;
    if (item.face != ConeItem::kNoFace) return add_face(scene_.faces[item.face]);
    if (source.kind == ConeSource::Kind::Sphere) return add_sphere(item.source, source);
    const ConeMap& world = levels_[0].map;
    levels_.push_back({source.tree,
                       source.placed ? world.composed(source.placement.outer_from_inner) : world,
                       item.source});
    push_node(static_cast<std::uint32_t>(levels_.size() - 1), 0);
}

void ConeSearch::add_plane(std::uint32_t number) {
    const ConeSource& source = scene_.sources[number];
    if (!is_seen(source) || start_->source == number) return;
    const bool front = dot(source.normal, cone_->origin - source.point) > 0.0;
    const bool far_side = is_far_side(source, number, front);
    if (far_side && !source.may_pass) return;
    const ConeCover cover = plane_cover(*cone_, source.point, source.normal, start_->range);
    if (!(cover.share > kLeastCover)) return;
    add_flat(number, 0, source.point, source.normal, cover, front, far_side);
}

void ConeSearch::add_sphere(std::uint32_t number, const ConeSource& source) {
    const bool inside = start_->is_inside(number);
    if (!inside && start_->source == number) return;
    ConePiece piece{.source = number, .share = 1.0, .front = !inside};
    if (!inside) {
        if (const std::optional<ConeCover> cover = sphere_cover(source)) {
            if (!(cover->share > kLeastCover)) return;
            piece.share = cover->share;
            piece.at = cover->at;
        } else {
            // The cone starts inside a sphere that it did not enter.
            piece.front = false;
        }
    }
    // Solves |o + z d - c| = r; takes the nearest point of the line if rounding loses the roots.
    const Ray ray = line(piece.at);
    const Vec3 from = ray.origin - source.point;
    const double a = length_squared(ray.direction), b = dot(from, ray.direction);
    const Vec3 off = from - (b / a) * ray.direction;
    const double left = source.radius * source.radius - length_squared(off);
    const double root = std::sqrt(std::max(left, 0.0) / a);
    const double near = -b / a - root, far = -b / a + root;
    if (piece.front && !(near >= start_->range.z_min) && !start_->plane) {
        if (!(far > start_->range.z_min)) return;
        piece.front = false;
        piece.share = 1.0;
    }
    // A disc oblique to the surface where it starts may lie behind what is met, in part.
    piece.z = piece.front ? std::max(near, start_->range.z_min) : far;
    add(piece);
    if (!piece.front || !source.may_pass) return;
    piece.front = false;
    piece.far_side = true;
    piece.z = far;
    add(piece);
}

std::optional<ConeCover> ConeSearch::sphere_cover(const ConeSource& source) {
    const ConeMap& map = levels_[0].map;
    const ConeSphere sphere{source.point, source.radius};
    if (start_->plane && !is_cut(sphere, *start_->plane) &&
        dot(sphere.center - start_->plane->point, start_->plane->normal) < 0.0) {
        return ConeCover{};
    }
    const SphereDisc disc = sphere_disc(*cone_, map, sphere.center, sphere.radius);
    ConeCover cover = cover_of(disc);
    if (tables_ && disc.kind == SphereDisc::Kind::Disc) {
        cover.share = CoverageTables::shared().sphere(disc.distance, disc.radius);
    }
    if (!(cover.share > kLeastCover) || !start_->plane || !is_cut(sphere, *start_->plane)) {
        return cover;
    }
    return cut_cover(*cone_, map, sphere, *start_->plane, cover, start_->range.z_max, scratch_);
}

void ConeSearch::add_face(const ConeFace& face) {
    const ConeSource& source = scene_.sources[face.source];
    if (start_->source == face.source && start_->part == face.part) return;
    bool front = false;
    const ConeCover cover = polygon_cover(levels_[0].map, face.vertices, face.loop_ends,
                                          start_->range, scratch_, &front);
    if (!(cover.share > kLeastCover)) return;
    front = front != source.inward;
    const bool far_side = is_far_side(source, face.source, front);
    if (far_side && !source.may_pass) return;
    add_flat(face.source, face.part, face.point, face.normal, cover, front, far_side);
}

void ConeSearch::add_triangle(const Level& level, std::uint32_t triangle) {
    const ConeSource& source = scene_.sources[level.source];
    ConeRange range = start_->range;
    if (start_->source == level.source) {
        if (start_->part == triangle) return;
        range.z_min = std::max(range.z_min, start_->clear);
    }
    const TriangleMesh& mesh = *source.mesh.mesh;
    std::array<ConePoint, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = level.map(mesh.positions[mesh.triangles[triangle][k]]);
    }
    bool front = false;
    const ConeCover cover = triangle_cover(corners, range, level.map.converges, front);
    if (!(cover.share > kLeastCover)) return;
    front = front != source.is_inward(triangle);
    const bool far_side = is_far_side(source, level.source, front);
    if (far_side && !source.may_pass) return;
    const TrianglePlace place = place_in_triangle(corners, cover.at);
    add({level.source, triangle, place.z, cover.share, cover.at, place.u, place.v, front,
         far_side});
}

void ConeSearch::add_flat(std::uint32_t source, std::uint32_t part, const Vec3& point,
                          const Vec3& normal, const ConeCover& cover, bool front, bool far_side) {
    const Ray ray = line(cover.at);
    const double z = dot(normal, point - ray.origin) / dot(normal, ray.direction);
    if (!std::isfinite(z)) return;
    // Parts of an oblique disc at the start lie on the other side of the face where it starts.
    if (far_side && start_->source == source && !(z >= start_->clear)) return;
    add({source, part, z, cover.share, cover.at, 0, 0, front, far_side});
}

void ConeSearch::add(const ConePiece& piece) {
    if (!(piece.z <= start_->range.z_max)) return;
    pieces_.push_back(piece);
    std::push_heap(pieces_.begin(), pieces_.end(), kFartherPiece);
}

Ray ConeSearch::line(const Vec2& at) const {
    const Vec3 across = at.x * ex_ + at.y * ey_;
    return {cone_->origin + cone_->radius * across, cone_->axis + cone_->spread * across};
}

}  // namespace alhazen
