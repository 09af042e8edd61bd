#pragma once
/// Converts the nodes of a glTF scene to parts of one object. Transforms are concatenated along the
/// hierarchy; nodes share the objects of their meshes.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, sections 3.5 and 3.7; EXT_mesh_gpu_instancing.
/// Differs: a node with a singular transform is omitted (files hide nodes by a scale of zero).

#include "alhazen/formats/gltf/scene/gltf_geometry.h"
#include "alhazen/formats/gltf/scene/gltf_materials.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

class NodeBuilder {
  public:
    NodeBuilder(const Document& document, const ImportSource& source, const Pose& pose,
                Budget& budget, SceneDescription& scene, Diagnostics& diagnostics);

    /// Adds the meshes of these nodes to the root object (index 0), which must exist.
    void add(std::span<const Index> nodes, const std::vector<Affine>& world_from_node);

  private:
    /// The primitives of a mesh in an object. For a node with a skin, primitives with joints are
    /// already in world space; those without are transformed by the node.
    enum class Primitives { All, WithJoints, WithoutJoints };
    struct ObjectKey {
        Index mesh;
        std::vector<double> weights;  ///< of the morph targets
        Primitives primitives = Primitives::All;
        Index skin = 0;  ///< for WithJoints

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
    /// Number of bytes of a part of this name, for the budget.
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
    std::map<ObjectKey, ObjectIndex> objects_;                    ///< shared by nodes
    std::map<Index, std::vector<Affine>> joints_;                 ///< of the used skins
    std::vector<char> mesh_seen_;                                 ///< [mesh] counted below
    std::size_t points_ = 0, lines_ = 0, without_positions_ = 0;  ///< omitted primitives
    std::map<std::string, std::size_t> other_attributes_;         ///< ignored attributes
};

}  // namespace alhazen::gltf
