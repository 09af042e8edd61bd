#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

namespace alhazen {

WideBvhKernels wide_bvh_kernels(std::uint32_t width, Precision precision) {
    if (precision == Precision::Fast) {
        WideBvhKernels kernels = wide_bvh_kernels_fast();
        kernels.all_hits = wide_bvh_kernels_8().all_hits;
        kernels.shadowed = wide_bvh_kernels_8().shadowed;
        return kernels;
    }
    if (width == 4) return wide_bvh_kernels_4();
    if (width == 16) return wide_bvh_kernels_16();
    return wide_bvh_kernels_8();
}

}  // namespace alhazen
