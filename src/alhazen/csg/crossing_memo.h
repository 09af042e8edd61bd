#pragma once
/// A cache of the crossings of recent lines with leaves of solids of several media. Most hits of
/// such a solid query it twice: for the hit, and for the media on both sides of it.
///
/// Conventions: a table of fixed size, whose entries lines evict. Cached crossings are
/// bit-identical to those of a new test. Threads: each thread has its own cache.

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class CrossingMemo {
  public:
    [[nodiscard]] static CrossingMemo& of_thread() {
        thread_local CrossingMemo memo;
        return memo;
    }
    /// A number that is unique in the process.
    [[nodiscard]] static std::uint64_t number_of_solid();

    struct Key {
        std::uint64_t solid;
        std::uint64_t leaf;
        std::array<std::uint64_t, 6> line;  ///< bits of origin and direction

        Key(std::uint64_t of_solid, std::uint32_t of_leaf, const Ray& ray)
            : solid(of_solid), leaf(of_leaf), line{bits(ray.origin.x),    bits(ray.origin.y),
                                                   bits(ray.origin.z),    bits(ray.direction.x),
                                                   bits(ray.direction.y), bits(ray.direction.z)} {}
        friend bool operator==(const Key&, const Key&) = default;

      private:
        static std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }
    };

    /// Cached crossings of a line; valid until the next call.
    struct Found {
        bool known = false;
        std::span<const ShapeHit> hits;
    };
    [[nodiscard]] Found find(const Key& key) const {
        if (places_.empty()) return {};
        const Place& place = places_[index(key)];
        if (place.key != key) return {};
        return {true, std::span(place.hits).first(place.count)};
    }
    /// Stores the crossings unless there are too many.
    void keep(const Key& key, std::span<const ShapeHit> hits);

  private:
    static constexpr std::size_t kPlaces = 2048, kMostHits = 8;
    struct Place {
        Key key{0, 0, {}};  // no solid: numbers start at 1
        std::size_t count = 0;
        std::array<ShapeHit, kMostHits> hits;
    };

    [[nodiscard]] static std::size_t index(const Key& key) {
        constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15u;  // 2^64 over the golden ratio
        std::uint64_t mixed = key.solid ^ (key.leaf << 32);
        for (const std::uint64_t word : key.line) mixed = (std::rotl(mixed, 23) ^ word) * kOdd;
        return static_cast<std::size_t>(mixed >> 32) % kPlaces;
    }

    std::vector<Place> places_;  ///< empty until the first crossings are stored
};

}  // namespace alhazen
