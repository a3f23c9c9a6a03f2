// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/animation.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace thaw::view {

std::optional<AnimationKind> animationKind(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
    if (ending == ".png" || ending == ".apng") return AnimationKind::apng;
    if (ending == ".gif") return AnimationKind::gif;
    if (ending == ".mp4" || ending == ".webm") return AnimationKind::video;
    return std::nullopt;
}

Rectangle changedPart(const Image& before, const Image& after) {
    int left = after.width, right = -1, top = after.height, bottom = -1;
    for (int y = 0; y < after.height; ++y)
        for (int x = 0; x < after.width; ++x) {
            if (before.at(x, y) == after.at(x, y)) continue;
            left = std::min(left, x), right = std::max(right, x);
            top = std::min(top, y), bottom = std::max(bottom, y);
        }
    if (right < 0) return {0, 0, 1, 1};
    return {left, top, right - left + 1, bottom - top + 1};
}

std::unique_ptr<AnimationWriter> AnimationWriter::create(const Animation& a, std::string& error) {
    const auto refuse = [&](const std::string& why) {
        error = "cannot write " + a.path + ": " + why;
        return nullptr;
    };
    const std::optional<AnimationKind> kind = animationKind(a.path);
    if (!kind) return refuse("the ending must be .png, .apng, .gif, .mp4 or .webm");
    if (a.width < 1 || a.height < 1 || a.width > 16384 || a.height > 16384) return refuse("no such size");
    if (a.frames < 1 || a.frames > 100000) return refuse("needs 1 to 100000 frames");
    if (a.framesPerSecond < 1 || a.framesPerSecond > (*kind == AnimationKind::gif ? 50 : 60))
        return refuse(*kind == AnimationKind::gif ? "a GIF shows 1 to 50 frames a second"
                                                  : "needs 1 to 60 frames a second");
    if (!(a.hold >= 0 && a.hold <= 60)) return refuse("the last frame can stay for 0 to 60 s");
    if (*kind == AnimationKind::video && (a.width % 2 || a.height % 2)) return refuse("a video needs even sides");
    return *kind == AnimationKind::apng  ? createApng(a, error)
           : *kind == AnimationKind::gif ? createGif(a, error)
                                         : createVideo(a, error);
}

} // namespace thaw::view
