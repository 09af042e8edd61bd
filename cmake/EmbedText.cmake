# Writes text files into a C++ source as an EmbeddedText (alhazen/base/embedded_text.h).
#   alhazen_embed_text(OUTPUT file.cpp HEADER header VARIABLE name FILES file...)
# The files are its parts in their order, as literals below 16 KiB; those that are longer must be ASCII. The source is
# written when the build is configured, again after a change: a command of the build would make all sources of its
# target wait until the libraries that the target needs are there.
function(alhazen_embed_text)
    cmake_parse_arguments(ARG "" "OUTPUT;HEADER;VARIABLE" "FILES" ${ARGN})
    list(TRANSFORM ARG_FILES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
    set(text "// Generated from ${ARG_FILES}: do not edit.\n#include \"${ARG_HEADER}\"\n\nnamespace alhazen {\n\n")
    string(APPEND text "namespace {\nconstexpr std::string_view ${ARG_VARIABLE}Parts[] = {")
    foreach(file IN LISTS ARG_FILES)
        file(READ "${file}" content)
        string(LENGTH "${content}" length)
        foreach(begin RANGE 0 ${length} 16000)
            string(SUBSTRING "${content}" ${begin} 16000 part)
            string(APPEND text "\n    R\"embedded(${part})embedded\",")
        endforeach()
    endforeach()
    string(APPEND text "};\n}  // namespace\n\nconst EmbeddedText ${ARG_VARIABLE} = ${ARG_VARIABLE}Parts;\n\n")
    string(APPEND text "}  // namespace alhazen\n")
    file(WRITE "${ARG_OUTPUT}.new" "${text}")
    file(COPY_FILE "${ARG_OUTPUT}.new" "${ARG_OUTPUT}" ONLY_IF_DIFFERENT)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARG_FILES})
endfunction()
