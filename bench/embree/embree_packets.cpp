#include "embree/embree_packets.h"

#if defined(__SSE__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace alhazen::bench {

namespace {

/// Sets flush-to-zero and denormals-are-zero for the lifetime of the object.
class FlushDenormals {
  public:
#if defined(__SSE__)
    FlushDenormals() : saved_(_mm_getcsr()) {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    }
    ~FlushDenormals() {
        _mm_setcsr(saved_);
    }

  private:
    unsigned saved_;
#else
    FlushDenormals() {}
    ~FlushDenormals() {}
#endif
};

template <int kWidth>
struct Api;
template <>
struct Api<1> {
    using Nearest = RTCRayHit;
    using Any = RTCRay;
    static void trace(const int*, RTCScene s, RTCIntersectContext& c, Nearest& p) {
        rtcIntersect1(s, &c, &p);
    }
    static void trace(const int*, RTCScene s, RTCIntersectContext& c, Any& p) {
        rtcOccluded1(s, &c, &p);
    }
};
template <>
struct Api<4> {
    using Nearest = RTCRayHit4;
    using Any = RTCRay4;
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Nearest& p) {
        rtcIntersect4(v, s, &c, &p);
    }
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Any& p) {
        rtcOccluded4(v, s, &c, &p);
    }
};
template <>
struct Api<8> {
    using Nearest = RTCRayHit8;
    using Any = RTCRay8;
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Nearest& p) {
        rtcIntersect8(v, s, &c, &p);
    }
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Any& p) {
        rtcOccluded8(v, s, &c, &p);
    }
};
template <>
struct Api<16> {
    using Nearest = RTCRayHit16;
    using Any = RTCRay16;
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Nearest& p) {
        rtcIntersect16(v, s, &c, &p);
    }
    static void trace(const int* v, RTCScene s, RTCIntersectContext& c, Any& p) {
        rtcOccluded16(v, s, &c, &p);
    }
};

/// Packet is Api<kWidth>::Nearest or Api<kWidth>::Any.
template <int kWidth, class Packet>
class Packets final : public EmbreePackets {
  public:
    static constexpr bool kAny = std::is_same_v<Packet, typename Api<kWidth>::Any>;

    explicit Packets(const RaySet& set)
        : set_(set), packets_((set.rays.size() + kWidth - 1) / kWidth) {
        for (std::size_t i = 0; i < packets_.size() * kWidth; ++i) {
            // An unused lane holds a copy of the last ray.
            const Ray& ray = set.rays[std::min(i, set.rays.size() - 1)];
            RTCRayN* p = rays(packets_[i / kWidth]);
            const unsigned lane = i % kWidth;
            RTCRayN_org_x(p, kWidth, lane) = static_cast<float>(ray.origin.x);
            RTCRayN_org_y(p, kWidth, lane) = static_cast<float>(ray.origin.y);
            RTCRayN_org_z(p, kWidth, lane) = static_cast<float>(ray.origin.z);
            RTCRayN_dir_x(p, kWidth, lane) = static_cast<float>(ray.direction.x);
            RTCRayN_dir_y(p, kWidth, lane) = static_cast<float>(ray.direction.y);
            RTCRayN_dir_z(p, kWidth, lane) = static_cast<float>(ray.direction.z);
            RTCRayN_tnear(p, kWidth, lane) = static_cast<float>(ray.t_min);
            RTCRayN_time(p, kWidth, lane) = 0;
            RTCRayN_mask(p, kWidth, lane) = 0xFFFFFFFFu;
            RTCRayN_id(p, kWidth, lane) = 0;
            RTCRayN_flags(p, kWidth, lane) = 0;
        }
        reset();
    }

    void reset() override {
        for (std::size_t i = 0; i < packets_.size() * kWidth; ++i) {
            Packet& packet = packets_[i / kWidth];
            const unsigned lane = i % kWidth;
            const Ray& ray = set_.rays[std::min(i, set_.rays.size() - 1)];
            RTCRayN_tfar(rays(packet), kWidth, lane) = static_cast<float>(ray.t_max);
            if constexpr (!kAny) {
                RTCHitN_geomID(hits(packet), kWidth, lane) = RTC_INVALID_GEOMETRY_ID;
                RTCHitN_instID(hits(packet), kWidth, lane, 0) = RTC_INVALID_GEOMETRY_ID;
            }
        }
    }

    void trace(RTCScene scene, bool coherent) override {
        const FlushDenormals flush;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        alignas(64) int valid[kWidth];
        for (int i = 0; i < kWidth; ++i) valid[i] = -1;
        const std::size_t full = set_.rays.size() / kWidth;
        for (std::size_t i = 0; i < full; ++i) {
            Api<kWidth>::trace(valid, scene, context, packets_[i]);
        }
        if (full == packets_.size()) return;
        for (std::size_t i = set_.rays.size() % kWidth; i < kWidth; ++i) valid[i] = 0;
        Api<kWidth>::trace(valid, scene, context, packets_[full]);
    }

    [[nodiscard]] float t(std::size_t i) const override {
        Packet& packet = const_cast<Packet&>(packets_[i / kWidth]);
        const unsigned lane = i % kWidth;
        const float far = RTCRayN_tfar(rays(packet), kWidth, lane);
        if constexpr (kAny) {
            return far < 0.0f ? 0.0f : kMiss;
        } else {
            const bool found =
                RTCHitN_geomID(hits(packet), kWidth, lane) != RTC_INVALID_GEOMETRY_ID;
            return found ? far : kMiss;
        }
    }

    [[nodiscard]] std::size_t count_hits() const override {
        std::size_t count = 0;
        for (std::size_t i = 0; i < set_.rays.size(); ++i) count += t(i) != kMiss;
        return count;
    }

  private:
    // Both structures have the memory layout that Embree's accessors for any width expect.
    static RTCRayN* rays(Packet& packet) { return reinterpret_cast<RTCRayN*>(&packet); }
    static RTCHitN* hits(Packet& packet) {
        return RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(&packet), kWidth);
    }

    const RaySet& set_;
    std::vector<Packet> packets_;
};

template <int kWidth>
std::unique_ptr<EmbreePackets> make(const RaySet& set) {
    if (set.any_hit) return std::make_unique<Packets<kWidth, typename Api<kWidth>::Any>>(set);
    return std::make_unique<Packets<kWidth, typename Api<kWidth>::Nearest>>(set);
}

}  // namespace

std::unique_ptr<EmbreePackets> make_embree_packets(const RaySet& set, int width) {
    switch (width) {
        case 4:
            return make<4>(set);
        case 8:
            return make<8>(set);
        case 16:
            return make<16>(set);
        default:
            return make<1>(set);
    }
}

}  // namespace alhazen::bench
