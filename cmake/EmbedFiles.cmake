# cmake -DLIST=file -DROOT=folder -DOUTPUT=file.cpp -P EmbedFiles.cmake
# Writes the C++ source for cupola_embed(): LIST has one absolute path a line, ROOT is what names are relative to.
file(STRINGS ${LIST} paths)
set(entries "")
foreach(path IN LISTS paths)
  file(RELATIVE_PATH name ${ROOT} ${path})
  file(READ ${path} text)
  if(text MATCHES "\\)EMBED\"")
    message(FATAL_ERROR "${name} holds the mark )EMBED\" that ends a raw string")
  endif()
  string(APPEND entries "    {\"${name}\", R\"EMBED(${text})EMBED\"},\n")
endforeach()
list(LENGTH paths count)
file(WRITE ${OUTPUT}
     "// Made by cmake/EmbedFiles.cmake.\n"
     "#include \"renderer/gl/embedded.h\"\n\n#include <array>\n\n"
     "namespace cupola::gl {\nnamespace {\n"
     "constexpr std::array<EmbeddedFile, ${count}> files{{\n${entries}}};\n"
     "} // namespace\n\n"
     "std::span<const EmbeddedFile> embedded_files() { return files; }\n\n"
     "} // namespace cupola::gl\n")
