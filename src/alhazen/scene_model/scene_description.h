#pragma once
/// The content of a scene file: names, values and their source locations. Importers create it,
/// `validate` checks it, `compile` turns it into a `Scene`. Plain data that may be edited in
/// between.
///
/// Conventions: an object is a list of parts; a part is a shape, a mesh or another object under a
/// transform. `root` is the rendered object. An object used by several parts is instanced, not
/// copied.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/cameras/camera.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/math/affine.h"
#include "alhazen/scene_model/conventions.h"
#include "alhazen/scene_model/scene_motion.h"
#include "alhazen/shading/lights/environment_settings.h"
#include "alhazen/shading/lights/light.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shapes/meshes/mesh_motion.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

enum class MeshIndex : std::uint32_t {};
enum class ObjectIndex : std::uint32_t {};

struct Part {
    std::variant<AnyShape, MeshIndex, ObjectIndex> what;
    Affine object_from_part;  ///< into the frame of the object that contains the part
    /// Ignored for an object (its parts have their own) and for a mesh with vertex materials.
    MaterialId material{0};
    std::string name;
    FileLocation location;
    /// Bits of `mask_of(RayKind)`, or kAllRays. A kind of ray sees the part if it also sees all
    /// enclosing objects.
    RayMask visible_to = kAllRays;
    /// Null: the part is static. Otherwise object_from_part is its placement as the shutter opens.
    std::shared_ptr<const PartMotion> motion;
};

/// How the parts of an object combine.
enum class Combine : std::uint8_t {
    Group,         ///< separate parts; as an operand of a solid: their union
    Union,         ///< one solid
    Intersection,  ///< the volume common to all
    Difference,    ///< the first part minus all the others
};

/// The material of a surface that a subtracted part cuts.
enum class CutMaterial : std::uint8_t {
    Own,      ///< the subtracted part's material
    Minuend,  ///< the material of the solid that is cut
};

/// A list of parts. Every object but a group is a solid, whose parts must bound volumes (closed
/// shapes, closed meshes, objects made of these).
struct ObjectDescription {
    std::string name;
    std::vector<Part> parts;
    FileLocation location;
    Combine combine = Combine::Group;
    CutMaterial cut_material = CutMaterial::Own;  ///< for a difference
    /// For a group: "NAME" or "NAME:SETTING=VALUE,..."; the object then keeps an aggregate of its
    /// own. Empty: the scene's accelerator.
    std::string accelerator;
};

struct MeshDescription {
    std::string name;
    std::shared_ptr<TriangleMesh> mesh;  ///< vertex_materials hold values of MaterialId
    FileLocation location;
    /// Positions of moving vertices; `mesh` is the state as the shutter opens. Empty: static.
    std::vector<MeshKey> keys;
    bool of_polygon = false;  ///< the triangles of a polygon whose corners are not in a plane
};

struct TextureDescription {
    std::string name;
    Texture texture;  ///< image already read
    FileLocation location;
};

struct CameraDescription {
    std::string name;
    Camera camera;
    double aspect = 1;  ///< width / height that the camera was described for
    FileLocation location;
    /// Motion: world_from_camera * (the camera as given); empty: static.
    std::vector<TransformKey> keys;
};

struct LightDescription {
    std::string name;
    Light light;
    FileLocation location;
};

struct EnvironmentDescription {
    EnvironmentSettings settings;
    FileLocation location;
};

struct MaterialDescription {
    Material material;
    FileLocation location;
};

/// Largest side of a picture, pixels.
inline constexpr int kMaxPictureSide = 65536;
/// Throws Error (Usage) unless both sides are 1 to kMaxPictureSide.
void check_picture_size(int width, int height);

/// Picture settings of the file; the command line overrides them.
struct PictureSettings {
    std::optional<int> width, height;  ///< pixels
    std::optional<Rgb> background;     ///< black when the file has none
};

/// An animation of the file; the scene shows one moment of it (ImportOptions::time).
struct AnimationInfo {
    std::string name;
    double begin = 0, end = 0;  ///< times of its first and last key, seconds
};

/// The up axis of a file without cameras.
enum class UpAxis { Y, Z };

struct SceneDescription {
    // Out of line: compiled once, not in every includer.
    SceneDescription();
    SceneDescription(const SceneDescription&);
    SceneDescription(SceneDescription&&) noexcept;
    SceneDescription& operator=(const SceneDescription&);
    SceneDescription& operator=(SceneDescription&&) noexcept;
    ~SceneDescription();

    std::string format;  ///< name of the importer
    std::filesystem::path path;
    std::set<std::filesystem::path> files;   ///< other files that were read or that it names
    std::vector<CameraDescription> cameras;  ///< the first is the default
    std::vector<LightDescription> lights;
    std::vector<MaterialDescription> materials;  ///< indexed by MaterialId
    std::vector<TextureDescription> textures;    ///< indexed by TextureId
    std::vector<MeshDescription> meshes;         ///< indexed by MeshIndex
    std::vector<ObjectDescription> objects;      ///< indexed by ObjectIndex
    ObjectIndex root{0};
    std::vector<AnimationInfo> animations;
    PictureSettings picture;
    Shutter shutter;
    UpAxis up_axis = UpAxis::Y;
    Conventions conventions;
    /// For physically based renderers; others use `picture.background`.
    std::optional<EnvironmentDescription> environment;
};

/// Adds every finding about `description` to `diagnostics`: non-finite values, singular transforms,
/// invalid shapes, meshes and keys, ids out of range, objects that contain themselves, nesting
/// deeper than kMaxInstanceDepth, empty ray masks, operands of a solid that bound no volume,
/// unknown accelerators, an empty scene (warning).
void validate(const SceneDescription& description, Diagnostics& diagnostics);

}  // namespace alhazen
