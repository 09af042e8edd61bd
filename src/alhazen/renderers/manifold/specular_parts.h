#pragma once
/// The parts of a scene whose surfaces are mirrors or clear glass everywhere, at which specular
/// chains are sought.
///
/// Conventions: a part has one part_key: the surfaces of one material in a shape, a mesh, a solid
/// or an outermost instance. Excluded, and left to paths, are materials that vary over the surface
/// in normals, roughness or coverage, meshes with vertex materials, parts invisible to reflected
/// rays, and all parts beyond kMostParts.
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
    bool closed = true;  ///< points outside its box are outside the part
    /// If it is one sphere, or lies in one plane, and does not move: its chains are known.
    std::optional<BoundingSphere> sphere;
    std::optional<FlatPlace> flat;
};

class SpecularParts {
  public:
    explicit SpecularParts(const Scene& scene);

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    [[nodiscard]] std::size_t size() const { return parts_.size(); }
    [[nodiscard]] const SpecularPart& operator[](std::size_t i) const { return parts_[i]; }
    /// Null if there is none.
    [[nodiscard]] const SpecularPart* find(std::uint64_t key) const {
        const auto known = by_key_.find(key);
        return known == by_key_.end() ? nullptr : &parts_[known->second];
    }
    /// True if parts beyond kMostParts were excluded.
    [[nodiscard]] bool leaves_some_out() const { return leaves_some_out_; }

  private:
    struct Bends {
        bool reflects = false, refracts = false;
        [[nodiscard]] bool any() const { return reflects || refracts; }
    };
    /// The enclosing objects of a primitive.
    struct Owner {
        Affine world;
        std::optional<std::uint32_t> instance;  ///< index of the outermost
        bool moves = false;
        std::optional<Box3> solid;  ///< its box in world space, for primitives of a solid
    };
    [[nodiscard]] Bends bends_of(const Material& material) const;
    /// The material of a primitive, if it reflects or refracts and is visible to reflected rays.
    [[nodiscard]] std::optional<MaterialId> bending(const PrimitiveTable& table,
                                                    PrimitiveId id) const;
    [[nodiscard]] bool has_some(const Aggregate& aggregate);
    void expand(const Aggregate& aggregate, const Owner& owner);
    void add(const PrimitiveTable& table, PrimitiveId id, const Owner& owner);
    /// Sets the known shape of a part of one primitive.
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
