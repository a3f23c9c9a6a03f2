// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "player.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace thaw::test {

const char* const kSmallScene = R"({
  "thawScene": 1,
  "name": "small",
  "world": {"particleSpacing": 0.005, "gravity": [0, -9.81, 0], "ambientTemperature": 293.15, "convection": 10,
            "thermalTimeScale": 50},
  "materials": [{"name": "m", "preset": "wax", "density": 900, "color": [0.9, 0.8, 0.7]}],
  "bodies": [{"name": "block", "shape": {"type": "box", "size": [0.03, 0.03, 0.03]}, "position": [0, 0.015, 0],
              "material": "m", "temperature": 300}],
  "colliders": [{"shape": {"type": "plane"}}],
  "heatSources": [{"position": [0, 0.06, 0], "power": 40, "radius": 0.005}],
  "camera": {"eye": [0.1, 0.1, 0.2], "target": [0, 0.015, 0], "fieldOfViewDegrees": 30},
  "look": {"exposure": 1},
  "defaults": {"seconds": 0.2, "budgetMilliseconds": 4, "captures": [0, 0.1]}
})";

Answer player(const std::vector<std::string>& arguments) {
    int out[2], err[2];
    if (pipe(out) != 0 || pipe(err) != 0) throw std::runtime_error("pipe");
    std::vector<std::string> words{THAW_PLAYER_PATH};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork");
    if (child == 0) {
        dup2(open("/dev/null", O_RDONLY), 0);
        dup2(out[1], 1);
        dup2(err[1], 2);
        for (int fd : {out[0], out[1], err[0], err[1]}) close(fd);
        execv(argv[0], argv.data());
        _exit(127);
    }
    close(out[1]);
    close(err[1]);
    Answer answer;
    pollfd open[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
    std::string* const texts[2] = {&answer.out, &answer.err};
    while (open[0].fd >= 0 || open[1].fd >= 0) {
        if (poll(open, 2, -1) < 0) continue;
        for (int i = 0; i < 2; ++i) {
            if (open[i].fd < 0 || open[i].revents == 0) continue;
            char block[4096];
            const ssize_t got = read(open[i].fd, block, sizeof block);
            if (got > 0) {
                texts[i]->append(block, size_t(got));
            } else {
                close(open[i].fd);
                open[i].fd = -1;
            }
        }
    }
    int status = 0;
    waitpid(child, &status, 0);
    answer.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return answer;
}

Folder::Folder() {
    static std::atomic<int> next{0};
    root_ = std::filesystem::temp_directory_path() /
            ("thaw-cli-" + std::to_string(getpid()) + "-" + std::to_string(next++));
    std::filesystem::create_directories(root_);
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = root_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file.string();
}

std::string readFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

size_t lineCount(const std::string& text) { return size_t(std::count(text.begin(), text.end(), '\n')); }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("nothing to replace: " + what);
    return text.replace(at, what.size(), with);
}

} // namespace thaw::test
