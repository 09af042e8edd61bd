#pragma once
/// Faces of other parts that coincide with the boundary of a volume: a liquid in its glass, two
/// clouds that touch, a block of glass on its table.
///
/// Conventions: a ray hits one of the faces, that of the lowest primitive, and rays that leave it
/// begin beyond all of them; so the faces are treated as one surface. If one is opaque, it is the
/// surface hit. Else all are crossed together: one boundary between the volumes before and behind,
/// with the BSDF of the face that was hit. Of volumes entered together the one that is left last is
/// outermost, independent of the order of the parts; if no ray distinguishes them, the one of the
/// lowest primitive. A solid of several media is one volume; a face of it may be a wall between two
/// of them. Partly covering faces are ignored.
/// A thin sheet is met where the boundary at its place does not refract, which is crossed with it;
/// a boundary that refracts is met below a smooth sheet, and of others and the boundary the one
/// that was hit is met alone. Other sheets, and an opaque face below a sheet, are told; opaque
/// faces that are hit first are met alone.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/volumes/medium_stack.h"

namespace alhazen {

/// A face that is crossed together with the one that was hit.
struct OtherFace {
    Medium inside;  ///< of the volume that it bounds
    bool entering = true;
    bool wall = false;      ///< of a solid of several media; `inside` is behind it
    bool around = false;    ///< its volume surrounds that of the face that was hit
    bool endless = false;   ///< its primitive is unbounded
    bool known = false;     ///< its volume is a solid of several media
    bool physical = false;  ///< its material (MaterialSample::physical)
    bool tints = false;     ///< it is the one that rays hit first behind a thin sheet
    Rgb kt;                 ///< of its material
};
/// Faces that are entered come first, the outermost volume first.
using OtherFaces = std::vector<OtherFace>;

/// The faces at one place of a ray that have been crossed together. Sheets and open surfaces among
/// them, which are crossed by themselves, are left out.
class CrossedFaces {
  public:
    /// For the start of a ray.
    void clear() {
        volumes_.clear();
        end_ = 0.0;
    }
    /// True if the face of that volume (volume_number) at the distance was crossed with another.
    [[nodiscard]] bool has(std::uint64_t volume, double t) const {
        return t <= end_ && std::find(volumes_.begin(), volumes_.end(), volume) != volumes_.end();
    }
    [[nodiscard]] bool may_have(double t) const { return t <= end_ && !volumes_.empty(); }
    /// Adds the faces that are crossed with a surface at the distance `t`, of reach `reach`
    /// (CoincidentSurfaces).
    void add(const OtherFaces& others, double t, double reach) {
        if (t > end_) volumes_.clear();
        for (const OtherFace& other : others) volumes_.push_back(other.inside.part);
        end_ = std::max(end_, t + 2.0 * reach);
    }
    /// Adds the second crossing of the wall of a solid that was added last.
    void add_wall(std::uint64_t volume) { volumes_.push_back(volume); }

  private:
    std::vector<std::uint64_t> volumes_;
    double end_ = 0.0;  ///< distance
};

class CoincidentFaces {
  public:
    explicit CoincidentFaces(const Scene& scene);
    /// Shares the data of the scene; the results of `find` are not copied.
    CoincidentFaces(const CoincidentFaces& known) : scene_(known.scene_), kinds_(known.kinds_) {}
    CoincidentFaces& operator=(const CoincidentFaces&) = delete;
    ~CoincidentFaces() = default;

    /// Finds the faces at the point where a ray along `direction` hit a surface, none before the
    /// start of that ray (ShadingPoint::way).
    void find(const ShadingPoint& point, const Vec3& direction, const Arrival& arrival,
              RayMask mask);
    /// As `find`, for rays that meet all surfaces at a place one by one: none at a thin sheet.
    void find_next_to_sheets(const ShadingPoint& point, const Vec3& direction,
                             const Arrival& arrival, RayMask mask);
    /// The faces that are crossed with the surface.
    [[nodiscard]] const OtherFaces& others() const { return others_; }
    /// The hit of an opaque face along `ray()`; none: the surface itself is hit. At a thin sheet:
    /// of the face below it.
    [[nodiscard]] const std::optional<Hit>& opaque() const { return opaque_; }
    /// Hits along `ray()` of other thin sheets, one of each part.
    [[nodiscard]] const std::vector<Hit>& sheets() const { return sheets_; }
    /// A hit along `ray()` that may be met instead of the surface: of a thin sheet at a face that
    /// bounds a volume, of such a face at a thin sheet.
    [[nodiscard]] const std::optional<Hit>& instead() const { return instead_; }
    /// The ray along which the faces were found.
    [[nodiscard]] const Ray& ray() const { return ray_; }

    /// False if the surface at a hit is known to bound no volume.
    [[nodiscard]] bool may_bound(const Hit& hit) const;
    /// The volume that a surface bounds, whether light enters it there or not: behind an opaque
    /// wall of a solid lies the medium of that solid. `point`: of the hit.
    [[nodiscard]] std::optional<Medium> volume_behind(const Hit& hit,
                                                      const ShadingPoint& point) const;
    /// Sorts faces at the surface of `point`: those that are entered first, the outermost volume
    /// first. Forgets what was found.
    void sort(OtherFaces& faces, const ShadingPoint& point, const Vec3& direction,
              const Arrival& arrival);

  private:
    enum class Kind : std::uint8_t { BoundsVolume, Opaque, Neither };

    /// One of the volumes that are entered together.
    struct Entered {
        std::array<double, 5> left{};  ///< [direction of `follow`] distance at which it is left
        std::size_t other = 0;         ///< index in `others_`; its size: the face that was hit
    };
    /// A volume around a ray of `follow`.
    struct Within {
        std::uint64_t part = 0;
        std::uint32_t material = 0;
        std::size_t entered = 0;  ///< index in `entered_`; its size: another volume
    };

    /// Forgets what was found.
    void clear();
    /// Finds `hits_` along `ray_`, without some of the part of the surface itself.
    void find_hits(const Surface& surface, const Arrival& arrival, RayMask mask);
    /// `own`: the volume of the face that was hit; null: a thin sheet was.
    void look_at(const Hit& hit, const std::uint64_t* own, const Arrival& arrival);
    /// Sorts `others_` and, if `own` is not null, the face that was hit of that volume, which is
    /// entered.
    void sort_entered(const ShadingPoint& point, const Medium* own, const Vec3& direction,
                      const Arrival& arrival, RayMask mask);
    /// Follows ray `number` out of all volumes that are entered; sets Entered::left.
    void follow(const Ray& ray, std::size_t number, const Medium* own, const Arrival& arrival,
                RayMask mask);

    const Scene& scene_;
    std::shared_ptr<const std::vector<Kind>> kinds_;  ///< [material]; null: none bounds a volume
    Ray ray_;
    std::vector<Hit> hits_;
    OtherFaces others_;
    OtherFaces sorted_;
    std::vector<Entered> entered_;
    std::vector<Within> within_;
    std::optional<Hit> opaque_, instead_;
    std::vector<Hit> sheets_;
    std::vector<HitParts> sheet_parts_;  ///< of `sheets_`
    ShadingPoint other_;
};

}  // namespace alhazen
