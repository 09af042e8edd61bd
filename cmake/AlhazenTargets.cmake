# One place for the flags that carry the guarantees, and the two functions every folder uses.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()

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
    # With precompiled headers GCC 12 inlines std::string otherwise, and sees overflows that cannot be (its bug 105651);
    # and names of headers that a file does not include are shadowed.
    $<$<AND:$<BOOL:${ALHAZEN_QUICK_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-error=invalid-pch;-Wno-shadow>
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

# alhazen_precompile(TARGET header...): where ALHAZEN_QUICK_BUILD is on, compiles these once for the target.
function(alhazen_precompile target)
    if(ALHAZEN_QUICK_BUILD)
        target_precompile_headers(${target} PRIVATE ${ARGN})
    endif()
endfunction()

# alhazen_quick_build(TARGET): where ALHAZEN_QUICK_BUILD is on, -O1, for a target whose speed hardly counts.
function(alhazen_quick_build target)
    if(ALHAZEN_QUICK_BUILD)
        target_compile_options(${target} PRIVATE -O1)
    endif()
endfunction()

# alhazen_library(NAME SOURCES file... DEPENDS folder... LIBRARIES target... PRIVATE_LIBRARIES target...)
# makes the target alhazen_NAME of one folder of src/alhazen. Without sources it is header-only. Our flags stay
# inside of this build: who uses an installed library has the few of AlhazenInstall.cmake.
function(alhazen_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    if(ARG_SOURCES)
        add_library(alhazen_${name} STATIC ${ARG_SOURCES})
        target_link_libraries(alhazen_${name} PUBLIC $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES}
                              PRIVATE ${ARG_PRIVATE_LIBRARIES})
    else()
        add_library(alhazen_${name} INTERFACE)
        target_link_libraries(alhazen_${name} INTERFACE $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES})
    endif()
endfunction()

# alhazen_test(NAME [LABEL label] SOURCES file... DEPENDS folder...) makes the GoogleTest program
# alhazen_NAME_test. Tests labelled "heavy" do not belong to the everyday run.
function(alhazen_test name)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    set(target alhazen_${name}_test)
    add_executable(${target} ${ARG_SOURCES})
    target_link_libraries(${target} PRIVATE alhazen_flags ${ARG_DEPENDS} ${ARG_LIBRARIES}
                          GTest::gtest_main)
    if(ALHAZEN_QUICK_BUILD)
        target_precompile_headers(${target} REUSE_FROM alhazen_test_headers)
        target_compile_options(${target} PRIVATE -O1)
        # Of Highway: the definitions must be those of the precompiled headers.
        target_compile_definitions(${target} PRIVATE HWY_SHARED_DEFINE)
    endif()
    target_include_directories(${target} PRIVATE "${CMAKE_SOURCE_DIR}/tests")
    target_compile_definitions(${target} PRIVATE
        ALHAZEN_TEST_DATA_DEFAULT="${ALHAZEN_TEST_DATA}"
        ALHAZEN_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
    if(NOT ARG_LABEL)
        set(ARG_LABEL fast)
    endif()
    if(ALHAZEN_QUICK_BUILD AND ARG_LABEL STREQUAL "heavy")
        set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 600)
    endif()
    add_test(NAME ${name} COMMAND ${target})
    set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()
