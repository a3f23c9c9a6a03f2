// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "view/animation.h"

#include "apng.h"
#include "view/palette.h"

#include <doctest/doctest.h>
#include <gif_lib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

using namespace thaw::view;
namespace fs = std::filesystem;

namespace {
struct TemporaryFolder {
    fs::path path = fs::temp_directory_path() / ("thaw-animation-" + std::to_string(getpid()));
    TemporaryFolder() { fs::create_directories(path); }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    std::string file(const std::string& name) const { return (path / name).string(); }
    std::set<std::string> names() const {
        std::set<std::string> out;
        for (const auto& entry : fs::directory_iterator(path)) out.insert(entry.path().filename().string());
        return out;
    }
};

constexpr int kWidth = 48, kHeight = 34;

// A gradient in which a disc wanders; the third frame is as the second.
std::vector<Image> frames() {
    std::vector<Image> out;
    for (const int k : {0, 1, 1, 3, 4}) {
        Image image(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                image.at(x, y) = {uint8_t(3 * x), uint8_t(4 * y), uint8_t(80 + x - y), 255};
                if (std::hypot(x - 10 - 5 * k, y - 12 - 2 * k) < 6) image.at(x, y) = {250, uint8_t(40 * k), 20, 255};
            }
        out.push_back(image);
    }
    return out;
}

std::string contentOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void writeAll(const Animation& animation, const std::vector<Image>& images) {
    std::string error;
    const auto writer = AnimationWriter::create(animation, error);
    REQUIRE_MESSAGE(writer != nullptr, error);
    for (const Image& image : images) REQUIRE(writer->add(image, error));
    REQUIRE_MESSAGE(writer->finish(error), error);
}

void copyInto(Image& canvas, const Image& part, int x0, int y0) {
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) canvas.at(x0 + x, y0 + y) = part.at(x, y);
}
} // namespace

TEST_CASE("an APNG holds every frame exactly, in its time, and plays without end") {
    const TemporaryFolder folder;
    const std::vector<Image> images = frames();
    writeAll({folder.file("a.png"), kWidth, kHeight, int(images.size()), 12, 1.5}, images);
    CHECK(folder.names() == std::set<std::string>{"a.png"});
    const thaw::test::Apng apng = thaw::test::parseApng(contentOf(folder.file("a.png")));
    CHECK(apng.width == kWidth);
    CHECK(apng.height == kHeight);
    CHECK(apng.plays == 0);
    REQUIRE(apng.frames.size() == images.size());
    Image canvas(kWidth, kHeight);
    for (size_t k = 0; k < images.size(); ++k) {
        CAPTURE(k);
        const thaw::test::ApngFrame& f = apng.frames[k];
        const double seconds = double(f.delay) / f.delayUnits;
        CHECK(seconds == doctest::Approx(k + 1 < images.size() ? 1.0 / 12 : 1.5 + 1.0 / 12).epsilon(0.001));
        CHECK(f.dispose == 0);
        CHECK(f.blend == 0);
        std::ofstream(folder.file("frame.png"), std::ios::binary) << f.png;
        std::string error;
        const std::optional<Image> part = readPng(folder.file("frame.png"), error);
        REQUIRE_MESSAGE(part, error);
        copyInto(canvas, *part, int(f.x), int(f.y));
        CHECK(canvas.pixels == images[k].pixels);
        if (k > 0) CHECK(f.width * f.height < kWidth * kHeight / 2); // only what has changed
    }
    CHECK(apng.frames[2].width == 1);
    // Any reader of PNG shows the first one.
    std::string error;
    const std::optional<Image> still = readPng(folder.file("a.png"), error);
    REQUIRE(still);
    CHECK(still->pixels == images[0].pixels);
}

TEST_CASE("a GIF holds every frame in 256 colours, keeps time in the sum, and plays without end") {
    const TemporaryFolder folder;
    const std::vector<Image> images = frames();
    writeAll({folder.file("a.gif"), kWidth, kHeight, int(images.size()), 30, 2}, images);
    CHECK(folder.names() == std::set<std::string>{"a.gif"});
    int why = 0;
    const std::unique_ptr<GifFileType, void (*)(GifFileType*)> gif(DGifOpenFileName(folder.file("a.gif").c_str(), &why),
                                                                   [](GifFileType* g) { DGifCloseFile(g, nullptr); });
    REQUIRE(gif);
    REQUIRE(DGifSlurp(gif.get()) == GIF_OK);
    CHECK(gif->SWidth == kWidth);
    CHECK(gif->SHeight == kHeight);
    REQUIRE(gif->ImageCount == int(images.size()));
    REQUIRE(gif->SColorMap);
    bool forever = false;
    const SavedImage& first = gif->SavedImages[0];
    for (int e = 0; e + 1 < first.ExtensionBlockCount; ++e) {
        const ExtensionBlock &name = first.ExtensionBlocks[e], &data = first.ExtensionBlocks[e + 1];
        forever =
            forever || (std::string(reinterpret_cast<char*>(name.Bytes), size_t(name.ByteCount)) == "NETSCAPE2.0" &&
                        data.ByteCount == 3 && data.Bytes[1] == 0 && data.Bytes[2] == 0);
    }
    CHECK(forever);
    Image canvas(kWidth, kHeight);
    std::vector<int> delays;
    for (int k = 0; k < gif->ImageCount; ++k) {
        CAPTURE(k);
        const SavedImage& s = gif->SavedImages[k];
        GraphicsControlBlock control{};
        REQUIRE(DGifSavedExtensionToGCB(gif.get(), k, &control) == GIF_OK);
        delays.push_back(control.DelayTime);
        CHECK(control.DisposalMode == DISPOSE_DO_NOT);
        for (int y = 0; y < s.ImageDesc.Height; ++y)
            for (int x = 0; x < s.ImageDesc.Width; ++x) {
                const int index = s.RasterBits[y * s.ImageDesc.Width + x];
                if (index == control.TransparentColor) continue;
                const GifColorType& c = gif->SColorMap->Colors[index];
                canvas.at(s.ImageDesc.Left + x, s.ImageDesc.Top + y) = {c.Red, c.Green, c.Blue, 255};
            }
        const ImageDifference d = compare(canvas, images[size_t(k)], 24);
        CHECK(d.meanAbsolute < 6);
        CHECK(d.shareOver < 0.01);
        if (k > 0) CHECK(s.ImageDesc.Width * s.ImageDesc.Height < kWidth * kHeight);
    }
    // 30 a second do not fit hundredths: 3 and 4 take turns.
    CHECK(delays == std::vector<int>{3, 4, 3, 3, 4 + 200});
}

TEST_CASE("a palette holds the colours there are, when they fit") {
    Image image(16, 4);
    const Rgba colors[4] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {10, 20, 250, 255}, {130, 130, 130, 255}};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 16; ++x) image.at(x, y) = colors[y];
    ColorCount count;
    count.add(image);
    const std::vector<Rgba> palette = count.palette(255);
    REQUIRE(palette.size() == 4);
    for (const Rgba& c : colors) CHECK(std::find(palette.begin(), palette.end(), c) != palette.end());
    CHECK(count.palette(2).size() == 2);
    CHECK(ColorCount().palette(255).empty());
    // Where the colours are far apart, the pattern does not show.
    const std::vector<uint8_t> indices = Dither(palette).indices(image);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 16; ++x) CHECK(palette[indices[size_t(16 * y + x)]] == colors[y]);
}

TEST_CASE("between two colours the pattern keeps the mean") {
    Image image(64, 64, {104, 104, 104, 255});
    Dither dither({{100, 100, 100, 255}, {108, 108, 108, 255}});
    double sum = 0;
    for (const uint8_t i : dither.indices(image)) sum += i ? 108 : 100;
    CHECK(sum / (64 * 64) == doctest::Approx(104).epsilon(0.02));
}

TEST_CASE("an animation that is not finished leaves what was there") {
    const TemporaryFolder folder;
    const std::vector<Image> images = frames();
    for (const char* name : {"a.png", "a.gif"}) {
        CAPTURE(name);
        std::ofstream(folder.file(name)) << "old";
        {
            std::string error;
            const auto writer = AnimationWriter::create({folder.file(name), kWidth, kHeight, 5, 30, 0}, error);
            REQUIRE(writer);
            CHECK(writer->add(images[0], error));
            CHECK_FALSE(writer->add(Image(kWidth, kHeight + 1), error));
            CHECK_FALSE(writer->finish(error));
            CHECK(error == "frames are missing");
        }
        CHECK(contentOf(folder.file(name)) == "old");
    }
    CHECK(folder.names() == std::set<std::string>{"a.gif", "a.png"}); // and no parts of files
    std::string error;
    const auto writer = AnimationWriter::create({folder.file("b.png"), kWidth, kHeight, 1, 30, 0}, error);
    CHECK(writer->add(images[0], error));
    CHECK_FALSE(writer->add(images[0], error));
}

TEST_CASE("an animation that cannot be is refused with a reason") {
    const TemporaryFolder folder;
    const auto refused = [&](const Animation& a, const std::string& why) {
        std::string error;
        CHECK(AnimationWriter::create(a, error) == nullptr);
        CHECK_MESSAGE(error.find(why) != std::string::npos, error);
    };
    refused({folder.file("a.avi"), 16, 16, 1, 30, 0}, "the ending must be");
    refused({folder.file("a"), 16, 16, 1, 30, 0}, "the ending must be");
    refused({folder.file("a.png"), 0, 16, 1, 30, 0}, "no such size");
    refused({folder.file("a.png"), 16, 16, 0, 30, 0}, "frames");
    refused({folder.file("a.png"), 16, 16, 1, 61, 0}, "1 to 60");
    refused({folder.file("a.gif"), 16, 16, 1, 51, 0}, "1 to 50");
    refused({folder.file("a.gif"), 16, 16, 1, 50, std::nan("")}, "last frame");
    refused({folder.file("a.mp4"), 17, 16, 1, 30, 0}, "even");
    for (const char* ending : {"png", "gif"})
        refused({folder.file("none/a.") + ending, 16, 16, 1, 30, 0}, "cannot write");
    CHECK(animationKind("x/Y.GIF") == AnimationKind::gif);
    CHECK(folder.names().empty());
}

TEST_CASE("a video is the work of ffmpeg, which gets every pixel") {
    const TemporaryFolder folder;
    const std::vector<Image> images = frames();
    const std::string old = std::getenv("PATH");
    // One that keeps what it is told and given.
    const auto pretend = [&](const std::string& script) {
        std::ofstream(folder.file("ffmpeg")) << "#!/bin/sh\n" << script;
        fs::permissions(folder.file("ffmpeg"), fs::perms::owner_all);
    };
    std::string error;
    setenv("PATH", folder.file("nothing").c_str(), 1);
    CHECK(AnimationWriter::create({folder.file("v.mp4"), kWidth, kHeight, 5, 25, 0}, error) == nullptr);
    CHECK(error.find("needs the program ffmpeg") != std::string::npos);
    setenv("PATH", (folder.path.string() + ":" + old).c_str(), 1);
    pretend("echo \"$@\" > '" + folder.file("words") + "'\nfor last; do :; done\ncat > \"$last\"\n");
    writeAll({folder.file("v.mp4"), kWidth, kHeight, 5, 25, 0}, images);
    const std::string video = contentOf(folder.file("v.mp4")), words = contentOf(folder.file("words"));
    REQUIRE(video.size() == 5 * images[0].pixels.size() * 4);
    for (size_t k = 0; k < 5; ++k)
        CHECK(std::memcmp(video.data() + k * video.size() / 5, images[k].pixels.data(), video.size() / 5) == 0);
    CHECK(words.find("-video_size 48x34 -framerate 25") != std::string::npos);
    CHECK(words.find(".part.mp4") != std::string::npos);
    // One that fails, and one that does not listen.
    std::ofstream(folder.file("v.mp4")) << "old";
    for (const char* script : {"cat > /dev/null; exit 3\n", "exit 3\n"}) {
        CAPTURE(script);
        pretend(script);
        const auto writer = AnimationWriter::create({folder.file("v.mp4"), kWidth, kHeight, 5, 25, 0}, error);
        REQUIRE(writer);
        bool good = true;
        for (const Image& image : images) good = good && writer->add(image, error);
        if (good) good = writer->finish(error);
        CHECK_FALSE(good);
        CHECK(error.find("ffmpeg") != std::string::npos);
        CHECK(contentOf(folder.file("v.mp4")) == "old");
    }
    CHECK(folder.names() == std::set<std::string>{"ffmpeg", "v.mp4", "words"});
    setenv("PATH", old.c_str(), 1);
}
