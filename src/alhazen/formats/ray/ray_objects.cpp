#include "alhazen/formats/ray/ray_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alhazen/formats/core/homogeneous_matrix.h"
#include "alhazen/formats/ray/ray_extensions.h"
#include "alhazen/formats/ray/ray_mesh.h"
#include "alhazen/formats/ray/ray_view.h"

namespace alhazen {

namespace {

// The shapes of the format, each in its local frame.

AnyShape read_sphere(BlockReader&) {
    return Sphere{};
}
AnyShape read_box(BlockReader&) {
    return BoxShape{};
}
AnyShape read_square(BlockReader&) {
    return Rectangle{};
}

AnyShape read_cylinder(BlockReader& reader) {
    Cylinder cylinder;
    reader.read("capped", cylinder.capped);
    return cylinder;
}

AnyShape read_cone(BlockReader& reader) {
    Cone cone;
    if (const auto height = reader.find("height")) {
        double z = 0;
        if (reader.values().read(*height, "height", z)) {
            // A cone may point down.
            if (std::abs(z) >= kMinLength && std::abs(z) <= kMaxCoordinate) {
                cone.top.z = z;
            } else {
                reader.error(*height, "height must be a number other than 0, of a size from " +
                                          std::string("1e-70 to 1e70"));
            }
        }
    }
    reader.read("bottom_radius", cone.base_radius);
    reader.read("top_radius", cone.top_radius);
    reader.read("capped", cone.capped);
    cone.base_radius = std::abs(cone.base_radius);
    cone.top_radius = std::abs(cone.top_radius);
    return cone;
}

using ReadShape = AnyShape (*)(BlockReader&);
constexpr std::pair<std::string_view, ReadShape> kShapeObjects[] = {
    {"sphere", read_sphere},     {"box", read_box},   {"square", read_square},
    {"cylinder", read_cylinder}, {"cone", read_cone},
};

bool is_mesh(std::string_view name) {
    return name == "trimesh" || name == "polymesh";
}

bool is_shape(std::string_view name) {
    return is_mesh(name) || std::any_of(std::begin(kShapeObjects), std::end(kShapeObjects),
                                        [&](const auto& entry) { return entry.first == name; });
}

constexpr std::array<std::string_view, 4> kTransforms{"translate", "rotate", "scale", "transform"};

bool is_transform(std::string_view name) {
    return std::find(kTransforms.begin(), kTransforms.end(), name) != kTransforms.end();
}

using Arguments = std::vector<TextNode>;

bool read_numbers(const Arguments& arguments, std::string_view what, const ValueReader& values,
                  double* out) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (!values.read(arguments[i], what, out[i])) return false;
    }
    return true;
}

/// Reads four rows of a matrix that multiplies column vectors.
std::optional<Affine> read_matrix(const Arguments& rows, const ValueReader& values,
                                  RayContext& context) {
    std::array<double, 16> m{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (!values.read_numbers(rows[i], "transform", 4, &m[4 * i])) return std::nullopt;
    }
    const HomogeneousMatrix matrix(m);
    if (matrix.last_row == LastRow::Perspective) {
        values.diagnostics.error(rows[3].location(),
                                 "transform: the last row must be (0, 0, 0, 1)");
        return std::nullopt;
    }
    if (matrix.last_row == LastRow::Rounded && !context.reported_rounding) {
        context.reported_rounding = true;
        values.diagnostics.warning(rows[3].location(),
                                   "transform: the last row is rounded; it and others are taken as "
                                   "(0, 0, 0, 1) after division by the last number");
    }
    return matrix.transform;
}

/// The transform `name` with its arguments (those before the object).
std::optional<Affine> read_affine(std::string_view name, TextNode list, const Arguments& arguments,
                                  const ValueReader& values, RayContext& context) {
    const std::size_t count = arguments.size();
    double v[4];
    if (name == "transform" && count == 4) return read_matrix(arguments, values, context);
    const bool fits = (name == "translate" && count == 3) || (name == "rotate" && count == 4) ||
                      (name == "scale" && (count == 1 || count == 3));
    if (!fits) {
        values.diagnostics.error(list.location(),
                                 std::string(name) + ": wrong number of arguments; expected " +
                                     (name == "translate" ? "(x, y, z, object)"
                                      : name == "rotate"  ? "(x, y, z, radians, object)"
                                      : name == "scale"   ? "(s, object) or (x, y, z, object)"
                                                          : "(row, row, row, row, object)"));
        return std::nullopt;
    }
    if (!read_numbers(arguments, name, values, v)) return std::nullopt;
    if (name == "translate") return Affine::translate({v[0], v[1], v[2]});
    if (name == "scale")
        return Affine::scale(count == 1 ? Vec3{v[0], v[0], v[0]} : Vec3{v[0], v[1], v[2]});
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) {
        values.diagnostics.error(list.location(), "rotate: the axis must not be the zero vector");
        return std::nullopt;
    }
    return Affine::rotate({v[0], v[1], v[2]}, v[3]);
}

/// From what the materials of a mesh's vertices start: in the token family the mesh's own, if that
/// stands before them, else the one around the mesh; in the dictionary family no material.
RayMaterial start_of_vertices(TextNode mesh, const RayMaterial& own, const RayMaterial& around,
                              bool dictionary) {
    if (dictionary) return {};
    RayMaterial start = around;
    for (const TextNode item : mesh) {
        if (item.is(NodeKind::Pair, "materials")) return start;
        if (item.is(NodeKind::Pair, "material")) start = own;
    }
    return start;
}

}  // namespace

std::string RayObjects::known(Place place) {
    std::vector<std::string_view> names;
    if (place == Place::TopLevel) names = ray_cameras_and_lights();
    names.push_back("material");
    for (const auto& [name, read] : kShapeObjects) names.push_back(name);
    names.insert(names.end(), {"trimesh", "polymesh"});
    names.insert(names.end(), kTransforms.begin(), kTransforms.end());
    return joined(names) + " and groups { }";
}

void RayObjects::read(TextNode item, const Affine& object_from_part, RayMaterial& material,
                      Place place) {
    Affine transform = object_from_part;
    std::optional<TextNode> object = item;
    after_refused_word_ = std::exchange(refused_word_, false);
    // Transform chains are iterated, not recursed into: only groups use stack.
    while (object && object->is(NodeKind::Entry) && is_transform(object->text())) {
        object = read_transform(*object, transform);
        place = Place::Inside;
    }
    if (object && !object->broken()) read_untransformed(*object, transform, material, place);
}

void RayObjects::read_untransformed(TextNode item, const Affine& object_from_part,
                                    RayMaterial& material, Place place) {
    const std::string_view name = item.text();
    if (item.is(NodeKind::Block)) return read_group(item, object_from_part, material);
    if (item.is(NodeKind::Pair, "material")) {
        if (!item.empty()) material = materials_.read(item.first(), material);
        return;
    }
    if (!item.is(NodeKind::Entry)) return refuse(item, place);
    if (name == "material") return materials_.define(item, material);
    if (is_shape(name)) return read_shape(item, object_from_part, material);
    refuse(item, place);
}

void RayObjects::refuse(TextNode item, Place place) {
    const std::string_view name = item.text();
    // In `ball foo { }` the word is what is not known.
    if (after_refused_word_ && item.is(NodeKind::Entry)) return;
    refused_word_ = item.is(NodeKind::Word);
    const auto error = [&](const std::string& message) {
        context_.diagnostics.error(item.location(), message);
    };
    const bool camera_or_light = is_ray_camera_or_light(name);
    if (camera_or_light && place == Place::Inside) {
        return error(std::string(name) + ": cameras and lights stand at the top level of the file" +
                     ", outside groups and transforms");
    }
    if (camera_or_light || is_shape(name)) {  // no entry: `camera = { }`, `sphere;`
        return error(std::string(name) + ": expected a block { } right after the name");
    }
    if (!item.is(NodeKind::Entry) && !item.is(NodeKind::Word)) {
        return error("expected an object, found " + item.describe() + "; known are " +
                     known(place));
    }
    if (const auto extension = ray_extension(name)) {
        const bool light = name.ends_with("_light") || name == "skybox";
        return error(refusal(light ? "light" : "object", name, *extension));
    }
    error("unknown object '" + printable(name) + "'; known are " + known(place));
}

/// Reads a group. A default set inside is local to it: `material` is a copy.
void RayObjects::read_group(TextNode block, const Affine& object_from_part, RayMaterial material) {
    for (const TextNode item : block) read(item, object_from_part, material, Place::Inside);
    refused_word_ = false;
}

std::optional<TextNode> RayObjects::read_transform(TextNode entry, Affine& object_from_part) {
    if (entry.broken() || entry.empty() || entry.first().broken()) return std::nullopt;
    const TextNode list = entry.first();
    if (!list.is(NodeKind::List) || list.empty()) {
        context_.diagnostics.error(entry.location(),
                                   std::string(entry.text()) + ": expected (..., object)");
        return std::nullopt;
    }
    Arguments arguments;
    for (const TextNode argument : list) {
        if (arguments.size() > 5) break;  // too many already
        arguments.push_back(argument);
    }
    const TextNode object = arguments.back();
    arguments.pop_back();
    const std::optional<Affine> transform =
        read_affine(entry.text(), list, arguments, {context_.diagnostics}, context_);
    // Reads the object even after an invalid transform, to report its errors too.
    if (transform) object_from_part = object_from_part * *transform;
    return object;
}

void RayObjects::read_shape(TextNode entry, const Affine& object_from_part,
                            const RayMaterial& material) {
    const std::string name(entry.text());
    if (entry.empty() || !entry.first().is(NodeKind::Block)) {
        context_.diagnostics.error(entry.location(), name + ": expected a block { }");
        return;
    }
    BlockReader reader(entry.first(), name, BlockReader::Strictness::Tolerant,
                       context_.diagnostics);
    RayMaterial own = material;
    if (const auto value = reader.find("material")) own = materials_.read(*value, material);
    Part part;
    reader.read("name", part.name);
    part.object_from_part = object_from_part;
    part.location = entry.location();
    if (is_mesh(name)) {
        const auto mesh = read_ray_mesh(
            reader, context_, materials_,
            start_of_vertices(reader.block(), own, material, context_.family.dictionary));
        reader.finish(true);
        if (!mesh) return;
        part.what = *mesh;
    } else {
        for (const auto& [known_name, read] : kShapeObjects) {
            if (known_name == name) part.what = read(reader);
        }
        reader.finish();
    }
    part.material = materials_.use(own);
    context_.count_elements(1, part.location);
    context_.scene.objects.front().parts.push_back(std::move(part));
}

}  // namespace alhazen
