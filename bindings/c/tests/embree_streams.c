/* A bumpy ball, copies of it and a floor that moves, by streams of rays: more of Embree 3 than embree_program.c.
 * Compiled unchanged, and with rtc renamed to alhazen. */
#include <embree3/rtcore.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SIDE 40
#define WIDTH 32
#define RAYS (WIDTH * WIDTH)

static void on_error(void* user, enum RTCError code, const char* text) {
    (void)user;
    (void)text;
    printf("error %d\n", (int)code);
}
static bool on_progress(void* user, double done) {
    *(int*)user += done >= 0 && done <= 1;
    return true;
}

/* One buffer holds the vertices and, after them, the faces. */
static RTCScene new_ball(RTCDevice device) {
    const size_t vertices = (SIDE + 1) * (SIDE + 1), faces = 2 * SIDE * SIDE;
    RTCScene scene = rtcNewScene(device);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    RTCBuffer buffer = rtcNewBuffer(device, 16 * vertices + 12 * faces);
    float* p = (float*)rtcGetBufferData(buffer);
    unsigned* f = (unsigned*)((char*)p + 16 * vertices);
    unsigned i, j;
    for (i = 0; i <= SIDE; ++i) {
        for (j = 0; j <= SIDE; ++j) {
            const float u = 6.2831853f * (float)j / SIDE, v = 3.14159265f * (float)i / SIDE;
            const float r = 1 + 0.07f * sinf(5 * u) * sinf(4 * v);
            p[0] = r * sinf(v) * cosf(u);
            p[1] = r * sinf(v) * sinf(u);
            p[2] = r * cosf(v);
            p += 4;
            if (i < SIDE && j < SIDE) {
                const unsigned k = i * (SIDE + 1) + j;
                const unsigned corners[6] = {k, k + SIDE + 1, k + 1, k + 1, k + SIDE + 1, k + SIDE + 2};
                unsigned c;
                for (c = 0; c < 6; ++c) *f++ = corners[c];
            }
        }
    }
    rtcSetGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, buffer, 0, 16, vertices);
    rtcSetGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, buffer, 16 * vertices, 12, faces);
    rtcReleaseBuffer(buffer);
    rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetGeometryMask(mesh, 0xFFFFFFFFu);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcJoinCommitScene(scene);
    return scene;
}

static RTCGeometry new_floor(RTCDevice device, float** heights) {
    static const float points[12] = {-7, -7, -1.2f, 7, -7, -1.2f, 7, 7, -1.2f, -7, 7, -1.2f};
    static const unsigned corners[6] = {0, 1, 2, 0, 2, 3};
    RTCGeometry floor = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    int i;
    *heights = (float*)rtcSetNewGeometryBuffer(floor, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4);
    for (i = 0; i < 12; ++i) (*heights)[i] = points[i];
    rtcSetSharedGeometryBuffer(floor, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners, 0, 12, 2);
    rtcSetGeometryMask(floor, 0xFFFFFFFFu);
    rtcCommitGeometry(floor);
    return floor;
}

static struct RTCRayHit ray_at(int i) {
    struct RTCRayHit r;
    r.ray.org_x = 0.3f;
    r.ray.org_y = -0.2f;
    r.ray.org_z = 9;
    r.ray.dir_x = 0.0413f * ((float)(i % WIDTH) - 15.37f);
    r.ray.dir_y = 0.0397f * ((float)(i / WIDTH) - 15.61f);
    r.ray.dir_z = -1;
    r.ray.tnear = r.ray.time = 0;
    r.ray.tfar = INFINITY;
    r.ray.mask = 0xFFFFFFFFu;
    r.ray.id = r.ray.flags = 0;
    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
}

static struct RTCRayHit rays[RAYS], again[RAYS];
static struct RTCRay shadows[RAYS];
static struct RTCRayHit16 packets[RAYS / 16];

static void differ(const char* what, int i, const struct RTCHit* hit, float t) {
    const struct RTCHit* first = &rays[i].hit;
    if (hit->geomID != first->geomID || hit->instID[0] != first->instID[0] || t != rays[i].ray.tfar)
        printf("%s differs at %d\n", what, i);
}

/* Traces the same rays by every stream. */
static void trace(RTCScene scene, const char* name) {
    struct RTCIntersectContext context;
    struct RTCRayHit* pointers[RAYS];
    struct RTCRayHitNp arrays;
    int i, hits = 0;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (i = 0; i < RAYS; ++i) {
        struct RTCRayHit16* p = &packets[i / 16];
        rays[i] = again[i] = ray_at(i);
        shadows[i] = rays[i].ray;
        pointers[i] = &again[RAYS - 1 - i];
        p->ray.org_x[i % 16] = rays[i].ray.org_x;
        p->ray.org_y[i % 16] = rays[i].ray.org_y;
        p->ray.org_z[i % 16] = rays[i].ray.org_z;
        p->ray.dir_x[i % 16] = rays[i].ray.dir_x;
        p->ray.dir_y[i % 16] = rays[i].ray.dir_y;
        p->ray.dir_z[i % 16] = rays[i].ray.dir_z;
        p->ray.tnear[i % 16] = p->ray.time[i % 16] = 0;
        p->ray.tfar[i % 16] = INFINITY;
        p->ray.mask[i % 16] = 0xFFFFFFFFu;
        p->ray.id[i % 16] = p->ray.flags[i % 16] = 0;
        p->hit.geomID[i % 16] = p->hit.instID[0][i % 16] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene, &context, rays, RAYS, sizeof rays[0]);
    rtcIntersect1Mp(scene, &context, pointers, RAYS);
    rtcIntersectNM(scene, &context, (struct RTCRayHitN*)packets, 16, RAYS / 16 - 1, sizeof packets[0]);
    {
        struct RTCRayHit16* p = &packets[RAYS / 16 - 1];
        arrays.ray.org_x = p->ray.org_x;
        arrays.ray.org_y = p->ray.org_y;
        arrays.ray.org_z = p->ray.org_z;
        arrays.ray.dir_x = p->ray.dir_x;
        arrays.ray.dir_y = p->ray.dir_y;
        arrays.ray.dir_z = p->ray.dir_z;
        arrays.ray.tnear = p->ray.tnear;
        arrays.ray.tfar = p->ray.tfar;
        arrays.ray.time = p->ray.time;
        arrays.ray.mask = p->ray.mask;
        arrays.ray.id = p->ray.id;
        arrays.ray.flags = p->ray.flags;
        arrays.hit.Ng_x = p->hit.Ng_x;
        arrays.hit.Ng_y = p->hit.Ng_y;
        arrays.hit.Ng_z = p->hit.Ng_z;
        arrays.hit.u = p->hit.u;
        arrays.hit.v = p->hit.v;
        arrays.hit.primID = p->hit.primID;
        arrays.hit.geomID = p->hit.geomID;
        arrays.hit.instID[0] = p->hit.instID[0];
    }
    rtcIntersectNp(scene, &context, &arrays, 16);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_NONE; /* Embree 3.13.5 does not return from coherent ones without the floor */
    rtcOccluded1M(scene, &context, shadows, RAYS, sizeof shadows[0]);
    for (i = 0; i < RAYS; ++i) {
        const struct RTCRayHit16* p = &packets[i / 16];
        struct RTCHit lane;
        const bool hit = rays[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
        lane.geomID = p->hit.geomID[i % 16];
        lane.instID[0] = p->hit.instID[0][i % 16];
        differ("1Mp", i, &again[i].hit, again[i].ray.tfar);
        differ("NM or Np", i, &lane, p->ray.tfar[i % 16]);
        if (hit != (shadows[i].tfar < 0)) printf("occlusion differs at %d\n", i);
        if (!hit) continue;
        ++hits;
        printf("%s %d: %d in %d, %u at %.3f\n", name, i, (int)rays[i].hit.geomID, (int)rays[i].hit.instID[0],
               rays[i].hit.primID, rays[i].ray.tfar);
    }
    printf("%s: %d hits\n", name, hits);
}

int main(void) {
    RTCDevice device = rtcNewDevice("threads=1"), same;
    RTCScene ball, scene;
    RTCGeometry floor;
    float* heights;
    int i, told = 0, mark = 0;
    if (!device) return 1;
    rtcSetDeviceErrorFunction(device, on_error, NULL);
    printf("masks %d\n", (int)rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED));
    ball = new_ball(device);
    scene = rtcNewScene(device);
    same = rtcGetSceneDevice(scene);
    printf("same device %d\n", same == device);
    rtcReleaseDevice(same);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    printf("flags %d\n", (int)rtcGetSceneFlags(scene));
    rtcSetSceneProgressMonitorFunction(scene, on_progress, &told);
    floor = new_floor(device, &heights);
    rtcSetGeometryUserData(floor, &mark);
    printf("floor is %u\n", rtcAttachGeometry(scene, floor));
    printf("known %d\n", rtcGetGeometryUserData(rtcGetGeometry(scene, 0)) == &mark);
    for (i = 0; i < 9; ++i) {
        RTCGeometry copy = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, read[12];
        m[0] = 0.6f + 0.05f * (float)i;
        m[12] = 2.3f * (float)(i % 3 - 1);
        m[13] = 2.1f * (float)(i / 3 - 1);
        rtcSetGeometryInstancedScene(copy, ball);
        rtcSetGeometryTransform(copy, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m);
        rtcCommitGeometry(copy);
        rtcGetGeometryTransform(copy, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, read);
        if (read[0] != m[0] || read[3] != m[12] || read[7] != m[13]) printf("transform %d differs\n", i);
        rtcAttachGeometryByID(scene, copy, 20 + (unsigned)i);
        rtcReleaseGeometry(copy);
    }
    rtcReleaseScene(ball);
    rtcCommitScene(scene);
    trace(scene, "first");
    for (i = 0; i < 4; ++i) heights[3 * i + 2] = 0.1f + 0.13f * (float)i;
    rtcUpdateGeometryBuffer(floor, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(floor);
    rtcCommitScene(scene);
    trace(scene, "raised");
    rtcDisableGeometry(floor);
    rtcDetachGeometry(scene, 24);
    rtcCommitScene(scene);
    trace(scene, "without");
    printf("told %d, last error %d\n", told > 0, (int)rtcGetDeviceError(device));
    rtcReleaseGeometry(floor);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return 0;
}
