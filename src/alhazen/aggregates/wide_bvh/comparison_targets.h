#pragma once
/// The instruction sets of kernels that only comparisons need: all but AVX-512. Included first.
///
/// AVX-512 fuses as AVX2 does, so that counts of tests are those of the set.

#include <hwy/detect_targets.h>
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3)
