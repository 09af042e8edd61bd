#include "alhazen/accel/directions/coherence_lists.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

/// A cell of directions as its bounding cone.
struct DirectionCone {
    Vec3 axis;  ///< unit
    double cosine = 1, sine = 0;

    DirectionCone(const DirectionCube& cube, std::size_t cell) {
        const auto n = static_cast<std::size_t>(cube.resolution());
        const int face = static_cast<int>(cell / (n * n));
        const auto corners =
            cube.corners(face, static_cast<int>(cell % n), static_cast<int>(cell / n % n));
        axis = normalize(corners[0] + corners[1] + corners[2] + corners[3]);
        for (const Vec3& c : corners) cosine = std::min(cosine, dot(axis, normalize(c)));
        sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    }
};

/// The given resolution, or, for 0, one with about two cells per primitive.
int resolution_for(std::size_t primitives, int given) {
    if (given > 0) return given;
    return static_cast<int>(
        std::clamp(std::sqrt(static_cast<double>(primitives) / 3.0), 4.0, 64.0));
}

bool touches(const BoundingSphere& sphere, double margin, const Box3& box) {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
        const double beside = std::max(
            0.0, std::max(box.lo[k] - sphere.center[k], sphere.center[k] - box.hi[k]) - margin);
        square += beside * beside;
    }
    return !(square > sphere.radius * sphere.radius);
}

}  // namespace

CoherenceLists::CoherenceLists(const BoundsSource& source, const std::vector<Vec3>& lights,
                               double margin, int resolution, std::size_t most_bytes)
    : primitives_(source.size()),
      margin_(margin),
      cube_(resolution_for(source.size(), resolution)),
      light_cube_(4 * cube_.resolution()),
      most_bytes_(most_bytes),
      origins_(source.size() + lights.size()) {
    Box3 all;
    for (std::size_t i = 0; i < source.size(); ++i) {
        spheres_.push_back(source.sphere(i));
        all.include(source.box(i));
    }
    for (const Vec3& light : lights) spheres_.push_back({light, 0});
    grid_ = CellGrid(all, static_cast<double>(source.size()), 256);
    sort_into_cells();
    used_ = spheres_.capacity() * sizeof(spheres_[0]) + origins_.size() * sizeof(origins_[0]) +
            (starts_.capacity() + entries_.capacity()) * sizeof(std::uint32_t);
}

void CoherenceLists::sort_into_cells() {
    std::vector<std::uint32_t> by_radius(primitives_);
    std::iota(by_radius.begin(), by_radius.end(), 0u);
    std::stable_sort(by_radius.begin(), by_radius.end(), [&](std::uint32_t a, std::uint32_t b) {
        return spheres_[a].radius < spheres_[b].radius;
    });
    std::vector<std::vector<std::uint32_t>> lists(grid_.size());
    for (const std::uint32_t i : by_radius) {
        interruption_point();
        const BoundingSphere& s = spheres_[i];
        const Vec3 half{s.radius, s.radius, s.radius};
        const auto [first, last] = grid_.range({s.center - half, s.center + half});
        for (int z = first[2]; z <= last[2]; ++z) {
            for (int y = first[1]; y <= last[1]; ++y) {
                for (int x = first[0]; x <= last[0]; ++x) {
                    if (touches(s, margin_, grid_.cell_box({x, y, z}))) {
                        lists[grid_.number({x, y, z})].push_back(i);
                    }
                }
            }
        }
    }
    starts_.push_back(0);
    for (const auto& list : lists) {
        entries_.insert(entries_.end(), list.begin(), list.end());
        starts_.push_back(static_cast<std::uint32_t>(entries_.size()));
    }
}

CoherenceLists::Origin CoherenceLists::origin_at(const Vec3& point) const {
    Origin found;
    if (!grid_.box.contains(point)) return found;
    const std::size_t cell =
        grid_.number({grid_.index(0, point.x), grid_.index(1, point.y), grid_.index(2, point.z)});
    for (std::uint32_t e = starts_[cell]; e < starts_[cell + 1]; ++e) {
        const BoundingSphere& s = spheres_[entries_[e]];
        ++found.tested;
        const double reach = s.radius + 0.5 * margin_;
        if (length_squared(point - s.center) <= reach * reach) {
            found.primitive = entries_[e];
            return found;
        }
    }
    return found;
}

template <class T>
T* CoherenceLists::made_at(std::atomic<T*>& place, std::size_t count,
                           std::vector<std::unique_ptr<T[]>>& made) const {
    T* known = place.load(std::memory_order_acquire);
    if (known != nullptr) return known;
    const std::lock_guard lock(making_);
    known = place.load(std::memory_order_relaxed);
    const std::size_t bytes = count * sizeof(T);
    if (known != nullptr || used_ + bytes > most_bytes_) return known;
    known = made.emplace_back(std::make_unique<T[]>(count)).get();
    used_ += bytes;
    place.store(known, std::memory_order_release);
    return known;
}

CoherenceLists::Slot* CoherenceLists::slot_of(std::uint32_t origin, std::size_t cell) const {
    constexpr std::size_t kCells = std::tuple_size_v<Block>;
    const std::size_t count = (cube_of(origin).size() + kCells - 1) / kCells;
    Blocks* blocks = made_at(origins_[origin], count, made_origins_);
    if (blocks == nullptr) return nullptr;
    Block* block = made_at(blocks[cell / kCells], 1, made_blocks_);
    return block == nullptr ? nullptr : &(*block)[cell % kCells];
}

const CoherenceLists::List* CoherenceLists::find(std::uint32_t origin,
                                                 const Vec3& direction) const {
    const std::size_t cell = cube_of(origin).cell_of(direction);
    Slot* slot = slot_of(origin, cell);
    if (slot == nullptr) return nullptr;
    const List* known = slot->load(std::memory_order_acquire);
    if (known != nullptr || full_) return known;
    auto made = std::make_unique<const List>(make(origin, cell));
    const std::lock_guard lock(making_);
    known = slot->load(std::memory_order_relaxed);
    const std::size_t bytes = sizeof(List) + made->capacity() * sizeof(Candidate);
    if (known != nullptr) return known;
    if (used_ + bytes > most_bytes_) {
        // Otherwise every ray of this cell would compute the list again.
        full_ = true;
        return nullptr;
    }
    used_ += bytes;
    known = made_lists_.emplace_back(std::move(made)).get();
    slot->store(known, std::memory_order_release);
    return known;
}

CoherenceLists::List CoherenceLists::make(std::uint32_t origin, std::size_t cell) const {
    const DirectionCone cone(cube_of(origin), cell);
    const BoundingSphere& from = spheres_[origin];
    List list;
    for (std::uint32_t i = 0; i < primitives_; ++i) {
        const Vec3 between = spheres_[i].center - from.center;
        const double distance = length(between);
        const double radii = from.radius + spheres_[i].radius + 2 * margin_;
        double begin = 0;
        if (distance > radii) {
            // The cosine of the sum of the angles of both cones, minus its rounding error.
            const double sine = radii / distance;
            const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
            const double least = cone.cosine * cosine - cone.sine * sine - 1e-12;
            if (dot(cone.axis, between) < least * distance) continue;
            begin = distance - radii;
        }
        list.push_back({begin, i});
    }
    std::stable_sort(list.begin(), list.end(),
                     [](const Candidate& a, const Candidate& b) { return a.begin < b.begin; });
    list.shrink_to_fit();
    return list;
}

}  // namespace alhazen
