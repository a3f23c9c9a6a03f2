// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "args.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace thaw::player {
namespace {

struct Kind {
    const char* name;
    scene::TriMesh (*make)();
};
constexpr Kind kKinds[] = {{"candle", scene::makeCandle}, {"saucer", scene::makeSaucer},
                           {"star", scene::makeStar},     {"cone", scene::makeWaffleCone},
                           {"scoops", scene::makeScoops}, {"upper-scoop", scene::makeUpperScoop},
                           {"bunny", scene::makeBunny},   {"pan", scene::makePan}};

std::string knownKinds() {
    std::string all;
    for (const Kind& k : kKinds)
        all += (all.empty() ? "" : &k == std::end(kKinds) - 1 ? " or " : ", ") + std::string(k.name);
    return all;
}

} // namespace

void addMakeMesh(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("make-mesh", "Write a mesh of the sample scenes");
    auto kind = std::make_shared<std::string>();
    auto out = std::make_shared<std::string>();
    command->add_option("kind", *kind, knownKinds())->required();
    command->add_option("--out", *out, "OBJ file to write")->required();
    command->callback([=, &exitCode] {
        const auto found =
            std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return *kind == k.name; });
        if (found == std::end(kKinds))
            throw scene::InputError("make-mesh: must be " + knownKinds() + ", got '" + scene::oneLine(*kind, 40) + "'");
        const scene::TriMesh mesh = found->make();
        try {
            scene::writeObj(*out, mesh, "made by: thaw make-mesh " + *kind);
        } catch (const std::runtime_error& e) {
            throw RunError(scene::oneLine(*out, 400) + ": " + e.what());
        }
        std::printf("%s: %zu triangles, %.4g cm^3\n", scene::oneLine(*out, 400).c_str(), mesh.triangleCount(),
                    scene::volumeOf(mesh) * 1e6);
        exitCode = kExitOk;
    });
}

} // namespace thaw::player
