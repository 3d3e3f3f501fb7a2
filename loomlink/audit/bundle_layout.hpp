#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink::bundle {

/// The fixed lines of a bundle.
inline constexpr std::string_view opening = R"({"format":"weave-audit-bundle","version":1,)";
inline constexpr std::string_view head_name = R"("head":)";
inline constexpr std::string_view leaves_opening = R"("leaves":[)";
inline constexpr std::string_view leaves_closing = "],";
inline constexpr std::string_view records_opening = R"("records":[)";
inline constexpr std::string_view closing = "]}";

/// A fixed line that does not stand where it should.
struct Misfit {
    std::size_t line;  ///< from 1
    std::string cause;
};

/// The parts of a bundle, found as well as damage allows. Items keep the comma that should end all but the
/// last.
struct Layout {
    std::string_view head;                  ///< the line after `"head":`, with its comma
    std::vector<std::string_view> leaves;   ///< lines between the brackets
    std::vector<std::string_view> records;  ///< as well
    std::vector<Misfit> misfits;
};

Layout split(std::string_view file);

}  // namespace weave::loomlink::bundle
