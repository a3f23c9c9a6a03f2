// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "args.h"
#include "report.h"

#include <cstdio>
#include <new>

int main(int argc, char** argv) {
    using namespace thaw::player;
    using thaw::scene::oneLine;
    CLI::App app{"thaw: objects that melt, drip, pool and set again\n"
                 "Exit codes: 0 ok, 1 a run failed its check or a file could not be written, 2 bad input",
                 "thaw"};
    app.require_subcommand(1);
    app.set_version_flag("--version",
                         formatted("thaw %d.%d.%d (%s)", thawGetVersion() / 10000, thawGetVersion() / 100 % 100,
                                   thawGetVersion() % 100, thawGetBuildString()));
    int exitCode = kExitOk;
    addRun(app, exitCode);
    addCapture(app, exitCode);
    addMelt(app, exitCode);
    addInfo(app, exitCode);
    addBench(app, exitCode);
    addValidate(app, exitCode);
    addMakeMesh(app, exitCode);
    try {
        if (argc > 1 && argv[1][0] != '-') {
            std::string known;
            bool found = false;
            for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
                found = found || command->get_name() == argv[1];
                known += (known.empty() ? "" : ", ") + command->get_name();
            }
            if (!found)
                throw thaw::scene::InputError("unknown command '" + oneLine(argv[1], 40) + "' (known: " + known + ")");
        }
        app.parse(argc, argv);
        return exitCode;
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app.exit(e); // --help, --version
        std::fprintf(stderr, "thaw: %s (see thaw --help)\n", oneLine(e.what(), 600).c_str());
        return kExitBadInput;
    } catch (const thaw::scene::InputError& e) {
        std::fprintf(stderr, "thaw: %s\n", oneLine(e.what(), 1200).c_str());
        return kExitBadInput;
    } catch (const std::bad_alloc&) {
        std::fputs("thaw: not enough memory\n", stderr);
        return kExitFailed;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "thaw: %s\n", oneLine(e.what(), 1200).c_str());
        return kExitFailed;
    }
}
