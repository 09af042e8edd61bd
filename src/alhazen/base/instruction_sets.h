#pragma once
/// Compiles a function of scalar arithmetic twice, with and without fused multiply-add and AVX; the
/// version for the processor is chosen at program start.
///
/// `ALHAZEN_FOR_EACH_INSTRUCTION_SET(head, result)` defines the function `head`, which returns
/// `result`: a call of the function that does the work.
/// Source: GCC manual, "Function Multiversioning", "Common Function Attributes" (flatten).
/// Conventions: contraction is off in both versions, so both give the same bits; the gain is that
/// std::fma is an instruction instead of a call. For large free functions only: a call has a cost,
/// and both versions share one symbol. Only one version is compiled by other compilers, for other
/// machines, and with sanitizers, which run before the choice is made.

#if defined(__x86_64__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// flatten: called functions are compiled for the version's instructions only where they are
// inlined.
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET(head, result)        \
    __attribute__((target("default"))) head {                 \
        return result;                                        \
    }                                                         \
    __attribute__((flatten, target("arch=x86-64-v3"))) head { \
        return result;                                        \
    }
#else
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET(head, result) \
    head {                                             \
        return result;                                 \
    }
#endif
