// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// What the passes of the renderer share: texture units, render targets, buffers.

#pragma once

#include "view/gl_objects.h"

#include <string>

namespace thaw::view {

/// Texture units, fixed for the whole frame.
enum Unit : int {
    unitKeyMap,
    unitFlameMap,
    unitGeometry,
    unitLight,
    unitFlame,
    unitMirror,
    unitRamp,
    unitNormals,
    unitAlbedos,
    unitDepths,
    unitKinds,
    unitSource,
    unitNear,
    unitFar,
    unitBehind,
    unitBack,
    unitSplats,
    unitSplatDepths,
    unitSplatAlbedos,
    unitSplatStates,
    unitCount
};

/// A program and what it is made of; see GlProgram::build.
struct Recipe {
    GlProgram& program;
    const char *vertex, *fragment, *pass;
};

struct Target {
    GlTexture texture;
    GlFramebuffer framebuffer;
    int width = 0, height = 0;
};

/// Of the bound texture.
void setTexture(GLenum kind, GLint filter);
void bindTexture(int unit, GLenum kind, GLuint texture);
/// Gives a texture its size, without content. Leaves it bound to unitSource.
void makeTexture(GlTexture& target, GLenum format, int w, int h, GLint filter);
/// Gives a target its size; depth may be nullptr. False, with the reason in error, when the driver refuses it.
bool makeTarget(Target& target, GLenum format, int w, int h, GLint filter, GlTexture* depth, std::string& error);
void upload(GlBuffer& buffer, GLenum kind, const void* data, size_t bytes, GLenum usage);
/// Of the bound vertex array, from the buffer that was uploaded last, without gaps.
void attribute(GLuint index, GLint components, GLenum type);

} // namespace thaw::view
