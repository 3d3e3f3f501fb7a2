#include <studio/document/journal.hpp>

#include <weave/core/json.hpp>

#include <optional>

namespace weave::studio {

namespace {

Json form_of(const EditStep& step) {
    Json edits = Json::array();
    for (const Edit& edit : step.edits) edits.push_back(to_json(edit));
    return {{"text", step.text.toStdString()}, {"key", step.key.toStdString()}, {"edits", std::move(edits)}};
}

std::string text_of(const Json& form) {
    return form.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<QString> text_in(const Json& form, const char* name) {
    const auto found = form.find(name);
    if (found == form.end() || !found->is_string()) return std::nullopt;
    return QString::fromStdString(found->get<std::string>());
}

std::optional<EditStep> step_of(const Json& form) {
    const auto text = text_in(form, "text"), key = text_in(form, "key");
    const auto edits = form.find("edits");
    if (!text || !key || edits == form.end() || !edits->is_array()) return std::nullopt;
    EditStep step{*text, {}, *key};
    for (const Json& each : *edits) {
        auto edit = edit_from_json(each);
        if (!edit) return std::nullopt;
        step.edits.push_back(std::move(*edit));
    }
    return step;
}

std::optional<JournalEntry> entry_of(std::string_view line) {
    auto form = parse_json(line);
    if (!form) return std::nullopt;
    if (form->is_string()) {
        if (*form == "undone") return Undone{};
        if (*form == "redone") return Redone{};
        if (*form == "stroke ended") return StrokeEnd{};
        return std::nullopt;
    }
    if (!form->is_object()) return std::nullopt;
    if (const auto shown = text_in(*form, "shown")) return BlockShown{shown->toStdString()};
    auto step = step_of(*form);
    if (!step) return std::nullopt;
    return JournalEntry(std::move(*step));
}

}  // namespace

std::string journal_line(const JournalEntry& entry) {
    if (std::holds_alternative<Undone>(entry)) return "\"undone\"\n";
    if (std::holds_alternative<Redone>(entry)) return "\"redone\"\n";
    if (std::holds_alternative<StrokeEnd>(entry)) return "\"stroke ended\"\n";
    if (const auto* shown = std::get_if<BlockShown>(&entry)) return text_of({{"shown", shown->block}}) + "\n";
    return text_of(form_of(std::get<EditStep>(entry))) + "\n";
}

bool is_of_design(const JournalEntry& entry) {
    return !std::holds_alternative<StrokeEnd>(entry) && !std::holds_alternative<BlockShown>(entry);
}

ReadJournal read_journal(std::string_view text) {
    ReadJournal read;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::optional<JournalEntry> entry;
        if (end != std::string_view::npos) entry = entry_of(text.substr(0, end));
        if (!entry) {
            read.is_understood = end == std::string_view::npos;
            return read;
        }
        read.entries.push_back(std::move(*entry));
        read.bytes += end + 1;
        text.remove_prefix(end + 1);
    }
    return read;
}

}  // namespace weave::studio
