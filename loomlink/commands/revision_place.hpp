#pragma once

#include <loomlink/commands/command.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

/// Which revision of which design a command is about.
struct RevisionPlace {
    std::string design;
    std::optional<std::int64_t> number;

    /// The number, which the command asks for.
    [[nodiscard]] std::int64_t revision() const { return number.value_or(0); }
    /// Its path in the API, or that of something below it.
    [[nodiscard]] std::string path(const std::string& below = {}) const;
    /// `shoe, revision 3`, fit to be shown.
    [[nodiscard]] std::string words() const;
};

/// Lets a command take DESIGN and N; the number may be left out unless it is needed.
std::shared_ptr<RevisionPlace> add_revision_place(CLI::App* command, bool needs_number = true);

}  // namespace weave::loomlink
