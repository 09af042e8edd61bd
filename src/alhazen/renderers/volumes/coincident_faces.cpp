#include "alhazen/renderers/volumes/coincident_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/scene/nearby_parts.h"

namespace alhazen {

namespace {

/// The `number`-th direction in which ends of volumes are searched for, if a ray crosses a surface
/// along `direction`: straight on, then nearly along the surface.
Vec3 outward(const ShadingPoint& point, const Vec3& direction, std::size_t number) {
    if (number == 0) return direction;
    constexpr double kInward = 0.1;
    const Vec3& n = point.geometric;
    const Vec3 outward = dot(direction, n) > 0.0 ? n : -n;
    const Vec3 u = perpendicular(outward), v = cross(outward, u);
    // 0.8 and 0.6, in steps of a right angle: unlikely to be along an edge of the model.
    const Vec3 x = 0.8 * u + 0.6 * v, y = 0.8 * v - 0.6 * u;
    const Vec3 along = number == 1 ? x : number == 2 ? -x : number == 3 ? y : -y;
    return normalize(along + kInward * outward);
}

bool has_inside(const Scene& scene, MaterialId id) {
    return has_inside(scene.materials[static_cast<std::size_t>(id)]);
}

/// True if nothing below the reflection of a metallic-roughness material is left.
bool is_metal(const Material& m) {
    if (m.alpha_mode != AlphaMode::Opaque || m.conductor || m.dielectric) return false;
    if (!m.metallic_roughness) return false;
    const ScalarInput& metallic = m.metallic_roughness->metallic;
    return metallic.texture == kNoTexture && metallic.value >= 1.0;
}

/// The medium of the outermost solid of constructive geometry around a hit: CsgSolid::only_medium;
/// kNoMedium: it is of no solid.
std::uint32_t medium_of_solid(const Scene& scene, const Hit& hit) {
    if (scene.census.solids == 0) return CsgSolid::kNoMedium;
    const Aggregate* around = scene.aggregate.get();
    for (std::size_t level = hit.path.size();; --level) {
        if (around->completes_surfaces()) {
            if (const auto* solid = dynamic_cast<const CsgAggregate*>(around)) {
                return solid->solid().only_medium();
            }
        }
        if (level == 0) return CsgSolid::kNoMedium;
        const PrimitiveTable& table = around->primitives();
        around = table.instances[table.index(hit.path[level - 1])].aggregate.get();
    }
}

}  // namespace

CoincidentFaces::CoincidentFaces(const Scene& scene) : scene_(scene) {
    if (std::none_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
            return has_inside(m) || (is_sheet(m) && is_clear(m));
        })) {
        return;
    }
    std::vector<Kind> kinds;
    for (const Material& m : scene.materials) {
        kinds.push_back(may_bound_volume(m)            ? Kind::BoundsVolume
                        : m.is_opaque() || is_metal(m) ? Kind::Opaque
                                                       : Kind::Neither);
    }
    kinds_ = std::make_shared<const std::vector<Kind>>(std::move(kinds));
}

void CoincidentFaces::clear() {
    others_.clear();
    opaque_.reset();
    instead_.reset();
    sheets_.clear();
    sheet_parts_.clear();
}

void CoincidentFaces::find(const ShadingPoint& point, const Vec3& direction, const Arrival& arrival,
                           RayMask mask) {
    clear();
    if (!kinds_ || point.material->coverage < 1.0) return;
    const Surface& surface = point.surface;
    const Kind kind = (*kinds_)[static_cast<std::size_t>(surface.materials[0])];
    const bool is_sheet = point.material->thin;
    if (is_sheet ? kind == Kind::Opaque || surface.media.known : kind != Kind::BoundsVolume) return;
    ray_ = CoincidentSurfaces::around(surface, direction);
    // Faces before the start of the ray have been crossed.
    const double away = CoincidentSurfaces::reach(surface, direction);
    ray_.t_min = std::max(0.0, away - std::max(0.0, point.way));
    find_hits(surface, arrival, mask);
    const HitParts own{surface.part, surface.instance};
    const std::uint64_t number = volume_number(surface);
    for (const Hit& hit : hits_) {
        if (parts_of(*scene_.aggregate, hit) == own) continue;
        look_at(hit, is_sheet ? nullptr : &number, arrival);
    }
    if (opaque_) {
        others_.clear();
        instead_.reset();
    } else if (!others_.empty()) {
        const Medium inside = volume_of(scene_, point);
        const bool enters = !is_sheet && enters_volume(point);
        sort_entered(point, enters ? &inside : nullptr, direction, arrival, mask);
    }
}

void CoincidentFaces::find_next_to_sheets(const ShadingPoint& point, const Vec3& direction,
                                          const Arrival& arrival, RayMask mask) {
    if (!point.material->thin) return find(point, direction, arrival, mask);
    clear();
}

bool CoincidentFaces::may_bound(const Hit& hit) const {
    if (!kinds_) return false;
    const std::uint32_t medium = medium_of_solid(scene_, hit);
    if (medium == CsgSolid::kOpaque) return false;
    if (medium < CsgSolid::kMixture) return has_inside(scene_, MaterialId{medium});
    const std::optional<MaterialId> material = plain_material(*scene_.aggregate, hit);
    return !material || has_inside(scene_, *material);
}

std::optional<Medium> CoincidentFaces::volume_behind(const Hit& hit,
                                                     const ShadingPoint& point) const {
    if (!kinds_) return std::nullopt;
    const Surface& surface = point.surface;
    if (surface.media.known) return volume_of(scene_, point);
    const std::uint32_t medium = medium_of_solid(scene_, hit);
    if (medium == CsgSolid::kOpaque) return std::nullopt;
    const auto bounds_by = [&](int i) {
        return !point.material->thin &&
               has_inside(scene_, surface.materials[static_cast<std::size_t>(i)]);
    };
    if (medium < CsgSolid::kMixture) {
        const MaterialId id{medium};
        if (!has_inside(scene_, id)) return std::nullopt;
        if (bounds_by(0)) return volume_of(scene_, point);
        const MaterialSample inside = medium_at(scene_, surface, id);
        if (inside.thin) return std::nullopt;
        return Medium{volume_number(surface), inside.index, inside.absorption, medium,
                      point.seen_by};
    }
    for (int i = 0; i < surface.material_count; ++i) {
        if (bounds_by(i)) return volume_of(scene_, point);
    }
    return std::nullopt;
}

void CoincidentFaces::sort(OtherFaces& faces, const ShadingPoint& point, const Vec3& direction,
                           const Arrival& arrival) {
    std::swap(others_, faces);
    sort_entered(point, nullptr, direction, arrival, kAllRays);
    std::swap(others_, faces);
    clear();
}

void CoincidentFaces::find_hits(const Surface& surface, const Arrival& arrival, RayMask mask) {
    hits_.clear();
    const NearbyParts* near = scene_.nearby_parts.get();
    const double reach = 0.5 * ray_.t_max;
    if (near == nullptr || near->may_touch(surface, reach)) {
        scene_.aggregate->all_hits(ray_, hits_, {nullptr, mask, arrival.time});
        return;
    }
    for (const NearbyParts::Unbounded& one : near->unbounded()) {
        if (!one.may_touch(surface.point, reach)) continue;
        scene_.aggregate->primitives().all_hits(one.id, ray_, kUnusedShear, hits_, NoStats{}, mask);
    }
    if (hits_.size() > 1) sort_appended(hits_, 0);
}

void CoincidentFaces::look_at(const Hit& hit, const std::uint64_t* own, const Arrival& arrival) {
    set_shading_point(scene_, ray_, hit, arrival, {}, other_);
    if (other_.material->coverage < 1.0 || is_hit_from_behind(other_)) return;
    const auto material = static_cast<std::size_t>(other_.surface.materials[0]);
    if (other_.material->thin && (*kinds_)[material] != Kind::Opaque) {
        if (other_.surface.media.known) return;
        if (own != nullptr && !instead_) instead_ = hit;
        const HitParts parts{other_.surface.part, other_.surface.instance};
        if (std::find(sheet_parts_.begin(), sheet_parts_.end(), parts) != sheet_parts_.end())
            return;
        sheet_parts_.push_back(parts);
        sheets_.push_back(hit);
        return;
    }
    const bool known = other_.surface.media.known;
    if (known) {
        // Rays hit a wall twice.
        const std::uint64_t number = volume_number(other_.surface);
        const auto is_same = [&](const OtherFace& face) { return face.inside.part == number; };
        if ((own != nullptr && number == *own) ||
            std::any_of(others_.begin(), others_.end(), is_same))
            return;
    }
    if ((*kinds_)[material] == Kind::Opaque) {
        if (!opaque_) opaque_ = hit;
    } else if ((*kinds_)[material] == Kind::BoundsVolume) {
        if (own == nullptr && !instead_) instead_ = hit;
        const Box3 box = scene_.aggregate->primitives().box(static_cast<std::size_t>(hit.top()));
        const MaterialSample& sample = *other_.material;
        const bool tints = own == nullptr && others_.empty();
        // A physical sample is turned to the view from air.
        const Rgb kt = tints && sample.physical
                           ? material_at(scene_, other_.surface, {}, {other_.surface.point, {}, {}})
                                 .transmissive
                           : sample.transmissive;
        others_.push_back({.inside = volume_of(scene_, other_),
                           .entering = enters_volume(other_),
                           .wall = is_wall(other_.surface),
                           .endless = !box.bounded(),
                           .known = known,
                           .physical = sample.physical,
                           .tints = tints,
                           .kt = kt});
    }
}

void CoincidentFaces::sort_entered(const ShadingPoint& point, const Medium* own,
                                   const Vec3& direction, const Arrival& arrival, RayMask mask) {
    entered_.clear();
    if (own != nullptr) entered_.push_back({{}, others_.size()});
    for (std::size_t i = 0; i < others_.size(); ++i) {
        if (others_[i].entering) entered_.push_back({{}, i});
    }
    if (entered_.size() < 2) return;
    const auto same = [](const Entered& a, const Entered& b) { return a.left == b.left; };
    const auto outer = [](const Entered& a, const Entered& b) { return a.left > b.left; };
    for (std::size_t k = 0; k < entered_[0].left.size(); ++k) {
        follow(leaving_ray(point.surface, outward(point, direction, k)), k, own, arrival, mask);
        std::stable_sort(entered_.begin(), entered_.end(), outer);
        if (std::adjacent_find(entered_.begin(), entered_.end(), same) == entered_.end()) break;
    }
    sorted_.clear();
    bool around = own != nullptr;
    for (const Entered& e : entered_) {
        if (e.other == others_.size()) {
            around = false;
            continue;
        }
        sorted_.push_back(others_[e.other]);
        sorted_.back().around = around;
    }
    for (const OtherFace& other : others_) {
        if (!other.entering) sorted_.push_back(other);
    }
    std::swap(others_, sorted_);
}

void CoincidentFaces::follow(const Ray& ray, std::size_t number, const Medium* own,
                             const Arrival& arrival, RayMask mask) {
    within_.clear();
    for (std::size_t i = 0; i < entered_.size(); ++i) {
        Entered& e = entered_[i];
        e.left[number] = std::numeric_limits<double>::infinity();
        const Medium& inside = e.other < others_.size() ? others_[e.other].inside : *own;
        within_.push_back({inside.part, inside.material, i});
    }
    hits_.clear();
    scene_.aggregate->all_hits(ray, hits_, {nullptr, mask, arrival.time});
    std::size_t missing = entered_.size();
    double last = 0.0;
    for (const Hit& hit : hits_) {
        if (missing == 0) return;
        if (!may_bound(hit)) continue;
        set_shading_point(scene_, ray, hit, arrival, {}, other_);
        const std::optional<Medium> behind = volume_behind(hit, other_);
        if (!behind || is_wall(other_.surface)) continue;
        const Medium& volume = *behind;
        if (enters_volume(other_)) {
            within_.push_back({volume.part, volume.material, entered_.size()});
            continue;
        }
        // As in MediumStack::leave.
        auto left = std::find_if(within_.rbegin(), within_.rend(),
                                 [&](const Within& w) { return w.part == volume.part; });
        if (left == within_.rend()) {
            left = std::find_if(within_.rbegin(), within_.rend(),
                                [&](const Within& w) { return w.material == volume.material; });
        }
        if (left == within_.rend()) continue;
        if (left->entered < entered_.size()) {
            // Faces that coincide are left together.
            if (hit.t - last > 2.0 * CoincidentSurfaces::reach(other_.surface, ray.direction))
                last = hit.t;
            entered_[left->entered].left[number] = last;
            --missing;
        }
        within_.erase(std::next(left).base());
    }
}

}  // namespace alhazen
