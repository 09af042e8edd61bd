/* Tests callbacks that call the library, scenes that contain themselves, streams without rays. Prints failures. */
#include <alhazen/alhazen.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;
#define EXPECT(condition)                                                        \
    do {                                                                         \
        if (!(condition)) {                                                      \
            printf("callbacks_test.c:%d: not true: %s\n", __LINE__, #condition); \
            ++failures;                                                          \
        }                                                                        \
    } while (0)

static AlhazenDevice device;
static AlhazenScene scene;
static ssize_t bytes_held = 0;
static int asked = 0;

static AlhazenGeometry new_triangle(void) {
    static const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned corners[3] = {0, 1, 2};
    AlhazenGeometry mesh = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_TRIANGLE);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, points, 0, 12, 3);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, corners, 0, 12, 1);
    alhazenCommitGeometry(mesh);
    return mesh;
}

/* All calls that lock a scene. */
static void ask_the_scene(void) {
    AlhazenGeometry mesh;
    unsigned id;
    if (scene == NULL) return;
    mesh = new_triangle();
    id = alhazenAttachGeometry(scene, mesh);
    EXPECT(alhazenGetGeometry(scene, id) == mesh);
    alhazenDetachGeometry(scene, id);
    alhazenReleaseGeometry(mesh);
    ++asked;
}
static bool on_progress(void* user, double done) {
    (void)user;
    (void)done;
    ask_the_scene();
    alhazenCommitScene(scene); /* within its own commit */
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION);
    return true;
}
static bool on_memory(void* user, ssize_t bytes, bool post) {
    (void)user;
    (void)post;
    bytes_held += bytes;
    ask_the_scene();
    return true;
}

static void test_monitors_may_ask_the_scene(void) {
    AlhazenGeometry mesh = new_triangle();
    struct AlhazenRayHit hit;
    scene = alhazenNewScene(device);
    alhazenAttachGeometry(scene, mesh);
    alhazenReleaseGeometry(mesh);
    alhazenSetSceneProgressMonitorFunction(scene, on_progress, NULL);
    alhazenSetDeviceMemoryMonitorFunction(device, on_memory, NULL);
    alhazenCommitScene(scene);
    alhazenJoinCommitScene(scene);
    EXPECT(asked >= 8 && bytes_held > 0);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    memset(&hit, 0, sizeof hit);
    hit.ray.org_x = hit.ray.org_y = 0.25f;
    hit.ray.org_z = 1;
    hit.ray.dir_z = -1;
    hit.ray.tfar = INFINITY;
    hit.ray.mask = 1;
    alhazenIntersect1(scene, NULL, &hit);
    EXPECT(hit.hit.geomID == 0 && hit.ray.tfar == 1.0f);
    alhazenSetSceneProgressMonitorFunction(scene, NULL, NULL);
    alhazenReleaseScene(scene);
    scene = NULL;
    alhazenSetDeviceMemoryMonitorFunction(device, NULL, NULL);
    EXPECT(bytes_held == 0);
}

static AlhazenGeometry instance_of(AlhazenScene inner) {
    AlhazenGeometry instance = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_INSTANCE);
    if (inner != NULL) alhazenSetGeometryInstancedScene(instance, inner);
    alhazenCommitGeometry(instance);
    return instance;
}

static void test_a_scene_is_no_instance_in_itself(void) {
    AlhazenScene a = alhazenNewScene(device), b = alhazenNewScene(device);
    AlhazenGeometry of_a = instance_of(a), of_b = instance_of(b), empty = instance_of(NULL);
    alhazenAttachGeometry(a, of_a);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION);
    EXPECT(strstr(alhazenGetDeviceErrorMessage(device), "an instance in itself") != NULL);
    alhazenAttachGeometry(a, of_b);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenAttachGeometryByID(b, of_a, 7); /* through a */
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION);
    alhazenAttachGeometry(b, empty);
    alhazenSetGeometryInstancedScene(empty, a);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_OPERATION);
    alhazenDetachGeometry(a, 0);
    alhazenSetGeometryInstancedScene(empty, a); /* a is empty */
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenReleaseGeometry(of_a);
    alhazenReleaseGeometry(of_b);
    alhazenReleaseGeometry(empty);
    alhazenReleaseScene(a);
    alhazenReleaseScene(b);
}

static char told[100];
static int times_told = 0;
static void on_error(void* user, enum AlhazenError code, const char* text) {
    (void)user;
    (void)code;
    ++times_told;
    alhazenDetachGeometry(scene, 12345); /* fails too */
    strncpy(told, text, sizeof told - 1);
}

static void test_the_outer_error_keeps_its_text(void) {
    scene = alhazenNewScene(device);
    alhazenSetDeviceErrorFunction(device, on_error, NULL);
    alhazenAttachGeometry(scene, NULL);
    alhazenSetDeviceErrorFunction(device, NULL, NULL);
    EXPECT(times_told == 1);
    EXPECT(strcmp(told, "the geometry is NULL") == 0);
    EXPECT(strcmp(alhazenGetDeviceErrorMessage(device), "the geometry is NULL") == 0);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenReleaseScene(scene);
    scene = NULL;
}

static int ends_told = 0;
static bool release_and_end(void* user, double done) {
    (void)user;
    (void)done;
    alhazenReleaseScene(scene);
    return false;
}
static void note_end(void* user, enum AlhazenError code, const char* text) {
    EXPECT(*(int*)user == 7); /* read through the device */
    EXPECT(code == ALHAZEN_ERROR_CANCELLED && strstr(text, "ended the commit") != NULL);
    ++ends_told;
}

static void test_a_monitor_may_release_the_last_reference(void) {
    int seven = 7;
    AlhazenDevice held = device;
    device = alhazenNewDevice(NULL);
    scene = alhazenNewScene(device);
    alhazenSetDeviceErrorFunction(device, note_end, &seven);
    alhazenSetSceneProgressMonitorFunction(scene, release_and_end, NULL);
    alhazenReleaseDevice(device); /* the scene holds it */
    alhazenCommitScene(scene);
    EXPECT(ends_told == 1);
    scene = NULL;
    device = held;
}

static bool end_at_last(void* user, double done) {
    *(double*)user = done;
    return done < 1;
}
static void test_the_last_report_does_not_end_a_commit(void) {
    double last = 0;
    struct AlhazenBounds bounds;
    AlhazenScene done = alhazenNewScene(device);
    alhazenSetSceneProgressMonitorFunction(done, end_at_last, &last);
    alhazenCommitScene(done);
    alhazenGetSceneBounds(done, &bounds);
    EXPECT(last == 1 && alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenReleaseScene(done);
}

static void test_no_rays_are_nothing_to_do(void) {
    AlhazenScene empty = alhazenNewScene(device);
    alhazenCommitScene(empty);
    alhazenIntersect1M(empty, NULL, NULL, 0, 0);
    alhazenIntersect1Mp(empty, NULL, NULL, 0);
    alhazenIntersectNM(empty, NULL, NULL, 0, 0, 0);
    alhazenIntersectNp(empty, NULL, NULL, 0);
    alhazenIntersect1Md(empty, NULL, NULL, 0, 0);
    alhazenOccluded1M(empty, NULL, NULL, 0, 0);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    alhazenIntersect1M(empty, NULL, NULL, 1, 0);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenReleaseScene(empty);
}

static void test_items_stay_within_their_buffer(void) {
    AlhazenBuffer buffer = alhazenNewBuffer(device, 40);
    AlhazenGeometry mesh = new_triangle();
    alhazenSetGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, buffer, 4, 12, 3);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    EXPECT(alhazenGetGeometryBufferData(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0) == (char*)alhazenGetBufferData(buffer) + 4);
    alhazenSetGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, buffer, 8, 12, 3);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenSetGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, buffer, 0, SIZE_MAX / 2, 3);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_INVALID_ARGUMENT);
    alhazenReleaseBuffer(buffer);
    alhazenReleaseGeometry(mesh);
}

int main(void) {
    device = alhazenNewDevice(NULL);
    test_monitors_may_ask_the_scene();
    test_a_scene_is_no_instance_in_itself();
    test_the_outer_error_keeps_its_text();
    test_a_monitor_may_release_the_last_reference();
    test_the_last_report_does_not_end_a_commit();
    test_no_rays_are_nothing_to_do();
    test_items_stay_within_their_buffer();
    alhazenReleaseDevice(device);
    printf("%d failures\n", failures);
    return failures == 0 ? 0 : 1;
}
