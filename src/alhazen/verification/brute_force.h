#pragma once
/// All hits of rays with all primitives of an aggregate and of its instances, from the tests of the
/// primitives alone: the reference that accelerators are compared with.
///
/// Conventions: hits, paths and order are those of Aggregate::all_hits. In tables with many
/// primitives a ray is tested with those whose boxes its line meets: a list of boxes in the order
/// of the file, each around 64 boxes of one primitive, tested in lanes (met_boxes.h). It shares no
/// code with an accelerator. Boxes of triangles are computed from their corners. Boxes of shapes
/// and CSG solids are trusted only in tables with more than `kMostPlain` of them; otherwise every
/// ray is tested.
/// Complexity: O(rays x primitives / 64) if neighbours in the file are neighbours in space,
/// otherwise a nanosecond per ray and primitive. Threads: all cores; const functions may be called
/// from many threads.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/verification/met_boxes.h"

namespace alhazen {

class BruteForce {
  public:
    /// `aggregate` must outlive the object; only its tables and CSG solids are used.
    explicit BruteForce(const Aggregate& aggregate);
    ~BruteForce();
    BruteForce(const BruteForce&) = delete;
    BruteForce& operator=(const BruteForce&) = delete;

    struct Shot {
        Ray ray;
        RayMask mask;
        std::vector<Hit>* hits;  ///< all hits of the ray are appended, sorted
    };
    void all_hits(std::span<const Shot> shots) const;
    /// Aggregate::shadowed for a ray whose hits are `all`.
    [[nodiscard]] bool shadowed(const Ray& ray, RayMask mask, std::span<const Hit> all,
                                std::vector<Hit>& crossings) const;

    /// Number of shapes and CSG solids that were tested only with rays that meet their boxes.
    [[nodiscard]] std::uint64_t believed_boxes() const { return believed_boxes_; }

    static constexpr std::size_t kMostPlain = 16384;

  private:
    struct Group;
    class Batch;

    const Group* group_of(const Aggregate& aggregate);
    void add_boxes(Group& group);
    static bool shadowed_in(const Group& group, const Ray& ray, RayMask mask,
                            std::span<const Hit> all, std::size_t level,
                            std::vector<Hit>& crossings);

    std::map<const Aggregate*, std::unique_ptr<Group>> groups_;
    std::uint64_t believed_boxes_ = 0;
    const Group* root_;  // built last
};

}  // namespace alhazen
