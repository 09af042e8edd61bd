#pragma once
/// The instruction sets of kernels used only for comparisons: all but AVX-512. Included first.
///
/// AVX-512 fuses as AVX2 does, so it gives the same counts of tests.

#include <hwy/detect_targets.h>
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
    (HWY_SSSE3 | HWY_AVX3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
