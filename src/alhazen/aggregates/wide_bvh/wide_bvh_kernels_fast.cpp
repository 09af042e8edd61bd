// Nodes of 8 children, triangles in single precision.
#define ALHAZEN_KERNELS_FUNCTION wide_bvh_kernels_fast
#define ALHAZEN_KERNELS_WIDTH 8
#define ALHAZEN_KERNELS_TEST FloatTriangleTest
#include "alhazen/aggregates/wide_bvh/kernels-inl.h"
