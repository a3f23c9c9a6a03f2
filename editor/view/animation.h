// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/image.h"
#include "view/png.h"

#include <memory>
#include <string>

namespace thaw::view {

enum class AnimationKind {
    apng, // .png, .apng: every colour, plays in browsers
    gif,  // .gif: 256 colours for all frames, dithered
    video // .mp4, .webm: by the program ffmpeg
};
/// By the ending of a path, whatever its case. nullopt: none of these.
std::optional<AnimationKind> animationKind(const std::string& path);

struct Animation {
    std::string path;
    int width = 0, height = 0; // pixels of every frame, 1..16384; even for video
    int frames = 0;            // as many as will be added, 1..100000
    int framesPerSecond = 30;  // 1..60; a GIF shows 50 at most
    double hold = 0;           // s, 0..60, that the last frame stays on top of its time; not in video
};

/// Writes pictures one after the other into a file that plays them without end (video: once). The file is there once
/// finish() has said true, and what was there before stays until then.
class AnimationWriter {
public:
    virtual ~AnimationWriter() = default;
    /// The next frame. False, with the reason in error.
    virtual bool add(const Image& image, std::string& error) = 0;
    /// After the last one. False, with the reason in error.
    virtual bool finish(std::string& error) = 0;

    /// nullptr, with the reason in error, when something is out of range, the place cannot be written, or there is no
    /// ffmpeg for a video.
    static std::unique_ptr<AnimationWriter> create(const Animation& animation, std::string& error);
};

/// What of a picture is not as in another of the same size; at least one pixel.
Rectangle changedPart(const Image& before, const Image& after);

// One for each kind; create() has checked the numbers.
std::unique_ptr<AnimationWriter> createApng(const Animation& animation, std::string& error);
std::unique_ptr<AnimationWriter> createGif(const Animation& animation, std::string& error);
std::unique_ptr<AnimationWriter> createVideo(const Animation& animation, std::string& error);

} // namespace thaw::view
