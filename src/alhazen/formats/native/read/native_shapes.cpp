#include "alhazen/formats/native/read/native_shapes.h"

#include "alhazen/formats/native/read/native_exact_shapes.h"
#include "alhazen/formats/native/read/native_solids.h"

namespace alhazen {

namespace {

/// Appends one loop `((x, y, z), ...)` to the polygon.
void read_loop(TextNode loop, std::string_view key, const ValueReader& values, Polygon& polygon) {
    if (!values.is_list(loop, key)) return;
    for (const TextNode point : loop) {
        Vec3 vertex;
        if (values.read(point, key, vertex)) polygon.vertices.push_back(vertex);
    }
    polygon.loop_ends.push_back(static_cast<std::uint32_t>(polygon.vertices.size()));
}

AnyShape read_polygon(BlockReader& reader) {
    Polygon polygon;
    const auto vertices = reader.find("vertices");
    const auto loops = reader.find("loops");
    if (reader.has("vertices") == reader.has("loops")) {
        reader.error(reader.block(), "expected either 'vertices = ...' or 'loops = ...'");
    }
    if (vertices) read_loop(*vertices, "vertices", reader.values(), polygon);
    if (loops && reader.values().is_list(*loops, "loops")) {
        for (const TextNode loop : *loops) read_loop(loop, "loops", reader.values(), polygon);
    }
    return polygon;
}

struct ShapeEntry {
    const char* type;
    AnyShape (*read)(BlockReader&);
};

/// The keys are the names of the struct's fields; what a file leaves out keeps the struct's
/// default.
// clang-format off
constexpr ShapeEntry kShapes[] = {
    {Sphere::kName, [](BlockReader& r) -> AnyShape {
        Sphere s;
        r.read("center", s.center);
        r.read("radius", s.radius);
        return s;
    }},
    {Plane::kName, [](BlockReader& r) -> AnyShape {
        Plane s;
        r.read("point", s.point);
        r.read("normal", s.normal);
        return s;
    }},
    {Disc::kName, [](BlockReader& r) -> AnyShape {
        Disc s;
        r.read("center", s.center);
        r.read("normal", s.normal);
        r.read("radius", s.radius);
        r.read("inner_radius", s.inner_radius);
        return s;
    }},
    {Rectangle::kName, [](BlockReader& r) -> AnyShape {
        Rectangle s;
        r.read("corner", s.corner);
        r.read("edge_u", s.edge_u);
        r.read("edge_v", s.edge_v);
        return s;
    }},
    {BoxShape::kName, [](BlockReader& r) -> AnyShape {
        BoxShape s;
        r.read("lo", s.lo);
        r.read("hi", s.hi);
        return s;
    }},
    {Cylinder::kName, [](BlockReader& r) -> AnyShape {
        Cylinder s;
        r.read("base", s.base);
        r.read("top", s.top);
        r.read("radius", s.radius);
        r.read("capped", s.capped);
        return s;
    }},
    {Cone::kName, [](BlockReader& r) -> AnyShape {
        Cone s;
        r.read("base", s.base);
        r.read("top", s.top);
        r.read("base_radius", s.base_radius);
        r.read("top_radius", s.top_radius);
        r.read("capped", s.capped);
        return s;
    }},
    {Polygon::kName, read_polygon},
    {HalfSpace::kName, [](BlockReader& r) -> AnyShape {
        HalfSpace s;
        r.read("point", s.point);
        r.read("normal", s.normal);
        return s;
    }},
    {Polyhedron::kName, read_native_polyhedron},
    {Ellipsoid::kName, read_native_ellipsoid},
    {EllipticCylinder::kName, read_native_elliptic_cylinder},
    {EllipticCone::kName, read_native_elliptic_cone},
    {Tgc::kName, read_native_tgc},
    {Torus::kName, read_native_torus},
    {Paraboloid::kName, read_native_paraboloid},
    {Hyperboloid::kName, read_native_hyperboloid},
    {TwoSheetHyperboloid::kName, read_native_two_sheet_hyperboloid},
    {Quadric::kName, read_native_quadric},
    {Algebraic::kName, read_native_algebraic},
    {Superellipsoid::kName, read_native_superellipsoid},
    {Prism::kName, read_native_prism},
    {Lathe::kName, read_native_lathe},
    {Blob::kName, read_native_blob},
    {HeightField::kName, read_native_height_field},
};
// clang-format on

static_assert(std::size(kShapes) == AnalyticShapes::kCount, "every shape needs its entry here");

}  // namespace

AnyShape read_native_shape(std::string_view type, BlockReader& reader) {
    for (const ShapeEntry& entry : kShapes) {
        if (entry.type == type) return entry.read(reader);
    }
    return {};
}

bool is_native_shape(std::string_view type) {
    for (const ShapeEntry& entry : kShapes) {
        if (entry.type == type) return true;
    }
    return false;
}

std::vector<std::string_view> native_shape_names() {
    std::vector<std::string_view> names;
    for (const ShapeEntry& entry : kShapes) names.emplace_back(entry.type);
    return names;
}

}  // namespace alhazen
