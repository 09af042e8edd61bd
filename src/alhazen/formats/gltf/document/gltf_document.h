#pragma once
/// A parsed and checked glTF 2.0 file with its buffers loaded. `read_gltf_document` guarantees:
/// indices are in range, accessors lie within their buffers, the nodes form a forest.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022); extensions by their names.
/// Differs: see docs/reference/formats/gltf.md.
/// Conventions: names and units of the specification (angles in radians, right-handed, Y up,
/// texture coordinates from the upper left corner).

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "alhazen/formats/core/importer.h"

namespace alhazen::gltf {

using Index = std::uint32_t;

struct Buffer {
    std::shared_ptr<const std::string>
        owned;                 ///< null for the chunk of a GLB, which the source owns
    std::string_view bytes;    ///< byteLength bytes; empty for a buffer without references
    std::uint64_t length = 0;  ///< byteLength
    bool lacks_data = false;   ///< the buffer names no data, and is all zeros
};
struct BufferView {
    Index buffer = 0;
    std::uint64_t offset = 0, length = 0;
    std::uint32_t stride = 0;  ///< 0: tightly packed
    std::uint32_t target = 0;  ///< 34962 (vertices) or 34963 (indices); 0: undeclared
};

enum class ComponentType : std::uint16_t {
    Byte = 5120,
    UnsignedByte = 5121,
    Short = 5122,
    UnsignedShort = 5123,
    UnsignedInt = 5125,
    Float = 5126,
};
enum class ElementType : std::uint8_t { Scalar, Vec2, Vec3, Vec4, Mat2, Mat3, Mat4 };

struct SparseAccessor {
    std::uint64_t count = 0;
    Index indices_view = 0;
    std::uint64_t indices_offset = 0;
    ComponentType indices_type = ComponentType::UnsignedInt;
    Index values_view = 0;
    std::uint64_t values_offset = 0;
};
struct Accessor {
    std::string name;
    std::optional<Index> view;  ///< none: zeros
    std::uint64_t offset = 0, count = 0;
    ComponentType component = ComponentType::Float;
    ElementType type = ElementType::Scalar;
    bool normalized = false;
    std::optional<SparseAccessor> sparse;
    std::vector<double> min, max;  ///< as declared, of stored values; empty: undeclared
};

struct Image {
    std::string name;
    std::string uri;            ///< decoded file name, relative to the document; may be empty
    std::optional<Index> view;  ///< the encoded image
    std::string data;           ///< the encoded image of a data: URI
    std::string mime_type;      ///< as declared; empty: undeclared
    bool elsewhere = false;     ///< stored on the network: the textures that name it have no source
};
/// Filters of a sampler; Mipmap in a name means any mipmap mode.
enum class Filter { Unset, Nearest, Linear, NearestMipmap, LinearMipmap };
struct Sampler {
    Filter magnify = Filter::Unset, minify = Filter::Unset;
    Wrap wrap_s = Wrap::Repeat, wrap_t = Wrap::Repeat;
};
struct Texture {
    std::optional<Index> sampler;
    std::optional<Index> source;  ///< none: only an unsupported extension has an image
};
struct TextureInfo {
    Index texture = 0;
    Index tex_coord = 0;                              ///< KHR_texture_transform may override it
    std::array<double, 2> offset{0, 0}, scale{1, 1};  ///< KHR_texture_transform
    double rotation = 0;                              ///< KHR_texture_transform, radians
    double strength = 1;  ///< scale of a normal texture or strength of an occlusion texture
};
/// KHR_materials_pbrSpecularGlossiness, which replaces metal, roughness and base colour.
struct SpecularGlossiness {
    std::array<double, 4> diffuse{1, 1, 1, 1};
    std::array<double, 3> specular{1, 1, 1};
    double glossiness = 1;
    std::optional<TextureInfo> diffuse_texture, specular_glossiness_texture;
};
struct Material {
    std::string name;
    std::array<double, 4> base_color{1, 1, 1, 1};
    std::optional<TextureInfo> base_color_texture;
    double metallic = 1, roughness = 1;
    std::optional<TextureInfo> metallic_roughness_texture, normal_texture, occlusion_texture,
        emissive_texture;
    std::array<double, 3> emissive{0, 0, 0};
    AlphaMode alpha_mode = AlphaMode::Opaque;
    double alpha_cutoff = 0.5;
    bool double_sided = false;
    bool unlit = false;            ///< KHR_materials_unlit
    double emissive_strength = 1;  ///< KHR_materials_emissive_strength
    double ior = 1.5;              ///< KHR_materials_ior
    double transmission = 0;       ///< KHR_materials_transmission
    std::optional<TextureInfo> transmission_texture;
    double thickness = 0;  ///< KHR_materials_volume
    std::optional<TextureInfo> thickness_texture;
    std::optional<double> attenuation_distance;
    std::array<double, 3> attenuation_color{1, 1, 1};
    double specular = 1;  ///< KHR_materials_specular
    std::array<double, 3> specular_color{1, 1, 1};
    std::optional<TextureInfo> specular_texture, specular_color_texture;
    double coat = 0, coat_roughness = 0;  ///< KHR_materials_clearcoat
    std::optional<TextureInfo> coat_texture, coat_roughness_texture, coat_normal_texture;
    std::array<double, 3> sheen_color{0, 0, 0};  ///< KHR_materials_sheen
    double sheen_roughness = 0;
    std::optional<TextureInfo> sheen_color_texture, sheen_roughness_texture;
    double iridescence = 0, film_ior = 1.3;  ///< KHR_materials_iridescence
    double film_thinnest = 100, film_thickest = 400;
    std::optional<TextureInfo> iridescence_texture, film_thickness_texture;
    double anisotropy = 0, anisotropy_rotation = 0;  ///< KHR_materials_anisotropy, radians
    std::optional<TextureInfo> anisotropy_texture;
    double diffuse_transmission = 0;  ///< KHR_materials_diffuse_transmission
    std::array<double, 3> diffuse_transmission_color{1, 1, 1};
    std::optional<TextureInfo> diffuse_transmission_texture, diffuse_transmission_color_texture;
    double dispersion = 0;                        ///< KHR_materials_dispersion
    std::array<double, 3> multiscatter{0, 0, 0};  ///< KHR_materials_volume_scatter
    double scatter_anisotropy = 0;
    std::optional<SpecularGlossiness> specular_glossiness;
};

using Attributes = std::map<std::string, Index>;  ///< semantic -> accessor
enum class PrimitiveMode : std::uint8_t {
    Points = 0,
    Lines = 1,
    LineLoop = 2,
    LineStrip = 3,
    Triangles = 4,
    TriangleStrip = 5,
    TriangleFan = 6,
};
struct Primitive {
    PrimitiveMode mode = PrimitiveMode::Triangles;
    Attributes attributes;
    std::optional<Index> indices, material;
    std::vector<Attributes> targets;  ///< morph targets
};
struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights;  ///< of the morph targets; empty: all zero
};

struct Skin {
    std::string name;
    std::optional<Index> inverse_bind_matrices;
    std::vector<Index> joints;
    std::optional<Index> skeleton;
};
struct Node {
    std::string name;
    std::vector<Index> children;
    std::optional<Index> mesh, skin, camera, light;
    std::vector<double> weights;
    std::optional<std::array<double, 16>> matrix;  ///< column-major; replaces the next three
    std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
    std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
    Attributes instances;                        ///< EXT_mesh_gpu_instancing; empty: none
    bool visible = true;  ///< KHR_node_visibility: false also hides all descendants
};
struct Scene {
    std::string name;
    std::vector<Index> nodes;
};

struct Camera {
    std::string name;
    bool perspective = true;
    std::optional<double> aspect;  ///< perspective
    double yfov = 0;               ///< perspective
    double xmag = 1, ymag = 1;     ///< orthographic
    double near = 0;
    std::optional<double> far;
};
struct PunctualLight {  ///< KHR_lights_punctual
    enum class Type { Directional, Point, Spot };
    std::string name;
    Type type = Type::Point;
    std::array<double, 3> color{1, 1, 1};
    double intensity = 1;  ///< candela, or lux for a directional light
    std::optional<double> range;
    double inner_cone = 0, outer_cone = 0.7853981633974483;
};

enum class Interpolation { Linear, Step, CubicSpline };
struct AnimationSampler {
    Index input = 0, output = 0;
    Interpolation interpolation = Interpolation::Linear;
};
enum class AnimationPath { Translation, Rotation, Scale, Weights };
struct AnimationChannel {
    Index sampler = 0;
    std::optional<Index> node;  ///< none: an extension defines the target
    AnimationPath path = AnimationPath::Translation;
};
struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
    std::vector<AnimationSampler> samplers;
};

struct Document {
    std::vector<Buffer> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<Image> images;
    std::vector<Sampler> samplers;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Node> nodes;
    std::vector<Camera> cameras;
    std::vector<PunctualLight> lights;
    std::vector<Animation> animations;
    std::vector<Scene> scenes;
    std::optional<Index> scene;  ///< the default scene
    std::vector<std::string> extensions_used, extensions_required;
};

/// Parses JSON or GLB, loads the buffers (not the images) and checks the whole document. Reports
/// to `diagnostics`; each message begins with a JSON pointer ("#/meshes/0/primitives/1: ...").
/// After an error the document must not be used. An unsupported extension is an error that names it
/// if required, a warning if only used. Throws Error (Resource) above a limit. The document refers
/// to `source.bytes` (the chunk of a GLB is not copied) and must not outlive it.
[[nodiscard]] Document read_gltf_document(const ImportSource& source, Diagnostics& diagnostics);

/// Number of components of an element: 1, 2, 3, 4, 4, 9, 16.
[[nodiscard]] std::size_t component_count(ElementType type);

/// All numbers of an accessor in element order, [count * component_count]. Normalised integers are
/// converted to -1..1 or 0..1; matrices are column-major without padding; sparse values are
/// applied.
[[nodiscard]] std::vector<double> read_numbers(const Document& document, Index accessor);
/// Reads only the first `most` elements, at a cost proportional to `most`.
[[nodiscard]] std::vector<double> read_numbers(const Document& document, Index accessor,
                                               std::uint64_t most);
/// All numbers of an accessor of unsigned integers (indices, joints).
[[nodiscard]] std::vector<std::uint32_t> read_integers(const Document& document, Index accessor);
[[nodiscard]] std::string_view bytes_of(const Document& document, const BufferView& view);

}  // namespace alhazen::gltf
