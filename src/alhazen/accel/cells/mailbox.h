#pragma once
/// Records the primitives that a ray was tested against, so that a primitive in many cells is
/// tested once.
///
/// Source: Arnaldi, Priol and Bouatouch, "A New Space Subdivision Method for Ray Tracing CSG
/// Modelled Scenes", The Visual Computer 3, 1987; Amanatides and Woo, "A Fast Voxel Traversal
/// Algorithm for Ray Tracing", Eurographics 1987 (ray ids in the primitives).
/// Differs: a small hash table per thread instead of an id in every primitive: threads do not share
/// it, and a nested traversal only reduces the savings. A primitive whose entry was overwritten is
/// tested again.

#include <array>
#include <cstdint>
#include <span>

namespace alhazen {

class Mailbox {
  public:
    /// A mailbox for one ray.
    Mailbox() : ray_(++table().last_ray) {}

    /// True if the primitive is not recorded yet; records it.
    [[nodiscard]] bool is_new(std::uint32_t primitive) {
        Entry& entry = table().entries[(primitive * 0x9E3779B1u) >> (32 - kBits)];
        if (entry.ray == ray_ && entry.primitive == primitive) return false;
        entry = {ray_, primitive};
        return true;
    }

  private:
    static constexpr int kBits = 8;
    struct Entry {
        std::uint64_t ray = 0;
        std::uint32_t primitive = 0;
    };
    struct Table {
        std::uint64_t last_ray = 0;
        std::array<Entry, 1u << kBits> entries{};
    };
    static Table& table() {
        static thread_local Table table;
        return table;
    }

    std::uint64_t ray_;
};

/// Tests the primitives of a cell; returns true if the visitor stops. Without `remembers` the
/// mailbox is not used.
template <class Visitor, class Stats>
bool visit_entries(std::span<const std::uint32_t> entries, bool remembers, Mailbox& mailbox,
                   Visitor& visitor, Stats stats) {
    if (entries.empty()) stats.empty_cells(1);
    for (const std::uint32_t primitive : entries) {
        if (remembers && !mailbox.is_new(primitive)) {
            stats.mailbox_saved(1);
            continue;
        }
        if (visitor.visit(primitive)) return true;
    }
    return false;
}

}  // namespace alhazen
