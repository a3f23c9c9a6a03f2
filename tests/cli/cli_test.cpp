// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "player.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>

using namespace thaw::test;

namespace {
// Exit code 2, one line on stderr that starts with the program and holds `says`, nothing on stdout.
void checkRefused(const std::vector<std::string>& arguments, const std::string& says) {
    const Answer answer = player(arguments);
    std::string command;
    for (const std::string& a : arguments) command += " " + a.substr(0, 80);
    CAPTURE(command);
    CAPTURE(answer.err);
    CHECK(answer.exitCode == 2);
    CHECK(lineCount(answer.err) == 1);
    CHECK(answer.err.compare(0, 6, "thaw: ") == 0);
    CHECK(contains(answer.err, says));
    CHECK(answer.out == "");
}

// A unit cube as triangles, for the formats below.
constexpr float kCorners[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
constexpr int kFaces[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                               {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};

std::string cubeObj() {
    std::string text = "# cube\no cube\n";
    for (const auto& v : kCorners)
        text += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
    for (const auto& f : kFaces)
        text +=
            "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " + std::to_string(f[2] + 1) + "\n";
    return text;
}

std::string cubePly() {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& v : kCorners)
        text += std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
    for (const auto& f : kFaces)
        text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
    return text;
}

void append(std::string& bytes, const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }

std::string cubeStl() { // binary: every triangle has corners of its own, to be welded
    std::string bytes(80, ' ');
    const uint32_t count = 12;
    append(bytes, &count, 4);
    for (const auto& f : kFaces) {
        const float normal[3] = {0, 0, 0};
        append(bytes, normal, 12);
        for (int k : f) append(bytes, kCorners[k], 12);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string cubeBinary() {
    std::string bytes;
    append(bytes, kCorners, sizeof kCorners);
    for (const auto& f : kFaces)
        for (int k : f) {
            const uint16_t index = uint16_t(k);
            append(bytes, &index, 2);
        }
    return bytes;
}

// Two nodes: the cube as it is, and one of half its size beside it. 1 + 1/8 of a cube, only if transforms are applied.
std::string cubesGltf(const char* buffer) {
    return std::string(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
"nodes": [{"mesh": 0}, {"translation": [3, 0, 0], "children": [2]}, {"mesh": 0, "scale": [0.5, 0.5, 0.5]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [
 {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
 {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
"buffers": [{)") +
           buffer + R"("byteLength": 168}]})";
}

std::string cubesGlb() {
    std::string json = cubesGltf("");
    while (json.size() % 4) json += ' ';
    const std::string bin = cubeBinary();
    std::string bytes = "glTF";
    const uint32_t header[2] = {2, uint32_t(12 + 8 + json.size() + 8 + bin.size())};
    append(bytes, header, 8);
    const uint32_t jsonHead[2] = {uint32_t(json.size()), 0x4E4F534Au}, binHead[2] = {uint32_t(bin.size()), 0x004E4942u};
    append(bytes, jsonHead, 8);
    bytes += json;
    append(bytes, binHead, 8);
    return bytes + bin;
}

// A scene that holds one mesh file, its unit being 2 cm.
std::string meshScene(const std::string& file) {
    return R"({"thawScene": 1, "world": {"particleSpacing": 0.002}, "bodies": [{"mesh": ")" + file +
           R"(", "scale": 0.02}]})";
}

// The number behind a word; -1 when it is not there. Fillings are not exact lattices: compare with a tolerance.
double countAfter(const std::string& out, const std::string& word) {
    const size_t at = out.find(word);
    return at == std::string::npos ? -1.0 : std::stod(out.substr(at + word.size()));
}

std::string hashOf(const std::string& out) {
    const size_t at = out.find("state hash");
    return at == std::string::npos ? "" : out.substr(at, out.find('\n', at) - at);
}

double reportedVolume(const std::string& out) { // cm^3
    const size_t end = out.find(" cm^3,");
    if (end == std::string::npos) return -1.0;
    const size_t start = out.rfind(' ', end - 1) + 1;
    return std::stod(out.substr(start, end - start));
}
} // namespace

TEST_CASE("help of every command is there and ends well") {
    const std::vector<std::vector<std::string>> commands = {{},       {"run"},   {"capture"},        {"melt"},
                                                            {"info"}, {"bench"}, {"bench", "scene"}, {"make-mesh"}};
    for (std::vector<std::string> command : commands) {
        command.push_back("--help");
        const Answer answer = player(command);
        CAPTURE(command[0]);
        CHECK(answer.exitCode == 0);
        CHECK(contains(answer.out, "Usage"));
        CHECK(answer.err == "");
    }
    const Answer answer = player({"--version"});
    CHECK(answer.exitCode == 0);
    CHECK(contains(answer.out, "thaw 0."));
}

TEST_CASE("wrong command lines are refused") {
    Folder folder;
    const std::string scene = folder.write("s.json", kSmallScene);
    checkRefused({}, "subcommand");
    checkRefused({"fly"}, "unknown command 'fly' (known: run, capture, melt, info, bench, validate, make-mesh)");
    checkRefused({"run"}, "scene is required");
    checkRefused({"run", scene, "--sconds", "1"}, "--sconds");
    checkRefused({"run", scene, "--seconds", "soon"}, "--seconds");
    checkRefused({"run", scene, "--seconds", "nan"}, "--seconds: must be in 0.01..3600 s, got nan");
    checkRefused({"run", scene, "--seconds=-1"}, "--seconds: must be in 0.01..3600 s, got -1");
    checkRefused({"run", scene, "--budget-ms", "1e9"}, "--budget-ms: must be in 0.05..10000 ms, got 1000000000");
    checkRefused({"run", scene, "--threads", "0"}, "--threads: must be in 1..64, got 0");
    checkRefused({"run", scene, "--work", "1,2"}, "--work: must be 3 to 4 numbers, got 2");
    checkRefused({"run", scene, "--work", "4,4,12,17"}, "--work least sub-steps: must be in 1..16, got 17");
    checkRefused({"run", scene, "--work", "99,2,3"}, "--work sub-steps: must be in 1..16, got 99");
    checkRefused({"run", scene, "--work", "a,b,c"}, "--work: must be numbers");
    checkRefused({"run", scene, "--work", "1,2,3", "--budget-ms", "4"}, "--work");
    checkRefused({"run", scene, "--mesh", "fbx", "--out", folder.path("o")}, "--mesh: must be ply or obj, got 'fbx'");
    checkRefused({"run", scene, "--pictures", "3"}, "--out");
    checkRefused({"run", scene, "--picture-size", "10x10", "--out", folder.path("o")},
                 "must be in 16..8192 pixels, got 10");
    checkRefused({"capture", scene, "--out", folder.path("o"), "--view", "xray"}, "--view: must be shaded");
    checkRefused({"capture", scene, "--out", folder.path("o"), "--at", "0,,1"}, "--at: must be numbers");
    checkRefused({"melt", folder.write("c.obj", cubeObj()), "--material", "lead"}, "--material: must be one of wax");
    checkRefused({"melt", folder.path("c.obj"), "--size", "0"}, "--size: must be in 0.001..100 m, got 0");
    checkRefused({"melt", folder.path("c.obj"), "--up", "x"}, "--up: must be y or z, got 'x'");
    checkRefused({"melt", folder.path("nowhere.obj")}, "nowhere.obj: no such file");
    checkRefused({"bench", "scene", scene, "--runs", "0"}, "--runs: must be in 1..1000, got 0");
    checkRefused({"make-mesh", "spoon", "--out", folder.path("x.obj")},
                 "must be candle, saucer, star, cone, scoops, upper-scoop, bunny or pan, got 'spoon'");
}

TEST_CASE("bad scenes are refused in one line that names file, place and value") {
    Folder folder;
    const std::string good = kSmallScene;
    auto refused = [&](const char* name, const std::string& text, const std::string& says) {
        const std::string file = folder.write(name, text);
        checkRefused({"info", file}, file);
        checkRefused({"info", file}, says);
    };
    checkRefused({"run", folder.path("none.json")}, "none.json: no such file");
    checkRefused({"run", folder.path("")}, "is a folder");
    refused("empty.json", "", "is empty");
    refused("syntax.json", "{\n \"thawScene\": 1,,\n}", "syntax.json:2:17: not valid JSON");
    refused("binary.json", std::string("\x00\x01\x02\xff", 4), "binary.json:1:1: not valid JSON");
    refused("density.json", replaced(good, "\"density\": 900", "\"density\": -3"),
            "density.json: at /materials/0/density: must be in 1..30000 kg/m^3, got -3");
    refused("key.json", replaced(good, "\"density\": 900", "\"densitty\": 900"),
            "at /materials/0/densitty: unknown key");
    refused("type.json", replaced(good, "\"density\": 900", "\"density\": [900]"),
            "must be a number (kg/m^3), got an array");
    refused("unit.json", replaced(good, "\"temperature\": 300", "\"temperature\": 27"),
            "must be in 100..10000 K, got 27");
    refused("huge.json", replaced(good, "\"temperature\": 300", "\"temperature\": 2147483648"), "got 2147483648");
    refused("nan.json", replaced(good, "\"temperature\": 300", "\"temperature\": NaN"), "not valid JSON");
    refused("missing.json", meshScene("gone.obj"), "at /bodies/0/mesh: gone.obj: no such file");
    refused("folder.json", meshScene("."), "at /bodies/0/mesh: .: is not a file");
    refused("many.json", replaced(good, "\"particleSpacing\": 0.005", "\"particleSpacing\": 0.0001391"),
            "at /world/particleSpacing: 0.0001391 m gives about 10031");
    refused("many.json", replaced(good, "\"particleSpacing\": 0.005", "\"particleSpacing\": 0.0001391"),
            "the maximum is 4000000");
    refused("few.json",
            replaced(good, "\"particleSpacing\": 0.005", "\"particleSpacing\": 0.005, \"maxParticles\": 100"),
            "gives about 216 particles, the maximum is 100");
    refused("millimetres.json", replaced(good, "[0.03, 0.03, 0.03]", "[30, 30, 30]"), "if it is in millimetres");
    refused("none.json", replaced(good, "0.03, 0.03, 0.03", "0.0001, 0.0001, 0.0001"), "at /bodies/0: ");
}

TEST_CASE("bad meshes are refused in one line") {
    Folder folder;
    auto refused = [&](const char* name, const std::string& content, const std::string& says) {
        folder.write(name, content);
        checkRefused({"info", folder.write("s.json", meshScene(name))},
                     std::string("at /bodies/0/mesh: ") + name + ": " + says);
        checkRefused({"melt", folder.path(name)}, std::string(name) + ": " + says);
    };
    refused("empty.obj", "", "is empty");
    refused("comment.obj", "# nothing\n", "");
    refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "");
    refused("text.stl", "this is no mesh", "");
    refused("text.ply", "ply\nformat ascii 1.0\nelement vertex 99999999\nproperty float x\nend_header\n", "");
    refused("text.glb", "glTF", "");
    refused("text.gltf", "{}", "");
    refused("short.glb", cubesGlb().substr(0, 700), "");
    refused("a.fbx", "x", "unknown mesh format '.fbx'");
    refused("nan.obj", replaced(cubeObj(), "v 1.000000", "v nan"), "");
    refused("far.obj", replaced(cubeObj(), "f 1 5 7", "f 1 5 700"), "");
    const std::string flat = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n"; // encloses nothing
    folder.write("flat.obj", flat);
    checkRefused({"info", folder.write("flat.json", meshScene("flat.obj"))}, "at /bodies/0: ");
}

TEST_CASE("damaged meshes never end the player by a signal") {
    Folder folder;
    struct Format {
        const char* name;
        std::string good;
    };
    const Format formats[] = {{"m.obj", cubeObj()}, {"m.ply", cubePly()}, {"m.stl", cubeStl()}, {"m.glb", cubesGlb()}};
    uint32_t state = 99;
    auto next = [&](uint32_t bound) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % bound;
    };
    const std::string scene =
        R"({"thawScene": 1, "world": {"particleSpacing": 0.01, "maxParticles": 2000}, "bodies": [)";
    for (const Format& format : formats) {
        const std::string file =
            folder.write("d.json", scene + "{\"mesh\": \"" + format.name + "\", \"scale\": 0.05}]}");
        for (int i = 0; i < 12; ++i) {
            std::string bytes = format.good;
            if (i % 3 == 0)
                bytes.resize(1 + next(uint32_t(bytes.size())));
            else
                for (int n = 0; n < i; ++n) bytes[next(uint32_t(bytes.size()))] = char(next(256));
            folder.write(format.name, bytes);
            const Answer answer = player({"info", file});
            CAPTURE(format.name);
            CAPTURE(i);
            CAPTURE(answer.err);
            CHECK((answer.exitCode == 0 || answer.exitCode == 2));
            CHECK(lineCount(answer.err) == (answer.exitCode == 0 ? 0 : 1));
        }
    }
}

TEST_CASE("meshes of every format are read, joined and transformed") {
    Folder folder;
    struct Format {
        const char* name;
        std::string content;
        double volume; // in cubes of 8 cm^3
        size_t triangles, vertices;
    };
    folder.write("cubes.bin", cubeBinary());
    const Format formats[] = {
        {"cube.obj", cubeObj(), 1.0, 12, 8},
        {"cube.ply", cubePly(), 1.0, 12, 8},
        {"cube.stl", cubeStl(), 1.0, 12, 8},
        {"UPPER.OBJ", cubeObj(), 1.0, 12, 8},
        {"cubes.gltf", cubesGltf("\"uri\": \"cubes.bin\", "), 1.125, 24, 16},
        {"cubes.glb", cubesGlb(), 1.125, 24, 16},
    };
    for (const Format& format : formats) {
        folder.write(format.name, format.content);
        const Answer answer = player({"info", folder.write("s.json", meshScene(format.name))});
        CAPTURE(format.name);
        CAPTURE(answer.err);
        CAPTURE(answer.out);
        CHECK(answer.exitCode == 0);
        CHECK(contains(answer.out, "mesh: " + std::to_string(format.triangles) + " triangles, " +
                                       std::to_string(format.vertices) + " vertices"));
        CHECK(reportedVolume(answer.out) == doctest::Approx(8.0 * format.volume).epsilon(0.001));
    }
}

TEST_CASE("info tells what a scene holds and which stages run") {
    Folder folder;
    const Answer answer = player({"info", folder.write("s.json", kSmallScene)});
    CAPTURE(answer.err);
    CAPTURE(answer.out);
    CHECK(answer.exitCode == 0);
    CHECK(countAfter(answer.out, "particles: ") == doctest::Approx(216).epsilon(0.03));
    CHECK(contains(answer.out, "density 900 kg/m^3"));
    CHECK(contains(answer.out, "40 W at (0, 0.06, 0) m"));
    CHECK(contains(answer.out, "\n  radiation   on"));
    // Without its source the same scene has no rays to cast.
    const Answer dark = player(
        {"info", folder.write("d.json", replaced(kSmallScene, "\"power\": 40", "\"power\": 40, \"enabled\": false"))});
    CHECK(dark.exitCode == 0);
    CHECK(contains(dark.out, "\n  radiation   off"));
}

TEST_CASE("run writes its report, its lines and its mesh") {
    Folder folder;
    const std::string scene = folder.write("s.json", kSmallScene), out = folder.path("a/b");
    const Answer answer =
        player({"run", scene, "--seconds", "0.5", "--work", "2,4,12", "--threads", "1", "--out", out, "--mesh", "ply",
                "--csv", folder.path("frames.csv"), "--json", folder.path("r.json"), "--quiet"});
    CAPTURE(answer.err);
    REQUIRE(answer.exitCode == 0);
    CHECK(answer.err == "");
    CHECK(readFile(out + "/table.txt") == answer.out);
    CHECK(readFile(out + "/table.json") == readFile(folder.path("r.json")));
    const auto report = nlohmann::json::parse(readFile(folder.path("r.json")));
    CHECK(report["steps"] == 30);
    CHECK(report["particles"]["count"].get<double>() == doctest::Approx(216).epsilon(0.03));
    CHECK(report["faults"].empty());
    CHECK(report["ledger"]["absorbed"].get<double>() > 0.0);
    CHECK(report["stepMilliseconds"]["p50"].get<double>() <= report["stepMilliseconds"]["p99"].get<double>());
    CHECK(report["stepMilliseconds"]["p99"].get<double>() <= report["stepMilliseconds"]["max"].get<double>());
    CHECK(contains(answer.out, report["stateHash"].get<std::string>()));
    CHECK(lineCount(readFile(folder.path("frames.csv"))) == 31);
    CHECK(readFile(out + "/surface.ply").compare(0, 4, "ply\n") == 0);

    // The same work gives the same state, whoever asks and on however many threads.
    const Answer bench = player({"bench", "scene", scene, "--seconds", "0.5", "--work", "2,4,12", "--threads", "1,2",
                                 "--runs", "2", "--quiet"});
    CAPTURE(bench.err);
    CHECK(bench.exitCode == 0);
    CHECK(lineCount(bench.out) == 5);
    size_t same = 0;
    for (size_t at = 0; (at = bench.out.find(report["stateHash"].get<std::string>(), at)) != std::string::npos; ++at)
        ++same;
    CHECK(same == 4);
}

TEST_CASE("run says what paths and shapes did") {
    const Folder folder;
    const std::string scene = folder.write("s.json", R"({"thawScene": 1,
      "world": {"particleSpacing": 0.004, "thermalTimeScale": 0},
      "bodies": [{"shape": {"type": "box", "size": [0.03, 0.02, 0.03]}, "position": [0, 0.01, 0], "temperature": 345}],
      "colliders": [{"name": "floor", "shape": {"type": "plane"}}],
      "paths": [{"name": "lane", "points": [[0, 0, 0.05], [0, 0, 0.2]], "reach": 0.02}],
      "shapes": [{"name": "tile", "contours": [[[-0.03, 0, -0.03], [0.03, 0, -0.03], [0.03, 0, 0.03], [-0.03, 0, 0.03]]]}]
    })");
    const Answer answer = player({"run", scene, "--seconds", "9", "--json", folder.path("r.json"), "--quiet"});
    CHECK(answer.exitCode == 0);
    CHECK(contains(answer.out, "shape tile"));
    CHECK(contains(answer.out, "path lane"));
    const auto report = nlohmann::json::parse(readFile(folder.path("r.json")));
    CHECK(report["shapes"][0]["name"] == "tile");
    CHECK(report["shapes"][0]["fill"].get<double>() > 0.9);
    CHECK(report["shapes"][0]["set"].get<double>() == report["shapes"][0]["mass"].get<double>());
    CHECK(report["shapes"][0]["filledAfter"].get<double>() > 0);
    CHECK(report["paths"][0]["captured"] == 0);
    CHECK(report["paths"][0]["arrivalTime"].is_null());
    CHECK(report["ledger"]["controlHeat"].get<double>() > 0);
}

TEST_CASE("a run that misses what is asked of it, or cannot write, ends with 1") {
    Folder folder;
    const std::string scene = folder.write("s.json", kSmallScene), file = folder.write("file", "x");
    const Answer slow =
        player({"run", scene, "--budget-ms", "0.05", "--most-over", "0", "--seconds", "0.3", "--quiet"});
    CHECK(slow.exitCode == 1);
    CHECK(contains(slow.err, "--most-over allows 0 %"));
    CHECK(lineCount(slow.err) == 1);
    const Answer blocked = player({"run", scene, "--out", file + "/below"});
    CHECK(blocked.exitCode == 1);
    CHECK(contains(blocked.err, "cannot be made a folder"));
    CHECK(lineCount(blocked.err) == 1);
    const Answer unwritable = player({"run", scene, "--json", folder.path("no/such/folder/r.json")});
    CHECK(unwritable.exitCode == 1);
    CHECK(contains(unwritable.err, "cannot be written"));
}

TEST_CASE("melt makes a scene that runs again from its file to the same state") {
    Folder folder;
    folder.write("cube.obj", cubeObj());
    for (const char* material : {"wax", "ice"}) {
        CAPTURE(material);
        const Answer first =
            player({"melt", folder.path("cube.obj"), "--material", material, "--spacing", "0.01", "--seconds", "0.3",
                    "--work", "2,4,12", "--threads", "1", "--save-scene", folder.path("cube.json"), "--quiet"});
        CAPTURE(first.err);
        REQUIRE(first.exitCode == 0);
        CHECK(countAfter(first.out, "particles ") == doctest::Approx(1000).epsilon(0.03)); // 0.1 m in steps of 0.01 m
        const Answer again = player(
            {"run", folder.path("cube.json"), "--seconds", "0.3", "--work", "2,4,12", "--threads", "1", "--quiet"});
        CAPTURE(again.err);
        CHECK(again.exitCode == 0);
        CHECK(hashOf(first.out) != "");
        CHECK(hashOf(again.out) == hashOf(first.out));
    }
}

TEST_CASE("melt stands a mesh with z up on its feet") {
    Folder folder;
    // A post of 1 x 1 x 3 along z.
    std::string post = cubeObj();
    for (int i = 0; i < 4; ++i) post = replaced(post, " 1.000000\n", " 3.0\n");
    folder.write("post.obj", post);
    for (const char* up : {"y", "z"}) {
        const Answer made = player({"melt", folder.path("post.obj"), "--up", up, "--size", "0.09", "--spacing", "0.01",
                                    "--seconds", "0.02", "--save-scene", folder.path("post.json"), "--quiet"});
        CAPTURE(made.err);
        REQUIRE(made.exitCode == 0);
        const Answer told = player({"info", folder.path("post.json")});
        CAPTURE(told.out);
        CHECK(told.exitCode == 0);
        // Its lamp hangs at the height of the body and 0.3 of its size more.
        CHECK(contains(told.out, *up == 'z' ? "W at (0, 0.117, 0) m" : "W at (0, 0.057, 0) m"));
        CHECK(countAfter(told.out, "particles: ") == doctest::Approx(81).epsilon(0.06));
    }
}

TEST_CASE("make-mesh writes the mesh that is in the repository") {
    Folder folder;
    const Answer answer = player({"make-mesh", "candle", "--out", folder.path("c.obj")});
    CHECK(answer.exitCode == 0);
    CHECK(contains(answer.out, "3360 triangles"));
    CHECK(readFile(folder.path("c.obj"))
              .compare(0, 30, readFile(THAW_SOURCE_DIR "/samples/scenes/meshes/candle.obj"), 0, 30) == 0);
}
