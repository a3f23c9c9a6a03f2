// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>

namespace thaw::view {

namespace {

bool hasExtension(const char* list, const char* name) {
    const size_t n = std::strlen(name);
    for (const char* p = list; p && (p = std::strstr(p, name)); p += n)
        if ((p == list || p[-1] == ' ') && (p[n] == ' ' || p[n] == 0)) return true;
    return false;
}

std::string hex(EGLint code) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%x", static_cast<unsigned>(code));
    return text;
}

// EGL gives the same display to everyone who asks and ends it for all of them at once, so the last context here has to.
struct OpenDisplays {
    std::mutex mutex;
    std::map<EGLDisplay, int> contexts;
};
OpenDisplays& openDisplays() {
    static OpenDisplays displays;
    return displays;
}

struct Made {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;
};

// Surfaceless where EGL allows it, else a pbuffer of one pixel: we draw into framebuffer objects only.
bool open(EGLDisplay display, Made& made, std::string& why) {
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY) return why = "no display", false;
    if (!eglInitialize(display, &major, &minor)) return why = "eglInitialize " + hex(eglGetError()), false;
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    const bool surfaceless = hasExtension(extensions, "EGL_KHR_surfaceless_context");
    made.display = display;
    const auto fail = [&](const char* step) {
        why = std::string(step) + " " + hex(eglGetError());
        if (made.surface != EGL_NO_SURFACE) eglDestroySurface(display, made.surface);
        if (made.context != EGL_NO_CONTEXT) eglDestroyContext(display, made.context);
        made = {};
        return false;
    };
    if (!eglBindAPI(EGL_OPENGL_API)) return fail("eglBindAPI");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) {
        if (!surfaceless || !hasExtension(extensions, "EGL_KHR_no_config_context")) return fail("eglChooseConfig");
        config = nullptr;
    }
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    made.context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (made.context == EGL_NO_CONTEXT) return fail("eglCreateContext (OpenGL 3.3 core)");
    if (!surfaceless) {
        const EGLint onePixel[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        made.surface = eglCreatePbufferSurface(display, config, onePixel);
        if (made.surface == EGL_NO_SURFACE) return fail("eglCreatePbufferSurface");
    }
    if (!eglMakeCurrent(display, made.surface, made.surface, made.context)) return fail("eglMakeCurrent");
    return true;
}

} // namespace

std::unique_ptr<HeadlessContext> HeadlessContext::create(std::string& error) {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    Made made;
    std::string way, tried;
    const auto attempt = [&](const std::string& name, EGLDisplay candidate) {
        std::string why;
        if (open(candidate, made, why)) return way = name, true;
        tried += (tried.empty() ? "" : "; ") + name + ": " + why;
        return false;
    };
    bool ok = false;
    if (hasExtension(client, "EGL_EXT_platform_base")) {
        if (hasExtension(client, "EGL_MESA_platform_surfaceless"))
            ok = attempt("surfaceless",
                         eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
        // NVIDIA's EGL knows no surfaceless platform, but each card is a device.
        if (!ok && hasExtension(client, "EGL_EXT_platform_device") &&
            (hasExtension(client, "EGL_EXT_device_enumeration") || hasExtension(client, "EGL_EXT_device_base"))) {
            EGLDeviceEXT devices[8];
            EGLint count = 0;
            if (eglQueryDevicesEXT(8, devices, &count))
                for (EGLint i = 0; i < count && !ok; ++i)
                    ok = attempt("device " + std::to_string(i),
                                 eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        }
    }
    if (!ok) ok = attempt("default display", eglGetDisplay(EGL_DEFAULT_DISPLAY));
    if (!ok) {
        error = "no headless OpenGL 3.3 context (" + tried + ")";
        return nullptr;
    }
    // The default display may be the window system's, with windows of the host: that one is not ours to end.
    if (way != "default display") {
        OpenDisplays& displays = openDisplays();
        const std::lock_guard lock(displays.mutex);
        ++displays.contexts[made.display];
    }
    std::unique_ptr<HeadlessContext> result(new HeadlessContext);
    result->display = made.display;
    result->context = made.context;
    result->surface = made.surface;
    result->platformString = way;
    const auto text = [](GLenum name) {
        const GLubyte* s = glGetString(name);
        return std::string(s ? reinterpret_cast<const char*>(s) : "unknown");
    };
    result->rendererString = text(GL_RENDERER) + " | " + text(GL_VERSION);
    return result;
}

HeadlessContext::~HeadlessContext() {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    eglDestroyContext(display, context);
    OpenDisplays& displays = openDisplays();
    const std::lock_guard lock(displays.mutex);
    const auto found = displays.contexts.find(display);
    if (found == displays.contexts.end() || --found->second > 0) return;
    displays.contexts.erase(found);
    eglTerminate(display);
}

bool HeadlessContext::makeCurrent() { return eglMakeCurrent(display, surface, surface, context) == EGL_TRUE; }

} // namespace thaw::view
