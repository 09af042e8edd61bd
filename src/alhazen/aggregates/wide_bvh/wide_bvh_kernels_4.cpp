// Nodes of 4 children.
#define ALHAZEN_KERNELS wide_bvh_kernels_4
#define ALHAZEN_KERNELS_WIDTH 4
#define ALHAZEN_KERNELS_TEST FilteredTriangleTest
#include "alhazen/aggregates/wide_bvh/kernels-inl.h"
