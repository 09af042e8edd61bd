/// Trap at invalid floating-point operations (those that make a NaN, or order one) while a test
/// runs, where the environment variable ALHAZEN_TRAP_NAN is set. Linked into the programs whose
/// rooms promise none; tests that feed NaN on purpose are left out where CTest starts them.

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdlib>

namespace {

#ifdef __GLIBC__
class NanTraps final : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override {
        std::feclearexcept(FE_INVALID);
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
