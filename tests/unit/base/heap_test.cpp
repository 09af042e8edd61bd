#include "alhazen/base/heap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <cstring>
#include <memory>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

long faults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

/// Faults of pages while a block of the heap is set.
long faults_of_block(std::size_t bytes) {
    const auto block = std::make_unique_for_overwrite<char[]>(bytes);
    const long before = faults();
    std::memset(block.get(), 1, bytes);
    return faults() - before;
}

TEST(Heap, WhatIsFreedIsNotTouchedAnew) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "another heap";
#endif
    prepare_heap();
    constexpr std::size_t kPage = 4096;
    for (const std::size_t bytes : {std::size_t{3} << 20, std::size_t{6} << 20}) {
        (void)faults_of_block(bytes);
        EXPECT_LT(faults_of_block(bytes), long(bytes / kPage / 4)) << bytes << " bytes";
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
