// Nodes of 16 children: for AVX2 and plain C++ only. They are there to be compared with nodes of 8;
// AVX-512 fuses as AVX2 does and SSE4 does not as plain C++, so that counts of tests stay those of
// the set.
#include <hwy/detect_targets.h>
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)

#define ALHAZEN_KERNELS_FUNCTION wide_bvh_kernels_16
#define ALHAZEN_KERNELS_WIDTH 16
#define ALHAZEN_KERNELS_TEST FilteredTriangleTest
#include "alhazen/aggregates/wide_bvh/kernels-inl.h"
