#pragma once
/// Compiles a function of scalar arithmetic twice, with and without fused multiply-add and AVX; the
/// version for the processor is chosen when the program starts.
///
/// `ALHAZEN_FOR_EACH_INSTRUCTION_SET(head, result)` defines the function `head` that returns
/// `result`, a call of a function with all of the work.
/// Source: GCC manual, "Function Multiversioning", "Common Function Attributes" (flatten).
/// Conventions: contraction is off in both versions, so that both give the same bits; the gain is
/// that std::fma is an instruction and not a call. For large, free functions only: a call costs,
/// and both versions share one symbol. One version for other compilers, other machines, and with
/// sanitizers, which run before the choice is made.

#if defined(__x86_64__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// flatten: what is called is compiled for the version's instructions only where it is inlined.
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
