#include <cstring>
#include <limits>
#include <span>

#include "handles.h"

namespace alhazen::capi {

namespace {

/// What a context says.
struct Wishes {
    Coherence coherence = Coherence::Any;
    bool normals = true;
};

Wishes wishes_of(const AlhazenIntersectContext* context) {
    if (context == nullptr) return {};
    need_argument(context->structSize >= sizeof(AlhazenIntersectContext),
                  "the context is not initialised: alhazenInitIntersectContext");
    const auto flags = static_cast<unsigned>(context->flags);
    return {(flags & ALHAZEN_INTERSECT_CONTEXT_FLAG_COHERENT) != 0 ? Coherence::Coherent
                                                                   : Coherence::Any,
            (flags & ALHAZEN_INTERSECT_CONTEXT_FLAG_NO_NORMALS) == 0};
}

/// The answer of one ray.
struct Answer {
    bool found = false;
    double t = 0, u = 0, v = 0;
    Vec3 normal;
    unsigned primitive = ALHAZEN_INVALID_ID, geometry = ALHAZEN_INVALID_ID,
             instance = ALHAZEN_INVALID_ID;
};

/// The rays of a call: [i] its ray, its mask, and where the answer goes.
template <class Rays>
concept RayLayout = requires(const Rays& rays, std::size_t i, const Answer& answer) {
    { rays.ray(i) } -> std::same_as<Ray>;
    { rays.mask(i) } -> std::same_as<RayMask>;
    { rays.active(i) } -> std::same_as<bool>;
    rays.answer(i, answer);
    rays.occlude(i);
};

Answer answer_of(const Built& built, const Ray& ray, const Hit& hit, bool normals,
                 Surface& scratch) {
    Answer answer;
    if (!hit.found()) return answer;
    const HitIds ids = built.tracer->ids(hit);
    const bool in_instance = !hit.path.empty();
    const Built* inner = &built;
    if (in_instance) {
        const Built::Origin& placed = built.origins[static_cast<std::size_t>(ids.outermost)];
        answer.instance = placed.geometry;
        inner = placed.instanced.get();
    }
    const Built::Origin& origin = inner->origins[static_cast<std::size_t>(ids.geometry)];
    answer.found = true;
    answer.geometry = origin.geometry;
    answer.primitive = origin.primitive + ids.primitive;
    answer.t = hit.t;
    answer.u = hit.u;
    answer.v = hit.v;
    if (normals) {
        built.tracer->surface(ray, hit, scratch);
        answer.normal = scratch.normal;
    }
    return answer;
}

/// Memory of one thread.
struct Scratch {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<std::size_t> which;
    std::unique_ptr<bool[]> occluded;
    std::size_t occluded_size = 0;
    Surface surface;
};

Scratch& scratch_of_thread() {
    thread_local Scratch scratch;
    return scratch;
}

/// Calls trace(mask) for each set of consecutive active rays [begin, end) of one mask, which lie in
/// scratch.rays, their numbers in scratch.which.
template <class Rays, class Trace>
void for_each_mask(const Rays& rays, std::size_t begin, std::size_t end, Scratch& scratch,
                   const Trace& trace) {
    while (begin < end) {
        scratch.rays.clear();
        scratch.which.clear();
        RayMask mask = 0;
        for (; begin < end; ++begin) {
            if (!rays.active(begin)) continue;
            if (!scratch.which.empty() && rays.mask(begin) != mask) break;
            mask = rays.mask(begin);
            scratch.rays.push_back(rays.ray(begin));
            scratch.which.push_back(begin);
        }
        if (!scratch.which.empty()) trace(mask);
    }
}

/// Rays of a call are taken so many at a time.
constexpr std::size_t kBlock = 1024;

/// One ray, without the lists of many.
void intersect_one(const Built& built, const Wishes& wishes, const RayLayout auto& rays) {
    const Ray ray = rays.ray(0);
    Hit hit;
    built.tracer->intersect(ray, hit, rays.mask(0));
    rays.answer(0, answer_of(built, ray, hit, wishes.normals, scratch_of_thread().surface));
}

template <RayLayout Rays>
void intersect_all(const Built& built, const Wishes& wishes, std::size_t count, const Rays& rays) {
    Scratch& scratch = scratch_of_thread();
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
        for_each_mask(rays, begin, std::min(count, begin + kBlock), scratch, [&](RayMask mask) {
            scratch.hits.resize(scratch.rays.size());
            if (scratch.rays.size() == 1) {
                built.tracer->intersect(scratch.rays[0], scratch.hits[0], mask);
            } else {
                built.tracer->intersect(scratch.rays, scratch.hits, mask, wishes.coherence);
            }
            for (std::size_t k = 0; k < scratch.rays.size(); ++k) {
                rays.answer(scratch.which[k], answer_of(built, scratch.rays[k], scratch.hits[k],
                                                        wishes.normals, scratch.surface));
            }
        });
    }
}

template <RayLayout Rays>
void occlude_all(const Built& built, const Wishes& wishes, std::size_t count, const Rays& rays) {
    Scratch& scratch = scratch_of_thread();
    if (scratch.occluded_size < kBlock) {
        scratch.occluded = std::make_unique<bool[]>(kBlock);
        scratch.occluded_size = kBlock;
    }
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
        for_each_mask(rays, begin, std::min(count, begin + kBlock), scratch, [&](RayMask mask) {
            const std::span<bool> found(scratch.occluded.get(), scratch.rays.size());
            if (scratch.rays.size() == 1) {
                found[0] = built.tracer->occluded(scratch.rays[0], mask);
            } else {
                built.tracer->occluded(scratch.rays, found, mask, wishes.coherence);
            }
            for (std::size_t k = 0; k < scratch.rays.size(); ++k) {
                if (found[k]) rays.occlude(scratch.which[k]);
            }
        });
    }
}

constexpr float kMinusInfinity = -std::numeric_limits<float>::infinity();

Ray ray_of(const AlhazenRay& r) {
    return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tnear, r.tfar};
}

/// Structs of rays, a stride apart: AlhazenRayHit, or for occlusion AlhazenRay.
class StructRays {
  public:
    StructRays(void* begin, std::size_t stride)
        : begin_(static_cast<std::byte*>(begin)), stride_(stride) {}

    [[nodiscard]] Ray ray(std::size_t i) const { return ray_of(ray_at(i)); }
    [[nodiscard]] RayMask mask(std::size_t i) const { return ray_at(i).mask; }
    [[nodiscard]] bool active(std::size_t) const { return true; }
    void occlude(std::size_t i) const { ray_at(i).tfar = kMinusInfinity; }
    void answer(std::size_t i, const Answer& a) const {
        AlhazenHit& hit = reinterpret_cast<AlhazenRayHit*>(begin_ + i * stride_)->hit;
        hit.geomID = a.geometry;
        hit.primID = a.primitive;
        hit.instID[0] = a.instance;
        if (!a.found) return;
        ray_at(i).tfar = static_cast<float>(a.t);
        hit.Ng_x = static_cast<float>(a.normal.x);
        hit.Ng_y = static_cast<float>(a.normal.y);
        hit.Ng_z = static_cast<float>(a.normal.z);
        hit.u = static_cast<float>(a.u);
        hit.v = static_cast<float>(a.v);
    }

  private:
    /// The ray is the first member of either struct.
    [[nodiscard]] AlhazenRay& ray_at(std::size_t i) const {
        return *reinterpret_cast<AlhazenRay*>(begin_ + i * stride_);
    }
    std::byte* begin_;
    std::size_t stride_;
};

/// Rays in double, a stride apart.
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

/// A packet: rays, and hits or null.
template <class PacketRay, class PacketHit>
class PacketRays {
  public:
    PacketRays(const int* valid, PacketRay& rays, PacketHit* hits)
        : valid_(valid), rays_(rays), hits_(hits) {}

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
        PacketHit& hit = *hits_;
        hit.geomID[i] = a.geometry;
        hit.primID[i] = a.primitive;
        hit.instID[0][i] = a.instance;
        if (!a.found) return;
        rays_.tfar[i] = static_cast<float>(a.t);
        hit.Ng_x[i] = static_cast<float>(a.normal.x);
        hit.Ng_y[i] = static_cast<float>(a.normal.y);
        hit.Ng_z[i] = static_cast<float>(a.normal.z);
        hit.u[i] = static_cast<float>(a.u);
        hit.v[i] = static_cast<float>(a.v);
    }

  private:
    const int* valid_;
    PacketRay& rays_;
    PacketHit* hits_;
};

/// Runs query(built, wishes) for a committed scene.
template <class Query>
void ask(AlhazenScene handle, const AlhazenIntersectContext* context, const void* rays,
         const Query& query) {
    const Scene* scene = object(handle);
    guarded(device_of(scene), [&] {
        need_argument(scene != nullptr && rays != nullptr, "the scene or the rays are NULL");
        need(scene->built != nullptr, ALHAZEN_ERROR_INVALID_OPERATION,
             "the scene is not committed");
        query(*scene->built, wishes_of(context));
    });
}

template <std::size_t N, class PacketRay, class PacketHit>
void intersect_packet(const int* valid, AlhazenScene scene, const AlhazenIntersectContext* context,
                      PacketRay* ray, PacketHit* hit) {
    ask(scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, N, PacketRays<PacketRay, PacketHit>(valid, *ray, hit));
    });
}

template <std::size_t N, class PacketHit, class PacketRay>
void occlude_packet(const int* valid, AlhazenScene scene, const AlhazenIntersectContext* context,
                    PacketRay* ray) {
    ask(scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, N, PacketRays<PacketRay, PacketHit>(valid, *ray, nullptr));
    });
}

}  // namespace

}  // namespace alhazen::capi

using namespace alhazen::capi;

void alhazenIntersect1(AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit* rayhit) {
    ask(scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_one(built, wishes, StructRays(rayhit, sizeof(AlhazenRayHit)));
    });
}
void alhazenIntersect1M(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRayHit* rayhit,
                        unsigned int M, size_t byteStride) {
    ask(scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, M, StructRays(rayhit, byteStride));
    });
}
void alhazenIntersect1Md(AlhazenScene scene, AlhazenIntersectContext* context,
                         AlhazenRayHitd* rayhit, size_t M, size_t byteStride) {
    ask(scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, M, DoubleRays(rayhit, byteStride));
    });
}
void alhazenIntersect4(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit4* rayhit) {
    intersect_packet<4>(valid, scene, context, rayhit != nullptr ? &rayhit->ray : nullptr,
                        rayhit != nullptr ? &rayhit->hit : nullptr);
}
void alhazenIntersect8(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit8* rayhit) {
    intersect_packet<8>(valid, scene, context, rayhit != nullptr ? &rayhit->ray : nullptr,
                        rayhit != nullptr ? &rayhit->hit : nullptr);
}
void alhazenIntersect16(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                        AlhazenRayHit16* rayhit) {
    intersect_packet<16>(valid, scene, context, rayhit != nullptr ? &rayhit->ray : nullptr,
                         rayhit != nullptr ? &rayhit->hit : nullptr);
}
void alhazenOccluded1(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRay* ray) {
    ask(scene, context, ray, [&](const Built& built, const Wishes&) {
        const StructRays rays(ray, sizeof(AlhazenRay));
        if (built.tracer->occluded(rays.ray(0), rays.mask(0))) rays.occlude(0);
    });
}
void alhazenOccluded1M(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRay* ray,
                       unsigned int M, size_t byteStride) {
    ask(scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, M, StructRays(ray, byteStride));
    });
}
void alhazenOccluded4(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                      AlhazenRay4* ray) {
    occlude_packet<4, AlhazenHit4>(valid, scene, context, ray);
}
void alhazenOccluded8(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                      AlhazenRay8* ray) {
    occlude_packet<8, AlhazenHit8>(valid, scene, context, ray);
}
void alhazenOccluded16(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRay16* ray) {
    occlude_packet<16, AlhazenHit16>(valid, scene, context, ray);
}
