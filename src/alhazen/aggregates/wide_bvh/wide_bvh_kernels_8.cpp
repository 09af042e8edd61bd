// Nodes of 8 children.
#define ALHAZEN_KERNELS_FUNCTION wide_bvh_kernels_8
#define ALHAZEN_KERNELS_WIDTH 8
#define ALHAZEN_KERNELS_TEST FilteredTriangleTest
#include "alhazen/aggregates/wide_bvh/kernels-inl.h"
