/* Two triangles, a hole between them and an instance of both, by the basic calls of Embree 3. Compiled
 * unchanged, and with rtc renamed to alhazen. */
#include <embree3/rtcore.h>

#include <math.h>
#include <stdio.h>

static void on_error(void* user, enum RTCError code, const char* text) {
    (void)user;
    printf("error %d: %s\n", (int)code, text);
}

static RTCScene new_quads(RTCDevice device) {
    RTCScene scene = rtcNewScene(device);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* vertices = (float*)rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                      3 * sizeof(float), 5);
    unsigned* indices = (unsigned*)rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                           3 * sizeof(unsigned), 2);
    const float points[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 2, 1, 1, 2, 1};
    const unsigned corners[6] = {0, 1, 2, 1, 3, 4};
    int i;
    for (i = 0; i < 15; ++i) vertices[i] = points[i];
    for (i = 0; i < 6; ++i) indices[i] = corners[i];
    rtcSetGeometryMask(mesh, 0xFFFFFFFFu);
    rtcCommitGeometry(mesh);
    rtcAttachGeometryByID(scene, mesh, 3);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene);
    return scene;
}

static struct RTCRay ray_at(float x, float y) {
    struct RTCRay ray;
    ray.org_x = x;
    ray.org_y = y;
    ray.org_z = 5;
    ray.dir_x = ray.dir_y = 0;
    ray.dir_z = -1;
    ray.tnear = 0;
    ray.tfar = INFINITY;
    ray.time = 0;
    ray.mask = 0xFFFFFFFFu;
    ray.id = ray.flags = 0;
    return ray;
}

int main(void) {
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene inner, scene;
    RTCGeometry instance;
    struct RTCIntersectContext context;
    struct RTCBounds bounds;
    const float shift[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 4, 0, -2};
    int x, y;
    if (!device) {
        printf("no device: %d\n", (int)rtcGetDeviceError(NULL));
        return 1;
    }
    rtcSetDeviceErrorFunction(device, on_error, NULL);
    inner = new_quads(device);
    scene = new_quads(device);
    instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, inner);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, shift);
    rtcCommitGeometry(instance);
    printf("attached as %u\n", rtcAttachGeometry(scene, instance));
    rtcReleaseGeometry(instance);
    rtcReleaseScene(inner);
    rtcCommitScene(scene);
    rtcGetSceneBounds(scene, &bounds);
    printf("bounds %ld %ld %ld to %ld %ld %ld\n", lrintf(bounds.lower_x), lrintf(bounds.lower_y),
           lrintf(bounds.lower_z), lrintf(bounds.upper_x), lrintf(bounds.upper_y), lrintf(bounds.upper_z));
    rtcInitIntersectContext(&context);
    for (y = 0; y < 8; ++y) {
        for (x = 0; x < 24; ++x) {
            struct RTCRayHit one;
            struct RTCRay shadow = ray_at(0.2713f * (float)x - 0.0937f, 0.3119f * (float)y - 0.1041f);
            one.ray = shadow;
            one.hit.geomID = one.hit.primID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &one);
            rtcOccluded1(scene, &context, &shadow);
            if ((one.hit.geomID != RTC_INVALID_GEOMETRY_ID) != (shadow.tfar < 0)) printf("occlusion differs\n");
            if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            printf("%d %d: geometry %u primitive %u instance %d t %.3f u %.3f v %.3f up %d\n", x, y, one.hit.geomID,
                   one.hit.primID, (int)one.hit.instID[0], one.ray.tfar, one.hit.u, one.hit.v, one.hit.Ng_z > 0);
        }
    }
    printf("last error %d\n", (int)rtcGetDeviceError(device));
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return 0;
}
