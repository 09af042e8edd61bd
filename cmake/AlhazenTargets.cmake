# One place for the flags that carry the guarantees, and the two functions every folder uses.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()

include(CheckCXXCompilerFlag)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g")

add_library(alhazen_flags INTERFACE)
target_include_directories(alhazen_flags INTERFACE "${CMAKE_SOURCE_DIR}/src")
target_compile_options(alhazen_flags INTERFACE
    # Contraction would give the two owners of an edge different signs: it is off everywhere.
    -ffp-contract=off -fno-math-errno -fstack-protector-strong
    # GCC 12 turns double(float(x)) into x where two such conversions stand side by side (seen at -O2):
    # boxes that are rounded outward through float would not be.
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
    -Woverloaded-virtual -Wimplicit-fallthrough -Wundef
    # Designated initialisers leave the other fields to their defaults on purpose.
    -Wno-missing-field-initializers
    $<$<BOOL:${ALHAZEN_WERROR}>:-Werror>
    # GCC says of wide vectors that it passed them otherwise in 2010.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
target_compile_definitions(alhazen_flags INTERFACE
    ALHAZEN_VERSION="${PROJECT_VERSION}"
    $<$<NOT:$<BOOL:${ALHAZEN_BENCH}>>:_GLIBCXX_ASSERTIONS>)
if(CMAKE_BUILD_TYPE STREQUAL "Release" OR CMAKE_BUILD_TYPE STREQUAL "RelWithDebInfo")
    target_compile_definitions(alhazen_flags INTERFACE _FORTIFY_SOURCE=2)
endif()
if(ALHAZEN_SANITIZE)
    target_compile_options(alhazen_flags INTERFACE
        -fsanitize=${ALHAZEN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(alhazen_flags INTERFACE -fsanitize=${ALHAZEN_SANITIZE})
endif()

# The options of kernels: files compiled once per instruction set (src/alhazen/simd/lanes-inl.h).
set(ALHAZEN_KERNEL_OPTIONS)
# No 512-bit registers for copies either: see LaneTag in simd/lanes-inl.h.
check_cxx_compiler_flag(-mmove-max=256 ALHAZEN_HAS_MOVE_MAX)
if(ALHAZEN_HAS_MOVE_MAX)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -mmove-max=256 -mstore-max=256)
endif()
# Queries are copied as a whole: by the library's memcpy, not by rep movs (docs/design/build.md).
check_cxx_compiler_flag(-mmemcpy-strategy=libcall:-1:noalign ALHAZEN_HAS_MEMCPY_STRATEGY)
if(ALHAZEN_HAS_MEMCPY_STRATEGY)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -mmemcpy-strategy=libcall:-1:noalign)
endif()
# ALHAZEN_KERNEL_TARGETS: definitions that choose the instruction sets.
set(ALHAZEN_KERNEL_TARGETS)
if(ALHAZEN_FUZZ)
    # The fuzzers trace no ray: one instruction set, without sanitizers in it, is enough.
    set(ALHAZEN_KERNEL_TARGETS HWY_COMPILE_ONLY_STATIC)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -fno-sanitize=all)
elseif(ALHAZEN_KERNELS STREQUAL "native")
    set(ALHAZEN_KERNEL_TARGETS HWY_COMPILE_ONLY_STATIC)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -march=native)
endif()

# alhazen_library(NAME SOURCES file... KERNELS file... DEPENDS room... LIBRARIES target... PRIVATE_LIBRARIES target...)
# makes the target alhazen_NAME of one room of src/alhazen. Without sources it is header-only. Our flags stay
# inside of this build: who uses an installed library has the few of AlhazenInstall.cmake.
# Sources are compiled several to a unit (unity build), kernels one by one.
function(alhazen_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;KERNELS;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    if(ARG_SOURCES)
        add_library(alhazen_${name} STATIC ${ARG_SOURCES} ${ARG_KERNELS})
        target_link_libraries(alhazen_${name} PUBLIC $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES}
                              PRIVATE ${ARG_PRIVATE_LIBRARIES})
        set_target_properties(alhazen_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10
                              UNITY_BUILD_UNIQUE_ID ALHAZEN_UNITY_ID)
        set_source_files_properties(${ARG_KERNELS} PROPERTIES
            SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON
            COMPILE_DEFINITIONS "${ALHAZEN_KERNEL_TARGETS}" COMPILE_OPTIONS "${ALHAZEN_KERNEL_OPTIONS}")
    else()
        add_library(alhazen_${name} INTERFACE)
        target_link_libraries(alhazen_${name} INTERFACE $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES})
    endif()
endfunction()

# Tests are compiled quickly: their own speed hardly counts. -fpch-preprocess lets ccache see through the precompiled header.
set(ALHAZEN_TEST_OPTIONS -O1 $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;-Wno-shadow>)

# alhazen_test(NAME [LABEL label] SOURCES file... DEPENDS folder...) makes the GoogleTest program
# alhazen_NAME_test. Tests labelled "heavy" do not belong to the everyday run.
function(alhazen_test name)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    set(target alhazen_${name}_test)
    add_executable(${target} ${ARG_SOURCES})
    target_link_libraries(${target} PRIVATE alhazen_flags alhazen_test_support ${ARG_DEPENDS} ${ARG_LIBRARIES}
                          GTest::gtest_main)
    target_precompile_headers(${target} REUSE_FROM alhazen_test_headers)
    target_compile_options(${target} PRIVATE ${ALHAZEN_TEST_OPTIONS})
    if(NOT ARG_LABEL)
        set(ARG_LABEL fast)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 600)
    endif()
    add_test(NAME ${name} COMMAND ${target})
    set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()
