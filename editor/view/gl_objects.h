// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace thaw::view {

/// Owner of one OpenGL name.
template <auto Create, auto Destroy> class GlObject {
public:
    GlObject() = default;
    GlObject(GlObject&& other) noexcept : name(std::exchange(other.name, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name, other.name);
        return *this;
    }
    ~GlObject() { reset(); }
    /// The name, made at the first call.
    GLuint get() {
        if (!name) Create(&name);
        return name;
    }
    void reset() {
        if (name) Destroy(&name);
        name = 0;
    }

private:
    GLuint name = 0;
};

namespace detail {
inline void genTexture(GLuint* n) { glGenTextures(1, n); }
inline void deleteTexture(GLuint* n) { glDeleteTextures(1, n); }
inline void genBuffer(GLuint* n) { glGenBuffers(1, n); }
inline void deleteBuffer(GLuint* n) { glDeleteBuffers(1, n); }
inline void genArray(GLuint* n) { glGenVertexArrays(1, n); }
inline void deleteArray(GLuint* n) { glDeleteVertexArrays(1, n); }
inline void genFramebuffer(GLuint* n) { glGenFramebuffers(1, n); }
inline void deleteFramebuffer(GLuint* n) { glDeleteFramebuffers(1, n); }
} // namespace detail

using GlTexture = GlObject<detail::genTexture, detail::deleteTexture>;
using GlBuffer = GlObject<detail::genBuffer, detail::deleteBuffer>;
using GlVertexArray = GlObject<detail::genArray, detail::deleteArray>;
using GlFramebuffer = GlObject<detail::genFramebuffer, detail::deleteFramebuffer>;

/// A linked program with its uniforms by name. Setting a uniform that the program does not use is no error.
class GlProgram {
public:
    GlProgram() = default;
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;
    ~GlProgram() {
        if (program) glDeleteProgram(program);
    }

    /// Files of shaders/; "+" joins several. common.glsl and a line "#define <pass>" are put before them. False, with
    /// the compiler's log in error, when they do not compile or link.
    bool build(const char* vertexFile, const char* fragmentFiles, const char* pass, std::string& error);
    void use() const { glUseProgram(program); }

    void set(const char* name, int v) { glUniform1i(location(name), v); }
    void set(const char* name, float v) { glUniform1f(location(name), v); }
    void set(const char* name, float x, float y) { glUniform2f(location(name), x, y); }
    void set(const char* name, int x, int y) { glUniform2i(location(name), x, y); }
    void set2(const char* name, const float* v, int count) { glUniform2fv(location(name), count, v); }
    void set3(const char* name, const float* v, int count = 1) { glUniform3fv(location(name), count, v); }
    void set4(const char* name, const float* v, int count = 1) { glUniform4fv(location(name), count, v); }
    void set1(const char* name, const float* v, int count) { glUniform1fv(location(name), count, v); }
    void setMatrix(const char* name, const float* v) { glUniformMatrix4fv(location(name), 1, GL_FALSE, v); }

private:
    GLint location(const char* name);
    GLuint program = 0;
    std::map<std::string, GLint, std::less<>> locations;
};

} // namespace thaw::view
