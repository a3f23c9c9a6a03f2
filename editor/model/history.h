// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/live_world.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace thaw::editor {

/// What was run since the start: images of the world every few frames, and of every step what it was given, so that any
/// frame can be had again with the same bits.
class History {
public:
    /// One step, and the scene that it was done with.
    struct Step {
        thawWork work{};
        std::shared_ptr<const scene::Scene> scene;
        bool driven = false; // colliders that were moved since went there as a hand would
    };

    /// bytes: of images; when they are more, every other old one goes.
    explicit History(size_t bytes = size_t{256} << 20) : limit_(bytes) {}

    /// As the world stands after a build: the start.
    void begin(const LiveWorld& live);
    void clear();
    /// A step was done, which led to this frame. What was run beyond it before is forgotten.
    void add(int64_t frame, const Step& step, const LiveWorld& live);
    /// Forgets what comes after a frame.
    void cut(int64_t frame);

    bool empty() const { return images_.empty(); }
    int64_t newest() const { return int64_t(steps_.size()); }
    /// Step that leads to this frame, 1..newest.
    const Step& step(int64_t frame) const { return steps_[size_t(frame - 1)]; }
    /// Puts the world to the last image that is not after a frame, and says which frame that is; -1 where the library
    /// refuses it.
    int64_t restore(int64_t frame, LiveWorld& live) const;
    /// Frame of that image.
    int64_t imageBefore(int64_t frame) const;
    size_t bytes() const { return bytes_; }

private:
    struct Image {
        int64_t frame = 0;
        std::vector<uint8_t> data;
        LiveWorld::Standing standing;
    };
    void keep(int64_t frame, const LiveWorld& live);
    void thin();

    size_t limit_, bytes_ = 0;
    std::vector<Image> images_; // by frame
    std::vector<Step> steps_;
};

} // namespace thaw::editor
