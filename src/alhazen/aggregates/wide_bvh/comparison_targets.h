#pragma once
/// The instruction sets of kernels that only comparisons need: AVX2 and plain C++. Included first.
///
/// AVX-512 fuses as AVX2 does and SSE4 does not, as plain C++, so that counts of tests are those of
/// the set.

#include <hwy/detect_targets.h>
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
