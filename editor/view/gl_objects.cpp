// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/gl_objects.h"

#include "view/shader_sources.h"

#include <string_view>
#include <vector>

namespace thaw::view {

namespace {

GLuint compile(GLenum stage, const char* files, const char* pass, std::string& error) {
    const char* common = shaderSource("common.glsl");
    if (!common) return error = "shader common.glsl is not in this build", 0u;
    std::string text = std::string("#version 330 core\n#define ") + (pass && *pass ? pass : "NO_PASS") + "\n" + common;
    std::string_view rest = files;
    while (!rest.empty()) {
        const size_t cut = rest.find('+');
        const std::string file(rest.substr(0, cut));
        rest = cut == std::string_view::npos ? std::string_view{} : rest.substr(cut + 1);
        const char* part = shaderSource(file.c_str());
        if (!part) return error = "shader " + file + " is not in this build", 0u;
        text += "\n#line 1\n";
        text += part;
    }
    const GLuint shader = glCreateShader(stage);
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint ok = 0, size = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &size);
    std::vector<char> log(static_cast<size_t>(size) + 1, 0);
    glGetShaderInfoLog(shader, size, nullptr, log.data());
    error = std::string("shader ") + files + " does not compile: " + log.data();
    glDeleteShader(shader);
    return 0;
}

} // namespace

bool GlProgram::build(const char* vertexFile, const char* fragmentFiles, const char* pass, std::string& error) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, vertexFile, pass, error);
    if (!vertex) return false;
    const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragmentFiles, pass, error);
    if (!fragment) {
        glDeleteShader(vertex);
        return false;
    }
    program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glBindFragDataLocation(program, 0, "oColor");
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint ok = 0, size = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok) return true;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &size);
    std::vector<char> log(static_cast<size_t>(size) + 1, 0);
    glGetProgramInfoLog(program, size, nullptr, log.data());
    error = std::string("shaders ") + vertexFile + " and " + fragmentFiles + " do not link: " + log.data();
    return false;
}

GLint GlProgram::location(const char* name) {
    const auto found = locations.find(std::string_view(name));
    if (found != locations.end()) return found->second;
    const GLint place = glGetUniformLocation(program, name);
    locations.emplace(name, place);
    return place;
}

} // namespace thaw::view
