/// Traps invalid floating-point operations (those that create or order a NaN) while a test runs, if
/// the environment variable ALHAZEN_TRAP_NAN is set. Linked into the test programs of modules that
/// create no NaN; CTest excludes tests that use NaN on purpose.

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
