/* Tests the C interface by threads: commits that join, queries of one scene, scenes of a thread, errors. Prints
 * failures; what ThreadSanitizer reports is a failure, too. */
#define _POSIX_C_SOURCE 200809L
#include <alhazen/alhazen.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { kThreads = 6, kSide = 24, kRounds = 20 };

static pthread_mutex_t failures_mutex = PTHREAD_MUTEX_INITIALIZER;
static int failures = 0;
#define EXPECT(condition)                                                       \
    do {                                                                        \
        if (!(condition)) {                                                     \
            pthread_mutex_lock(&failures_mutex);                                \
            printf("threads_test.c:%d: not true: %s\n", __LINE__, #condition);  \
            ++failures;                                                         \
            pthread_mutex_unlock(&failures_mutex);                              \
        }                                                                       \
    } while (0)

static AlhazenDevice device;
static AlhazenScene shared;
static pthread_barrier_t barrier;
static float points[(kSide + 1) * (kSide + 1)][3];
static unsigned corners[2 * kSide * kSide][3];

/* A hilly square from (0, 0) to (1, 1). */
static void make_hills(void) {
    int i, k = 0;
    for (i = 0; i < (kSide + 1) * (kSide + 1); ++i) {
        points[i][0] = (float)(i % (kSide + 1)) / kSide;
        points[i][1] = (float)(i / (kSide + 1)) / kSide;
        points[i][2] = 0.1f * sinf(9 * points[i][0]) * cosf(7 * points[i][1]);
    }
    for (i = 0; i < kSide * kSide; ++i) {
        const unsigned a = (unsigned)(i / kSide * (kSide + 1) + i % kSide), b = a + kSide + 1;
        const unsigned pair[2][3] = {{a, a + 1, b}, {b, a + 1, b + 1}};
        memcpy(corners[k], pair, sizeof pair);
        k += 2;
    }
}

static AlhazenGeometry new_hills(void) {
    AlhazenGeometry mesh = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_TRIANGLE);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_VERTEX, 0, ALHAZEN_FORMAT_FLOAT3, points, 0,
                                   sizeof points[0], sizeof points / sizeof points[0]);
    alhazenSetSharedGeometryBuffer(mesh, ALHAZEN_BUFFER_TYPE_INDEX, 0, ALHAZEN_FORMAT_UINT3, corners, 0,
                                   sizeof corners[0], sizeof corners / sizeof corners[0]);
    alhazenCommitGeometry(mesh);
    return mesh;
}

static struct AlhazenRayHit ray_at(int i) {
    struct AlhazenRayHit ray;
    memset(&ray, 0, sizeof ray);
    ray.ray.org_x = 0.013f + 0.97f * (float)(i % 8) / 8;
    ray.ray.org_y = 0.017f + 0.97f * (float)(i / 8) / 8;
    ray.ray.org_z = 2;
    ray.ray.dir_x = 0.01f;
    ray.ray.dir_z = -1;
    ray.ray.tfar = INFINITY;
    ray.ray.mask = 0xFFFFFFFFu;
    ray.hit.geomID = ALHAZEN_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = ALHAZEN_INVALID_GEOMETRY_ID;
    return ray;
}

/* The sum of the distances of 64 rays, traced one by one or together. */
static double trace(AlhazenScene scene, bool together) {
    struct AlhazenRayHit rays[64];
    struct AlhazenIntersectContext context;
    double sum = 0;
    int i;
    alhazenInitIntersectContext(&context);
    for (i = 0; i < 64; ++i) rays[i] = ray_at(i);
    if (together) alhazenIntersect1M(scene, &context, rays, 64, sizeof rays[0]);
    for (i = 0; i < 64; ++i) {
        if (!together) alhazenIntersect1(scene, &context, &rays[i]);
        EXPECT(rays[i].hit.geomID != ALHAZEN_INVALID_GEOMETRY_ID);
        sum += rays[i].ray.tfar;
    }
    return sum;
}

static double expected;

/* A scene of this thread, with the shared one as an instance. */
static void build_around_shared(void) {
    AlhazenScene own = alhazenNewScene(device);
    AlhazenGeometry instance = alhazenNewGeometry(device, ALHAZEN_GEOMETRY_TYPE_INSTANCE);
    alhazenSetGeometryInstancedScene(instance, shared);
    alhazenCommitGeometry(instance);
    alhazenAttachGeometry(own, instance);
    alhazenReleaseGeometry(instance);
    alhazenCommitScene(own);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    EXPECT(trace(own, true) == expected);
    alhazenReleaseScene(own);
}

static void* work(void* number) {
    const int mine = *(const int*)number;
    int round;
    pthread_barrier_wait(&barrier);
    alhazenJoinCommitScene(shared);
    EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
    pthread_barrier_wait(&barrier);
    if (mine == 0) expected = trace(shared, false);
    pthread_barrier_wait(&barrier);
    for (round = 0; round < kRounds; ++round) {
        alhazenRetainScene(shared);
        EXPECT(trace(shared, (mine + round) % 2 == 0) == expected);
        if (round % 5 == mine % 5) build_around_shared();
        if (mine % 2 == 1) {
            alhazenNewGeometry(device, (enum AlhazenGeometryType)12345);
            EXPECT(alhazenGetDeviceError(device) != ALHAZEN_ERROR_NONE);
        }
        EXPECT(alhazenGetDeviceError(device) == ALHAZEN_ERROR_NONE);
        alhazenReleaseScene(shared);
    }
    return NULL;
}

int main(void) {
    pthread_t threads[kThreads];
    int numbers[kThreads], i;
    AlhazenGeometry mesh;
    make_hills();
    device = alhazenNewDevice("threads=2");
    shared = alhazenNewScene(device);
    mesh = new_hills();
    alhazenAttachGeometry(shared, mesh);
    alhazenReleaseGeometry(mesh);
    pthread_barrier_init(&barrier, NULL, kThreads);
    for (i = 0; i < kThreads; ++i) {
        numbers[i] = i;
        pthread_create(&threads[i], NULL, work, &numbers[i]);
    }
    for (i = 0; i < kThreads; ++i) pthread_join(threads[i], NULL);
    pthread_barrier_destroy(&barrier);
    alhazenReleaseScene(shared);
    alhazenReleaseDevice(device);
    printf("%d failures\n", failures);
    return failures != 0;
}
