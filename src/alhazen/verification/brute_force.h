#pragma once
/// All hits of rays with all primitives of an aggregate and of those that it places, by the tests
/// of the primitives alone: the truth that accelerators are compared with.
///
/// Conventions: hits, paths and order are those of Aggregate::all_hits. Where a table has many
/// primitives a ray is tested with those whose boxes its line meets: a plain list of boxes in the
/// order of the file, each around 64 boxes of one primitive, tested in lanes (met_boxes.h). No part
/// of this is shared with an accelerator. Boxes of triangles are taken from their corners. Boxes of
/// shapes, and of solids of CSG, are believed only in tables with more than `kMostPlain` of them;
/// others are tested with every ray.
/// Complexity: O(rays x primitives / 64) where neighbours in the file are neighbours in space; a
/// nanosecond for each ray and primitive where they are not. Threads: all cores; const functions
/// may be called from many threads.

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
    /// `aggregate` must outlive the object; only its tables are asked, and its CSG solids.
    explicit BruteForce(const Aggregate& aggregate);
    ~BruteForce();
    BruteForce(const BruteForce&) = delete;
    BruteForce& operator=(const BruteForce&) = delete;

    struct Shot {
        Ray ray;
        RayMask mask;
        std::vector<Hit>* hits;  ///< all of the ray are appended, sorted
    };
    void all_hits(std::span<const Shot> shots) const;
    /// As Aggregate::shadowed, for a ray with these hits.
    [[nodiscard]] bool shadowed(const Ray& ray, RayMask mask, std::span<const Hit> all,
                                std::vector<Hit>& crossings) const;

    /// Shapes and CSG solids that were tested with the rays that meet their boxes only.
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
    const Group* root_;  // made last
};

}  // namespace alhazen
