// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// GIF 89a with one palette for all frames. It can be chosen only once all of them are known, so they wait, deflated.
#include "view/animation.h"
#include "view/palette.h"
#include "view/part_file.h"

#include <gif_lib.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace thaw::view {

namespace {
constexpr uint8_t kSame = 255; // index of what has not changed: it is left transparent

class Gif final : public AnimationWriter {
public:
    explicit Gif(const Animation& a) : animation_(a), place_(a.path) {}

    // Whether there will be a file, before hours of work for it.
    bool canBeWritten() const {
        std::FILE* file = std::fopen(place_.part().c_str(), "wb");
        return file && std::fclose(file) == 0;
    }

    bool add(const Image& image, std::string& error) override {
        if (image.width != animation_.width || image.height != animation_.height ||
            int(waiting_.size()) == animation_.frames)
            return error = "a frame of another size, or one too many", false;
        colors_.add(image);
        const uLong raw = uLong(image.pixels.size() * sizeof(Rgba));
        uLongf size = compressBound(raw);
        std::vector<uint8_t> out(size);
        if (compress2(out.data(), &size, reinterpret_cast<const Bytef*>(image.pixels.data()), raw, 1) != Z_OK)
            return error = "a frame cannot be compressed", false;
        out.resize(size), out.shrink_to_fit();
        waiting_.push_back(std::move(out));
        return true;
    }

    bool finish(std::string& error) override {
        if (int(waiting_.size()) != animation_.frames) return error = "frames are missing", false;
        int why = 0;
        GifFileType* gif = EGifOpenFileName(place_.part().c_str(), false, &why);
        if (!gif) return error = "cannot write " + place_.part() + ": " + reason(why), false;
        const bool written = writeAll(gif);
        if (!written) why = gif->Error;
        int closing = 0;
        if (EGifCloseFile(gif, &closing) != GIF_OK || !written)
            return error = "cannot write " + place_.part() + ": " + reason(written ? closing : why), false;
        return place_.moveToPlace(error);
    }

private:
    static std::string reason(int code) {
        const char* text = GifErrorString(code);
        return text ? text : "unknown";
    }

    bool writeAll(GifFileType* gif) {
        const std::vector<Rgba> palette = colors_.palette(kSame);
        GifColorType colors[256] = {};
        for (size_t i = 0; i < palette.size(); ++i) colors[i] = {palette[i].r, palette[i].g, palette[i].b};
        const std::unique_ptr<ColorMapObject, void (*)(ColorMapObject*)> map(GifMakeMapObject(256, colors),
                                                                             &GifFreeMapObject);
        if (!map) return false;
        EGifSetGifVersion(gif, true);
        const uint8_t forever[3] = {1, 0, 0};
        if (EGifPutScreenDesc(gif, animation_.width, animation_.height, 8, 0, map.get()) != GIF_OK ||
            EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE) != GIF_OK ||
            EGifPutExtensionBlock(gif, 11, "NETSCAPE2.0") != GIF_OK ||
            EGifPutExtensionBlock(gif, sizeof forever, forever) != GIF_OK || EGifPutExtensionTrailer(gif) != GIF_OK)
            return false;
        Dither dither(palette);
        Image image(animation_.width, animation_.height);
        std::vector<uint8_t> shown;
        for (size_t k = 0; k < waiting_.size(); ++k) {
            uLongf size = uLongf(image.pixels.size() * sizeof(Rgba));
            if (uncompress(reinterpret_cast<Bytef*>(image.pixels.data()), &size, waiting_[k].data(),
                           uLong(waiting_[k].size())) != Z_OK)
                return false;
            std::vector<uint8_t> indices = dither.indices(image);
            if (!writeFrame(gif, k, indices, shown)) return false;
            shown = std::move(indices);
        }
        return true;
    }

    bool writeFrame(GifFileType* gif, size_t k, const std::vector<uint8_t>& indices,
                    const std::vector<uint8_t>& shown) {
        const auto at = [&](int x, int y) { return size_t(y) * size_t(animation_.width) + size_t(x); };
        int left = animation_.width, right = -1, top = animation_.height, bottom = -1;
        for (int y = 0; y < animation_.height; ++y)
            for (int x = 0; x < animation_.width; ++x)
                if (shown.empty() || shown[at(x, y)] != indices[at(x, y)])
                    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = y;
        if (right < 0) left = right = top = bottom = 0;
        // Hundredths of a second: rounded so that the sum is right.
        const auto time = [&](size_t frames) {
            return std::lround(100.0 * double(frames) / animation_.framesPerSecond);
        };
        GraphicsControlBlock control{};
        control.DisposalMode = DISPOSE_DO_NOT;
        control.DelayTime = int(time(k + 1) - time(k));
        if (k + 1 == waiting_.size()) control.DelayTime += int(std::lround(100 * animation_.hold));
        control.TransparentColor = kSame;
        GifByteType block[4];
        const int width = right - left + 1;
        if (EGifGCBToExtension(&control, block) != 4 ||
            EGifPutExtension(gif, GRAPHICS_EXT_FUNC_CODE, 4, block) != GIF_OK ||
            EGifPutImageDesc(gif, left, top, width, bottom - top + 1, false, nullptr) != GIF_OK)
            return false;
        std::vector<GifPixelType> row(static_cast<size_t>(width));
        for (int y = top; y <= bottom; ++y) {
            for (int x = left; x <= right; ++x)
                row[size_t(x - left)] =
                    !shown.empty() && shown[at(x, y)] == indices[at(x, y)] ? kSame : indices[at(x, y)];
            if (EGifPutLine(gif, row.data(), width) != GIF_OK) return false;
        }
        return true;
    }

    Animation animation_;
    PartFile place_;
    ColorCount colors_;
    std::vector<std::vector<uint8_t>> waiting_;
};
} // namespace

std::unique_ptr<AnimationWriter> createGif(const Animation& animation, std::string& error) {
    auto made = std::make_unique<Gif>(animation);
    if (made->canBeWritten()) return made;
    error = "cannot write " + animation.path;
    return nullptr;
}

} // namespace thaw::view
