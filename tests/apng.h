// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Takes an animated PNG apart, by the PNG specification, third edition: into frames that are PNGs of their own.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace thaw::test {

struct ApngFrame {
    uint32_t width = 0, height = 0, x = 0, y = 0, delay = 0, delayUnits = 0;
    int dispose = -1, blend = -1;
    std::string png; // this frame alone
};
struct Apng {
    uint32_t width = 0, height = 0, plays = 99;
    std::vector<ApngFrame> frames;
};

inline uint32_t crcOf(const std::string& bytes) {
    uint32_t c = 0xffffffffu;
    for (const char byte : bytes) {
        c ^= uint8_t(byte);
        for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return c ^ 0xffffffffu;
}

inline std::string bigEndian(uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }

inline std::string pngChunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    return bigEndian(uint32_t(data.size())) + body + bigEndian(crcOf(body));
}

// Throws std::runtime_error when it breaks a rule: signature, order, sums, sequence numbers, count, bounds.
inline Apng parseApng(const std::string& file) {
    const auto require = [](bool good, const char* what) {
        if (!good) throw std::runtime_error(std::string("APNG: ") + what);
    };
    const auto number = [](const std::string& s, size_t at, size_t bytes = 4) {
        uint32_t v = 0;
        for (size_t k = 0; k < bytes; ++k) v = v << 8 | uint8_t(s.at(at + k));
        return v;
    };
    const std::string signature = "\x89PNG\r\n\x1a\n";
    require(file.compare(0, 8, signature) == 0, "signature");
    Apng out;
    std::string header, data, last;
    uint32_t sequence = 0, count = 0;
    const auto close = [&] { // the frame whose data is all there
        if (out.frames.empty()) return;
        ApngFrame& f = out.frames.back();
        require(!data.empty(), "a frame without data");
        f.png = signature + pngChunk("IHDR", bigEndian(f.width) + bigEndian(f.height) + header.substr(8)) +
                pngChunk("IDAT", data) + pngChunk("IEND", "");
        data.clear();
    };
    for (size_t at = 8; at < file.size();) {
        require(last != "IEND", "something behind its end");
        const uint32_t size = number(file, at);
        require(at + 12 + size <= file.size(), "it ends too early");
        const std::string type = file.substr(at + 4, 4), body = file.substr(at + 8, size);
        require(number(file, at + 8 + size) == crcOf(type + body), "a sum");
        require((at == 8) == (type == "IHDR"), "IHDR comes first");
        if (type == "IHDR") header = body, out.width = number(body, 0), out.height = number(body, 4);
        if (type == "acTL") {
            require(last == "IHDR" && size == 8, "acTL");
            count = number(body, 0), out.plays = number(body, 4);
        }
        if (type == "fcTL") {
            require(size == 26 && number(body, 0) == sequence++, "fcTL");
            close();
            ApngFrame f;
            f.width = number(body, 4), f.height = number(body, 8), f.x = number(body, 12), f.y = number(body, 16);
            f.delay = number(body, 20, 2), f.delayUnits = number(body, 22, 2), f.dispose = body[24], f.blend = body[25];
            require(f.width > 0 && f.height > 0 && f.x + f.width <= out.width && f.y + f.height <= out.height,
                    "a frame outside");
            out.frames.push_back(f);
        }
        if (type == "IDAT") require(out.frames.size() == 1, "IDAT is of the first frame"), data += body;
        if (type == "fdAT") {
            require(out.frames.size() > 1 && number(body, 0) == sequence++, "fdAT");
            data += body.substr(4);
        }
        last = type;
        at += 12 + size;
    }
    close();
    require(last == "IEND", "no end");
    require(out.frames.size() == count, "another count than it says");
    return out;
}

} // namespace thaw::test
