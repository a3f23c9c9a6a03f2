// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/history.h"

#include <algorithm>

namespace thaw::editor {

namespace {
// An image takes as long as a tenth of a step, and going back to any frame at most as long as ten.
constexpr int64_t kEvery = 10;
} // namespace

void History::clear() {
    images_.clear(), steps_.clear();
    bytes_ = 0;
}

void History::begin(const LiveWorld& live) {
    clear();
    keep(0, live);
}

void History::add(int64_t frame, const Step& step, const LiveWorld& live) {
    cut(frame - 1);
    steps_.push_back(step);
    if (frame % kEvery == 0) keep(frame, live);
}

void History::cut(int64_t frame) {
    if (frame >= newest()) return;
    steps_.resize(size_t(frame));
    while (!images_.empty() && images_.back().frame > frame) bytes_ -= images_.back().data.size(), images_.pop_back();
}

void History::keep(int64_t frame, const LiveWorld& live) {
    Image image;
    image.frame = frame, image.standing = live.standing();
    image.data.resize(thawWorld_GetSnapshotSize(live.world(), thawSnapshot_world));
    size_t written = 0;
    if (image.data.empty() || thawWorld_Save(live.world(), thawSnapshot_world, image.data.data(), image.data.size(),
                                             &written) != thawResult_ok)
        return;
    image.data.resize(written);
    bytes_ += written;
    images_.push_back(std::move(image));
    while (bytes_ > limit_ && images_.size() > 3) thin();
}

void History::thin() {
    // The one that is missed least: with the smallest gap, for how long ago it is. The start and the newest stay.
    size_t least = 1;
    double best = 1e300;
    for (size_t i = 1; i + 1 < images_.size(); ++i) {
        const double gap = double(images_[i + 1].frame - images_[i - 1].frame);
        const double cost = gap / double(images_.back().frame - images_[i].frame + kEvery);
        if (cost < best) best = cost, least = i;
    }
    bytes_ -= images_[least].data.size();
    images_.erase(images_.begin() + int64_t(least));
}

int64_t History::imageBefore(int64_t frame) const {
    const auto after = std::upper_bound(images_.begin(), images_.end(), frame,
                                        [](int64_t f, const Image& image) { return f < image.frame; });
    return after == images_.begin() ? -1 : std::prev(after)->frame;
}

int64_t History::restore(int64_t frame, LiveWorld& live) const {
    const int64_t at = imageBefore(frame);
    if (at < 0 || !live.world()) return -1;
    const Image& image = *std::find_if(images_.begin(), images_.end(), [&](const Image& i) { return i.frame == at; });
    if (thawWorld_Restore(live.world(), image.data.data(), image.data.size()) != thawResult_ok) return -1;
    live.stand(image.standing);
    return at;
}

} // namespace thaw::editor
