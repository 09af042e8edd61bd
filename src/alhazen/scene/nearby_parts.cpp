#include "alhazen/scene/nearby_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>
#include <utility>

#include "alhazen/accel/bounds/bound_tree.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Meshes of at most this many triangles are as many pieces, as long as there are few in all.
constexpr std::size_t kTrianglesApart = 64;
constexpr std::size_t kMostTrianglesApart = std::size_t{1} << 14;
/// A query of the tree that visits more nodes is given up.
constexpr std::size_t kMostVisits = 256;

/// A part, or some of one, or all of an object of many parts.
struct Piece {
    Box3 box;
    double coordinates = 0;  ///< the largest that went into the box
    HitParts parts;
    bool clear = false;  ///< may let light through
    bool mixed = false;  ///< of several parts
};

double largest(const Vec3& v) {
    return max_component(abs(v));
}
double largest(const Box3& box) {
    return std::max(largest(box.lo), largest(box.hi));
}

Box3 enlarged(const Box3& box, double by) {
    const Vec3 margin{by, by, by};
    return {box.lo - margin, box.hi + margin};
}

bool is_bounded(const Box3& box) {
    return box.bounded() && largest(box) <= BoundedPrimitives::kReach;
}

/// All points with coordinates up to `most`. The largest coordinate of its image is that of the
/// terms of any of their images.
Box3 cube(double most) {
    return {{-most, -most, -most}, {most, most, most}};
}

/// Divides aggregates into pieces.
class Pieces {
  public:
    explicit Pieces(std::span<const Material> materials) : materials_(materials) {}

    /// Takes each piece of a primitive of the root, and the primitive.
    using Visit = std::function<void(const Piece&, PrimitiveId)>;

    void of_root(const Aggregate& root, const Visit& visit) {
        const PrimitiveTable& table = root.primitives();
        std::size_t apart = 0;
        for (const PlacedMesh& mesh : table.meshes) {
            const std::size_t triangles = mesh.mesh->triangles.size();
            if (triangles <= kTrianglesApart) apart += triangles;
        }
        each(root, apart <= kMostTrianglesApart, visit);
    }

  private:
    [[nodiscard]] bool is_clear(MaterialId id) const {
        return !materials_[static_cast<std::size_t>(id)].is_opaque();
    }
    [[nodiscard]] bool is_clear(const PlacedMesh& placed) const {
        const std::vector<std::uint32_t>& own = placed.mesh->vertex_materials;
        if (own.empty()) return is_clear(placed.material);
        return std::any_of(own.begin(), own.end(),
                           [&](std::uint32_t id) { return is_clear(MaterialId{id}); });
    }

    void each(const Aggregate& aggregate, bool triangles_apart, const Visit& visit) {
        const PrimitiveTable& table = aggregate.primitives();
        for (std::uint32_t i = 0; i < table.first(kTriangleKind); ++i) {
            visit(of_shape(aggregate, PrimitiveId{i}), PrimitiveId{i});
        }
        for (const PlacedMesh& mesh : table.meshes) {
            const PrimitiveId first{table.first(kTriangleKind) + mesh.first_triangle};
            each_of_mesh(mesh, triangles_apart, [&](const Piece& piece) { visit(piece, first); });
        }
        for (std::uint32_t i = 0; i < table.instances.size(); ++i) {
            const PrimitiveId id{table.first(kInstanceKind) + i};
            const Instance& instance = table.instances[i];
            if (instance.holds_rest) {
                each(*instance.aggregate, triangles_apart,
                     [&](const Piece& piece, PrimitiveId) { visit(piece, id); });
                continue;
            }
            for (const Piece& piece : of_object(*instance.aggregate)) {
                visit(placed(piece, instance), id);
            }
        }
    }

    [[nodiscard]] Piece of_shape(const Aggregate& aggregate, PrimitiveId id) const {
        const PrimitiveTable& table = aggregate.primitives();
        const std::uint32_t kind = table.kind(id), index = table.index(id);
        Piece piece{.box = table.box(static_cast<std::size_t>(id))};
        // An operand of a solid may be larger than the solid.
        if (!piece.box.bounded() && aggregate.completes_surfaces()) piece.box = aggregate.box();
        piece.coordinates = largest(piece.box);
        if (const Placement* placement = table.placement_of(id)) {
            const Box3 terms = cube(largest(table.inner_box(id)));
            piece.coordinates = std::max(piece.coordinates,
                                         largest(transformed(placement->outer_from_inner, terms)));
        }
        const std::uint32_t part = with_column(table.columns, kind, [&](const auto& column) {
            return column.parts.empty() ? 0 : column.parts[index];
        });
        piece.parts = {part, part};
        piece.clear = is_clear(table.shape_material(id));
        return piece;
    }

    template <class Tell>
    void each_of_mesh(const PlacedMesh& placed, bool triangles_apart, const Tell& visit) const {
        const TriangleMesh& mesh = *placed.mesh;
        const bool apart = triangles_apart && mesh.triangles.size() <= kTrianglesApart;
        Piece piece{.parts = {placed.part, placed.part}, .clear = is_clear(placed)};
        const auto tell = [&] {
            piece.coordinates = largest(piece.box);
            if (!piece.box.empty()) visit(piece);
            piece.box = {};
        };
        for (const auto& corners : mesh.triangles) {
            if (placed.motion) {
                piece.box.include(placed.motion->box(corners).swept());
            } else {
                for (const std::uint32_t i : corners) piece.box.include(mesh.positions[i]);
            }
            if (apart) tell();
        }
        if (!apart) tell();
    }

    /// The pieces of an aggregate that is placed, in its own frame.
    const std::vector<Piece>& of_object(const Aggregate& object) {
        if (const auto known = objects_.find(&object); known != objects_.end())
            return known->second;
        std::vector<Piece> pieces;
        each(object, false, [&](const Piece& piece, PrimitiveId) { add(piece, pieces); });
        return objects_[&object] = std::move(pieces);
    }
    /// Of too many pieces makes one.
    static void add(const Piece& piece, std::vector<Piece>& pieces) {
        if (piece.box.empty()) return;
        const bool is_mixed = pieces.size() == 1 && pieces[0].mixed;
        if (!is_mixed && pieces.size() < NearbyParts::kMostInObject) {
            pieces.push_back(piece);
            return;
        }
        Piece all = piece;
        for (const Piece& other : pieces) {
            all.box.include(other.box);
            all.coordinates = std::max(all.coordinates, other.coordinates);
        }
        all.mixed = true;
        pieces.assign(1, all);
    }

    [[nodiscard]] static Box3 image(const Box3& box, const Instance& instance) {
        return instance.motion ? instance.motion->bounds(box).swept()
                               : transformed(instance.placement.outer_from_inner, box);
    }
    [[nodiscard]] static Piece placed(Piece piece, const Instance& instance) {
        if (instance.of_shared_mesh) piece.parts.part = instance.part;
        piece.parts.instance = instance.part;
        if (!piece.box.bounded()) {
            piece.box = kAllSpace;
        } else {
            piece.coordinates = largest(image(cube(piece.coordinates), instance));
            piece.box = image(piece.box, instance);
        }
        return piece;
    }

    std::span<const Material> materials_;
    std::unordered_map<const Aggregate*, std::vector<Piece>> objects_;
};

NearbyParts::Unbounded unbounded_one(const PrimitiveTable& table, PrimitiveId id) {
    NearbyParts::Unbounded result{.id = id};
    if (table.kind(id) == kInstanceKind || table.placement_of(id) != nullptr) return result;
    with_column(table.columns, table.kind(id), [&]<class S>(const ShapeColumn<S>& column) {
        if constexpr (std::is_same_v<S, Plane>) {
            const Plane& plane = column.shapes[table.index(id)];
            result.is_plane = true;
            result.place = plane.point;
            result.unit_normal = plane.unit_normal;
        }
    });
    return result;
}

class BoxesOf final : public BoundsSource {
  public:
    explicit BoxesOf(std::span<const Piece> pieces) : pieces_(pieces) {}
    [[nodiscard]] std::size_t size() const override { return pieces_.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override { return pieces_[i].box; }

  private:
    std::span<const Piece> pieces_;
};

using Tree = BoundTree<SlabBound<3>>;

bool meets(const SlabBound<3>& bound, const Box3& box) {
    for (int k = 0; k < 3; ++k) {
        if (!(bound.range[k].lo <= box.hi[k] && box.lo[k] <= bound.range[k].hi)) return false;
    }
    return true;
}

/// Calls `visit` with the number of each box that meets `box` until it returns false. False if
/// it did, or the search took too long.
template <class Visit>
bool for_all_near(const Tree& tree, const Box3& box, const Visit& visit) {
    std::vector<std::uint32_t> waiting{0};
    for (std::size_t visits = 0; !waiting.empty(); ++visits) {
        if (visits == kMostVisits) return false;
        const Tree::Node& node = tree.nodes[waiting.back()];
        waiting.pop_back();
        if (!meets(node.bound, box)) continue;
        if (node.is_leaf() && !visit(node.first)) return false;
        for (std::uint32_t k = 0; k < node.count; ++k) waiting.push_back(node.first + k);
    }
    return true;
}

}  // namespace

NearbyParts::NearbyParts(const Aggregate& root, std::span<const Material> materials, bool moves) {
    std::vector<Piece> pieces;
    Pieces(materials).of_root(root, [&](const Piece& piece, PrimitiveId id) {
        if (piece.box.empty()) return;
        if (is_bounded(piece.box)) {
            pieces.push_back(piece);
            pieces.back().box = enlarged(piece.box, kSlack * piece.coordinates);
        } else if (unbounded_.empty() || unbounded_.back().id != id) {
            unbounded_.push_back(unbounded_one(root.primitives(), id));
        }
    });
    // Queries of single primitives know no time.
    const std::size_t most_unbounded = moves ? 0 : kMostUnbounded;
    if (pieces.empty() || unbounded_.size() > most_unbounded || root.completes_surfaces()) return;
    const Tree tree = Tree::median_split(BoxesOf(pieces));

    struct Part {
        Box3 box;
        double coordinates = 0;
        bool clear = false;
    };
    std::unordered_map<std::uint64_t, Part> parts;
    for (const Piece& piece : pieces) {
        if (piece.mixed) continue;
        Part& part = parts[key(piece.parts)];
        part.box.include(piece.box);
        part.coordinates = std::max(part.coordinates, piece.coordinates);
        part.clear = part.clear || piece.clear;
    }
    for (const auto& [number, part] : parts) {
        if (!part.clear) continue;
        const double slack = kSlack * part.coordinates;
        Known known{0.5 * slack, static_cast<std::uint32_t>(boxes_.size()), 0};
        const bool few =
            for_all_near(tree, enlarged(part.box, slack), [&, own = number](std::uint32_t i) {
                if (!pieces[i].mixed && key(pieces[i].parts) == own) return true;
                boxes_.push_back(enlarged(pieces[i].box, slack));
                return boxes_.size() - known.first <= kMostNear;
            });
        if (!few) {
            boxes_.resize(known.first);
            continue;
        }
        known.end = static_cast<std::uint32_t>(boxes_.size());
        known_.emplace(number, known);
    }
}

}  // namespace alhazen
