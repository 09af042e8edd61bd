# Flags that carry the guarantees, and the functions that define libraries and tests.

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
    # No contraction: it would give the two owners of an edge different signs.
    -ffp-contract=off -fno-math-errno -fstack-protector-strong
    # GCC 12 turns double(float(x)) into x where two of these conversions are adjacent (seen at -O2): boxes would not
    # be rounded outward through float.
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
    -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
    -Woverloaded-virtual -Wimplicit-fallthrough -Wundef
    # In a unity build names of one source are seen in the next: GCC is asked about local shadows only, and not about
    # types of anonymous namespaces outside of the main file.
    $<IF:$<CXX_COMPILER_ID:GNU>,-Wshadow=local,-Wshadow>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
    # Designated initialisers leave the other fields at their defaults.
    -Wno-missing-field-initializers
    $<$<BOOL:${ALHAZEN_WERROR}>:-Werror>
    # GCC collects its garbage from a gigabyte on: from half of it on, it took up to a tenth of its time, and from
    # 128 MB on a tenth more.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>
    # Silences GCC's note that the calling convention of wide vectors changed in 2010.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
target_compile_definitions(alhazen_flags INTERFACE
    ALHAZEN_VERSION="${PROJECT_VERSION}"
    $<$<NOT:$<BOOL:${ALHAZEN_BENCH}>>:_GLIBCXX_ASSERTIONS>)
if(CMAKE_BUILD_TYPE STREQUAL "Release" OR CMAKE_BUILD_TYPE STREQUAL "RelWithDebInfo")
    target_compile_definitions(alhazen_flags INTERFACE _FORTIFY_SOURCE=2)
endif()
if(ALHAZEN_SANITIZE)
    # Checks at every use of a pointer, which triple the time to compile kernels, are left out: AddressSanitizer sees
    # null and dangling pointers.
    target_compile_options(alhazen_flags INTERFACE
        -fsanitize=${ALHAZEN_SANITIZE} -fno-sanitize=null,alignment,vptr,object-size,pointer-overflow
        -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(alhazen_flags INTERFACE -fsanitize=${ALHAZEN_SANITIZE})
endif()

# A program with the property ALHAZEN_ARCHIVES links archives instead of shared libraries and loads OpenEXR with the
# first EXR picture: each shared library takes time at every start. Here they are allowed.
set(ALHAZEN_ARCHIVES_OF_PROGRAM OFF)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT ALHAZEN_SANITIZE AND NOT ALHAZEN_FUZZ)
    set(ALHAZEN_ARCHIVES_OF_PROGRAM ON)
endif()

# NARROW_COPIES: modules whose structs are written number by number and copied soon after. Copies of two numbers in one
# register wait until both have left the store buffer, some 15 cycles each (docs/design/build.md).
set(ALHAZEN_NARROW_OPTIONS)
check_cxx_compiler_flag(-mtune-ctrl=^sse_unaligned_load_optimal ALHAZEN_HAS_NARROW_COPIES)
if(ALHAZEN_HAS_NARROW_COPIES)
    set(ALHAZEN_NARROW_OPTIONS -mtune-ctrl=^sse_unaligned_load_optimal)
    # Small structs are cleared by stores: rep stos takes some 30 cycles to begin.
    check_cxx_compiler_flag(-mmemset-strategy=unrolled_loop:256:noalign,libcall:-1:noalign ALHAZEN_HAS_MEMSET_STRATEGY)
    if(ALHAZEN_HAS_MEMSET_STRATEGY)
        list(APPEND ALHAZEN_NARROW_OPTIONS -mmemset-strategy=unrolled_loop:256:noalign,libcall:-1:noalign)
    endif()
    # For kernels of these modules; undoes the option above.
    set(ALHAZEN_WIDE_OPTIONS -mtune-ctrl=sse_unaligned_load_optimal)
endif()

# Options of kernels: files compiled once per instruction set (src/alhazen/simd/lanes-inl.h).
set(ALHAZEN_KERNEL_OPTIONS)
# No 512-bit registers for copies: see LaneTag in simd/lanes-inl.h.
check_cxx_compiler_flag(-mmove-max=256 ALHAZEN_HAS_MOVE_MAX)
if(ALHAZEN_HAS_MOVE_MAX)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -mmove-max=256 -mstore-max=256)
endif()
# Queries are copied whole by the library's memcpy, not by rep movs (docs/design/build.md).
check_cxx_compiler_flag(-mmemcpy-strategy=libcall:-1:noalign ALHAZEN_HAS_MEMCPY_STRATEGY)
if(ALHAZEN_HAS_MEMCPY_STRATEGY)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -mmemcpy-strategy=libcall:-1:noalign)
endif()
# ALHAZEN_KERNEL_TARGETS: definitions that choose the instruction sets.
set(ALHAZEN_KERNEL_TARGETS)
if(ALHAZEN_FUZZ)
    # The fuzzers trace no rays: one instruction set without sanitizers suffices.
    set(ALHAZEN_KERNEL_TARGETS HWY_COMPILE_ONLY_STATIC)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -fno-sanitize=all)
elseif(ALHAZEN_KERNELS STREQUAL "native")
    set(ALHAZEN_KERNEL_TARGETS HWY_COMPILE_ONLY_STATIC)
    list(APPEND ALHAZEN_KERNEL_OPTIONS -march=native)
elseif(ALHAZEN_KERNELS STREQUAL "portable")
    set(ALHAZEN_KERNEL_TARGETS HWY_COMPILE_ONLY_SCALAR)
elseif(NOT ALHAZEN_KERNELS STREQUAL "all")
    message(FATAL_ERROR "ALHAZEN_KERNELS is '${ALHAZEN_KERNELS}'; it can be all, native or portable")
endif()

# Options of code whose own time counts little (COLD) or hardly (FROZEN), built for compile time: a fifth less of it than
# with -O2, and a tenth to a third less than that. Readers take a quarter longer with -Og, so those of large files are
# COLD.
set(ALHAZEN_COLD_OPTIONS -O1)
set(ALHAZEN_FROZEN_OPTIONS -Og)
# Programs list these before the libraries: of an inline function the linker keeps the first copy. Those of `aggregates`,
# in the target of `primitives`, are last, for kernels that count are built for compile time.
set(ALHAZEN_FAST_OBJECTS
    $<TARGET_OBJECTS:alhazen_renderers> $<TARGET_OBJECTS:alhazen_accel> $<TARGET_OBJECTS:alhazen_primitives>)

# Writes the source `unit` of the build folder that includes kernels, so that the headers of lanes are read once for all.
function(alhazen_write_kernel_unit unit)
    # Paths below src, here and in the build folder: what the compiler cache sees depends on no folder.
    file(RELATIVE_PATH name "${CMAKE_BINARY_DIR}/src" "${unit}")
    set(target "#undef HWY_TARGET_INCLUDE\n#define HWY_TARGET_INCLUDE \"${name}\"\n")
    set(text "// Generated: do not edit.\n${target}#include <hwy/foreach_target.h>\n")
    foreach(kernel IN LISTS ARGN)
        file(RELATIVE_PATH kernel "${CMAKE_SOURCE_DIR}/src" "${kernel}")
        string(APPEND text "#include \"${kernel}\"\n")
    endforeach()
    # Each of them has named itself as what to compile for the next instruction set.
    file(CONFIGURE OUTPUT "${unit}" CONTENT "${text}${target}" @ONLY)
endfunction()

# Compiles the sources of a target `batch` to a unit (empty: as usual), for `temperature` WARM, COLD or FROZEN.
function(alhazen_set_units target temperature batch)
    if(NOT batch)
        set(batch 100)
        if(temperature STREQUAL "WARM")
            set(batch 60)
        endif()
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch}
                          UNITY_BUILD_UNIQUE_ID ALHAZEN_UNITY_ID)
    target_compile_options(${target} PRIVATE ${ALHAZEN_${temperature}_OPTIONS})
endfunction()

# alhazen_library(NAME [COLD|FROZEN] [NARROW_COPIES] [BATCH number] [UNITS_OF folder] SOURCES file...
# FROZEN_SOURCES file... KERNELS file... SMALL_KERNELS file... DEPENDS folder... LIBRARIES target...
# PRIVATE_LIBRARIES target...) defines the target alhazen_NAME
# of one folder of src/alhazen; without sources it is header-only. Sources are compiled many to a unit (unity build),
# kernels one by one, small kernels as one unit. COLD, FROZEN: built for compile time; FROZEN_SOURCES: these sources of
# the folder. UNITS_OF: the sources are compiled with those of another folder, in its library and with its options; the
# target stands for it. The compile flags are private to this build: an installed library has only those of
# AlhazenInstall.cmake.
function(alhazen_library name)
    cmake_parse_arguments(ARG "COLD;FROZEN;NARROW_COPIES" "UNITS_OF;BATCH"
        "SOURCES;FROZEN_SOURCES;KERNELS;SMALL_KERNELS;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    set(library alhazen_${name})
    set(kernels ${ARG_KERNELS})
    if(ARG_SOURCES)
        set(sources ${ARG_SOURCES})
        set(temperature WARM)
        if(ARG_COLD)
            set(temperature COLD)
        elseif(ARG_FROZEN)
            set(temperature FROZEN)
        endif()
        if(ARG_SMALL_KERNELS)
            list(TRANSFORM ARG_SMALL_KERNELS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
            list(APPEND kernels "${CMAKE_CURRENT_BINARY_DIR}/small_kernels.cpp")
            alhazen_write_kernel_unit("${CMAKE_CURRENT_BINARY_DIR}/small_kernels.cpp" ${ARG_SMALL_KERNELS})
        endif()
        set(objects)
        if(ARG_FROZEN_SOURCES)
            # Objects of another target come first in an archive: of an inline function the linker keeps the first copy.
            add_library(alhazen_${name}_first OBJECT ${sources})
            target_link_libraries(alhazen_${name}_first PRIVATE alhazen_flags ${ARG_DEPENDS} ${ARG_LIBRARIES}
                                  ${ARG_PRIVATE_LIBRARIES})
            alhazen_set_units(alhazen_${name}_first ${temperature} "${ARG_BATCH}")
            set(objects $<TARGET_OBJECTS:alhazen_${name}_first>)
            set(sources ${ARG_FROZEN_SOURCES})
            set(temperature FROZEN)
        endif()
        if(ARG_UNITS_OF)
            if(ARG_COLD OR ARG_FROZEN OR ARG_FROZEN_SOURCES OR ARG_BATCH)
                message(FATAL_ERROR "${name}: with UNITS_OF sources are compiled as those of ${ARG_UNITS_OF}")
            endif()
            set(library alhazen_${ARG_UNITS_OF})
            list(REMOVE_ITEM ARG_DEPENDS ${library})
            add_library(alhazen_${name} INTERFACE)
            target_link_libraries(alhazen_${name} INTERFACE ${library})
            target_sources(${library} PRIVATE ${sources} ${kernels})
        else()
            add_library(${library} STATIC ${sources} ${kernels} ${objects})
            alhazen_set_units(${library} ${temperature} "${ARG_BATCH}")
        endif()
        target_link_libraries(${library} PUBLIC $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES}
                              PRIVATE ${ARG_PRIVATE_LIBRARIES})
        set(kernel_options ${ALHAZEN_KERNEL_OPTIONS})
        get_target_property(narrow ${library} ALHAZEN_NARROW)
        if(ARG_NARROW_COPIES)
            set_target_properties(${library} PROPERTIES ALHAZEN_NARROW ON)
            target_compile_options(${library} PRIVATE ${ALHAZEN_NARROW_OPTIONS})
        endif()
        if(ARG_NARROW_COPIES OR narrow)
            list(APPEND kernel_options ${ALHAZEN_WIDE_OPTIONS})
        endif()
        if(kernels)
            set_source_files_properties(${kernels} TARGET_DIRECTORY ${library} PROPERTIES
                SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON
                COMPILE_DEFINITIONS "${ALHAZEN_KERNEL_TARGETS}" COMPILE_OPTIONS "${kernel_options}")
        endif()
        if(ARG_SMALL_KERNELS)
            set_source_files_properties("${CMAKE_CURRENT_BINARY_DIR}/small_kernels.cpp" TARGET_DIRECTORY ${library}
                PROPERTIES INCLUDE_DIRECTORIES "${CMAKE_BINARY_DIR}/src")
        endif()
        list(TRANSFORM ARG_KERNELS PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
        set_property(GLOBAL APPEND PROPERTY ALHAZEN_KERNELS ${ARG_KERNELS} ${ARG_SMALL_KERNELS})
    else()
        add_library(alhazen_${name} INTERFACE)
        target_link_libraries(alhazen_${name} INTERFACE $<BUILD_INTERFACE:alhazen_flags> ${ARG_DEPENDS} ${ARG_LIBRARIES})
    endif()
endfunction()

# Tests are built for compile time; their own speed hardly matters.
set(ALHAZEN_TEST_OPTIONS -Og $<$<CXX_COMPILER_ID:GNU>:-Wno-shadow>)

# alhazen_test_entry(NAME PROGRAM [LABEL label] [TIMEOUT seconds] [COST seconds] [PARTS number] [FILTER pattern...]
# [ENVIRONMENT variable...]) adds the CTest entry NAME: tests of a GoogleTest program, all or those of FILTER, as PARTS
# entries that run side by side, NAME_1 and so on (GoogleTest's shards: each test is in one of them). COST: about how
# long it takes; what takes long begins first, so that no core is idle in the end. They yield to the tests of servers and
# pages, which wait much and measure how soon they are answered.
find_program(ALHAZEN_NICE nice)
function(alhazen_test_entry name program)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT;COST;PARTS" "FILTER;ENVIRONMENT" ${ARGN})
    if(NOT ARG_LABEL)
        set(ARG_LABEL fast)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 600)
    endif()
    if(ALHAZEN_SANITIZE)
        math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
    endif()
    if(NOT ARG_COST)
        set(ARG_COST 1)
    endif()
    set(command $<TARGET_FILE:${program}>)
    if(ALHAZEN_NICE)
        set(command "${ALHAZEN_NICE}" -n 5 $<TARGET_FILE:${program}>)
    endif()
    if(ARG_FILTER)
        list(JOIN ARG_FILTER ":" filter)
        list(APPEND command "--gtest_filter=${filter}")
    endif()
    if(NOT ARG_PARTS)
        set(ARG_PARTS 1)
    endif()
    math(EXPR cost "${ARG_COST} / ${ARG_PARTS}")
    math(EXPR last "${ARG_PARTS} - 1")
    foreach(part RANGE ${last})
        set(entry ${name})
        set(environment ${ARG_ENVIRONMENT})
        if(ARG_PARTS GREATER 1)
            math(EXPR number "${part} + 1")
            string(APPEND entry "_${number}")
            list(APPEND environment "GTEST_TOTAL_SHARDS=${ARG_PARTS}" "GTEST_SHARD_INDEX=${part}")
        endif()
        add_test(NAME ${entry} COMMAND ${command})
        set_tests_properties(${entry} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} COST ${cost}
                             ENVIRONMENT "${environment}")
    endforeach()
endfunction()

# Programs of heavy tests alone, which the target `all` leaves out.
add_custom_target(alhazen_heavy)
function(alhazen_is_heavy target)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(alhazen_heavy ${target})
endfunction()

# alhazen_test_program(NAME SOURCES file... DEPENDS folder... LIBRARIES target...) defines the GoogleTest program
# alhazen_NAME_test.
function(alhazen_test_program name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
    list(TRANSFORM ARG_DEPENDS PREPEND alhazen_)
    set(target alhazen_${name}_test)
    add_executable(${target} ${ARG_SOURCES})
    target_link_libraries(${target} PRIVATE alhazen_flags alhazen_test_support ${ARG_DEPENDS} ${ARG_LIBRARIES}
                          GTest::gtest_main)
    target_compile_options(${target} PRIVATE ${ALHAZEN_TEST_OPTIONS})
    # What the files of a unit instantiate alike is compiled once. Each has a namespace of its own: alhazen::ALHAZEN_TEST_FILE.
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 64
                          UNITY_BUILD_UNIQUE_ID ALHAZEN_TEST_FILE)
endfunction()

# alhazen_test(NAME [LABEL label] [TIMEOUT seconds] [COST seconds] [PARTS number] SOURCES file... DEPENDS folder...
# LIBRARIES target... UNTRAPPED pattern... THOROUGH pattern...) defines a program and the CTest entry NAME of all of its
# tests. Those labelled "heavy" are not part of the everyday run.
# THOROUGH: tests that try a part of their cases every day (tests/support/thorough.h). The entry NAME_thorough, labelled
# heavy, runs them with all; those that are named in UNTRAPPED, too, are in NAME_thorough_untrapped.
# UNTRAPPED divides the tests between two entries. NAME_nan_traps has a trap at invalid floating-point operations
# (tests/support/nan_traps.cpp); NAME has the tests named here: those that feed NaN, those of arithmetic in lanes, where
# lanes that are not used may hold one, and those that trace by lanes. One entry of all with clang, which computes both
# sides of a condition.
function(alhazen_test name)
    cmake_parse_arguments(ARG "" "LABEL;TIMEOUT;COST;PARTS" "SOURCES;DEPENDS;LIBRARIES;UNTRAPPED;THOROUGH" ${ARGN})
    alhazen_test_program(${name} SOURCES ${ARG_SOURCES} DEPENDS ${ARG_DEPENDS} LIBRARIES ${ARG_LIBRARIES})
    set(program alhazen_${name}_test)
    set(options)
    foreach(option LABEL TIMEOUT COST PARTS)
        if(ARG_${option})
            list(APPEND options ${option} ${ARG_${option}})
        endif()
    endforeach()
    if(ARG_UNTRAPPED AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        alhazen_test_entry(${name} ${program} FILTER ${ARG_UNTRAPPED})
        list(JOIN ARG_UNTRAPPED ":" untrapped)
        alhazen_test_entry(${name}_nan_traps ${program} ${options} FILTER "-${untrapped}"
                           ENVIRONMENT ALHAZEN_TRAP_NAN=1)
        set(trap ALHAZEN_TRAP_NAN=1)
    else()
        alhazen_test_entry(${name} ${program} ${options})
        set(trap)
        set(ARG_UNTRAPPED)
    endif()
    set(heavy LABEL heavy TIMEOUT 3600 ENVIRONMENT ALHAZEN_TEST_THOROUGH=1)
    set(thorough ${ARG_THOROUGH})
    list(REMOVE_ITEM thorough ${ARG_UNTRAPPED} "")
    if(thorough)
        # A pattern of THOROUGH may contain tests of UNTRAPPED: "-" begins those that are left out.
        set(filter ${thorough})
        if(ARG_UNTRAPPED)
            list(JOIN thorough ":" filter)
            string(APPEND filter "-${untrapped}")
        endif()
        alhazen_test_entry(${name}_thorough ${program} ${heavy} ${trap} FILTER ${filter})
    endif()
    list(REMOVE_ITEM ARG_THOROUGH ${thorough} "")
    if(ARG_THOROUGH)
        alhazen_test_entry(${name}_thorough_untrapped ${program} ${heavy} FILTER ${ARG_THOROUGH})
    endif()
endfunction()
