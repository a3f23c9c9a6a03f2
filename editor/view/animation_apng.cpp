// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Animated PNG, as in the PNG specification, third edition: the first frame is the picture that any reader shows, each
// later one is what has changed since. Truecolour without alpha.
#include "view/animation.h"
#include "view/part_file.h"
#include "view/png.h"

#include <cmath>
#include <cstdio>

namespace thaw::view {

namespace {
class Apng final : public AnimationWriter {
public:
    Apng(const Animation& a) : animation_(a), place_(a.path), file_(std::fopen(place_.part().c_str(), "wb")) {
        if (!file_) return;
        startPng(file_.get(), a.width, a.height, 3);
        PngBytes control;
        putPngNumber(control, uint32_t(a.frames), 4), putPngNumber(control, 0, 4); // without end
        chunk("acTL", control);
    }
    bool isOpen() const { return file_ != nullptr; }

    bool add(const Image& image, std::string& error) override {
        if (image.width != animation_.width || image.height != animation_.height || count_ == animation_.frames)
            return error = "a frame of another size, or one too many", false;
        const Rectangle r = count_ ? changedPart(last_, image) : Rectangle{0, 0, image.width, image.height};
        const bool isLast = ++count_ == animation_.frames;
        PngBytes frame;
        putPngNumber(frame, sequence_++, 4);
        for (const int v : {r.width, r.height, r.x, r.y}) putPngNumber(frame, uint32_t(v), 4);
        // Milliseconds where it is held, for which 60 s fit.
        const double seconds = 1.0 / animation_.framesPerSecond + animation_.hold;
        const bool held = isLast && animation_.hold > 0;
        putPngNumber(frame, held ? uint32_t(std::lround(1000 * seconds)) : 1, 2);
        putPngNumber(frame, held ? 1000 : uint32_t(animation_.framesPerSecond), 2);
        putPngNumber(frame, 0, 1), putPngNumber(frame, 0, 1); // stays for the next one; replaces what is there
        chunk("fcTL", frame);
        const bool isFirst = count_ == 1;
        PngBytes data = packedPng(image, r, 3, isFirst ? 0 : 4);
        if (data.empty()) return error = "a frame cannot be compressed", false;
        for (int k = 0; !isFirst && k < 4; ++k) data[size_t(k)] = uint8_t(sequence_ >> (24 - 8 * k));
        if (!isFirst) ++sequence_;
        chunk(isFirst ? "IDAT" : "fdAT", data);
        last_ = image;
        if (std::ferror(file_.get())) return error = "cannot write " + place_.part(), false;
        return true;
    }

    bool finish(std::string& error) override {
        if (count_ != animation_.frames) return error = "frames are missing", false;
        chunk("IEND", {});
        const bool bad = std::ferror(file_.get()) != 0;
        if (std::fclose(file_.release()) != 0 || bad) return error = "cannot write " + place_.part(), false;
        return place_.moveToPlace(error);
    }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    void chunk(const char* type, const PngBytes& data) { writePngChunk(file_.get(), type, data); }

    Animation animation_;
    PartFile place_; // before the file: it must be closed first
    std::unique_ptr<std::FILE, Close> file_;
    Image last_;
    int count_ = 0;
    uint32_t sequence_ = 0;
};
} // namespace

std::unique_ptr<AnimationWriter> createApng(const Animation& animation, std::string& error) {
    auto made = std::make_unique<Apng>(animation);
    if (made->isOpen()) return made;
    error = "cannot write " + animation.path;
    return nullptr;
}

} // namespace thaw::view
