// What the studio's folder of unsaved work tells of itself, as a program that was killed leaves it, or anybody else: what was read is
// written the same again.
#include "support/must.hpp"

#include <studio/document/journal_now.hpp>

using namespace weave::studio;
using weave::fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto now = read_journal_now(weave::fuzz::text_of(data, size));
    if (!now) return 0;
    must(now->base == "a" || now->base == "b", "a base is one of two files in the folder");
    const std::string text = journal_now_text(*now);
    const auto again = read_journal_now(text);
    must(static_cast<bool>(again), "what is written is read");
    must(journal_now_text(*again) == text, "it reads as it was written");
    return 0;
}
