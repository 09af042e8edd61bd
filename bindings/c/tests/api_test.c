/* Tests the C interface: every kind of call, buffers with strides, errors, monitors. Prints failures. */
#include <alhazen/alhazen.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;
#define EXPECT(condition)                                                    \
    do {                                                                     \
        if (!(condition)) {                                                  \
            printf("api_test.c:%d: not true: %s\n", __LINE__, #condition);   \
            ++failures;                                                      \
        }                                                                    \
    } while (0)

/* A square of two triangles at height z, from (0, 0) to (1, 1), in a struct with other members. */
struct Vertex {
    char name;
    float weight;
    float position[3];
};
static const struct Vertex kSquare[4] = {
    {'a', 1, {0, 0, 0}}, {'b', 1, {1, 0, 0}}, {'c', 1, {1, 1, 0}}, {'d', 1, {0, 1, 0}}};
static const unsigned kFaces[2][4] = {{0, 1, 2, 9}, {0, 2, 3, 9}};

static AlhazenScene new_square(AlhazenDevice device, unsigned mask) {
    AlhazenScene scene = alhazenNewScene(device);
    AlhazenGeometry mesh = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_TRIANGLE);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, kSquare,
                                   offsetof(struct Vertex, position), sizeof(struct Vertex), 4);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, kFaces, 0,
                                   sizeof kFaces[0], 2);
    alhazenSetGeometryMask(mesh, mask);
    alhazenCommitGeometry(mesh);
    alhazenAttachGeometry(scene, mesh);
    alhazenReleaseGeometry(mesh);
    return scene;
}

static struct AlhazenRay ray_at(float x, float y) {
    struct AlhazenRay ray;
    memset(&ray, 0, sizeof ray);
    ray.org_x = x;
    ray.org_y = y;
    ray.org_z = 2;
    ray.dir_z = -1;
    ray.tfar = INFINITY;
    ray.mask = 0xFFFFFFFFu;
    return ray;
}

/* Position i of a 4 x 4 lattice; two positions in each direction lie on the square. */
static float place(int i) { return 0.25f + 0.55f * (float)(i - 1); }
static bool is_hit(int i) { return i % 4 >= 1 && i % 4 <= 2 && i / 4 >= 1 && i / 4 <= 2; }

static void test_all_widths_agree(AlhazenDevice device) {
    AlhazenScene scene = new_square(device, 0xFFFFFFFFu);
    struct AlhazenRayHit singles[16], many[16];
    struct AlhazenRayHitd doubles[16];
    struct AlhazenRayHit16 packet;
    struct AlhazenRay16 shadows;
    struct AlhazenRay row[16];
    struct AlhazenIntersectContext context;
    int valid[16], i;
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenInitIntersectContext(&context);
    for (i = 0; i < 16; ++i) {
        memset(&singles[i], 0, sizeof singles[i]);
        memset(&doubles[i], 0, sizeof doubles[i]);
        singles[i].ray = row[i] = ray_at(place(i % 4), place(i / 4));
        many[i] = singles[i];
        doubles[i].org[0] = singles[i].ray.org_x;
        doubles[i].org[1] = singles[i].ray.org_y;
        doubles[i].org[2] = 2;
        doubles[i].dir[2] = -1;
        doubles[i].tfar = INFINITY;
        doubles[i].mask = 0xFFFFFFFFu;
        packet.ray.org_x[i] = shadows.org_x[i] = singles[i].ray.org_x;
        packet.ray.org_y[i] = shadows.org_y[i] = singles[i].ray.org_y;
        packet.ray.org_z[i] = shadows.org_z[i] = 2;
        packet.ray.dir_x[i] = packet.ray.dir_y[i] = shadows.dir_x[i] = shadows.dir_y[i] = 0;
        packet.ray.dir_z[i] = shadows.dir_z[i] = -1;
        packet.ray.tnear[i] = shadows.tnear[i] = 0;
        packet.ray.tfar[i] = shadows.tfar[i] = INFINITY;
        packet.ray.mask[i] = shadows.mask[i] = 0xFFFFFFFFu;
        packet.hit.geomID[i] = 77;
        valid[i] = i == 5 ? 0 : -1;
        alhazenIntersect1(scene, &context, &singles[i]);
    }
    context.flags = ALHAZEN_INTERSECT_CONTEXT_FLAG_COHERENT;
    alhazenIntersect1M(scene, &context, many, 16, sizeof many[0]);
    alhazenIntersect1Md(scene, NULL, doubles, 16, sizeof doubles[0]);
    alhazenIntersect16(valid, scene, &context, &packet);
    alhazenOccluded16(valid, scene, &context, &shadows);
    alhazenOccluded1M(scene, NULL, row, 16, sizeof row[0]);
    for (i = 0; i < 16; ++i) {
        EXPECT((singles[i].hit.geomID == 0) == is_hit(i));
        EXPECT((singles[i].hit.geomID == ALHAZEN_INVALID_ID) == !is_hit(i));
        EXPECT(singles[i].hit.instID[0] == ALHAZEN_INVALID_ID);
        EXPECT((row[i].tfar == -INFINITY) == is_hit(i));
        EXPECT(memcmp(&singles[i], &many[i], sizeof many[i]) == 0);
        EXPECT(doubles[i].geomID == singles[i].hit.geomID && doubles[i].primID == singles[i].hit.primID);
        if (is_hit(i)) {
            EXPECT(singles[i].ray.tfar == 2.0f && doubles[i].tfar == 2.0);
            EXPECT(singles[i].hit.Ng_z == 1.0f && doubles[i].Ng[2] == 1.0);
            /* u + v of the first triangle (0, 0) (1, 0) (1, 1) is x, u is x - y. */
            if (singles[i].hit.primID == 0) {
                EXPECT(fabsf(singles[i].hit.u - (place(i % 4) - place(i / 4))) < 1e-6f);
            }
        }
        if (i == 5) {
            EXPECT(packet.hit.geomID[i] == 77 && packet.ray.tfar[i] == INFINITY && shadows.tfar[i] == INFINITY);
        } else {
            EXPECT(packet.hit.geomID[i] == singles[i].hit.geomID);
            EXPECT(packet.ray.tfar[i] == singles[i].ray.tfar);
            EXPECT((shadows.tfar[i] == -INFINITY) == is_hit(i));
        }
    }
    alhazenReleaseScene(scene);
}

static void test_packets_of_4_and_8(AlhazenDevice device) {
    AlhazenScene scene = new_square(device, 0xFFFFFFFFu);
    struct AlhazenRayHit4 four;
    struct AlhazenRayHit8 eight;
    int i;
    alhazenCommitScene(scene);
    memset(&four, 0, sizeof four);
    memset(&eight, 0, sizeof eight);
    for (i = 0; i < 8; ++i) {
        eight.ray.org_x[i] = eight.ray.org_y[i] = 0.2f * (float)i + 0.1f;
        eight.ray.org_z[i] = 2;
        eight.ray.dir_z[i] = -1;
        eight.ray.tfar[i] = INFINITY;
        eight.ray.mask[i] = 1;
        if (i < 4) {
            four.ray.org_x[i] = four.ray.org_y[i] = eight.ray.org_x[i];
            four.ray.org_z[i] = 2;
            four.ray.dir_z[i] = -1;
            four.ray.tfar[i] = INFINITY;
            four.ray.mask[i] = 1;
        }
    }
    alhazenIntersect4(NULL, scene, NULL, &four);
    alhazenIntersect8(NULL, scene, NULL, &eight);
    alhazenOccluded4(NULL, scene, NULL, &four.ray);
    for (i = 0; i < 8; ++i) EXPECT((eight.hit.geomID[i] == 0) == (i < 5));
    for (i = 0; i < 4; ++i) EXPECT(four.hit.geomID[i] == 0 && four.ray.tfar[i] == -INFINITY);
    alhazenOccluded8(NULL, scene, NULL, &eight.ray);
    for (i = 0; i < 8; ++i) EXPECT((eight.ray.tfar[i] == -INFINITY) == (i < 5));
    alhazenReleaseScene(scene);
}

static void test_spheres_in_double_and_masks(AlhazenDevice device) {
    const double spheres[2][5] = {{0, 0, -1, 0.5, 99}, {0, 0, -4, 1, 99}};
    AlhazenScene scene = alhazenNewScene(device);
    AlhazenGeometry balls = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT);
    struct AlhazenRayHit hit;
    alhazenSetSharedGeometryBuffer(balls, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_DOUBLE4, spheres, 0,
                                   sizeof spheres[0], 2);
    alhazenSetGeometryMask(balls, 2);
    alhazenCommitGeometry(balls);
    alhazenAttachGeometryByID(scene, balls, 40);
    EXPECT(alhazenGetGeometry(scene, 40) == balls);
    alhazenReleaseGeometry(balls);
    alhazenCommitScene(scene);
    memset(&hit, 0, sizeof hit);
    hit.ray = ray_at(0, 0);
    alhazenIntersect1(scene, NULL, &hit);
    EXPECT(hit.hit.geomID == 40 && hit.hit.primID == 0 && hit.ray.tfar == 2.5f && hit.hit.Ng_z == 1.0f);
    hit.ray = ray_at(0, 0);
    hit.ray.tnear = 4;
    alhazenIntersect1(scene, NULL, &hit);
    EXPECT(hit.hit.primID == 1 && hit.ray.tfar == 5.0f);
    hit.ray = ray_at(0, 0);
    hit.ray.mask = 1;
    alhazenIntersect1(scene, NULL, &hit);
    EXPECT(hit.hit.geomID == ALHAZEN_INVALID_ID);
    alhazenReleaseScene(scene);
}

static void test_instances_outlive_their_handles(AlhazenDevice device) {
    const float moved[12] = {2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, -3}; /* rows */
    AlhazenScene inner = new_square(device, 0xFFFFFFFFu), scene = alhazenNewScene(device);
    AlhazenGeometry instance = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_INSTANCE);
    struct AlhazenRayHit hit;
    struct AlhazenBounds bounds;
    alhazenSetGeometryInstancedScene(instance, inner);
    alhazenSetGeometryTransform(instance, 0, ALHAZEN_FORMAT_FLOAT3X4_ROW_MAJOR, moved);
    alhazenCommitGeometry(instance);
    alhazenAttachGeometryByID(scene, instance, 5);
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION); /* inner is not committed */
    alhazenCommitScene(inner);
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenReleaseScene(inner);
    alhazenReleaseGeometry(instance);
    memset(&hit, 0, sizeof hit);
    hit.ray = ray_at(11.5f, 0.5f);
    alhazenIntersect1(scene, NULL, &hit);
    EXPECT(hit.hit.instID[0] == 5 && hit.hit.geomID == 0 && hit.hit.primID == 0 && hit.ray.tfar == 5.0f);
    alhazenGetSceneBounds(scene, &bounds);
    EXPECT(bounds.lower_x <= 10 && bounds.upper_x >= 12 && bounds.upper_x < 12.001f && bounds.lower_z > -3.001f);
    alhazenReleaseScene(scene);
}

static int told = 0;
static void on_error(void* user, enum AlhazenError code, const char* text) {
    *(enum AlhazenError*)user = code;
    EXPECT(strlen(text) > 5);
    ++told;
}

static void test_errors(void) {
    enum AlhazenError last = ALHAZEN_ERROR_NONE;
    AlhazenDevice device = alhazenNewDevice("threads=1, verbose=3");
    AlhazenGeometry mesh;
    AlhazenScene scene;
    struct AlhazenRayHit hit;
    struct AlhazenIntersectContext context;
    const float bad[9] = {0, 0, 0, 1, 0, 0, 0, 1, NAN};
    const unsigned face[3] = {0, 1, 3};
    EXPECT(device != NULL);
    EXPECT(alhazenNewDevice("sockets=2") == NULL);
    EXPECT(strstr(alhazenGetDeviceErrorMessage(NULL), "unknown key 'sockets'") != NULL);
    EXPECT(alhazenNewDevice("accelerator=none") == NULL);
    EXPECT(alhazenGetDeviceError(NULL) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    EXPECT(alhazenGetDeviceError(NULL) == ALHAZEN_ERROR_NONE);
    alhazenSetDeviceErrorFunction(device, on_error, &last);
    scene = alhazenNewScene(device);
    alhazenIntersect1(scene, NULL, &hit); /* not committed */
    EXPECT(last == ALHAZEN_ERROR_INVALID_OPERATION && told == 1);
    mesh = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_TRIANGLE);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_UINT3, bad, 0, 12, 3);
    EXPECT(last == ALHAZEN_ERROR_INVALID_ARGUMENT && told == 2);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION); /* the first error is kept */
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, bad, 0, 12, 3);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, face, 0, 12, 1);
    EXPECT(alhazenSetNewGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, 12, SIZE_MAX / 12) ==
           NULL);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_OUT_OF_MEMORY);
    alhazenCommitGeometry(mesh);
    alhazenAttachGeometry(scene, mesh);
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    EXPECT(strstr(alhazenGetDeviceErrorMessage(device), "vertex") != NULL);
    alhazenDisableGeometry(mesh);
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    memset(&context, 0, sizeof context); /* without alhazenInitIntersectContext */
    alhazenIntersect1(scene, &context, &hit);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenDetachGeometry(scene, 9);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenCommitScene(NULL);
    EXPECT(alhazenGetDeviceError(NULL) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenReleaseGeometry(mesh);
    alhazenReleaseScene(scene);
    alhazenReleaseScene(NULL);
    alhazenReleaseDevice(device);
}

/* The text of the error of a commit of the scene; "" if there is none. */
static const char* commit_error(AlhazenDevice device, AlhazenScene scene) {
    alhazenCommitScene(scene);
    return alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE ? "" : alhazenGetDeviceErrorMessage(device);
}

static void test_errors_of_a_commit_name_the_geometry(AlhazenDevice device) {
    const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const unsigned bad_face[3] = {0, 1, 9};
    float balls[8][4];
    float transform[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, NAN, 0, 0}; /* columns */
    AlhazenScene scene = alhazenNewScene(device), inner = new_square(device, 1), outer = alhazenNewScene(device);
    AlhazenGeometry spheres = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT);
    AlhazenGeometry mesh = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_TRIANGLE);
    AlhazenGeometry instance = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_INSTANCE);
    const char* text;
    int i;
    for (i = 0; i < 8; ++i) {
        balls[i][0] = (float)i;
        balls[i][1] = balls[i][2] = 0;
        balls[i][3] = 0.1f;
    }
    alhazenSetSharedGeometryBuffer(spheres, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT4, balls, 0, 16, 8);
    alhazenCommitGeometry(spheres);
    alhazenAttachGeometryByID(scene, spheres, 3);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, points, 0, 12, 3);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, bad_face, 0, 12, 1);
    alhazenCommitGeometry(mesh);
    alhazenAttachGeometryByID(scene, mesh, 7);
    text = commit_error(device, scene);
    EXPECT(strncmp(text, "geometry 7: error: mesh: triangle 0 uses vertex 9", 49) == 0);
    balls[5][3] = -1;
    text = commit_error(device, scene);
    EXPECT(strncmp(text, "geometry 3, primitive 5: error: sphere: radius", 46) == 0);
    alhazenAttachGeometryByID(outer, instance, 42);
    alhazenCommitGeometry(instance);
    EXPECT(strncmp(commit_error(device, outer), "geometry 42: an instance has no scene", 37) == 0);
    alhazenSetGeometryInstancedScene(instance, inner);
    alhazenSetGeometryTransform(instance, 0, ALHAZEN_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform);
    EXPECT(strncmp(commit_error(device, outer), "geometry 42: the scene of an instance is not", 44) == 0);
    alhazenCommitScene(inner);
    text = commit_error(device, outer);
    EXPECT(strcmp(text, "geometry 42: the transform is singular or not finite") == 0);
    alhazenReleaseGeometry(spheres);
    alhazenReleaseGeometry(mesh);
    alhazenReleaseGeometry(instance);
    alhazenReleaseScene(scene);
    alhazenReleaseScene(inner);
    alhazenReleaseScene(outer);
}

static void test_buffers_beyond_all_memory(AlhazenDevice device) {
#ifndef ALHAZEN_SANITIZED /* Clang's AddressSanitizer ends the program where `new` should throw */
    size_t i;
    for (i = 0; i < 40; ++i) { /* also sizes that the padding carries over the limit */
        EXPECT(alhazenNewBuffer(device, SIZE_MAX / 2 - i) == NULL);
        EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_OUT_OF_MEMORY);
    }
#endif
    EXPECT(alhazenNewBuffer(device, SIZE_MAX) == NULL);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_OUT_OF_MEMORY);
}

static ssize_t bytes_held = 0;
static int memory_calls = 0;
static bool allow_memory = true;
static bool on_memory(void* user, ssize_t bytes, bool post) {
    (void)user;
    (void)post;
    ++memory_calls;
    if (!allow_memory) return false;
    bytes_held += bytes;
    return true;
}
static bool refuse_the_tree(void* user, ssize_t bytes, bool post) {
    (void)user;
    bytes_held += bytes;
    return !(post && bytes > 0);
}
static double last_done = -1;
static bool on_progress(void* user, double done) {
    EXPECT(done >= last_done && done <= 1);
    last_done = done;
    return user == NULL;
}

static void test_monitors(void) {
    AlhazenDevice device = alhazenNewDevice(NULL);
    AlhazenScene scene;
    int stop = 1;
    alhazenSetDeviceMemoryMonitorFunction(device, on_memory, NULL);
    scene = new_square(device, 0xFFFFFFFFu);
    alhazenSetSceneProgressMonitorFunction(scene, on_progress, NULL);
    alhazenCommitScene(scene);
    EXPECT(last_done == 1 && memory_calls >= 2 && bytes_held > 0);
    last_done = -1;
    alhazenSetSceneProgressMonitorFunction(scene, on_progress, &stop);
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_CANCELLED);
    alhazenSetSceneProgressMonitorFunction(scene, NULL, NULL);
    allow_memory = false;
    alhazenCommitScene(scene);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_OUT_OF_MEMORY);
    allow_memory = true;
    alhazenSetDeviceMemoryMonitorFunction(device, refuse_the_tree, NULL);
    {
        const ssize_t before = bytes_held;
        alhazenCommitScene(scene);
        EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_OUT_OF_MEMORY);
        EXPECT(bytes_held == before); /* the tree was built, and is freed */
    }
    alhazenReleaseScene(scene);
    EXPECT(bytes_held == 0);
    alhazenReleaseDevice(device);
}

int main(void) {
    AlhazenDevice device = alhazenNewDevice(NULL);
    EXPECT(device != NULL);
    EXPECT(alhazenGetDeviceProperty(device, ALHAZEN_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) == 1);
    test_all_widths_agree(device);
    test_packets_of_4_and_8(device);
    test_spheres_in_double_and_masks(device);
    test_instances_outlive_their_handles(device);
    test_errors();
    test_errors_of_a_commit_name_the_geometry(device);
    test_buffers_beyond_all_memory(device);
    test_monitors();
    alhazenReleaseDevice(device);
    printf("%d failures\n", failures);
    return failures == 0 ? 0 : 1;
}
