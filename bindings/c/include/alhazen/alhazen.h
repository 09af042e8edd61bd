#ifndef ALHAZEN_H
#define ALHAZEN_H
/* Rays and geometry from C99, with a stable binary interface.
 *
 * Source: the interface of Embree 3 (Wald, Woop, Benthin, Johnson and Ernst, "Embree: A Kernel Framework for Efficient
 * CPU Ray Tracing", SIGGRAPH 2014). A program that uses only the calls below is ported by renaming rtc to alhazen, RTC
 * to Alhazen and RTC_ to ALHAZEN_.
 * Differs: hits are computed in double precision for vertices of any format, and are bit-identical for any number of
 * threads and of rays per call. Ng is a unit vector in world space, also inside instances. AlhazenIntersectContext
 * begins with its size and has no filter. Vertices may be double (ALHAZEN_FORMAT_DOUBLE3), as may rays
 * (alhazenIntersect1Md). Instanced scenes must not contain instances.
 *
 * Conventions: t is in [tnear, tfar], in units of the direction's length. On a hit tfar becomes t. Without a hit the
 * ids are ALHAZEN_INVALID_ID. Occlusion sets tfar to -infinity. A ray sees a geometry only if their masks share a bit.
 * Objects are reference-counted: New returns one reference, Release drops one; a scene holds its geometries.
 * Errors: no call with valid pointers ends the program. The first error of a thread is kept until
 * alhazenGetDeviceError reads it.
 * Threads: queries of a committed scene may run in many threads; no other call on the scene may run meanwhile. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define ALHAZEN_API __attribute__((visibility("default")))
#define ALHAZEN_ALIGN(bytes) __attribute__((aligned(bytes)))
#else
#define ALHAZEN_API
#define ALHAZEN_ALIGN(bytes)
#endif

#define ALHAZEN_INVALID_ID ((unsigned int)-1)
#define ALHAZEN_INVALID_GEOMETRY_ID ALHAZEN_INVALID_ID
#define ALHAZEN_MAX_INSTANCE_LEVEL_COUNT 1

/* ---- Devices */

typedef struct AlhazenDeviceTy* AlhazenDevice;
typedef struct AlhazenSceneTy* AlhazenScene;
typedef struct AlhazenGeometryTy* AlhazenGeometry;
typedef struct AlhazenBufferTy* AlhazenBuffer;

enum AlhazenError {
    ALHAZEN_ERROR_NONE = 0,
    ALHAZEN_ERROR_UNKNOWN = 1,
    ALHAZEN_ERROR_INVALID_ARGUMENT = 2,
    ALHAZEN_ERROR_INVALID_OPERATION = 3,
    ALHAZEN_ERROR_OUT_OF_MEMORY = 4,
    ALHAZEN_ERROR_UNSUPPORTED_CPU = 5,
    ALHAZEN_ERROR_CANCELLED = 6
};

/* Called with each error. May call the library; errors of such calls are kept as codes, but not reported. */
typedef void (*AlhazenErrorFunction)(void* userPtr, enum AlhazenError code, const char* text);
/* Called for each allocation of a scene: before (post false) its copy of the geometry, after (post true) the build of
 * the acceleration structure, and with negative bytes when both are freed. Returning false ends alhazenCommitScene with
 * ALHAZEN_ERROR_OUT_OF_MEMORY: bytes refused with post false are not allocated, and not reported again; those refused
 * with post true are freed, and reported as such. Monitors run in the thread of the commit and may query the scene. */
typedef bool (*AlhazenMemoryMonitorFunction)(void* userPtr, ssize_t bytes, bool post);
/* Called by alhazenCommitScene with the fraction done, from 0 to 1; returning false ends it with
 * ALHAZEN_ERROR_CANCELLED, except for the last call, with 1: the commit is done then, and the result is ignored. The
 * build of the acceleration structure is a single step. */
typedef bool (*AlhazenProgressMonitorFunction)(void* userPtr, double done);

/* Creates a device. config: NULL, or for example "threads=4,accelerator=wide_bvh,quality=high". threads: number used by
 * a commit; 0 uses all cores. Keys of Embree without a meaning here (verbose, isa, set_affinity, start_threads,
 * hugepages) are ignored. Returns NULL on an error, which alhazenGetDeviceError(NULL) returns. */
ALHAZEN_API AlhazenDevice alhazenNewDevice(const char* config);
ALHAZEN_API void alhazenRetainDevice(AlhazenDevice device);
ALHAZEN_API void alhazenReleaseDevice(AlhazenDevice device);
/* Returns and clears the first error of this thread, for a device or, with NULL, for alhazenNewDevice. */
ALHAZEN_API enum AlhazenError alhazenGetDeviceError(AlhazenDevice device);
/* Returns the text of the last error of this thread; "" if there is none. Valid until its next error. */
ALHAZEN_API const char* alhazenGetDeviceErrorMessage(AlhazenDevice device);
ALHAZEN_API void alhazenSetDeviceErrorFunction(AlhazenDevice device, AlhazenErrorFunction error, void* userPtr);
ALHAZEN_API void alhazenSetDeviceMemoryMonitorFunction(AlhazenDevice device, AlhazenMemoryMonitorFunction monitor,
                                                       void* userPtr);

enum AlhazenDeviceProperty {
    ALHAZEN_DEVICE_PROPERTY_VERSION = 0, /* 10000 major + 100 minor + patch */
    ALHAZEN_DEVICE_PROPERTY_VERSION_MAJOR = 1,
    ALHAZEN_DEVICE_PROPERTY_VERSION_MINOR = 2,
    ALHAZEN_DEVICE_PROPERTY_VERSION_PATCH = 3,
    ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED = 32,
    ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED = 33,
    ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED = 34,
    ALHAZEN_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED = 35,
    ALHAZEN_DEVICE_PROPERTY_RAY_MASK_SUPPORTED = 64,
    ALHAZEN_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED = 65,
    ALHAZEN_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED = 66,
    ALHAZEN_DEVICE_PROPERTY_IGNORE_INVALID_RAYS_ENABLED = 67,
    ALHAZEN_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED = 96,
    ALHAZEN_DEVICE_PROPERTY_QUAD_GEOMETRY_SUPPORTED = 97,
    ALHAZEN_DEVICE_PROPERTY_SUBDIVISION_GEOMETRY_SUPPORTED = 98,
    ALHAZEN_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED = 99,
    ALHAZEN_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED = 100,
    ALHAZEN_DEVICE_PROPERTY_POINT_GEOMETRY_SUPPORTED = 101,
    ALHAZEN_DEVICE_PROPERTY_TASKING_SYSTEM = 128,
    ALHAZEN_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED = 129,
    ALHAZEN_DEVICE_PROPERTY_PARALLEL_COMMIT_SUPPORTED = 130
};
/* Returns the version, or 1 or 0 for the other properties; 0 for a property that is not in the list. */
ALHAZEN_API ssize_t alhazenGetDeviceProperty(AlhazenDevice device, enum AlhazenDeviceProperty property);

/* ---- Geometry */

enum AlhazenGeometryType {
    ALHAZEN_GEOMETRY_TYPE_TRIANGLE = 0,
    ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT = 50, /* exact spheres: vertices x, y, z, radius */
    ALHAZEN_GEOMETRY_TYPE_INSTANCE = 121
};
enum AlhazenBufferType { ALHAZEN_BUFFER_TYPE_INDEX = 0, ALHAZEN_BUFFER_TYPE_VERTEX = 1 };
enum AlhazenFormat {
    ALHAZEN_FORMAT_UINT3 = 0x5003,
    ALHAZEN_FORMAT_FLOAT3 = 0x9003,
    ALHAZEN_FORMAT_FLOAT4 = 0x9004,
    ALHAZEN_FORMAT_FLOAT3X4_ROW_MAJOR = 0x9134,
    ALHAZEN_FORMAT_FLOAT3X4_COLUMN_MAJOR = 0x9234,
    ALHAZEN_FORMAT_FLOAT4X4_COLUMN_MAJOR = 0x9244,
    ALHAZEN_FORMAT_DOUBLE3 = 0xA003, /* vertices of triangles */
    ALHAZEN_FORMAT_DOUBLE4 = 0xA004  /* vertices of spheres */
};

enum AlhazenBuildQuality {
    ALHAZEN_BUILD_QUALITY_LOW = 0,
    ALHAZEN_BUILD_QUALITY_MEDIUM = 1,
    ALHAZEN_BUILD_QUALITY_HIGH = 2,
    ALHAZEN_BUILD_QUALITY_REFIT = 3 /* for geometries */
};

ALHAZEN_API AlhazenGeometry alhazenNewGeometry(AlhazenDevice device, enum AlhazenGeometryType type);
ALHAZEN_API void alhazenRetainGeometry(AlhazenGeometry geometry);
ALHAZEN_API void alhazenReleaseGeometry(AlhazenGeometry geometry);
/* Allocates memory that buffers of several geometries may share; each geometry holds a reference. */
ALHAZEN_API AlhazenBuffer alhazenNewBuffer(AlhazenDevice device, size_t byteSize);
/* Wraps the caller's memory, which must outlive the buffer. */
ALHAZEN_API AlhazenBuffer alhazenNewSharedBuffer(AlhazenDevice device, void* ptr, size_t byteSize);
ALHAZEN_API void* alhazenGetBufferData(AlhazenBuffer buffer);
ALHAZEN_API void alhazenRetainBuffer(AlhazenBuffer buffer);
ALHAZEN_API void alhazenReleaseBuffer(AlhazenBuffer buffer);
/* As alhazenSetSharedGeometryBuffer, for items inside a buffer; ALHAZEN_ERROR_INVALID_ARGUMENT if they exceed it. */
ALHAZEN_API void alhazenSetGeometryBuffer(AlhazenGeometry geometry, enum AlhazenBufferType type, unsigned int slot,
                                          enum AlhazenFormat format, AlhazenBuffer buffer, size_t byteOffset,
                                          size_t byteStride, size_t itemCount);
/* Item i is at ptr + byteOffset + i * byteStride, which need not be aligned. alhazenCommitScene reads the items; the
 * memory must be valid until then. slot must be 0. */
ALHAZEN_API void alhazenSetSharedGeometryBuffer(AlhazenGeometry geometry, enum AlhazenBufferType type,
                                                unsigned int slot, enum AlhazenFormat format, const void* ptr,
                                                size_t byteOffset, size_t byteStride, size_t itemCount);
/* Allocates memory of the geometry for items byteStride apart; returns NULL on an error. */
ALHAZEN_API void* alhazenSetNewGeometryBuffer(AlhazenGeometry geometry, enum AlhazenBufferType type, unsigned int slot,
                                              enum AlhazenFormat format, size_t byteStride, size_t itemCount);
ALHAZEN_API void* alhazenGetGeometryBufferData(AlhazenGeometry geometry, enum AlhazenBufferType type,
                                               unsigned int slot);
ALHAZEN_API void alhazenUpdateGeometryBuffer(AlhazenGeometry geometry, enum AlhazenBufferType type, unsigned int slot);
ALHAZEN_API void alhazenSetGeometryMask(AlhazenGeometry geometry, unsigned int mask);
ALHAZEN_API void alhazenSetGeometryUserData(AlhazenGeometry geometry, void* userPtr);
ALHAZEN_API void* alhazenGetGeometryUserData(AlhazenGeometry geometry);
/* Accepted for compatibility; has no effect. */
ALHAZEN_API void alhazenSetGeometryBuildQuality(AlhazenGeometry geometry, enum AlhazenBuildQuality quality);
/* timeStepCount must be 1. */
ALHAZEN_API void alhazenSetGeometryTimeStepCount(AlhazenGeometry geometry, unsigned int timeStepCount);
/* The instanced scene must be committed before the scene that contains the instance. A scene that would contain itself,
 * also indirectly, is ALHAZEN_ERROR_INVALID_OPERATION, here and in alhazenAttachGeometry. */
ALHAZEN_API void alhazenSetGeometryInstancedScene(AlhazenGeometry geometry, AlhazenScene scene);
/* timeStep must be 0. */
ALHAZEN_API void alhazenSetGeometryTransform(AlhazenGeometry geometry, unsigned int timeStep,
                                             enum AlhazenFormat format, const void* xfm);
ALHAZEN_API void alhazenGetGeometryTransform(AlhazenGeometry geometry, float time, enum AlhazenFormat format, void* xfm);
ALHAZEN_API void alhazenEnableGeometry(AlhazenGeometry geometry);
ALHAZEN_API void alhazenDisableGeometry(AlhazenGeometry geometry);
/* Only committed geometries take part in the next commit of a scene. */
ALHAZEN_API void alhazenCommitGeometry(AlhazenGeometry geometry);

/* ---- Scenes */

/* Accepted for compatibility; have no effect: hits are always robust and trees always compact. */
enum AlhazenSceneFlags {
    ALHAZEN_SCENE_FLAG_NONE = 0,
    ALHAZEN_SCENE_FLAG_DYNAMIC = 1,
    ALHAZEN_SCENE_FLAG_COMPACT = 2,
    ALHAZEN_SCENE_FLAG_ROBUST = 4
};
struct AlhazenBounds {
    float lower_x, lower_y, lower_z, align0;
    float upper_x, upper_y, upper_z, align1;
} ALHAZEN_ALIGN(16);

ALHAZEN_API AlhazenScene alhazenNewScene(AlhazenDevice device);
/* Returns a reference that the caller must release. */
ALHAZEN_API AlhazenDevice alhazenGetSceneDevice(AlhazenScene scene);
ALHAZEN_API void alhazenRetainScene(AlhazenScene scene);
ALHAZEN_API void alhazenReleaseScene(AlhazenScene scene);
ALHAZEN_API void alhazenSetSceneBuildQuality(AlhazenScene scene, enum AlhazenBuildQuality quality);
ALHAZEN_API void alhazenSetSceneFlags(AlhazenScene scene, enum AlhazenSceneFlags flags);
ALHAZEN_API enum AlhazenSceneFlags alhazenGetSceneFlags(AlhazenScene scene);
ALHAZEN_API void alhazenSetSceneProgressMonitorFunction(AlhazenScene scene, AlhazenProgressMonitorFunction progress,
                                                        void* userPtr);
/* Returns the id, the smallest free one; ALHAZEN_INVALID_ID on an error. */
ALHAZEN_API unsigned int alhazenAttachGeometry(AlhazenScene scene, AlhazenGeometry geometry);
ALHAZEN_API void alhazenAttachGeometryByID(AlhazenScene scene, AlhazenGeometry geometry, unsigned int geomID);
ALHAZEN_API void alhazenDetachGeometry(AlhazenScene scene, unsigned int geomID);
/* Return no reference. Both may run concurrently with calls that attach and detach. */
ALHAZEN_API AlhazenGeometry alhazenGetGeometry(AlhazenScene scene, unsigned int geomID);
ALHAZEN_API AlhazenGeometry alhazenGetGeometryThreadSafe(AlhazenScene scene, unsigned int geomID);
/* Builds the scene; on an error the previous commit stays valid. While another thread commits the scene, the call is
 * ALHAZEN_ERROR_INVALID_OPERATION. */
ALHAZEN_API void alhazenCommitScene(AlhazenScene scene);
/* As alhazenCommitScene, but waits for a commit of another thread and uses its result; threads do not share work. */
ALHAZEN_API void alhazenJoinCommitScene(AlhazenScene scene);
/* Bounds rounded outward; empty (lower above upper) without geometry. */
ALHAZEN_API void alhazenGetSceneBounds(AlhazenScene scene, struct AlhazenBounds* bounds_o);

/* ---- Rays */

enum AlhazenIntersectContextFlags {
    ALHAZEN_INTERSECT_CONTEXT_FLAG_NONE = 0,
    ALHAZEN_INTERSECT_CONTEXT_FLAG_INCOHERENT = 0,
    /* Neighbours have similar directions and start or end near a common point. Never changes a hit. */
    ALHAZEN_INTERSECT_CONTEXT_FLAG_COHERENT = 1,
    /* Sets Ng to 0, which saves the time to compute it. */
    ALHAZEN_INTERSECT_CONTEXT_FLAG_NO_NORMALS = 256
};
struct AlhazenIntersectContext {
    size_t structSize; /* size in the header that the caller was compiled with */
    enum AlhazenIntersectContextFlags flags;
};
static inline void alhazenInitIntersectContext(struct AlhazenIntersectContext* context) {
    context->structSize = sizeof(struct AlhazenIntersectContext);
    context->flags = ALHAZEN_INTERSECT_CONTEXT_FLAG_NONE;
}

struct AlhazenRay {
    float org_x, org_y, org_z, tnear;
    float dir_x, dir_y, dir_z, time; /* time, id and flags are not read */
    float tfar;
    unsigned int mask, id, flags;
} ALHAZEN_ALIGN(16);
struct AlhazenHit {
    float Ng_x, Ng_y, Ng_z;
    float u, v; /* weights of the second and third vertex; 0 for spheres */
    unsigned int primID, geomID;
    unsigned int instID[ALHAZEN_MAX_INSTANCE_LEVEL_COUNT];
} ALHAZEN_ALIGN(16);
struct AlhazenRayHit {
    struct AlhazenRay ray;
    struct AlhazenHit hit;
};

#define ALHAZEN_RAY_PACKET(N)                                        \
    struct AlhazenRay##N {                                           \
        float org_x[N], org_y[N], org_z[N], tnear[N];                \
        float dir_x[N], dir_y[N], dir_z[N], time[N], tfar[N];        \
        unsigned int mask[N], id[N], flags[N];                       \
    } ALHAZEN_ALIGN(4 * N);                                          \
    struct AlhazenHit##N {                                           \
        float Ng_x[N], Ng_y[N], Ng_z[N], u[N], v[N];                 \
        unsigned int primID[N], geomID[N];                           \
        unsigned int instID[ALHAZEN_MAX_INSTANCE_LEVEL_COUNT][N];    \
    } ALHAZEN_ALIGN(4 * N);                                          \
    struct AlhazenRayHit##N {                                        \
        struct AlhazenRay##N ray;                                    \
        struct AlhazenHit##N hit;                                    \
    };
ALHAZEN_RAY_PACKET(4)
ALHAZEN_RAY_PACKET(8)
ALHAZEN_RAY_PACKET(16)

/* One array per member, all of the same length. time, id and flags of rays are not read and may be NULL. */
struct AlhazenRayNp {
    float *org_x, *org_y, *org_z, *tnear;
    float *dir_x, *dir_y, *dir_z, *time, *tfar;
    unsigned int *mask, *id, *flags;
};
struct AlhazenHitNp {
    float *Ng_x, *Ng_y, *Ng_z, *u, *v;
    unsigned int *primID, *geomID;
    unsigned int* instID[ALHAZEN_MAX_INSTANCE_LEVEL_COUNT];
};
struct AlhazenRayHitNp {
    struct AlhazenRayNp ray;
    struct AlhazenHitNp hit;
};
/* N rays in the layout of struct AlhazenRay16 for N = 16. */
struct AlhazenRayN;
struct AlhazenHitN;
struct AlhazenRayHitN;

/* A ray with its hit in double precision. */
struct AlhazenRayHitd {
    double org[3], tnear, dir[3], tfar;
    double Ng[3], u, v;
    unsigned int mask, primID, geomID, instID;
};

/* context may be NULL, for the defaults of alhazenInitIntersectContext. Lanes of a packet whose valid is not -1 are
 * unchanged. M rays are byteStride apart; the calling thread traces them, from about ten rays on faster than one by
 * one. */
ALHAZEN_API void alhazenIntersect1(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                   struct AlhazenRayHit* rayhit);
ALHAZEN_API void alhazenIntersect4(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                   struct AlhazenRayHit4* rayhit);
ALHAZEN_API void alhazenIntersect8(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                   struct AlhazenRayHit8* rayhit);
ALHAZEN_API void alhazenIntersect16(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                    struct AlhazenRayHit16* rayhit);
ALHAZEN_API void alhazenIntersect1M(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                    struct AlhazenRayHit* rayhit, unsigned int M, size_t byteStride);
/* Rays at M addresses (1Mp); M packets of N rays (NM); N rays in arrays (Np). */
ALHAZEN_API void alhazenIntersect1Mp(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                     struct AlhazenRayHit** rayhit, unsigned int M);
ALHAZEN_API void alhazenIntersectNM(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                    struct AlhazenRayHitN* rayhit, unsigned int N, unsigned int M, size_t byteStride);
ALHAZEN_API void alhazenIntersectNp(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                    const struct AlhazenRayHitNp* rayhit, unsigned int N);
ALHAZEN_API void alhazenIntersect1Md(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                     struct AlhazenRayHitd* rayhit, size_t M, size_t byteStride);
ALHAZEN_API void alhazenOccluded1(AlhazenScene scene, struct AlhazenIntersectContext* context, struct AlhazenRay* ray);
ALHAZEN_API void alhazenOccluded4(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                  struct AlhazenRay4* ray);
ALHAZEN_API void alhazenOccluded8(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                  struct AlhazenRay8* ray);
ALHAZEN_API void alhazenOccluded16(const int* valid, AlhazenScene scene, struct AlhazenIntersectContext* context,
                                   struct AlhazenRay16* ray);
ALHAZEN_API void alhazenOccluded1M(AlhazenScene scene, struct AlhazenIntersectContext* context, struct AlhazenRay* ray,
                                   unsigned int M, size_t byteStride);
ALHAZEN_API void alhazenOccluded1Mp(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                    struct AlhazenRay** ray, unsigned int M);
ALHAZEN_API void alhazenOccludedNM(AlhazenScene scene, struct AlhazenIntersectContext* context, struct AlhazenRayN* ray,
                                   unsigned int N, unsigned int M, size_t byteStride);
ALHAZEN_API void alhazenOccludedNp(AlhazenScene scene, struct AlhazenIntersectContext* context,
                                   const struct AlhazenRayNp* ray, unsigned int N);

#ifdef __cplusplus
}
#endif
#endif
