#pragma once
/// The nodes of a glTF scene as parts of one object: transforms are multiplied out along the
/// hierarchy, meshes are objects that their nodes share.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, sections 3.5 and 3.7; EXT_mesh_gpu_instancing.
/// Differs: a node whose transform is singular is not seen (a scale of zero is how files hide
/// things).

#include "alhazen/formats/gltf/scene/gltf_geometry.h"
#include "alhazen/formats/gltf/scene/gltf_materials.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

class NodeBuilder {
  public:
    NodeBuilder(const Document& document, const ImportSource& source, const Pose& pose,
                Budget& budget, SceneDescription& scene, Diagnostics& diagnostics);

    /// Adds the meshes of these nodes to the root object (number 0), which must be there.
    void add(std::span<const Index> nodes, const std::vector<Affine>& world_from_node);

  private:
    /// What of a mesh an object holds: of a node with a skin, the primitives with joints are in
    /// the world already, those without are moved by the node as any other.
    enum class Primitives { All, WithJoints, WithoutJoints };
    struct ObjectKey {
        Index mesh;
        std::vector<double> weights;  ///< of the morph targets
        Primitives primitives = Primitives::All;
        Index skin = 0;  ///< of those with joints

        friend auto operator<=>(const ObjectKey&, const ObjectKey&) = default;
    };

    void add_skinned(Index node, const std::vector<double>& weights,
                     const std::vector<Affine>& world_from_node, const std::string& name);
    [[nodiscard]] ObjectIndex shared_object(ObjectKey key, const std::vector<Affine>* joints);
    [[nodiscard]] ObjectIndex make_object(const ObjectKey& key, const std::vector<Affine>* joints);
    [[nodiscard]] const std::vector<Affine>& joints_of(Index skin,
                                                       const std::vector<Affine>& world_from_node);
    void count_left_out(const Primitive& primitive);
    void add_mesh_part(Index mesh, std::size_t primitive, PrimitiveGeometry geometry,
                       ObjectDescription& object);
    void place(ObjectIndex object, const Affine& world_from_part, std::string name);
    void place_instances(const Node& node, ObjectIndex object, const Affine& world_from_node,
                         const std::string& name);
    /// What a part of this name costs, for the budget.
    [[nodiscard]] std::size_t part_bytes(const std::string& name) const;
    [[nodiscard]] std::string mesh_name(Index mesh) const;
    void report_left_out() const;

    const Document& document_;
    const ImportSource& source_;
    const Pose& pose_;
    Budget& budget_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    DefaultMaterial default_material_;
    std::map<ObjectKey, ObjectIndex> objects_;     ///< shared by the nodes that show the same
    std::map<Index, std::vector<Affine>> joints_;  ///< of the skins that are used
    std::vector<char> mesh_seen_;                  ///< [mesh] counted in what follows
    std::size_t points_ = 0, lines_ = 0, without_positions_ = 0;  ///< primitives left out
    std::map<std::string, std::size_t> other_attributes_;         ///< that are not read
};

}  // namespace alhazen::gltf
