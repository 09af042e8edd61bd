#pragma once
/// Memory layouts of the rays of a call and of their results.

#include <concepts>
#include <cstddef>
#include <limits>

#include "handles.h"

namespace alhazen::capi {

/// The result of one ray.
struct Answer {
    bool found = false;
    double t = 0, u = 0, v = 0;
    Vec3 normal;
    unsigned primitive = ALHAZEN_INVALID_ID, geometry = ALHAZEN_INVALID_ID,
             instance = ALHAZEN_INVALID_ID;
};

/// The rays of a call: [i] ray, mask, and where the result is stored.
template <class Rays>
concept RayLayout = requires(const Rays& rays, std::size_t i, const Answer& answer) {
    { rays.ray(i) } -> std::same_as<Ray>;
    { rays.mask(i) } -> std::same_as<RayMask>;
    { rays.active(i) } -> std::same_as<bool>;
    rays.answer(i, answer);
    rays.occlude(i);
};

inline constexpr float kMinusInfinity = -std::numeric_limits<float>::infinity();

/// Structs of rays: AlhazenRayHit, or AlhazenRay for occlusion; the address is place(i).
template <class Place>
class StructRays {
  public:
    explicit StructRays(Place place) : place_(place) {}

    [[nodiscard]] Ray ray(std::size_t i) const {
        const AlhazenRay& r = at(i);
        return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tnear, r.tfar};
    }
    [[nodiscard]] RayMask mask(std::size_t i) const { return at(i).mask; }
    [[nodiscard]] bool active(std::size_t) const { return true; }
    void occlude(std::size_t i) const { at(i).tfar = kMinusInfinity; }
    void answer(std::size_t i, const Answer& a) const {
        AlhazenHit& hit = static_cast<AlhazenRayHit*>(place_(i))->hit;
        hit.geomID = a.geometry;
        hit.primID = a.primitive;
        hit.instID[0] = a.instance;
        if (!a.found) return;
        at(i).tfar = static_cast<float>(a.t);
        hit.Ng_x = static_cast<float>(a.normal.x);
        hit.Ng_y = static_cast<float>(a.normal.y);
        hit.Ng_z = static_cast<float>(a.normal.z);
        hit.u = static_cast<float>(a.u);
        hit.v = static_cast<float>(a.v);
    }

  private:
    /// The ray is the first member of either struct.
    [[nodiscard]] AlhazenRay& at(std::size_t i) const {
        return *static_cast<AlhazenRay*>(place_(i));
    }
    Place place_;
};

/// Structs that are a stride apart.
inline auto structs_apart(void* begin, std::size_t stride) {
    return StructRays([begin, stride](std::size_t i) -> void* {
        return static_cast<std::byte*>(begin) + i * stride;
    });
}
/// Structs at the addresses of a list.
template <class Struct>
auto structs_at(Struct* const* pointers) {
    return StructRays([pointers](std::size_t i) -> void* { return pointers[i]; });
}

/// Rays in double precision that are a stride apart.
class DoubleRays {
  public:
    DoubleRays(void* begin, std::size_t stride)
        : begin_(static_cast<std::byte*>(begin)), stride_(stride) {}

    [[nodiscard]] Ray ray(std::size_t i) const {
        const AlhazenRayHitd& r = at(i);
        return {{r.org[0], r.org[1], r.org[2]}, {r.dir[0], r.dir[1], r.dir[2]}, r.tnear, r.tfar};
    }
    [[nodiscard]] RayMask mask(std::size_t i) const { return at(i).mask; }
    [[nodiscard]] bool active(std::size_t) const { return true; }
    void occlude(std::size_t i) const { at(i).tfar = -std::numeric_limits<double>::infinity(); }
    void answer(std::size_t i, const Answer& a) const {
        AlhazenRayHitd& r = at(i);
        r.geomID = a.geometry;
        r.primID = a.primitive;
        r.instID = a.instance;
        if (!a.found) return;
        r.tfar = a.t;
        for (int k = 0; k < 3; ++k) r.Ng[k] = a.normal[k];
        r.u = a.u;
        r.v = a.v;
    }

  private:
    [[nodiscard]] AlhazenRayHitd& at(std::size_t i) const {
        return *reinterpret_cast<AlhazenRayHitd*>(begin_ + i * stride_);
    }
    std::byte* begin_;
    std::size_t stride_;
};

/// One array per member. Without `valid` all rays are active.
class ArrayRays {
  public:
    ArrayRays(const AlhazenRayNp& rays, const AlhazenHitNp& hits, const int* valid)
        : rays_(rays), hits_(hits), valid_(valid) {}

    [[nodiscard]] Ray ray(std::size_t i) const {
        return {{rays_.org_x[i], rays_.org_y[i], rays_.org_z[i]},
                {rays_.dir_x[i], rays_.dir_y[i], rays_.dir_z[i]},
                rays_.tnear[i],
                rays_.tfar[i]};
    }
    [[nodiscard]] RayMask mask(std::size_t i) const { return rays_.mask[i]; }
    [[nodiscard]] bool active(std::size_t i) const { return valid_ == nullptr || valid_[i] == -1; }
    void occlude(std::size_t i) const { rays_.tfar[i] = kMinusInfinity; }
    void answer(std::size_t i, const Answer& a) const {
        hits_.geomID[i] = a.geometry;
        hits_.primID[i] = a.primitive;
        hits_.instID[0][i] = a.instance;
        if (!a.found) return;
        rays_.tfar[i] = static_cast<float>(a.t);
        hits_.Ng_x[i] = static_cast<float>(a.normal.x);
        hits_.Ng_y[i] = static_cast<float>(a.normal.y);
        hits_.Ng_z[i] = static_cast<float>(a.normal.z);
        hits_.u[i] = static_cast<float>(a.u);
        hits_.v[i] = static_cast<float>(a.v);
    }

  private:
    AlhazenRayNp rays_;
    AlhazenHitNp hits_;
    const int* valid_;
};

/// The arrays of a packet: members of equal length, one after another.
inline AlhazenRayNp arrays_of_rays(void* packet, std::size_t n) {
    auto* const f = static_cast<float*>(packet);
    auto* const u = static_cast<unsigned*>(packet);
    return {f,         f + n,     f + 2 * n, f + 3 * n, f + 4 * n,  f + 5 * n,
            f + 6 * n, f + 7 * n, f + 8 * n, u + 9 * n, u + 10 * n, u + 11 * n};
}
inline AlhazenHitNp arrays_of_hits(void* packet, std::size_t n) {
    auto* const f = static_cast<float*>(packet);
    auto* const u = static_cast<unsigned*>(packet);
    return {f, f + n, f + 2 * n, f + 3 * n, f + 4 * n, u + 5 * n, u + 6 * n, {u + 7 * n}};
}
/// Number of words of a ray: in a packet of n rays the hits follow after n times as many.
inline constexpr std::size_t kRayWords = sizeof(AlhazenRay) / 4;

}  // namespace alhazen::capi
