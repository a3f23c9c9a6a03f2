// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Video by the program ffmpeg, which gets the frames as they are through its standard input.
#include "view/animation.h"
#include "view/part_file.h"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

extern char** environ;

namespace thaw::view {

namespace {
// "" when there is none on PATH.
std::string findProgram(const std::string& name) {
    const char* path = std::getenv("PATH");
    const std::string folders = path ? path : "";
    for (size_t from = 0; from <= folders.size();) {
        const size_t end = std::min(folders.find(':', from), folders.size());
        const std::string file = (std::filesystem::path(folders.substr(from, end - from)) / name).string();
        std::error_code ignored;
        if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
        from = end + 1;
    }
    return "";
}

class Video final : public AnimationWriter {
public:
    explicit Video(const Animation& a) : animation_(a), place_(a.path) {}
    ~Video() override {
        if (pipe_ >= 0) close(pipe_);
        if (child_ > 0) waitpid(child_, nullptr, 0);
    }

    bool start(const std::string& program, std::string& error) {
        // Before ffmpeg does it in its own words, and late.
        std::FILE* file = std::fopen(place_.part().c_str(), "wb");
        if (!file || std::fclose(file) != 0) return error = "cannot write " + animation_.path, false;
        const std::string size = std::to_string(animation_.width) + "x" + std::to_string(animation_.height),
                          rate = std::to_string(animation_.framesPerSecond);
        std::vector<std::string> words{program,    "-hide_banner", "-loglevel", "error",       "-y",       "-f",
                                       "rawvideo", "-pix_fmt",     "rgba",      "-video_size", size,       "-framerate",
                                       rate,       "-i",           "-",         "-an",         "-pix_fmt", "yuv420p"};
        // VP9 keeps to a low bit rate unless told a quality.
        std::string ending = std::filesystem::path(animation_.path).extension().string();
        for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
        if (ending == ".webm") words.insert(words.end(), {"-crf", "24", "-b:v", "0"});
        words.push_back(std::filesystem::absolute(place_.part()).string()); // never taken for an option
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        // A socket and not a pipe: writing to one that nobody reads can be told not to raise a signal.
        int ends[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            return error = std::string("no socket for ffmpeg: ") + std::strerror(errno), false;
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
        const int failed = posix_spawn(&child_, program.c_str(), &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[0]);
        pipe_ = ends[1];
        if (failed) return child_ = 0, error = program + " does not start: " + std::strerror(failed), false;
        return true;
    }

    bool add(const Image& image, std::string& error) override {
        if (image.width != animation_.width || image.height != animation_.height || count_++ == animation_.frames)
            return error = "a frame of another size, or one too many", false;
        const char* at = reinterpret_cast<const char*>(image.pixels.data());
        for (size_t left = image.pixels.size() * sizeof(Rgba); left > 0;) {
            const ssize_t sent = send(pipe_, at, left, MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent <= 0) return error = "ffmpeg takes no more frames after " + std::to_string(count_ - 1), false;
            at += sent, left -= size_t(sent);
        }
        return true;
    }

    bool finish(std::string& error) override {
        if (count_ != animation_.frames) return error = "frames are missing", false;
        close(pipe_), pipe_ = -1;
        int status = 0;
        const pid_t child = child_;
        child_ = 0;
        if (waitpid(child, &status, 0) < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
            return error = "cannot write " + animation_.path + ": ffmpeg ended with " +
                           (WIFEXITED(status) ? std::to_string(WEXITSTATUS(status)) : "a signal"),
                   false;
        return place_.moveToPlace(error);
    }

private:
    Animation animation_;
    PartFile place_;
    pid_t child_ = 0;
    int pipe_ = -1, count_ = 0;
};
} // namespace

std::unique_ptr<AnimationWriter> createVideo(const Animation& animation, std::string& error) {
    const std::string program = findProgram("ffmpeg");
    if (program.empty())
        return error = "cannot write " + animation.path +
                       ": a video needs the program ffmpeg, which is not on PATH (.png and .gif need nothing)",
               nullptr;
    auto made = std::make_unique<Video>(animation);
    if (!made->start(program, error)) return nullptr;
    return made;
}

} // namespace thaw::view
