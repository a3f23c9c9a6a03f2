// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thaw::test {

struct Answer {
    int exitCode = -1; // 128 + n when signal n ended it
    std::string out, err;
};

// Runs the player with these arguments and waits for it. Standard input is empty.
Answer player(const std::vector<std::string>& arguments);

// A folder for the files of one test, removed with it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string path(const std::string& name) const { return (root_ / name).string(); }
    // Writes a file and gives its path.
    std::string write(const std::string& name, const std::string& content) const;

private:
    std::filesystem::path root_;
};

std::string readFile(const std::string& path);
size_t lineCount(const std::string& text);
bool contains(const std::string& text, const std::string& part);
std::string replaced(std::string text, const std::string& what, const std::string& with);

// A small scene that runs: a box of wax of about 216 particles over a floor, under a lamp.
extern const char* const kSmallScene;

} // namespace thaw::test
