#pragma once
/// The parts of a scene whose surfaces are mirrors or clear glass everywhere: those at which
/// chains are sought.
///
/// Conventions: a part is what has one part_key: the surfaces of one material in a shape, a mesh, a
/// solid or an outermost instance. Left out, so that their chains are
/// left to paths: materials that vary over the surface in their normals, roughness or coverage,
/// meshes whose vertices have materials, parts that reflected rays do not see, and all beyond
/// kMostParts.
/// Complexity: O(primitives of the objects that have such parts, instances expanded).

#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/box.h"
#include "alhazen/renderers/manifold/specular_chain.h"

namespace alhazen {

inline constexpr std::size_t kMostSpecularParts = 4096;

struct FlatPlace {
    Vec3 point, normal;  ///< unit
};

struct SpecularPart {
    std::uint64_t key = 0;
    bool reflects = false, refracts = false;
    Box3 box;  ///< in world space; may be unbounded
    BoundingSphere around;
    bool bounded = true;
    bool closed = true;  ///< what is outside of its box is outside of it
    /// It is one sphere, or lies in one plane, and rests: its chains are known.
    std::optional<BoundingSphere> sphere;
    std::optional<FlatPlace> flat;
};

class SpecularParts {
  public:
    explicit SpecularParts(const Scene& scene);

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    [[nodiscard]] std::size_t size() const { return parts_.size(); }
    [[nodiscard]] const SpecularPart& operator[](std::size_t i) const { return parts_[i]; }
    /// Null: it is none.
    [[nodiscard]] const SpecularPart* find(std::uint64_t key) const {
        const auto known = by_key_.find(key);
        return known == by_key_.end() ? nullptr : &parts_[known->second];
    }
    /// Some are left out, for there are too many.
    [[nodiscard]] bool leaves_some_out() const { return leaves_some_out_; }

  private:
    struct Bends {
        bool reflects = false, refracts = false;
        [[nodiscard]] bool any() const { return reflects || refracts; }
    };
    /// What is around a primitive.
    struct Owner {
        Affine world;
        std::optional<std::uint32_t> instance;  ///< number of the outermost
        bool moves = false;
        std::optional<Box3> solid;  ///< its box in world space, inside of a solid
    };
    [[nodiscard]] Bends bends_of(const Material& material) const;
    /// The material of a primitive, where it bends light and reflected rays see it.
    [[nodiscard]] std::optional<MaterialId> bending(const PrimitiveTable& table,
                                                    PrimitiveId id) const;
    [[nodiscard]] bool has_some(const Aggregate& aggregate);
    void expand(const Aggregate& aggregate, const Owner& owner);
    void add(const PrimitiveTable& table, PrimitiveId id, const Owner& owner);
    /// Sets what is known of a part of one primitive.
    void set_form(const PrimitiveTable& table, PrimitiveId id, const Owner& owner,
                  SpecularPart& part) const;

    const Scene& scene_;
    std::vector<Bends> materials_;
    std::map<const Aggregate*, bool> has_some_;
    std::vector<SpecularPart> parts_;
    std::unordered_map<std::uint64_t, std::size_t> by_key_;
    bool leaves_some_out_ = false;
};

}  // namespace alhazen
