#pragma once
/// Builds a scene description from NFF statements: equal materials once, triangles in one mesh per
/// material, lights with their default intensity.
///
/// Source: Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987.
/// Differs: all surfaces are two-sided.
/// Conventions: triangles keep the file order within their mesh; other polygons are shapes.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/geometry/polygon/free_diagonals.h"

namespace alhazen {

/// The statement `f`, or `fm`, which gives the colours separately.
struct NffFill {
    Rgb ambient, diffuse, specular;
    double shininess = 0, transmission = 0, index = 1;
};

struct NffView {
    std::optional<Vec3> from, at, up;
    std::optional<double> angle_deg;
    std::optional<Vec2> resolution;
    FileLocation location;
};

class NffBuilder {
  public:
    NffBuilder(SceneDescription& scene, const ImportOptions& options, Diagnostics& diagnostics);

    void set_fill(const NffFill& fill, const FileLocation& where);
    void add_light(const Vec3& position, const std::optional<Rgb>& color,
                   const FileLocation& where);
    void set_ambient(const Rgb& ambient) { ambient_ = ambient; }
    void add_sphere(const Vec3& center, double radius, const FileLocation& where);
    void add_cone(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius,
                  const FileLocation& where);
    /// Precondition: `normals` has as many elements as `vertices`, or none.
    void add_polygon(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
                     const FileLocation& where);
    /// Adds the camera, the intensities of the lights and the mesh normals.
    void finish(const NffView& view);

  private:
    void add_shape(AnyShape shape, const FileLocation& where);
    TriangleMesh& current_mesh(bool smooth, const FileLocation& where);
    void add_triangles(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
                       const FileLocation& where);
    MaterialId current_material(const FileLocation& where);
    void add_camera(const NffView& view);
    void check_room(const FileLocation& where);

    SceneDescription& scene_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    std::map<std::array<double, 12>, MaterialId> materials_;
    std::optional<MaterialId> material_;
    std::map<std::pair<MaterialId, bool>, std::size_t> meshes_;        ///< [material, smooth]
    std::map<TriangleMesh*, std::vector<PolygonTriangles>> polygons_;  ///< of each mesh
    std::vector<bool> default_intensity_;                              ///< [light]
    std::optional<Rgb> ambient_;
    std::uint64_t elements_ = 0;
    std::uint64_t degenerate_ = 0;
};

}  // namespace alhazen
