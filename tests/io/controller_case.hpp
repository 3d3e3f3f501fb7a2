#pragma once

// What the tests of controller files share.

#include <weave/io/controller_file.hpp>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

namespace weave::testing {

inline LoomProfile shipped(const std::string& loom) {
    return load_profile(WEAVE_SOURCE_DIR "/db/looms/" + loom + ".json").value();
}

/// A loom of so many hooks in one area, all of which carry ends, and its kind of file.
inline LoomProfile bare_loom(OutputFormat output, std::size_t hooks) {
    LoomProfile profile;
    profile.name = "bare";
    profile.areas = {{"all", hooks}};
    profile.total_hooks = hooks;
    profile.body = {{0, hooks - 1}};
    profile.output = output;
    profile.function_bytes = output == OutputFormat::ep ? 4 : 0;
    return profile;
}

/// Bytes written as hexadecimal digits, blanks between them as one likes.
inline std::string bytes_of(const std::string& digits) {
    std::string bytes, pair;
    for (const char c : digits) {
        if (c != ' ') pair += c;
        if (pair.size() < 2) continue;
        bytes += static_cast<char>(std::stoul(pair, nullptr, 16));
        pair.clear();
    }
    return bytes;
}

/// Refused with the place and these words.
inline void check_refused(const std::string& bytes, const LoomProfile& profile, const std::string& where,
                          const std::string& words) {
    const Result<ControllerFile> read = read_controller_file(bytes, profile);
    INFO(where << ": " << words);
    REQUIRE_FALSE(read);
    INFO(read.error().text());
    CHECK(read.error().code == ErrorCode::bad_input);
    CHECK(read.error().where == where);
    CHECK(read.error().message.find(words) != std::string::npos);
}

/// Read with one warning, which starts and goes on so.
inline void check_warned(const std::string& bytes, const LoomProfile& profile, const std::string& where,
                         const std::string& words) {
    const Result<ControllerFile> read = read_controller_file(bytes, profile);
    INFO(where << ": " << words);
    REQUIRE(read);
    for (const std::string& warning : read->warnings) UNSCOPED_INFO(warning);
    REQUIRE(read->warnings.size() == 1);
    CHECK(read->warnings[0].rfind(where + ": ", 0) == 0);
    CHECK(read->warnings[0].find(words) != std::string::npos);
}

/// The lifted hooks of a pick as text, X = lifted.
inline std::string shed_of(const ControllerFile& file, std::size_t pick) {
    std::string text;
    for (std::size_t hook = 0; hook < file.lifts.hooks(); ++hook)
        text += file.lifts.lifted(pick, hook) ? 'X' : '.';
    return text;
}

}  // namespace weave::testing
