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
/// What was drawn or typed came to its end: the step behind it stays by itself.
struct StrokeEnd {};
/// From here on another block was shown.
struct BlockShown {
    std::string block;
};

/// One thing that happened to a document since it was opened or saved last.
using JournalEntry = std::variant<EditStep, Undone, Redone, StrokeEnd, BlockShown>;

/// An entry as one line, its end included.
std::string journal_line(const JournalEntry& entry);

/// Whether it is about the design, not about the view of it alone.
bool is_of_design(const JournalEntry& entry);

/// What a journal holds, up to the first line that is not whole: of a program that was ended while it wrote, the
/// last may be torn.
struct ReadJournal {
    std::vector<JournalEntry> entries;
    std::size_t bytes = 0;      ///< of the lines that are whole
    bool is_understood = true;  ///< but for a torn end; if not, a line that has its end cannot be read
};
ReadJournal read_journal(std::string_view text);

}  // namespace weave::studio
