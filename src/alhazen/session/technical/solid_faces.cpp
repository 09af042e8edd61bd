#include "alhazen/session/technical/solid_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr std::size_t kMostLeaves = 400;
/// A point nearer to a face than this, relative to the size of the leaf, lies on it.
constexpr double kOnFace = 1e-7;
/// Cosine of the angle between normals below which faces meet smoothly.
constexpr double kSmooth = 0.9998;

SolidFace plane_face(const Vec3& at, const Vec3& normal) {
    SolidFace face;
    face.at = at;
    face.axis = normalize(normal);
    return face;
}

void add_frustum(const Vec3& base, const Vec3& top, double base_radius, double top_radius,
                 std::vector<SolidFace>& faces) {
    SolidFace side;
    side.kind = SolidFace::Kind::Side;
    side.at = base;
    side.height = length(top - base);
    side.axis = (top - base) / side.height;
    side.radius = base_radius;
    side.widening = (top_radius - base_radius) / side.height;
    faces.push_back(side);
    faces.push_back(plane_face(base, -side.axis));
    faces.push_back(plane_face(top, side.axis));
}

/// The box of both rims.
Box3 frustum_box(const Vec3& base, const Vec3& top, double base_radius, double top_radius) {
    const Vec3 axis = normalize(top - base);
    Box3 box;
    for (const auto& [center, radius] :
         {std::pair{base, base_radius}, std::pair{top, top_radius}}) {
        Vec3 reach;
        for (int k = 0; k < 3; ++k)
            reach[k] = radius * std::sqrt(std::max(0.0, 1.0 - axis[k] * axis[k]));
        box.include(center - reach);
        box.include(center + reach);
    }
    return box;
}

/// Adds the faces of a shape and sets its box in leaf space; false for unsupported shapes.
bool add_faces(const AnyShape& shape, std::vector<SolidFace>& faces, Box3& box) {
    if (const auto* s = std::get_if<Sphere>(&shape)) {
        SolidFace face;
        face.kind = SolidFace::Kind::Sphere;
        face.at = s->center;
        face.radius = s->radius;
        faces.push_back(face);
        box = s->box();
    } else if (const auto* c = std::get_if<Cylinder>(&shape)) {
        add_frustum(c->base, c->top, c->radius, c->radius, faces);
        box = frustum_box(c->base, c->top, c->radius, c->radius);
    } else if (const auto* k = std::get_if<Cone>(&shape)) {
        add_frustum(k->base, k->top, k->base_radius, k->top_radius, faces);
        box = frustum_box(k->base, k->top, k->base_radius, k->top_radius);
    } else if (const auto* b = std::get_if<BoxShape>(&shape)) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 normal;
            normal[axis] = 1.0;
            faces.push_back(plane_face(b->hi, normal));
            faces.push_back(plane_face(b->lo, -normal));
        }
        box = {b->lo, b->hi};
    } else {
        return false;
    }
    return true;
}

}  // namespace

double SolidFace::value(const Vec3& p) const {
    const Vec3 d = p - at;
    if (kind == Kind::Plane) return dot(d, axis);
    if (kind == Kind::Sphere) return length(d) - radius;
    const double z = dot(d, axis);
    return length(d - z * axis) - (radius + widening * z);
}

Vec3 SolidFace::gradient(const Vec3& p) const {
    if (kind == Kind::Plane) return axis;
    const Vec3 d = p - at;
    if (kind == Kind::Sphere) return unit_or(d, {0, 0, 1});
    return unit_or(d - dot(d, axis) * axis, perpendicular(axis)) - widening * axis;
}

std::optional<FacedSolid> FacedSolid::of(const SceneDescription& description, std::size_t object,
                                         const Affine& world) {
    FacedSolid solid;
    if (!solid.add_object(description, object, world, solid.root_)) return std::nullopt;
    return solid;
}

std::optional<FacedSolid> FacedSolid::of(const SceneDescription& description,
                                         std::span<const Part> parts) {
    FacedSolid solid;
    if (!solid.add_parts(description, Combine::Union, parts, {}, solid.root_)) return std::nullopt;
    return solid;
}

Box3 FacedSolid::box() const {
    Box3 box;
    for (const SolidLeaf& leaf : leaves_) box.include(leaf.box);
    return box;
}

bool FacedSolid::add_object(const SceneDescription& d, std::size_t object, const Affine& world,
                            std::uint32_t& node) {
    const ObjectDescription& o = d.objects[object];
    return add_parts(d, o.combine, o.parts, world, node);
}

bool FacedSolid::add_parts(const SceneDescription& d, Combine combine, std::span<const Part> parts,
                           const Affine& world, std::uint32_t& node) {
    node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    // A group is the union of its parts.
    nodes_[node].combine = combine == Combine::Group ? Combine::Union : combine;
    for (const Part& part : parts) {
        const Affine placed = world * part.object_from_part;
        std::uint32_t child = 0;
        if (const auto* inner = std::get_if<ObjectIndex>(&part.what)) {
            if (!add_object(d, static_cast<std::size_t>(*inner), placed, child)) return false;
        } else {
            const auto* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr || part.motion != nullptr || !add_leaf(*shape, placed)) {
                return false;
            }
            child = static_cast<std::uint32_t>(nodes_.size());
            nodes_.emplace_back();
            nodes_[child].leaf = static_cast<std::int32_t>(leaves_.size()) - 1;
        }
        nodes_[node].children.push_back(child);
    }
    return true;
}

bool FacedSolid::add_leaf(const AnyShape& shape, const Affine& world) {
    if (leaves_.size() == kMostLeaves) return false;
    SolidLeaf leaf;
    leaf.world = world;
    leaf.inverse = inverse(world);
    leaf.first = static_cast<std::uint32_t>(faces_.size());
    Box3 box;
    if (!add_faces(shape, faces_, box)) return false;
    leaf.end = static_cast<std::uint32_t>(faces_.size());
    for (std::uint32_t f = leaf.first; f < leaf.end; ++f) {
        faces_[f].leaf = static_cast<std::uint32_t>(leaves_.size());
    }
    leaf.size = length(box.size());
    for (int k = 0; k < 8; ++k) leaf.box.include(world.point(box.corner(k)));
    leaves_.push_back(leaf);
    return true;
}

bool FacedSolid::inside(std::uint32_t node, const Flags& in_leaf) const {
    const Node& n = nodes_[node];
    if (n.leaf >= 0) return in_leaf[static_cast<std::size_t>(n.leaf)] != 0;
    for (std::size_t k = 0; k < n.children.size(); ++k) {
        const bool in = inside(n.children[k], in_leaf);
        if (n.combine == Combine::Union && in) return true;
        if (n.combine == Combine::Intersection && !in) return false;
        if (n.combine == Combine::Difference && in == (k > 0)) return false;
    }
    return n.combine != Combine::Union && !n.children.empty();
}

Vec3 FacedSolid::normal(const SolidFace& face, const Vec3& p) const {
    const SolidLeaf& l = leaves_[face.leaf];
    return unit_or(transpose_times(l.inverse.linear, face.gradient(l.inverse.point(p))), {});
}

SolidWheel FacedSolid::wheel(const Vec3& p, const Vec3& tangent, const SolidFace& face) const {
    return wheel_around(p, unit_or(tangent, {}), normal(face, p));
}

SolidWheel FacedSolid::wheel(const Vec3& p, const Vec3& tangent) const {
    const Vec3 along = unit_or(tangent, {1, 0, 0});
    return wheel_around(p, along, normalize(perpendicular(along)));
}

SolidWheel FacedSolid::wheel_around(const Vec3& p, const Vec3& along, const Vec3& x) const {
    const Vec3 y = cross(along, x);
    Flags in_leaf(leaves_.size(), 1);
    struct Touching {
        std::uint32_t leaf;
        Vec3 normal;
    };
    std::vector<Touching> touching;
    std::vector<double> angles;
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
        const Vec3 local = leaves_[l].inverse.point(p);
        const std::size_t before = touching.size();
        for (std::uint32_t f = leaves_[l].first; f < leaves_[l].end && in_leaf[l] != 0; ++f) {
            const double value = faces_[f].value(local);
            if (std::abs(value) > kOnFace * leaves_[l].size) {
                in_leaf[l] = value < 0.0;
                continue;
            }
            const Vec3 n = normal(faces_[f], p);
            touching.push_back({l, n});
        }
        if (in_leaf[l] == 0) touching.resize(before);
    }
    for (const Touching& t : touching) {
        const double angle = std::atan2(dot(t.normal, y), dot(t.normal, x));
        for (const double a : {angle + 0.5 * kPi, angle - 0.5 * kPi}) {
            angles.push_back(a - 2 * kPi * std::floor(a / (2 * kPi)));
        }
    }
    std::sort(angles.begin(), angles.end());
    constexpr double kSame = 1e-5;
    angles.erase(
        std::unique(angles.begin(), angles.end(), [](double a, double b) { return b - a < kSame; }),
        angles.end());
    if (angles.size() > 1 && angles.front() + 2 * kPi - angles.back() < kSame) angles.pop_back();
    SolidWheel wheel;
    if (angles.size() < 2) return wheel;
    // True for each boundary whose following sector is solid.
    Flags solid, in = in_leaf;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        const double next = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2 * kPi;
        const double middle = 0.5 * (angles[k] + next);
        const Vec3 towards = std::cos(middle) * x + std::sin(middle) * y;
        for (const Touching& t : touching) in[t.leaf] = in_leaf[t.leaf];
        for (const Touching& t : touching) {
            in[t.leaf] = in[t.leaf] != 0 && dot(t.normal, towards) < 0.0;
        }
        solid.push_back(inside(root_, in));
    }
    std::vector<Vec3> out;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        const bool before = solid[k == 0 ? angles.size() - 1 : k - 1] != 0;
        if (before == (solid[k] != 0)) continue;
        const double turned = angles[k] + (before ? 0.5 : -0.5) * kPi;
        out.push_back(std::cos(turned) * x + std::sin(turned) * y);
    }
    if (out.size() < 2) return wheel;
    wheel.surface = true;
    wheel.edge = out.size() > 2 || dot(out[0], out[1]) < kSmooth;
    wheel.out = out[0];
    wheel.other_out = out[1];
    return wheel;
}

}  // namespace alhazen
