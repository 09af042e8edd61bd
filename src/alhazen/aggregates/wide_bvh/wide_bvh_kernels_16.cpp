// Nodes of 16 children.
#define ALHAZEN_KERNELS wide_bvh_kernels_16
#define ALHAZEN_KERNELS_WIDTH 16
#define ALHAZEN_KERNELS_TEST FilteredTriangleTest
#include "alhazen/aggregates/wide_bvh/kernels-inl.h"
