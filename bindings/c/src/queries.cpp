#include <algorithm>
#include <span>

#include "handles.h"
#include "ray_layouts.h"

namespace alhazen::capi {

namespace {

/// The settings of a context.
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

/// Scratch memory of a thread.
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

/// Calls trace(mask) for each set of consecutive active rays in [begin, end) with one mask. The
/// rays are in scratch.rays, their numbers in scratch.which.
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

/// Number of rays of a call that are processed at a time.
constexpr std::size_t kBlock = 1024;

/// Traces one ray without the lists for many.
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

/// Runs query(built, wishes) for a committed scene and `count` rays; does nothing without rays.
template <class Query>
void ask_for(std::size_t count, AlhazenScene handle, const AlhazenIntersectContext* context,
             const void* rays, const Query& query) {
    const Scene* scene = object(handle);
    guarded(device_of(scene), [&] {
        need_argument(scene != nullptr, "the scene is NULL");
        need_argument(rays != nullptr || count == 0, "the rays are NULL");
        need(scene->built != nullptr, ALHAZEN_ERROR_INVALID_OPERATION,
             "the scene is not committed");
        const Wishes wishes = wishes_of(context);
        if (count > 0) query(*scene->built, wishes);
    });
}
template <class Query>
void ask(AlhazenScene scene, const AlhazenIntersectContext* context, const void* rays,
         const Query& query) {
    ask_for(1, scene, context, rays, query);
}

/// Traces a packet of n rays.
void intersect_packet(const int* valid, AlhazenScene scene, const AlhazenIntersectContext* context,
                      void* rayhit, std::size_t n) {
    ask(scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        auto* const hits = static_cast<float*>(rayhit) + kRayWords * n;
        intersect_all(built, wishes, n,
                      ArrayRays(arrays_of_rays(rayhit, n), arrays_of_hits(hits, n), valid));
    });
}

void occlude_packet(const int* valid, AlhazenScene scene, const AlhazenIntersectContext* context,
                    void* rays, std::size_t n) {
    ask(scene, context, rays, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, n, ArrayRays(arrays_of_rays(rays, n), {}, valid));
    });
}

}  // namespace

}  // namespace alhazen::capi

using namespace alhazen::capi;

void alhazenIntersect1(AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit* rayhit) {
    ask(scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_one(built, wishes, structs_apart(rayhit, 0));
    });
}
void alhazenIntersect4(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit4* rayhit) {
    intersect_packet(valid, scene, context, rayhit, 4);
}
void alhazenIntersect8(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRayHit8* rayhit) {
    intersect_packet(valid, scene, context, rayhit, 8);
}
void alhazenIntersect16(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                        AlhazenRayHit16* rayhit) {
    intersect_packet(valid, scene, context, rayhit, 16);
}
void alhazenIntersect1M(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRayHit* rayhit,
                        unsigned int M, size_t byteStride) {
    ask_for(M, scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, M, structs_apart(rayhit, byteStride));
    });
}
void alhazenIntersect1Mp(AlhazenScene scene, AlhazenIntersectContext* context,
                         AlhazenRayHit** rayhit, unsigned int M) {
    ask_for(M, scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, M, structs_at(rayhit));
    });
}
void alhazenIntersectNM(AlhazenScene scene, AlhazenIntersectContext* context,
                        AlhazenRayHitN* rayhit, unsigned int N, unsigned int M, size_t byteStride) {
    ask_for(std::size_t{N} * M, scene, context, rayhit,
            [&](const Built& built, const Wishes& wishes) {
                for (std::size_t m = 0; m < M; ++m) {
                    auto* const rays = reinterpret_cast<std::byte*>(rayhit) + m * byteStride;
                    intersect_all(built, wishes, N,
                                  ArrayRays(arrays_of_rays(rays, N),
                                            arrays_of_hits(rays + 4 * kRayWords * N, N), nullptr));
                }
            });
}
void alhazenIntersectNp(AlhazenScene scene, AlhazenIntersectContext* context,
                        const AlhazenRayHitNp* rayhit, unsigned int N) {
    ask_for(N, scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, N, ArrayRays(rayhit->ray, rayhit->hit, nullptr));
    });
}
void alhazenIntersect1Md(AlhazenScene scene, AlhazenIntersectContext* context,
                         AlhazenRayHitd* rayhit, size_t M, size_t byteStride) {
    ask_for(M, scene, context, rayhit, [&](const Built& built, const Wishes& wishes) {
        intersect_all(built, wishes, M, DoubleRays(rayhit, byteStride));
    });
}

void alhazenOccluded1(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRay* ray) {
    ask(scene, context, ray, [&](const Built& built, const Wishes&) {
        const auto rays = structs_apart(ray, 0);
        if (built.tracer->occluded(rays.ray(0), rays.mask(0))) rays.occlude(0);
    });
}
void alhazenOccluded4(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                      AlhazenRay4* ray) {
    occlude_packet(valid, scene, context, ray, 4);
}
void alhazenOccluded8(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                      AlhazenRay8* ray) {
    occlude_packet(valid, scene, context, ray, 8);
}
void alhazenOccluded16(const int* valid, AlhazenScene scene, AlhazenIntersectContext* context,
                       AlhazenRay16* ray) {
    occlude_packet(valid, scene, context, ray, 16);
}
void alhazenOccluded1M(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRay* ray,
                       unsigned int M, size_t byteStride) {
    ask_for(M, scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, M, structs_apart(ray, byteStride));
    });
}
void alhazenOccluded1Mp(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRay** ray,
                        unsigned int M) {
    ask_for(M, scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, M, structs_at(ray));
    });
}
void alhazenOccludedNM(AlhazenScene scene, AlhazenIntersectContext* context, AlhazenRayN* ray,
                       unsigned int N, unsigned int M, size_t byteStride) {
    ask_for(std::size_t{N} * M, scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        for (std::size_t m = 0; m < M; ++m) {
            auto* const rays = reinterpret_cast<std::byte*>(ray) + m * byteStride;
            occlude_all(built, wishes, N, ArrayRays(arrays_of_rays(rays, N), {}, nullptr));
        }
    });
}
void alhazenOccludedNp(AlhazenScene scene, AlhazenIntersectContext* context,
                       const AlhazenRayNp* ray, unsigned int N) {
    ask_for(N, scene, context, ray, [&](const Built& built, const Wishes& wishes) {
        occlude_all(built, wishes, N, ArrayRays(*ray, {}, nullptr));
    });
}
