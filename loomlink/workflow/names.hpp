#pragma once

#include <weave/core/result.hpp>

#include <algorithm>
#include <loomlink/keys/file_name.hpp>
#include <loomlink/workflow/denial.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What a reason, a message or a comment may have, in bytes.
inline constexpr std::size_t most_text = 4000;

/// What a person says: the reason of a step, the message of a revision, a comment, a fault. UTF-8 of at most
/// `most_text` bytes, of lines and tabs, in which there is something to see: blanks, line breaks and characters
/// that are drawn as nothing say nothing. No other control characters, and nothing that turns the direction of
/// what is around it. New texts alone are held to it: a store may hold older ones. Errors name `member`.
Status check_text(const std::string& text, const std::string& member);
/// Names for people to read, such as `Mary Miller`: UTF-8 of `least` to `most` bytes, on one line, without
/// characters that nobody sees, so that no two who look the same are two.
Status check_line(const std::string& text, const std::string& member, std::size_t least, std::size_t most);
/// Names of designs, looms and branches: 1 to 64 of the letters a to z and A to Z, digits, `.`, `-`, `_` and
/// where `spaces` single spaces within; nothing that a Windows machine cannot hold as the name of a file.
Status check_name(const std::string& name, const std::string& member, bool spaces);

/// Refused where one of `known` has this name, be it in other capitals: people, and file systems, would take
/// the two for one. `what` says what they are, such as `design`.
template <class Named>
Status check_free(const std::vector<Named>& known, const std::string& name, const std::string& what) {
    const auto same = std::find_if(known.begin(), known.end(), [&](const Named& one) {
        return folded_name(one.name) == folded_name(name);
    });
    if (same == known.end()) return {};
    return deny(Denial::conflict, "the name is taken: there is a " + what + " '" + same->name + "'");
}

}  // namespace weave::loomlink
