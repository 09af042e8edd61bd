#pragma once
/// Builds the objects of a scene from a BRL-CAD database.
///
/// Source: BRL-CAD, "MGED User's Manual", on regions and attributes inherited from combinations;
/// manual page of `rt` on air.
/// Differs: a region with an unsupported solid, a member without a transform or a combination that
/// contains itself is omitted as a whole, with a warning, so that no wrong shape appears.
/// Conventions: a region is one solid of one material, which also covers the surfaces of cuts.
/// Operators above the regions apply to each region of their left operand, which keeps its
/// material. A solid outside any region forms a region of its own. Complexity: each object is built
/// once per material; operators above regions copy the regions below them.

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/formats/brlcad/brlcad_materials.h"
#include "alhazen/formats/brlcad/brlcad_shapes.h"
#include "alhazen/formats/core/importer.h"

namespace alhazen {

class BrlcadBuilder {
  public:
    BrlcadBuilder(const BrlcadDatabase& database, const ImportSource& source,
                  SceneDescription& scene, BrlcadMaterials& materials, Diagnostics& diagnostics);
    /// Builds the root from the objects of these names or, without names, from all top-level
    /// objects.
    void build(std::span<const std::string> names);

  private:
    enum class Outcome {
        Present,
        Empty,   ///< no solid, for example a combination without members
        Unread,  ///< contains an unsupported solid
    };
    struct Operand {
        Outcome outcome = Outcome::Empty;
        Part part{};
    };
    struct PlacedRegion {
        Part part;
        MaterialId material{};
    };
    using Regions = std::vector<PlacedRegion>;

    /// Counts the nesting depth of operators. Throws Error (Resource) above the limit.
    class Nesting {
      public:
        Nesting(BrlcadBuilder& builder, const BrlcadPlace& place);
        ~Nesting() { --builder_.depth_; }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;

      private:
        BrlcadBuilder& builder_;
    };

    // Within a region: solids of one material.
    Operand operand(const BrlcadTree& tree, std::uint32_t node, MaterialId material);
    Operand member(const BrlcadNode& leaf, MaterialId material);
    Operand object(const BrlcadObject& object, MaterialId material);
    Operand solid(const BrlcadObject& object, MaterialId material);
    Operand exclusive_or(const Part& a, const Part& b, const BrlcadPlace& place);
    Operand combined(Combine combine, std::vector<Part> parts, const BrlcadPlace& place);
    [[nodiscard]] bool is_surface(const Part& part) const;
    Part part_of(const BrlcadObject& object, const BrlcadPiece& piece, MaterialId material);
    void tell_about_mesh(const BrlcadObject& object, const BrlcadMesh& mesh,
                         const BrlcadPieces& pieces);

    // Above the regions.
    void add_group_parts(const BrlcadTree& tree, std::uint32_t node, const BrlcadState& state,
                         std::vector<Part>& parts);
    Operand group(const BrlcadObject& object, const BrlcadState& state);
    void add_regions(const BrlcadTree& tree, std::uint32_t node, const BrlcadState& state,
                     Regions& regions);
    void add_member_regions(const BrlcadNode& leaf, const BrlcadState& state, Regions& regions);
    void cut_regions(const BrlcadTree& tree, std::span<const std::uint32_t> others, Combine combine,
                     std::size_t first, Regions& regions);
    std::optional<PlacedRegion> region(const BrlcadObject& object, const BrlcadState& state);
    /// The pattern unit of the first solid of a region: see brlcad_pattern_unit.
    [[nodiscard]] Vec2 pattern_unit(const BrlcadObject& object) const;
    [[nodiscard]] bool is_drawn(const BrlcadCombination& comb);

    const BrlcadObject* look_up(const BrlcadNode& leaf);
    bool enter(const BrlcadObject& object);
    void leave(const BrlcadObject& object);
    Part placed(Part part, const BrlcadNode& leaf) const;
    ObjectIndex add_object(ObjectDescription object);
    void check_room(std::size_t parts, const BrlcadPlace& place);
    [[nodiscard]] std::vector<std::string> top_level() const;
    void tell_left_out();
    /// Tells of a region that `unread_` keeps away.
    void leave_out(const std::string& name, const FileLocation& where);
    void refuse();  ///< turns all warnings into errors

    using StateKey = decltype(std::declval<BrlcadState>().key());

    const BrlcadDatabase& database_;
    const ImportOptions& options_;
    SceneDescription& scene_;
    BrlcadMaterials& materials_;
    Diagnostics& diagnostics_;
    std::uint64_t max_parts_;
    std::uint64_t parts_ = 0;
    std::set<const BrlcadObject*> open_;  ///< combinations under construction; detects cycles
    std::map<std::pair<const BrlcadObject*, MaterialId>, Operand> objects_;
    std::map<std::pair<const BrlcadObject*, StateKey>, Operand> groups_;
    std::map<std::pair<const BrlcadObject*, StateKey>, std::optional<PlacedRegion>> regions_;
    std::map<const BrlcadObject*, BrlcadPieces> pieces_;
    std::map<const BrlcadObject*, MeshIndex> meshes_;
    std::set<MeshIndex> surface_meshes_;
    std::set<ObjectIndex> surface_objects_;  ///< objects with surface meshes
    std::set<const BrlcadObject*> cyclic_;   ///< combinations that contain themselves
    std::set<std::string> missing_;
    std::string unread_;  ///< why the last operand is Unread
    std::map<const BrlcadObject*, std::string> unread_of_;
    int depth_ = 0;
    std::uint64_t air_regions_ = 0, left_out_ = 0;
};

}  // namespace alhazen
