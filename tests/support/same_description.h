#pragma once
/// Comparison of two scene descriptions, bit for bit. Each function decomposes its structs into all
/// members: a new member does not compile until it is compared here (and written by the native
/// writer). Shapes are compared by their kFields.
///
/// Not compared: file locations, derived fields of shapes, and what native_writer.h lists.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <string>

#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/scene_model/scene_description.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen::testing {

inline bool same(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
template <class T>
requires std::is_integral_v<T> || std::is_enum_v<T>
bool same(T a, T b) {
    return a == b;
}
inline bool same(const std::string& a, const std::string& b) {
    return a == b;
}

/// True if all pairs are the same; arguments are a1, b1, a2, b2, ...
template <class A, class B, class... Rest>
bool all_same(const A& a, const B& b, const Rest&... rest);
inline bool all_same() {
    return true;
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b);
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b);
template <class... T>
bool same(const std::variant<T...>& a, const std::variant<T...>& b);
template <class T>
bool same(const std::shared_ptr<T>& a, const std::shared_ptr<T>& b);
template <class T, std::size_t N>
bool same(const std::array<T, N>& a, const std::array<T, N>& b) {
    for (std::size_t i = 0; i < N; ++i) {
        if (a[i] != b[i]) return false;
    }
    return true;
}

// Members of `a` are named a1, a2, ..., those of `b` b1, b2, ...

inline bool same(const Vec2& a, const Vec2& b) {
    return same(a.x, b.x) && same(a.y, b.y);
}
inline bool same(const Vec3& a, const Vec3& b) {
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}
inline bool same(const Rgb& a, const Rgb& b) {
    return same(a.r, b.r) && same(a.g, b.g) && same(a.b, b.b);
}
inline bool same(const Affine& a, const Affine& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1.x_axis, b1.x_axis, a1.y_axis, b1.y_axis, a1.z_axis, b1.z_axis, a2, b2);
}
inline bool same(const TransformKey& a, const TransformKey& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const PartMotion& a, const PartMotion& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const MeshKey& a, const MeshKey& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const VertexColor& a, const VertexColor& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const VertexTangent& a, const VertexTangent& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const TriangleMesh& a, const TriangleMesh& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8);
}

// Materials and textures.

inline bool same(const ColorInput& a, const ColorInput& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const ScalarInput& a, const ScalarInput& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2) && (a2 == kNoTexture || same(a3, b3));
}
inline bool same(const NormalMap& a, const NormalMap& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return same(a1, b1) && (a1 == kNoTexture || same(a2, b2));
}
inline bool same(const ClearCoat& a, const ClearCoat& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const SheenLayer& a, const SheenLayer& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const IridescentFilm& a, const IridescentFilm& b) {
    const auto& [a1, a2, a3, a4, a5] = a;
    const auto& [b1, b2, b3, b4, b5] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5);
}
inline bool same(const Grooves& a, const Grooves& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const DiffuseTransmission& a, const DiffuseTransmission& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const MetallicRoughness& a, const MetallicRoughness& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16, a17] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16, b17] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8, a9, b9, a10,
                    b10, a11, b11, a12, b12, a13, b13, a14, b14, a15, b15, a16, b16, a17, b17);
}
inline bool same(const Conductor& a, const Conductor& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const Dielectric& a, const Dielectric& b) {
    const auto& [a1] = a;
    const auto& [b1] = b;
    return all_same(a1, b1);
}
inline bool same(const VolumeScattering& a, const VolumeScattering& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const Dispersion& a, const Dispersion& b) {
    return a == b;
}
inline bool same(const Illuminant& a, const Illuminant& b) {
    return a == b;
}
inline bool same(const Material& a, const Material& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16, a17, a18,
                 a19, a20, a21, a22] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16, b17, b18,
                 b19, b20, b21, b22] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8, a9, b9, a10,
                    b10, a11, b11, a12, b12, a13, b13, a14, b14, a15, b15, a16, b16, a17, b17, a18,
                    b18, a19, b19, a20, b20, a21, b21, a22, b22);
}
inline bool same(const MaterialDescription& a, const MaterialDescription& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    (void)a2, (void)b2;
    return same(a1, b1);
}
inline bool same(const UvTransform& a, const UvTransform& b) {
    const auto& [a1, a2, a3, a4, a5] = a;
    const auto& [b1, b2, b3, b4, b5] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5);
}
inline bool same(const StoredImage& a, const StoredImage& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7] = b;
    (void)a7, (void)b7;
    const bool samples =
        a5.index() == b5.index() &&
        std::visit([&]<class V>(const V& v) { return same(v, std::get<V>(b.samples)); }, a5);
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a6, b6) && samples;
}
inline bool same(const ImageTexture& a, const ImageTexture& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9] = b;
    (void)a9, (void)b9;  // the mipmaps are made by `compile`
    return same(*a1, *b1) && all_same(a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8);
}
inline bool same(const SolidTexture& a, const SolidTexture& b) {
    return a == b;
}
inline bool same(const TextureDescription& a, const TextureDescription& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    (void)a3, (void)b3;
    return all_same(a1, b1, a2, b2);
}

// Cameras and lights.

inline bool same(const Lens& a, const Lens& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const PerspectiveCamera& a, const PerspectiveCamera& b) {
    const auto& [a1, a2, a3, a4, a5] = a;
    const auto& [b1, b2, b3, b4, b5] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5);
}
inline bool same(const OrthographicCamera& a, const OrthographicCamera& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const WideCamera& a, const WideCamera& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7);
}
inline bool same(const Attenuation& a, const Attenuation& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const AmbientLight& a, const AmbientLight& b) {
    const auto& [a1] = a;
    const auto& [b1] = b;
    return same(a1, b1);
}
inline bool same(const DirectionalLight& a, const DirectionalLight& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const LightProfile& a, const LightProfile& b) {
    const auto& [file_a, profile_a, down_a, front_a] = a;
    const auto& [file_b, profile_b, down_b, front_b] = b;
    (void)file_a, (void)file_b;
    const bool same_text = (profile_a == nullptr) == (profile_b == nullptr) &&
                           (!profile_a || profile_a->text() == profile_b->text());
    return same_text && (!profile_a || (same(down_a, down_b) && same(front_a, front_b)));
}
inline bool same(const PointLight& a, const PointLight& b) {
    const auto& [a1, a2, a3, a4, a5, a6, profile_a] = a;
    const auto& [b1, b2, b3, b4, b5, b6, profile_b] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6) && same(profile_a, profile_b);
}
inline bool same(const SpotLight& a, const SpotLight& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8, profile_a, derived_a] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8, profile_b, derived_b] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8) &&
           same(profile_a, profile_b);
}
inline bool same(const RectangleExtent& a, const RectangleExtent& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const DiscExtent& a, const DiscExtent& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
inline bool same(const SphereExtent& a, const SphereExtent& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const TubeExtent& a, const TubeExtent& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const PolygonExtent& a, const PolygonExtent& b) {
    const auto& [a1] = a;
    const auto& [b1] = b;
    return all_same(a1, b1);
}
inline bool same(const MeshExtent& a, const MeshExtent& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1) && a2 == b2;
}
inline bool same(const AreaLight& a, const AreaLight& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7] = b;
    (void)a6, (void)b6;  // the surface is made by `compile`
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a7, b7);
}
inline bool same(const CameraDescription& a, const CameraDescription& b) {
    const auto& [a1, a2, a3, a4, a5] = a;
    const auto& [b1, b2, b3, b4, b5] = b;
    (void)a4, (void)b4;
    return all_same(a1, b1, a2, b2, a3, b3, a5, b5);
}
inline bool same(const LightDescription& a, const LightDescription& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    (void)a3, (void)b3;
    return all_same(a1, b1, a2, b2);
}

// Parts. Shapes are compared by the fields that files give.

inline bool same(const Box3& a, const Box3& b) {
    return same(a.lo, b.lo) && same(a.hi, b.hi);
}
inline bool same(const ClipPlane& a, const ClipPlane& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const OrientedPlane& a, const OrientedPlane& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const ProfileCurve& a, const ProfileCurve& b) {
    return all_same(a.p[0], b.p[0], a.p[3], b.p[3], a.line, b.line) &&
           (a.line || all_same(a.p[1], b.p[1], a.p[2], b.p[2]));
}
inline bool same(const Profile& a, const Profile& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const BlobComponent& a, const BlobComponent& b) {
    return all_same(a.base, b.base, a.radius, b.radius, a.strength, b.strength, a.rod, b.rod) &&
           (!a.rod || same(a.top, b.top));
}
inline bool same(const TrimCurve& a, const TrimCurve& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}
/// Compares all fields of a shape.
template <Shape S>
bool same(const S& a, const S& b) {
    bool all = true;
    for_each_field<S>(
        [&](const auto& field) { all = all && same(a.*field.member, b.*field.member); });
    return all;
}
inline bool same(const Polygon& a, const Polygon& b) {
    // Without loops, all vertices are one loop.
    const auto loops = [](const Polygon& p) {
        return p.loop_ends.empty()
                   ? std::vector<std::uint32_t>{static_cast<std::uint32_t>(p.vertices.size())}
                   : p.loop_ends;
    };
    return same(a.vertices, b.vertices) && loops(a) == loops(b);
}
inline bool same(const Part& a, const Part& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7] = b;
    (void)a5, (void)b5;
    const bool object = std::holds_alternative<ObjectIndex>(a1);
    return all_same(a1, b1, a2, b2, a4, b4, a6, b6, a7, b7) && (object || same(a3, b3));
}
inline bool same(const ObjectDescription& a, const ObjectDescription& b) {
    const auto& [a1, a2, a3, a4, a5, a6] = a;
    const auto& [b1, b2, b3, b4, b5, b6] = b;
    (void)a3, (void)b3;
    return all_same(a1, b1, a2, b2, a4, b4, a5, b5, a6, b6);
}
/// `of_polygon` is for messages.
inline bool same(const MeshDescription& a, const MeshDescription& b) {
    const auto& [a1, a2, a3, a4, a5] = a;
    const auto& [b1, b2, b3, b4, b5] = b;
    (void)a3, (void)b3, (void)a5, (void)b5;
    return same(a1, b1) && same(*a2, *b2) && same(a4, b4);
}
inline bool same(const PictureSettings& a, const PictureSettings& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const Optics& a, const Optics& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const ShadingConventions& a, const ShadingConventions& b) {
    const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16, a17] = a;
    const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16, b17] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4, a5, b5, a6, b6, a7, b7, a8, b8, a9, b9, a10,
                    b10, a11, b11, a12, b12, a13, b13, a14, b14, a15, b15, a16, b16, a17, b17);
}
inline bool same(const SamplingConventions& a, const SamplingConventions& b) {
    const auto& [a1] = a;
    const auto& [b1] = b;
    return all_same(a1, b1);
}
inline bool same(const FilmConventions& a, const FilmConventions& b) {
    const auto& [a1, a2] = a;
    const auto& [b1, b2] = b;
    return all_same(a1, b1, a2, b2);
}
inline bool same(const ImportConventions& a, const ImportConventions& b) {
    const auto& [a1, a2, a3] = a;
    const auto& [b1, b2, b3] = b;
    return all_same(a1, b1, a2, b2, a3, b3);
}
inline bool same(const Conventions& a, const Conventions& b) {
    const auto& [a1, a2, a3, a4] = a;
    const auto& [b1, b2, b3, b4] = b;
    return all_same(a1, b1, a2, b2, a3, b3, a4, b4);
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!same(a[i], b[i])) return false;
    }
    return true;
}
template <class T>
bool same(const std::shared_ptr<T>& a, const std::shared_ptr<T>& b) {
    return a == b || (a && b && same(*a, *b));
}
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
template <class... T>
bool same(const std::variant<T...>& a, const std::variant<T...>& b) {
    return a.index() == b.index() &&
           std::visit([&]<class V>(const V& v) { return same(v, std::get<V>(b)); }, a);
}
template <class A, class B, class... Rest>
bool all_same(const A& a, const B& b, const Rest&... rest) {
    return same(a, b) && all_same(rest...);
}

inline bool same(const EnvironmentSettings& a, const EnvironmentSettings& b) {
    const auto& [kind_a, color_a, file_a, picture_a, scale_a, rotation_a, up_a, turbidity_a,
                 to_sun_a, ground_a] = a;
    const auto& [kind_b, color_b, file_b, picture_b, scale_b, rotation_b, up_b, turbidity_b,
                 to_sun_b, ground_b] = b;
    (void)file_a, (void)file_b;
    const auto same_direction = [](const std::optional<Vec3>& x, const std::optional<Vec3>& y) {
        return x.has_value() == y.has_value() && (!x || same(*x, *y));
    };
    const bool same_picture =
        (picture_a == nullptr) == (picture_b == nullptr) &&
        (!picture_a ||
         (picture_a->width == picture_b->width && picture_a->channels == picture_b->channels &&
          picture_a->linear == picture_b->linear && picture_a->samples == picture_b->samples));
    return kind_a == kind_b && same(color_a, color_b) && same_picture && same(scale_a, scale_b) &&
           same(rotation_a, rotation_b) && same_direction(up_a, up_b) &&
           same(turbidity_a, turbidity_b) && same_direction(to_sun_a, to_sun_b) &&
           same(ground_a, ground_b);
}

/// Fails the test if the lists differ, with the index of the first difference.
template <class T>
void expect_same_list(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
    EXPECT_EQ(a.size(), b.size()) << what;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (same(a[i], b[i])) continue;
        ADD_FAILURE() << what << " " << i << " differs";
        return;
    }
}

inline void expect_same(const SceneDescription& a, const SceneDescription& b) {
    const auto& [format_a, path_a, files_a, cameras_a, lights_a, materials_a, textures_a, meshes_a,
                 objects_a, root_a, animations_a, picture_a, shutter_a, up_a, conventions_a,
                 environment_a] = a;
    const auto& [format_b, path_b, files_b, cameras_b, lights_b, materials_b, textures_b, meshes_b,
                 objects_b, root_b, animations_b, picture_b, shutter_b, up_b, conventions_b,
                 environment_b] = b;
    (void)format_a, (void)format_b, (void)path_a, (void)path_b;
    EXPECT_TRUE(same(shutter_a.open, shutter_b.open) && same(shutter_a.close, shutter_b.close));
    (void)files_a, (void)files_b, (void)animations_a, (void)animations_b;
    expect_same_list(cameras_a, cameras_b, "camera");
    expect_same_list(lights_a, lights_b, "light");
    expect_same_list(materials_a, materials_b, "material");
    expect_same_list(textures_a, textures_b, "texture");
    expect_same_list(meshes_a, meshes_b, "mesh");
    expect_same_list(objects_a, objects_b, "object");
    EXPECT_EQ(root_a, root_b);
    EXPECT_TRUE(same(picture_a, picture_b)) << "picture";
    EXPECT_EQ(up_a, up_b);
    EXPECT_TRUE(same(conventions_a, conventions_b)) << "conventions";
    ASSERT_EQ(environment_a.has_value(), environment_b.has_value());
    if (environment_a) {
        EXPECT_TRUE(same(environment_a->settings, environment_b->settings)) << "environment";
    }
}

}  // namespace alhazen::testing
