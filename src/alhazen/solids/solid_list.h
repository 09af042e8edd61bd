#pragma once
/// The solids of a compiled scene: every closed shape, closed mesh and CSG object in every place of
/// its instances, numbered without storing a list of all.
///
/// Conventions: numbers count the solids of an aggregate in the order shapes, meshes, instances
/// (each in table order); the contents of an instance are numbered recursively. Surfaces that bound
/// no volume (planes, open meshes) are not solids. A CSG object is one solid.
/// Complexity and threads: built in O(shapes + instances stored) and a sort of each mesh's edges;
/// `solid_of` takes O(depth). Const functions may be called from many threads.

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Number of a solid in a scene: 0 to SolidList::count() - 1.
enum class SolidId : std::uint64_t {};

/// Geometry and placement of a solid.
struct SolidPlace {
    /// The aggregate that contains it; for a CSG object its own.
    std::shared_ptr<const Aggregate> aggregate;
    /// From the frame of the aggregate to the world.
    Placement world;
    enum class Kind { Shape, Mesh, Csg } kind = Kind::Csg;
    PrimitiveId shape = kNoPrimitive;  ///< for a shape
    std::uint32_t mesh = 0;            ///< for a mesh: its index in the table
    /// Numbers of the parts on the path to it (see Surface::part), outermost first.
    std::vector<std::uint32_t> parts;
    MaterialId material{0};  ///< of a shape or mesh; for a CSG object that of its first leaf
};

class SolidList {
  public:
    explicit SolidList(std::shared_ptr<const Aggregate> scene);

    /// The number of solids in all places; at most 2^63.
    [[nodiscard]] std::uint64_t count() const { return root_->count; }
    /// The number of stored shapes and meshes that bound no volume.
    [[nodiscard]] std::uint64_t open_surfaces() const { return open_surfaces_; }
    /// A mesh that bounds no volume; each is listed once.
    struct OpenMesh {
        const TriangleMesh* mesh;
        std::uint32_t part;  ///< number of the first part that places it (see Surface::part)
    };
    [[nodiscard]] const std::vector<OpenMesh>& open_meshes() const { return open_meshes_; }
    /// The solid of a hit surface; none for a surface that bounds no volume.
    [[nodiscard]] std::optional<SolidId> solid_of(const Hit& hit) const;
    /// The geometry and placement of a solid. Precondition: the id is below count().
    [[nodiscard]] SolidPlace place(SolidId id) const;
    /// Appends the solids that contain the beginning of the ray's line (t = -inf).
    void inside_at_minus_infinity(const Ray& ray, std::vector<SolidId>& solids) const;
    [[nodiscard]] const Aggregate& aggregate() const { return *root_->aggregate; }

  private:
    static constexpr std::uint32_t kOpen = 0xFFFFFFFFu;

    /// An aggregate and the numbers of its solids.
    struct Node {
        std::shared_ptr<const Aggregate> aggregate;
        const SolidAggregate* csg = nullptr;         ///< if the aggregate is one solid
        std::uint64_t count = 0;                     ///< solids in it, instances included
        std::vector<std::uint32_t> shape_number;     ///< [primitive], or kOpen
        std::vector<std::uint32_t> mesh_number;      ///< [mesh], or kOpen
        std::vector<std::uint64_t> instance_number;  ///< [instance] number of its first solid
        std::vector<const Node*> instances;          ///< [instance]
        std::vector<PrimitiveId> solid_shapes;       ///< [own number]
        std::vector<std::uint32_t> solid_meshes;     ///< [own number minus the number of shapes]
        std::vector<PrimitiveId> unbounded;          ///< shapes that may contain an end of a line
        bool has_unbounded = false;                  ///< here or in an instance
    };

    const Node* build(const std::shared_ptr<const Aggregate>& aggregate);
    void add_shapes(Node& node);
    void add_meshes(Node& node);
    void add_instances(Node& node);
    void collect_unbounded(const Node& node, const Ray& ray, std::uint64_t first,
                           std::vector<SolidId>& solids) const;

    std::unordered_map<const Aggregate*, std::unique_ptr<Node>> nodes_;
    std::unordered_map<const TriangleMesh*, bool> closed_meshes_;
    std::vector<OpenMesh> open_meshes_;
    std::uint64_t open_surfaces_ = 0;
    const Node* root_ = nullptr;
};

}  // namespace alhazen
