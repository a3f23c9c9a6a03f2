// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "apng.h"
#include "player.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

using namespace thaw::test;
namespace fs = std::filesystem;

namespace {
std::set<std::string> namesIn(const std::string& folder) {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) out.insert(entry.path().filename().string());
    return out;
}

std::string hashIn(const std::string& out) {
    const size_t at = out.find("state hash");
    return at == std::string::npos ? "" : out.substr(at);
}

void checkRefused(std::vector<std::string> arguments, int exitCode, const std::string& says) {
    arguments.insert(arguments.begin(), "capture");
    const Answer answer = player(arguments);
    CAPTURE(answer.err);
    CHECK(answer.exitCode == exitCode);
    CHECK(lineCount(answer.err) == 1);
    CHECK(contains(answer.err, says));
    CHECK(answer.out == "");
}
} // namespace

TEST_CASE("capture takes a melt as numbered pictures and as an animation of the same") {
    const Folder folder;
    // Its camera moves: every frame is another.
    const std::string scene =
        folder.write("s.json", replaced(kSmallScene, "\"fieldOfViewDegrees\": 30",
                                        "\"keys\": [{\"time\": 0}, {\"time\": 0.2, \"eye\": [0.2, 0.1, 0.1]}]"));
    const std::string out = folder.path("o"), film = folder.path("film.png");
    const Answer answer = player({"capture", scene, "--sequence", "--out", out, "--animation", film, "--fps", "20",
                                  "--size", "64x48", "--hold", "0.45", "--quiet"});
    CAPTURE(answer.err);
    REQUIRE(answer.exitCode == 0);
    CHECK(answer.err == "");
    CHECK(contains(answer.out, "5 frames, 20 a second"));
    // 0.2 s at 20 a second: with its first frame that is five.
    CHECK(namesIn(out) == std::set<std::string>{"frame_0000.png", "frame_0001.png", "frame_0002.png", "frame_0003.png",
                                                "frame_0004.png"});
    const Apng apng = parseApng(readFile(film));
    CHECK(apng.width == 64);
    CHECK(apng.height == 48);
    CHECK(apng.plays == 0);
    REQUIRE(apng.frames.size() == 5);
    for (size_t k = 0; k < 5; ++k) {
        CHECK(double(apng.frames[k].delay) / apng.frames[k].delayUnits ==
              doctest::Approx(k < 4 ? 0.05 : 0.5).epsilon(1e-3));
        CHECK(apng.frames[k].width > 32); // what moves is all over
    }
    std::set<std::string> different;
    for (const std::string& name : namesIn(out)) different.insert(readFile(out + "/" + name));
    CHECK(different.size() == 5);
    // The steps are those of a run, not of the pictures.
    const Answer slow =
        player({"capture", scene, "--animation", folder.path("b.gif"), "--fps", "5", "--size", "32x32", "--quiet"});
    REQUIRE(slow.exitCode == 0);
    CHECK(contains(slow.out, "2 frames, 5 a second"));
    CHECK(hashIn(slow.out) == hashIn(answer.out));
    CHECK(readFile(folder.path("b.gif")).compare(0, 6, "GIF89a") == 0);
    const Answer shorter = player({"capture", scene, "--animation", film, "--seconds", "0.1", "--fps", "10", "--size",
                                   "32x32", "--view", "temperature"});
    REQUIRE(shorter.exitCode == 0);
    CHECK(contains(shorter.err, "0.1 of 0.1 s")); // progress
    CHECK(parseApng(readFile(film)).frames.size() == 2);
    CHECK(parseApng(readFile(film)).width == 32);
}

TEST_CASE("an animation that cannot be made is refused before the melt") {
    const Folder folder;
    const std::string scene = folder.write("s.json", kSmallScene), gif = folder.path("a.gif");
    checkRefused({scene}, 2, "--out is required");
    checkRefused({scene, "--sequence"}, 2, "--sequence needs --out FOLDER");
    checkRefused({scene, "--animation", gif, "--out", folder.path("o")}, 2, "need --sequence");
    checkRefused({scene, "--animation", folder.path("a.avi")}, 2,
                 "--animation: must end in .png, .apng, .gif, .mp4 or");
    checkRefused({scene, "--animation", folder.path("a")}, 2, "--animation: must end in");
    checkRefused({scene, "--animation", gif, "--fps", "0"}, 2, "--fps: must be in 1..60, got 0");
    checkRefused({scene, "--animation", gif, "--fps", "61"}, 2, "--fps: must be in 1..60, got 61");
    checkRefused({scene, "--animation", gif, "--fps", "60"}, 2,
                 "--fps: a GIF shows 50 frames a second at most, got 60");
    checkRefused({scene, "--animation", gif, "--seconds=-1"}, 2, "--seconds: must be in 0.01..3600 s, got -1");
    checkRefused({scene, "--animation", gif, "--seconds", "nan"}, 2, "--seconds: must be in");
    checkRefused({scene, "--animation", gif, "--seconds", "3600", "--fps", "50"}, 2,
                 "180001 frames, the most are 100000");
    checkRefused({scene, "--animation", gif, "--hold", "61"}, 2, "--hold: must be in 0..60 s, got 61");
    checkRefused({scene, "--animation", gif, "--threads", "0"}, 2, "--threads: must be in 1..64, got 0");
    checkRefused({scene, "--animation", gif, "--at", "1"}, 2, "--at");
    checkRefused({scene, "--animation", gif, "--sheet"}, 2, "--sheet");
    checkRefused({scene, "--animation", gif, "--coarsest-level", "1"}, 2, "--coarsest-level");
    checkRefused({scene, scene, "--animation", gif}, 2, "take one scene");
    checkRefused({scene, "--animation", gif, "--view", "shaded,phase"}, 2, "take one view");
    checkRefused({scene, "--animation", folder.path("a.mp4"), "--size", "33x32"}, 2, "even sides, got 33x32");
    checkRefused({scene, "--out", folder.path("o"), "--fps", "10"}, 2, "--fps needs --sequence or --animation FILE");
    checkRefused({scene, "--out", folder.path("o"), "--seconds", "1"}, 2, "--seconds needs");
    checkRefused({scene, "--animation", folder.path("none/a.gif")}, 1, "cannot write");
    checkRefused({scene, "--sequence", "--out", folder.write("file", "x") + "/below"}, 1, "cannot be made a folder");
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder.path("nothing").c_str(), 1);
    checkRefused({scene, "--animation", folder.path("a.mp4"), "--size", "32x32"}, 1, "needs the program ffmpeg");
    setenv("PATH", path.c_str(), 1);
    CHECK(namesIn(folder.path("")) == std::set<std::string>{"s.json", "file"});
}

TEST_CASE("validate surface scenes steps the scenes of a folder and looks at their meshes") {
    const Folder folder;
    // Solid all along: a cube, whose mesh has the volume of what it holds.
    folder.write("scenes/small.json",
                 replaced(kSmallScene, "\"particleSpacing\": 0.005", "\"particleSpacing\": 0.0015"));
    const Answer answer =
        player({"validate", "surface", "scenes", "--scenes", folder.path("scenes"), "--out", folder.path("rows.csv")});
    CAPTURE(answer.out);
    CHECK(answer.exitCode == 0);
    CHECK(contains(answer.out, "small: edges with one triangle"));
    CHECK(contains(answer.out, "3 rows, 0 out"));
    const std::string rows = readFile(folder.path("rows.csv"));
    CHECK(contains(rows, "edges with more than two\",at most,0,0,0,0,1"));
    CHECK(contains(rows, "volume against the particles', frame "));
    const Answer none = player({"validate", "surface", "scenes", "--scenes", folder.path("nowhere")});
    CHECK(none.exitCode == 1);
    CHECK(contains(none.out, "no scenes in"));
    folder.write("scenes/bad.json", "{}");
    const Answer bad = player({"validate", "surface", "scenes", "--scenes", folder.path("scenes")});
    CHECK(bad.exitCode == 1);
    CHECK(contains(bad.out, "bad.json: at /: key 'thawScene' is missing"));
}
