#pragma once
/// The objects of a scene, for the guarantee of adaptive supersampling: shapes, connected pieces
/// of meshes and of polygons, and solids of constructive geometry, instances expanded, each with
/// bounds.
///
/// Conventions: objects are numbered; a hit identifies its object. If the scene has more than
/// `most` objects, instances are counted as one object each, from the innermost outwards, until
/// there are at most `most` objects or the outermost instances are single objects.
/// Complexity: linear in the number of objects, and in the size of meshes.
/// Threads: const functions may be called from many threads.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "alhazen/geometry/hit.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/renderers/antialias/joined_polygons.h"
#include "alhazen/renderers/antialias/mesh_pieces.h"

namespace alhazen {

/// Unit axes in addition to those of the frame, for tight bounds of oblique objects: Kay and
/// Kajiya's seven slabs.
inline constexpr double kThird = 0.57735026918962576451;
inline constexpr std::array<Vec3, 4> kDiagonals{{{kThird, kThird, kThird},
                                                 {kThird, kThird, -kThird},
                                                 {kThird, -kThird, kThird},
                                                 {kThird, -kThird, -kThird}}};

struct SceneObject {
    BoundingSphere sphere;  ///< the radius is infinite if unbounded
    Box3 box;
    /// [diagonal] unknown: all numbers.
    std::array<Interval, 4> diagonals{kAllNumbers, kAllNumbers, kAllNumbers, kAllNumbers};
    std::uint32_t part = 0;      ///< number of its part; see Surface
    std::uint32_t instance = 0;  ///< number of the part that placed it in the scene
    bool is_seen = true;         ///< visible to eye rays

    static constexpr Interval kAllNumbers{-std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::infinity()};
};

class SceneObjects {
  public:
    static constexpr std::uint64_t kMost = std::uint64_t{1} << 20;

    /// `root` must outlive the result.
    explicit SceneObjects(const Aggregate& root, std::uint64_t most = kMost);
    ~SceneObjects();

    [[nodiscard]] const std::vector<SceneObject>& objects() const { return objects_; }
    /// Index of the object of a hit of `root`.
    [[nodiscard]] std::uint32_t number_of(const Hit& hit) const;

  private:
    /// The indices of the objects of an aggregate: shapes, pieces of meshes, contents of instances.
    struct Layout;
    struct Place;

    const Layout* layout_of(const Aggregate& aggregate, int levels);
    const MeshPieces& pieces_of(const TriangleMesh& mesh);
    void add_objects(const Layout& layout, const Place& place);
    void add_shapes(const Layout& layout, const Place& place);
    void add_meshes(const Layout& layout, const Place& place);

    std::map<std::pair<const Aggregate*, int>, std::unique_ptr<Layout>> layouts_;
    std::map<const TriangleMesh*, std::unique_ptr<MeshPieces>> pieces_;
    const Layout* root_ = nullptr;  ///< null: the whole scene is one solid
    std::vector<SceneObject> objects_;
};

}  // namespace alhazen
