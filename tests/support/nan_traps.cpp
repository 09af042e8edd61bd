/// Traps invalid floating-point operations (those that create or order a NaN) while a test runs, if
/// the environment variable ALHAZEN_TRAP_NAN is set. Linked into the test programs of modules that
/// create no NaN; CTest excludes tests that use NaN on purpose. A test begins with a stack full of
/// NaNs that signal: what reads a number that was never set is trapped, too.

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <cstdlib>

namespace {

#ifdef __GLIBC__
/// Fills the stack below the caller.
[[gnu::noinline]] void fill_stack() {
    // As a double it signals; of its floats the lower one does, and the upper one is quiet.
    constexpr std::uint64_t kNan = 0x7FF0'0001'7FA0'0000;
    volatile std::uint64_t stack[1 << 16];
    for (volatile std::uint64_t& word : stack) word = kNan;
}

class NanTraps final : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override {
        std::feclearexcept(FE_INVALID);
        fill_stack();
        feenableexcept(FE_INVALID);
    }
    void OnTestEnd(const testing::TestInfo&) override { fedisableexcept(FE_INVALID); }
};

[[maybe_unused]] const bool installed = [] {
    if (std::getenv("ALHAZEN_TRAP_NAN") == nullptr) return false;
    testing::UnitTest::GetInstance()->listeners().Append(new NanTraps);
    return true;
}();
#endif

}  // namespace
