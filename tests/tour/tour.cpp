// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "editor/hand.h"
#include "view/palette.h"
#include "view/png.h"

#include <CLI/CLI.hpp>
#include <GLFW/glfw3.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

// Pictures of the editor in use, for its guide: each is made by the same hand on mouse and keys as the tests have.
// `./thaw gallery` runs it.

using namespace thaw::editor;
namespace scene = thaw::scene;

namespace {

void require(bool so, const char* what) {
    if (!so) throw std::runtime_error(what);
}

/// A picture of 256 colours: a third of the size, and text stays sharp.
void writeIndexed(const std::string& path, const thaw::view::Image& image) {
    using namespace thaw::view;
    ColorCount colors;
    colors.add(image);
    const std::vector<Rgba> palette = colors.palette(256);
    PngBytes rows;
    std::map<uint32_t, uint8_t> known;
    for (int y = 0; y < image.height; ++y) {
        rows.push_back(0); // no filter
        for (int x = 0; x < image.width; ++x) {
            const Rgba& p = image.at(x, y);
            const auto [place, fresh] = known.try_emplace(uint32_t(p.r) << 16 | uint32_t(p.g) << 8 | p.b, 0);
            if (fresh) {
                const auto far = [&](const Rgba& c) {
                    const int r = c.r - p.r, g = c.g - p.g, b = c.b - p.b;
                    return r * r + g * g + b * b;
                };
                const auto best = std::min_element(palette.begin(), palette.end(),
                                                   [&](const Rgba& a, const Rgba& b) { return far(a) < far(b); });
                place->second = uint8_t(best - palette.begin());
            }
            rows.push_back(place->second);
        }
    }
    PngBytes head, table, packed(compressBound(uLong(rows.size())));
    putPngNumber(head, uint32_t(image.width), 4), putPngNumber(head, uint32_t(image.height), 4);
    head.insert(head.end(), {8, 3, 0, 0, 0}); // 8 bits, palette, deflate, filters by row, not interlaced
    for (const Rgba& c : palette) table.insert(table.end(), {c.r, c.g, c.b});
    uLongf size = packed.size();
    require(compress2(packed.data(), &size, rows.data(), uLong(rows.size()), 9) == Z_OK, "no memory for a picture");
    packed.resize(size);
    std::FILE* file = std::fopen(path.c_str(), "wb");
    require(file, "the picture cannot be written");
    static constexpr uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const bool begun = std::fwrite(kSignature, 1, sizeof kSignature, file) == sizeof kSignature;
    writePngChunk(file, "IHDR", head), writePngChunk(file, "PLTE", table), writePngChunk(file, "IDAT", packed);
    writePngChunk(file, "IEND", {});
    const bool whole = !std::ferror(file) && begun;
    require(std::fclose(file) == 0 && whole, "the picture cannot be written");
}

struct Tour {
    Hand& hand;

    Studio& studio() { return hand.studio(); }
    void settle() { require(hand.settle(), "the simulation does not follow"); }
    void choose(Kind kind, int index = 0) { hand.click("item " + titleOf(studio().scene(), {kind, index})); }
    void play(int frames) {
        thawInitBudget(&studio().orders().budget); // the same work everywhere
        studio().orders().steps += uint64_t(frames);
        require(hand.wait([&] { return studio().frame().frame >= frames; }, 40000), "the simulation does not run");
    }
    /// A point on the side of the candle that is seen.
    Hand::Point side(float x, float y) { return hand.at(thawVec3{x, y, 0.017f}); }
    void drawS() {
        hand.click("tool Path");
        hand.move(side(0, 0.105f));
        hand.press();
        for (int i = 0; i <= 24; ++i)
            hand.move(side(0.009f * std::sin(0.2618f * float(i)), 0.105f - 0.08f * float(i) / 24));
        hand.release();
        hand.frame(2);
        require(studio().scene().paths.size() == 1, "no path was drawn");
    }
    /// Over a body, from the left to the right.
    void stroke(const char* tool, thawVec3 from, thawVec3 to) {
        hand.click(std::string("tool ") + tool);
        hand.drag(hand.at(from), hand.at(to), 10);
        hand.move(hand.at(to));
        settle();
    }

    void draw() {
        drawS();
        hand.click("tool Heat");
        hand.click(hand.at(thawVec3{0, 0.108f, 0.018f}));
        require(studio().scene().heatSources.size() == 2, "no heat source was placed");
        choose(Kind::path);
        settle();
        play(300);
    }
    void move() {
        hand.click("tool Move");
        choose(Kind::body);
    }
    void turn() {
        hand.click("tool Turn");
        choose(Kind::body);
    }
    void scale() {
        hand.click("tool Scale");
        choose(Kind::body);
    }
    void path() {
        drawS();
        hand.move(side(0.004f, 0.04f));
        settle();
    }
    void shape() {
        hand.move(hand.at(thawVec3{0, 0.05f, 0}));
        hand.wheel(-4);
        hand.click("tool Shape");
        const auto on = [&](float angle) {
            return hand.at(thawVec3{0.05f + 0.02f * std::cos(angle), 0, 0.05f + 0.02f * std::sin(angle)});
        };
        hand.move(on(0));
        hand.press();
        for (int i = 0; i <= 24; ++i) hand.move(on(0.2618f * float(i)));
        hand.release();
        hand.frame(2);
        require(studio().scene().shapes.size() == 1, "no shape was drawn");
        settle();
    }
    void heat() {
        hand.click("tool Heat");
        const Hand::Point at = hand.at(thawVec3{0, 0.08f, 0.018f});
        hand.click(at);
        require(studio().scene().heatSources.size() == 2, "no heat source was placed");
        settle();
    }
    void collider() {
        hand.move(hand.at(thawVec3{0, 0.05f, 0}));
        hand.wheel(-2);
        hand.click("tool Collider");
        hand.click(hand.at(thawVec3{0.05f, 0, 0.05f}));
        require(studio().scene().colliders.size() == 3, "no collider was placed");
        settle();
    }
    void warmth() {
        studio().view.picture = scene::PictureView::temperature;
        stroke("Warmth", {-0.01f, 0.09f, 0.016f}, {0.012f, 0.06f, 0.016f});
        choose(Kind::body);
    }
    void soot() {
        studio().view.picture = scene::PictureView::absorptivity;
        stroke("Soot", {-0.01f, 0.09f, 0.016f}, {0.012f, 0.05f, 0.016f});
        choose(Kind::body);
    }
    void erase() {
        drawS();
        hand.click("tool Erase");
        hand.click(side(0, 0.065f));
        require(studio().scene().paths.size() == 2, "nothing was erased");
        hand.move(side(0, 0.065f));
        settle();
    }
    void probe() {
        studio().view.picture = scene::PictureView::particles;
        settle();
        play(60);
        hand.click("tool Probe");
        hand.click(side(0, 0.09f));
        require(hand.wait([&] { return studio().hasPickedParticle; }), "no particle was picked");
        hand.frame(3);
    }
    void time() {
        drawS();
        settle();
        play(240);
        hand.click("tab Plan");
    }
    void material() { choose(Kind::material); }
    void camera() {
        hand.drag(hand.at(thawVec3{-0.05f, 0.12f, 0}), hand.at(thawVec3{0.02f, 0.1f, 0}), 8, 1);
        hand.click("item Camera");
    }
    void export_() {
        hand.key(GLFW_KEY_E, true);
        require(hand.wait([&] { return hand.sees("begin export"); }, 50), "no export window");
        // Not the folder of this machine.
        hand.frame(2);
        hand.click("export folder");
        hand.key(GLFW_KEY_A, true);
        hand.type("/home/artist/candle");
        hand.key(GLFW_KEY_HOME);
    }
    void keys() { hand.key(GLFW_KEY_SLASH, false, true); }
};

struct Stop {
    const char* name;
    void (Tour::*go)();
};
constexpr Stop kStops[] = {{"draw", &Tour::draw},      {"move", &Tour::move},         {"turn", &Tour::turn},
                           {"scale", &Tour::scale},    {"path", &Tour::path},         {"shape", &Tour::shape},
                           {"heat", &Tour::heat},      {"collider", &Tour::collider}, {"warmth", &Tour::warmth},
                           {"soot", &Tour::soot},      {"erase", &Tour::erase},       {"probe", &Tour::probe},
                           {"time", &Tour::time},      {"material", &Tour::material}, {"camera", &Tour::camera},
                           {"export", &Tour::export_}, {"keys", &Tour::keys}};

void show(const std::string& name, const std::string& file, const std::string& out) {
    const Stop* stop = nullptr;
    for (const Stop& s : kStops)
        if (name == s.name) stop = &s;
    require(stop, "there is no such picture");
    const Folder folder;
    Hand hand(folder, 1120, 700);
    // The pointer rests where it changes nothing.
    hand.app().drop(file);
    Tour tour{hand};
    tour.settle();
    (tour.*stop->go)();
    const bool keepsPointer = name == "path" || name == "erase" || name == "heat";
    if (!keepsPointer) hand.move({560, 695});
    // What was said for a moment is gone, and the picture is as fine as it gets.
    require(hand.wait([&] { return hand.studio().notice().text.empty() && hand.app().viewport().sharp(); }),
            "the picture does not come to rest");
    hand.frame(3);
    std::filesystem::create_directories(out);
    writeIndexed((std::filesystem::path(out) / "capture_000.png").string(), hand.picture());
}

} // namespace

int main(int count, char** values) {
    CLI::App command("Pictures of the editor in use, for its guide.", "thaw-tour");
    std::string name, file, out;
    command.add_option("name", name, "What is shown: draw, move, turn, scale, path, ...")->required();
    command.add_option("scene", file, "Scene (JSON) that is edited")->required();
    command.add_option("--out", out, "Folder for capture_000.png")->required();
    CLI11_PARSE(command, count, values);
    try {
        show(name, file, out);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "thaw-tour: %s: %s\n", name.c_str(), e.what());
        return 1;
    }
    return 0;
}
