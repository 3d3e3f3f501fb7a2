// The studio's journal of unsaved work, as a program that was killed leaves it, or anybody else: read up to the first line that
// is not whole, and what was read is written the same again.
#include "support/must.hpp"

#include <studio/document/journal.hpp>

using namespace weave::studio;
using weave::fuzz::must;

namespace {

std::string written(const ReadJournal& journal) {
    std::string text;
    for (const JournalEntry& entry : journal.entries) text += journal_line(entry);
    return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = weave::fuzz::text_of(data, size);
    const ReadJournal journal = read_journal(text);
    must(journal.bytes <= text.size(), "no more is read than there is");
    must(journal.bytes == 0 || text[journal.bytes - 1] == '\n', "a journal is read by whole lines");
    must(journal.entries.empty() == (journal.bytes == 0), "every line that is read is an entry");
    must(read_journal(text.substr(0, journal.bytes)).entries.size() == journal.entries.size(), "the whole lines stand by themselves");

    const std::string again = written(journal);
    const ReadJournal reread = read_journal(again);
    must(reread.entries.size() == journal.entries.size() && reread.bytes == again.size(), "all that is written is read");
    must(written(reread) == again, "an entry reads as it was written");
    return 0;
}
