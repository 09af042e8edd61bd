#include "instruction_count.h"

#include <fmt/format.h>

#include "alhazen/base/error.h"

#if defined(__linux__) && defined(__x86_64__)
#include <signal.h>
#include <ucontext.h>
#endif

namespace alhazen::bench {

#if defined(__linux__) && defined(__x86_64__)
namespace {

// Written by the signal handler of the stepped thread alone.
std::uint64_t steps = 0;
greg_t last_place = 0;

/// Called after each instruction, and after each turn of a repeated one, which stays in its place.
void step(int, siginfo_t*, void* context) {
    const greg_t place = static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
    if (place != last_place) ++steps;
    last_place = place;
}

/// Sets or clears the trap flag: bit 8 of the flags. The red zone below the stack is left alone.
[[gnu::noinline]] void begin_steps() {
    asm volatile(
        "lea -128(%%rsp), %%rsp\n pushfq\n orq $0x100, (%%rsp)\n popfq\n lea 128(%%rsp), %%rsp" ::
            : "cc", "memory");
}
[[gnu::noinline]] void end_steps() {
    asm volatile(
        "lea -128(%%rsp), %%rsp\n pushfq\n andq $~0x100, (%%rsp)\n popfq\n lea 128(%%rsp), "
        "%%rsp" ::
            : "cc", "memory");
}

std::uint64_t steps_of(const std::function<void()>& call) {
    steps = 0;
    last_place = 0;
    begin_steps();
    call();
    end_steps();
    return steps;
}

}  // namespace

std::uint64_t count_instructions(const std::function<void()>& call) {
    struct sigaction action {
    }, before{};
    action.sa_sigaction = step;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGTRAP, &action, &before);
    const std::uint64_t around = steps_of([] {});
    const std::uint64_t all = steps_of(call);
    sigaction(SIGTRAP, &before, nullptr);
    return all - around;
}

void check_instruction_count() {
    constexpr std::uint64_t kTurns = 1000;
    const auto loop = [](std::uint64_t turns) {
        return count_instructions([turns]() mutable {
            asm volatile("1: dec %0\n jnz 1b" : "+r"(turns)::"cc");
        });
    };
    const std::uint64_t counted = loop(2 * kTurns) - loop(kTurns);
    if (counted != 2 * kTurns) {
        throw Error(ErrorKind::Render,
                    fmt::format("{} instructions count as {}", 2 * kTurns, counted));
    }
}
#else
std::uint64_t count_instructions(const std::function<void()>&) {
    throw Error(ErrorKind::Usage, "instructions are counted on Linux on x86-64 only");
}

void check_instruction_count() {
    (void)count_instructions({});
}
#endif

}  // namespace alhazen::bench
