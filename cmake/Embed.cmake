# cupola_embed(TARGET FILES file...)
# Compiles text files (shaders) into TARGET, which then defines cupola::gl::embedded_files() of
# renderer/gl/embedded.h. Call it for one target only: the function has one definition in a program.
# A file is named from the current folder or from the repository root; the program knows it by its path from the
# repository root. The generated source is made anew when a file or the list changes.
function(cupola_embed target)
  cmake_parse_arguments(EMBED "" "" "FILES" ${ARGN})
  set(paths "")
  foreach(file ${EMBED_FILES})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
      set(file ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    elseif(EXISTS ${PROJECT_SOURCE_DIR}/${file})
      set(file ${PROJECT_SOURCE_DIR}/${file})
    elseif(NOT IS_ABSOLUTE ${file} OR NOT EXISTS ${file})
      message(FATAL_ERROR "cupola_embed(${target}): no such file: ${file}")
    endif()
    list(APPEND paths ${file})
  endforeach()
  list(SORT paths)
  list(REMOVE_DUPLICATES paths)

  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded.txt)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded.cpp)
  list(JOIN paths "\n" lines)
  file(CONFIGURE OUTPUT ${list_file} CONTENT "${lines}\n" @ONLY) # rewritten only when it differs
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DLIST=${list_file} -DROOT=${PROJECT_SOURCE_DIR} -DOUTPUT=${source}
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${paths} ${list_file} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    COMMENT "Embedding the shaders of ${target}"
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()
