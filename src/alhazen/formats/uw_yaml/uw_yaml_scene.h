#pragma once
/// The node tree of a course scene: nodes with a transform, components and children, converted to
/// parts, lights and cameras.
///
/// Source: the scenes of UW CSE 457, 2020 (docs/reference/formats/uw_yaml.md). M = T Rx Ry Rz S;
/// children multiply on the right.
/// Differs: transforms are multiplied in double; cones and rings are exact, not meshes.
/// Conventions: unsupported properties of a component are warnings that name them.

#include <set>
#include <string>

#include "alhazen/formats/uw_yaml/uw_yaml_assets.h"

namespace alhazen {

class UwSceneReader {
  public:
    UwSceneReader(const YAML::Node& document, const ImportSource& source, SceneDescription& scene,
                  Diagnostics& diagnostics);

    void read();

  private:
    /// The node whose components are being read.
    struct Place {
        std::string name;
        Affine world_from_node;
        FileLocation location;
    };
    using ReadComponent = void (UwSceneReader::*)(const Place&, const YAML::Node&);
    static ReadComponent reader_of(const std::string& component);

    void read_node(const YAML::Node& node, const Affine& world_from_parent, int depth);
    void count_visit(const YAML::Node& node);

    void nothing(const Place&, const YAML::Node&) {}
    void environment_map(const Place& place, const YAML::Node& component);
    void sphere(const Place& place, const YAML::Node& component);
    void cylinder(const Place& place, const YAML::Node& component);
    void cone(const Place& place, const YAML::Node& component);
    void plane(const Place& place, const YAML::Node& component);
    void ring(const Place& place, const YAML::Node& component);
    void triangle_mesh(const Place& place, const YAML::Node& component);
    void surface_of_revolution(const Place& place, const YAML::Node& component);
    void particle_system(const Place& place, const YAML::Node& component);
    void point_light(const Place& place, const YAML::Node& component);
    void directional_light(const Place& place, const YAML::Node& component);
    void area_light(const Place& place, const YAML::Node& component);
    void camera(const Place& place, const YAML::Node& component);
    void trace_settings(const YAML::Node& trace);
    void shadow_settings(const YAML::Node& trace);

    void add_part(const Place& place, const YAML::Node& component,
                  std::variant<AnyShape, MeshIndex, ObjectIndex> what,
                  const Affine& node_from_part = {});
    void warn_once(const YAML::Node& node, const std::string& what, const std::string& message);

    YAML::Node document_;
    const ImportSource& source_;
    SceneDescription& scene_;
    YamlValues values_;
    UwAssets assets_;
    std::set<std::string> warned_;
    std::size_t visits_ = 0;
};

}  // namespace alhazen
