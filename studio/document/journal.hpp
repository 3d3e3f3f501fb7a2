#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <studio/document/edit_step.hpp>

namespace weave::studio {

struct Undone {};
struct Redone {};

/// One thing that happened to a document since it was opened or saved last.
using JournalEntry = std::variant<EditStep, Undone, Redone>;

/// An entry as one line, its end included.
std::string journal_line(const JournalEntry& entry);

/// What a journal holds, up to the first line that is not whole: of a program that was ended while it wrote, the
/// last may be torn.
struct ReadJournal {
    std::vector<JournalEntry> entries;
    std::size_t bytes = 0;  ///< of the lines that are whole
};
ReadJournal read_journal(std::string_view text);

}  // namespace weave::studio
