// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "args.h"

#include <cstdio>

namespace thaw::player {

void addMakeMesh(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("make-mesh", "Write a mesh of the sample scenes");
    auto kind = std::make_shared<std::string>();
    auto out = std::make_shared<std::string>();
    command->add_option("kind", *kind, "candle, saucer or star")->required();
    command->add_option("--out", *out, "OBJ file to write")->required();
    command->callback([=, &exitCode] {
        scene::TriMesh mesh;
        if (*kind == "candle")
            mesh = scene::makeCandle();
        else if (*kind == "saucer")
            mesh = scene::makeSaucer();
        else if (*kind == "star")
            mesh = scene::makeStar();
        else
            throw scene::InputError("make-mesh: must be candle, saucer or star, got '" + scene::oneLine(*kind, 40) +
                                    "'");
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
