// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/passes.h"

namespace thaw::view {

void setTexture(GLenum kind, GLint filter) {
    glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(kind, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(kind, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(kind, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void bindTexture(int unit, GLenum kind, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(kind, texture);
}

void makeTexture(GlTexture& target, GLenum format, int w, int h, GLint filter) {
    bindTexture(unitSource, GL_TEXTURE_2D, target.get());
    const bool depth = format == GL_DEPTH_COMPONENT32F || format == GL_DEPTH_COMPONENT24;
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), w, h, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                 depth || format != GL_RGBA8 ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
    setTexture(GL_TEXTURE_2D, filter);
}

bool makeTarget(Target& target, GLenum format, int w, int h, GLint filter, GlTexture* depth, std::string& error) {
    makeTexture(target.texture, format, w, h, filter);
    target.width = w, target.height = h;
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture.get(), 0);
    if (depth) {
        makeTexture(*depth, GL_DEPTH_COMPONENT24, w, h, GL_NEAREST);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->get(), 0);
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
    error = "the driver refuses a render target of " + std::to_string(w) + " x " + std::to_string(h);
    return false;
}

void upload(GlBuffer& buffer, GLenum kind, const void* data, size_t bytes, GLenum usage) {
    glBindBuffer(kind, buffer.get());
    glBufferData(kind, static_cast<GLsizeiptr>(bytes), data, usage);
}

void attribute(GLuint index, GLint components, GLenum type) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, components, type, GL_FALSE, 0, nullptr);
}

} // namespace thaw::view
