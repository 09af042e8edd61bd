# Writes text files into a C++ source as a std::string_view.
#   alhazen_embed_text(OUTPUT file.cpp HEADER header VARIABLE name FILES file...)
# adds the command that makes the source; run as a script (cmake -P) with the same names, it makes it. The files are
# joined in their order, as literals below 16 KiB. Files that are longer must be ASCII.
if(CMAKE_SCRIPT_MODE_FILE)
    set(text "// Generated from ${FILES}: do not edit.\n#include \"${HEADER}\"\n\nnamespace alhazen {\n\n")
    string(APPEND text "const std::string_view ${VARIABLE} =")
    foreach(file IN LISTS FILES)
        file(READ "${file}" content)
        string(LENGTH "${content}" length)
        foreach(begin RANGE 0 ${length} 16000)
            string(SUBSTRING "${content}" ${begin} 16000 part)
            string(APPEND text "\n    R\"embedded(${part})embedded\"")
        endforeach()
    endforeach()
    string(APPEND text ";\n\n}  // namespace alhazen\n")
    file(WRITE "${OUTPUT}" "${text}")
    return()
endif()

set(ALHAZEN_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")
function(alhazen_embed_text)
    cmake_parse_arguments(ARG "" "OUTPUT;HEADER;VARIABLE" "FILES" ${ARGN})
    list(TRANSFORM ARG_FILES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
    add_custom_command(OUTPUT "${ARG_OUTPUT}"
        COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${ARG_OUTPUT}" "-DHEADER=${ARG_HEADER}" "-DVARIABLE=${ARG_VARIABLE}"
                "-DFILES=${ARG_FILES}" -P "${ALHAZEN_EMBED_SCRIPT}"
        DEPENDS ${ARG_FILES} "${ALHAZEN_EMBED_SCRIPT}" VERBATIM)
endfunction()
