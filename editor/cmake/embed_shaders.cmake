# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# cmake -DOUT_CPP= -DSHADERS=a;b -P embed_shaders.cmake
# Writes the C++ file that holds the text of the shaders and defines view/shader_sources.h.
set(head "// SPDX-FileCopyrightText: 2026 the thaw authors\n// SPDX-License-Identifier: MIT\n// Generated from shaders/ by editor/cmake/embed_shaders.cmake.\n")
set(entries "")
set(count 0)
list(SORT SHADERS)
foreach(path IN LISTS SHADERS)
  get_filename_component(name ${path} NAME)
  # Read as hex and written as numbers: a list or a raw string would trip over ; [ ] and ) in the text.
  file(READ ${path} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
  string(APPEND arrays "const unsigned char kText${count}[] = {\n${bytes}0};\n")
  string(APPEND entries "    {\"${name}\", kText${count}},\n")
  math(EXPR count "${count} + 1")
endforeach()

file(WRITE ${OUT_CPP} "${head}#include \"view/shader_sources.h\"

#include <cstring>

namespace thaw::view {
namespace {

struct Entry {
    const char* name;
    const unsigned char* text;
};

${arrays}
const Entry kEntries[] = {
${entries}    {nullptr, nullptr},
};

} // namespace

const char* shaderSource(const char* name) {
    for (const Entry& entry : kEntries)
        if (entry.name && std::strcmp(entry.name, name) == 0) return reinterpret_cast<const char*>(entry.text);
    return nullptr;
}

} // namespace thaw::view
")
