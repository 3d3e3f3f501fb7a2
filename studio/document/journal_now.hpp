#pragma once

#include <weave/core/result.hpp>

#include <string>
#include <string_view>

namespace weave::studio {

/// What the file `now` of a journal's folder tells: which base and journal count.
struct JournalNow {
    std::string base;      ///< `a` or `b`
    std::string path;      ///< of the design's file; empty where there is none
    bool is_saved = true;  ///< the base is what that file holds, or closing it would lose nothing
};

std::string journal_now_text(const JournalNow& now);
/// Errors: not such a text, or one of another format.
Result<JournalNow> read_journal_now(std::string_view text);

}  // namespace weave::studio
