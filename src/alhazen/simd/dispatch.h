#pragma once
/// Selects among the kernels of a source that is compiled once for each instruction set.
///
/// Conventions: included after <hwy/highway.h>, once for all targets (under HWY_ONCE). `kernel` is
/// a function of HWY_NAMESPACE, compiled for every target of the source.

#include <hwy/targets.h>

namespace alhazen {

/// The targets that kernels are chosen among: those of this machine, or the forced one.
[[nodiscard]] const hwy::ChosenTarget& chosen_simd_target();

}  // namespace alhazen

/// The table of a kernel, with one entry for each instruction set. Placed at the scope of the
/// kernel's own namespace.
#define ALHAZEN_KERNEL_TABLE(kernel)                                                   \
    static decltype(&HWY_STATIC_DISPATCH(kernel))                                      \
        const kernel##_table[] = {nullptr, /* Highway's entry for a choice not made */ \
                                  HWY_CHOOSE_TARGET_LIST(kernel), HWY_CHOOSE_FALLBACK(kernel)}

/// The kernel of the best instruction set.
#define ALHAZEN_KERNEL(kernel) (*kernel##_table[alhazen::chosen_simd_target().GetIndex()])
