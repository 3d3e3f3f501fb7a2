#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace weave::testing {

/// The lines of the block of PROTOCOL.md that begins with ```name.
inline std::vector<std::string> protocol_block(const std::string& name) {
    std::ifstream file(WEAVE_SOURCE_DIR "/libweave/weave/wire/PROTOCOL.md");
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        if (inside && line == "```") return lines;
        if (inside) lines.push_back(line);
        if (line == "```" + name) inside = true;
    }
    throw std::runtime_error("PROTOCOL.md has no block " + name);
}

/// The bytes that digits stand for, whatever spaces are between them.
inline std::string from_hex(const std::string& text) {
    std::istringstream words(text);
    std::string bytes;
    for (std::string word; words >> word;)
        for (std::size_t i = 0; i < word.size(); i += 2) bytes += static_cast<char>(std::stoi(word.substr(i, 2), nullptr, 16));
    return bytes;
}

}  // namespace weave::testing
