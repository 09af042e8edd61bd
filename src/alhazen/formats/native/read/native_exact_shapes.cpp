#include "alhazen/formats/native/read/native_exact_shapes.h"

namespace alhazen {

namespace {

/// `((x, y, z), (x, y, z))`: the lower and the upper corner.
void read_box(BlockReader& reader, std::string_view key, Box3& box) {
    const auto list = reader.find(key);
    if (!list || !reader.values().is_list(*list, key)) return;
    Vec3 corners[2];
    int count = 0;
    for (const TextNode corner : *list) {
        Vec3 value;
        if (!reader.values().read(corner, key, value)) return;
        if (count < 2) corners[count] = value;
        ++count;
    }
    if (count != 2) {
        reader.error(*list, std::string(key) + ": expected ((x, y, z), (x, y, z)), the lower " +
                                "corner and the upper one");
        return;
    }
    box = {corners[0], corners[1]};
}

std::string box_text(const Box3& box) {
    return native_list({native_value(box.lo), native_value(box.hi)});
}

/// `((x, y, z, offset), ...)`: what lies at dot((x, y, z), p) > offset is cut off.
void read_planes(BlockReader& reader, std::string_view key, std::vector<ClipPlane>& planes) {
    const auto list = reader.find(key);
    if (!list || !reader.values().is_list(*list, key)) return;
    for (const TextNode plane : *list) {
        double n[4];
        if (!reader.values().read_numbers(plane, key, 4, n)) continue;
        planes.push_back({{n[0], n[1], n[2]}, n[3]});
    }
}

}  // namespace

AnyShape read_native_ellipsoid(BlockReader& reader) {
    Ellipsoid s;
    reader.read("center", s.center);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("axis_c", s.axis_c);
    return s;
}

AnyShape read_native_elliptic_cylinder(BlockReader& reader) {
    EllipticCylinder s;
    reader.read("base", s.base);
    reader.read("top", s.top);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_elliptic_cone(BlockReader& reader) {
    EllipticCone s;
    reader.read("base", s.base);
    reader.read("top", s.top);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("top_scale", s.top_scale);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_tgc(BlockReader& reader) {
    Tgc s;
    reader.read("base", s.base);
    reader.read("height", s.height);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("axis_c", s.axis_c);
    reader.read("axis_d", s.axis_d);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_torus(BlockReader& reader) {
    Torus s;
    reader.read("center", s.center);
    reader.read("axis", s.axis);
    reader.read("major_radius", s.major_radius);
    reader.read("minor_radius", s.minor_radius);
    return s;
}

AnyShape read_native_paraboloid(BlockReader& reader) {
    Paraboloid s;
    reader.read("apex", s.apex);
    reader.read("rim", s.rim);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_hyperboloid(BlockReader& reader) {
    Hyperboloid s;
    reader.read("base", s.base);
    reader.read("top", s.top);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("waist", s.waist);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_two_sheet_hyperboloid(BlockReader& reader) {
    TwoSheetHyperboloid s;
    reader.read("base", s.base);
    reader.read("top", s.top);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("gap", s.gap);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_quadric(BlockReader& reader) {
    Quadric s;
    reader.read("squares", s.squares);
    reader.read("products", s.products);
    reader.read("linear", s.linear);
    reader.read("constant", s.constant);
    read_box(reader, "clip_box", s.clip_box);
    read_planes(reader, "clip_planes", s.clip_planes);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_algebraic(BlockReader& reader) {
    Algebraic s;
    reader.read("expression", s.expression);
    read_box(reader, "clip_box", s.clip_box);
    reader.read("capped", s.capped);
    return s;
}

AnyShape read_native_superellipsoid(BlockReader& reader) {
    Superellipsoid s;
    reader.read("center", s.center);
    reader.read("axis_a", s.axis_a);
    reader.read("axis_b", s.axis_b);
    reader.read("axis_c", s.axis_c);
    reader.read("east", s.east);
    reader.read("north", s.north);
    return s;
}

void add_fields(NativeBlockText& block, const Superellipsoid& s) {
    block.add("center", native_value(s.center));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add("axis_c", native_value(s.axis_c));
    block.add("east", native_value(s.east));
    block.add("north", native_value(s.north));
}

void add_fields(NativeBlockText& block, const Ellipsoid& s) {
    block.add("center", native_value(s.center));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add("axis_c", native_value(s.axis_c));
}

void add_fields(NativeBlockText& block, const EllipticCylinder& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const EllipticCone& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add_unless("top_scale", s.top_scale, 0.0);
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const Tgc& s) {
    block.add("base", native_value(s.base));
    block.add("height", native_value(s.height));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add("axis_c", native_value(s.axis_c));
    block.add("axis_d", native_value(s.axis_d));
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const Torus& s) {
    block.add("center", native_value(s.center));
    block.add("axis", native_value(s.axis));
    block.add("major_radius", native_value(s.major_radius));
    block.add("minor_radius", native_value(s.minor_radius));
}

void add_fields(NativeBlockText& block, const Paraboloid& s) {
    block.add("apex", native_value(s.apex));
    block.add("rim", native_value(s.rim));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const Hyperboloid& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add("waist", native_value(s.waist));
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const TwoSheetHyperboloid& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("axis_a", native_value(s.axis_a));
    block.add("axis_b", native_value(s.axis_b));
    block.add("gap", native_value(s.gap));
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const Quadric& s) {
    block.add("squares", native_value(s.squares));
    block.add("products", native_value(s.products));
    block.add("linear", native_value(s.linear));
    block.add("constant", native_value(s.constant));
    if (s.clip_box.bounded()) block.add("clip_box", box_text(s.clip_box));
    if (!s.clip_planes.empty()) {
        std::vector<std::string> planes;
        for (const ClipPlane& plane : s.clip_planes) {
            planes.push_back(
                native_list({native_value(plane.normal.x), native_value(plane.normal.y),
                             native_value(plane.normal.z), native_value(plane.offset)}));
        }
        block.add("clip_planes", native_list(planes));
    }
    block.add_unless("capped", s.capped, true);
}

void add_fields(NativeBlockText& block, const Algebraic& s) {
    block.add("expression", native_string(s.expression));
    block.add("clip_box", box_text(s.clip_box));
    block.add_unless("capped", s.capped, true);
}

}  // namespace alhazen
