#pragma once
/// The scene description made by the requests of a RIB file: patches collected in patch meshes,
/// other shapes, materials from colours, objects and instances.
///
/// Conventions: patches of the same object, transform, colour and degrees form one patch mesh with
/// shared control points (patch_welder.h), so that a closed surface in the file becomes a solid.

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/patches/cubic_basis.h"
#include "alhazen/formats/patches/patch_welder.h"
#include "alhazen/formats/rib/rib_requests.h"

namespace alhazen {

/// The state that AttributeBegin saves and AttributeEnd restores.
struct RibState {
    Affine transform;  ///< object_from_current, or world_from_current
    Rgb color{0.7, 0.7, 0.7};
    bool inherits_color = false;  ///< in an object: its colour is that of each instance
    CubicBasis basis_u, basis_v;
    int step_u = 3, step_v = 3;
    bool reversed = false;
    std::shared_ptr<const std::vector<TrimLoop>> trims;
    bool keeps_inside = false;  ///< of the trimming loops; false: the inside is cut away
};

class RibScene {
  public:
    RibScene(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics)
        : scene_(scene),
          file_(source.path.string()),
          name_(source.path.stem().string()),
          limit_(source.options.max_elements),
          max_nesting_(source.options.max_nesting),
          diagnostics_(diagnostics) {}

    /// Throws Error (Resource) beyond max_elements control points.
    void add_patch(const RibState& state, const BezierNet& net, const RibPlace& place);
    void add_shape(const RibState& state, AnyShape shape, const RibPlace& place);

    /// False if an object is already open, or none is.
    bool begin_object(const std::string& name, const RibPlace& place);
    bool end_object();
    /// False if there is no such object. Parts that inherit their colour have that of `state`.
    bool add_instance(const RibState& state, const std::string& name, const RibPlace& place);
    [[nodiscard]] bool in_object() const { return current_ != 0; }

    /// Notes geometry that has no shape here; `finish` lists it.
    void leave_out(const std::string& what, const RibPlace& place);

    /// Moves the patch meshes to their parts, and gives instances their colours.
    void finish();

    void error(const RibPlace& place, const std::string& message);
    void warning(const RibPlace& place, const std::string& message);
    [[nodiscard]] int errors() const { return errors_; }
    [[nodiscard]] SceneDescription& description() { return scene_; }

  private:
    struct Meshed {
        PatchWelder welder;
        std::size_t object, part;
    };
    using Key = std::array<double, 18>;
    /// What a part says beside its description.
    struct PartColor {
        Rgb color;
        bool inherits;
    };

    Part& add_part(const RibState& state, const RibPlace& place);
    MaterialId material_of(const Rgb& color);
    Meshed& mesh_of(const RibState& state, const BezierNet& net, const RibPlace& place);
    void count(std::uint64_t points, const FileLocation& where);
    /// The object with `color` for the parts that inherit theirs: itself if none does.
    std::size_t colored(std::size_t object, const Rgb& color, int depth);
    void color_instances();
    [[nodiscard]] FileLocation at(const RibPlace& place) const {
        return {file_, place.line, place.column};
    }

    SceneDescription& scene_;
    std::string file_, name_;
    std::uint64_t limit_, points_ = 0;
    int max_nesting_;
    Diagnostics& diagnostics_;
    std::deque<Meshed> meshes_;
    std::map<Key, std::size_t> mesh_numbers_;
    std::map<std::array<double, 3>, MaterialId> materials_;
    std::map<std::string, std::size_t> objects_;
    std::size_t current_ = 0;                               ///< the object to which parts are added
    std::vector<std::vector<PartColor>> part_colors_;       ///< by object and part
    std::map<std::array<double, 4>, std::size_t> colored_;  ///< by object and colour
    std::map<std::string, std::size_t> left_out_;           ///< number of requests
    RibPlace first_left_out_;
    int errors_ = 0;
};

}  // namespace alhazen
