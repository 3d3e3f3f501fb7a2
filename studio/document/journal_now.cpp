#include <studio/document/journal_now.hpp>

#include <weave/core/json.hpp>

namespace weave::studio {

namespace {

/// Of the whole folder: the base, the lines of the journal, and `now`. A studio that writes another one says so here.
constexpr int format = 1;

}  // namespace

std::string journal_now_text(const JournalNow& now) {
    const Json form{{"format", format}, {"base", now.base}, {"path", now.path}, {"is_saved", now.is_saved}};
    return form.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<JournalNow> read_journal_now(std::string_view text) {
    WEAVE_TRY(const Json form, parse_json(text));
    const auto is_named = [&](const char* name) { return form.contains(name) && form[name].is_string(); };
    if (!form.is_object() || !form.contains("format")) return bad_input("does not tell what lies here");
    if (form["format"] != format) return bad_input("was written by another version of the studio");
    if (!is_named("base") || !is_named("path") || !form.contains("is_saved") || !form["is_saved"].is_boolean())
        return bad_input("does not tell what lies here");
    JournalNow now{form["base"], form["path"], form["is_saved"]};
    if (now.base != "a" && now.base != "b") return bad_input("names a base that there cannot be");
    return now;
}

}  // namespace weave::studio
