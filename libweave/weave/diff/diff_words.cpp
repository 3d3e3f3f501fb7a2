#include <weave/core/text.hpp>
#include <weave/diff/design_diff.hpp>

#include <algorithm>
#include <cstdio>

namespace weave {

namespace {

/// `1.25 %`; never 0 where something differs.
std::string share_in_words(std::uint64_t part, std::uint64_t whole) {
    const double percent =
        100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(whole, 1));
    char text[32];
    std::snprintf(text, sizeof text, "%.*f %%", percent < 0.1 ? 4 : 2, percent);
    return percent > 0 && percent < 0.00005 ? "less than 0.0001 %" : text;
}

Json box_json(const std::optional<ChangedBox>& box) {
    if (!box) return nullptr;
    return {{"first_pick", box->first_pick + 1},
            {"last_pick", box->last_pick + 1},
            {"first_end", box->first_end + 1},
            {"last_end", box->last_end + 1}};
}

Json spans_json(const std::vector<LineSpan>& spans) {
    Json list = Json::array();
    for (const LineSpan& span : spans) {
        if (list.size() == most_listed) break;
        list.push_back({{"first", span.first + 1}, {"last", span.first + span.count}});
    }
    return list;
}

std::size_t lines_in(const std::vector<LineSpan>& spans) {
    std::size_t sum = 0;
    for (const LineSpan& span : spans) sum += span.count;
    return sum;
}

Json lines_json(const LineAlignment& lines) {
    const std::vector<LineSpan> removed = lines.removed(), inserted = lines.inserted();
    Json matches = Json::array();
    for (const LineMatch& match : lines.matches) {
        if (matches.size() == most_listed) break;
        matches.push_back({{"before", match.before + 1}, {"after", match.after + 1}, {"count", match.count}});
    }
    return {{"before", lines.before},
            {"after", lines.after},
            {"removed", lines_in(removed)},
            {"inserted", lines_in(inserted)},
            {"removed_ranges", spans_json(removed)},
            {"inserted_ranges", spans_json(inserted)},
            {"matches", std::move(matches)},
            {"match_count", lines.matches.size()}};
}

Json runs_json(const CardDiff& diff) {
    Json list = Json::array();
    for (const ChangedRun& run : diff.runs) {
        if (list.size() == most_listed) break;
        list.push_back({{"pick", run.pick_after + 1},
                        {"first_end", run.end_after + 1},
                        {"last_end", run.end_after + run.count},
                        {"pick_before", run.pick_before + 1},
                        {"first_end_before", run.end_before + 1},
                        {"became", run.lifted ? "lifted" : "lowered"}});
    }
    return list;
}

Json card_json(const DesignDiff& diff) {
    if (!diff.card) return {{"compared", nullptr}, {"why_not", diff.no_card}};
    const CardDiff& card = *diff.card;
    return {
        {"compared", card.compared},
        {"changed", card.changed()},
        {"lifted", card.lifted},
        {"lowered", card.lowered},
        {"share",
         card.compared == 0 ? 0.0 : static_cast<double>(card.changed()) / static_cast<double>(card.compared)},
        {"changed_picks", card.picks},
        {"changed_ends", card.ends},
        {"box", box_json(card.after)},
        {"box_before", box_json(card.before)},
        {"picks", lines_json(card.alignment.picks)},
        {"ends", lines_json(card.alignment.ends)},
        {"runs", runs_json(card)},
        {"run_count", card.runs_in_all}};
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json() : Json(text);
}

Json tree_json(const TreeDiff& tree) {
    Json list = Json::array();
    for (const BlockChange& block : tree.blocks) {
        if (list.size() == most_listed) break;
        list.push_back({{"kind", name_of(block.kind)},
                        {"before", text_or_null(block.before)},
                        {"after", text_or_null(block.after)},
                        {"kind_before", text_or_null(block.kind_before)},
                        {"kind_after", text_or_null(block.kind_after)},
                        {"text", block.text},
                        {"details", to_json(block.details)}});
    }
    return list;
}

std::string box_in_words(const ChangedBox& box) {
    return lines_in_words("pick", {{box.first_pick, box.last_pick, 1}}) + " and " +
           lines_in_words("end", {{box.first_end, box.last_end, 1}});
}

std::string size_in_words(const LineAlignment& lines, const char* noun) {
    const std::size_t removed = lines_in(lines.removed()), inserted = lines_in(lines.inserted());
    if (removed == 0 && inserted == 0) return "";
    std::string text = ", " + (removed > 0 ? counted(removed, noun) + " removed" : "");
    if (inserted > 0) text += (removed > 0 ? " and " : "") + counted(inserted, noun) + " inserted";
    return text;
}

constexpr std::size_t most_lines = 12;  ///< of a section

/// A heading and the first lines of a list.
template <class List, class TextOf>
std::string section(const std::string& heading, const List& list, TextOf text_of) {
    if (list.empty()) return "";
    std::string text = "\n" + heading + "\n";
    for (std::size_t k = 0; k < std::min(most_lines, list.size()); ++k)
        text += "  " + text_of(list[k]) + "\n";
    if (list.size() > most_lines)
        text += "  and " + std::to_string(list.size() - most_lines) + " more; --json tells more\n";
    return text;
}

std::string section(const std::string& heading, const Changes& changes) {
    return section(heading, changes, [](const Change& change) { return change.text; });
}

std::string run_in_words(const ChangedRun& run) {
    std::string text = "pick " + std::to_string(run.pick_after + 1) + ", " +
                       lines_in_words("end", {{run.end_after, run.end_after + run.count - 1, 1}}) + ": " +
                       (run.lifted ? "now lifted" : "no longer lifted");
    if (run.pick_before != run.pick_after || run.end_before != run.end_after)
        text += " (was pick " + std::to_string(run.pick_before + 1) + ", end " +
                std::to_string(run.end_before + 1) + ")";
    return text;
}

std::string card_section(const CardDiff& card) {
    if (card.changed() == 0) return "";
    std::string text = "\nCard\n  within " + box_in_words(*card.after) + "\n";
    const std::size_t most = std::min(most_lines, card.runs.size());
    for (std::size_t k = 0; k < most; ++k) text += "  " + run_in_words(card.runs[k]) + "\n";
    if (card.runs_in_all > most)
        text += "  and " + std::to_string(card.runs_in_all - most) + " more places; -o draws them\n";
    return text;
}

std::string tree_section(const TreeDiff& tree) {
    std::vector<std::string> lines;
    if (!tree.same_root)
        lines.push_back("the cloth is " + in_quotes(tree.root_after) + ", was " +
                        in_quotes(tree.root_before));
    for (const BlockChange& block : tree.blocks) lines.push_back(block.text);
    return section("Blocks", lines, [](const std::string& line) { return line; });
}

std::string summary(const DesignDiff& diff) {
    std::string text;
    const auto add = [&](std::size_t count, const char* section) {
        if (count > 0) text += (text.empty() ? "" : ", ") + (section + (" (" + std::to_string(count) + ")"));
    };
    add(diff.tree.blocks.size() + (diff.tree.same_root ? 0 : 1), "blocks");
    add(diff.picks.size(), "picks");
    add(diff.ends.size(), "ends");
    add(diff.yarns.size(), "yarns");
    add(diff.parameters.size(), "parameters");
    return text;
}

}  // namespace

std::string in_words(const CardDiff& diff) {
    const std::string lines =
        size_in_words(diff.alignment.picks, "pick") + size_in_words(diff.alignment.ends, "end");
    if (diff.changed() == 0) return lines.empty() ? "The cards are equal" : "No crossing differs" + lines;
    return std::to_string(diff.changed()) + " of " + counted(diff.compared, "crossing") + " differ (" +
           share_in_words(diff.changed(), diff.compared) + "): " + std::to_string(diff.lifted) + " lifted, " +
           std::to_string(diff.lowered) + " lowered" + lines;
}

std::string in_words(const DesignDiff& diff, const std::string& before, const std::string& after) {
    const std::string names = on_one_line(before) + " and " + on_one_line(after);
    const std::string view =
        diff.view_differs ? "What windows show of them differs, which is no part of a design\n" : "";
    if (diff.is_same()) return names + " are the same design\n" + view;
    std::string text = names + " differ: " + summary(diff) + "\n";
    text += (diff.card ? in_words(*diff.card) : "The cards were not compared: " + diff.no_card) + "\n" + view;
    text += tree_section(diff.tree);
    if (diff.card) text += card_section(*diff.card);
    text += section("Picks", diff.picks) + section("Ends", diff.ends) + section("Yarns", diff.yarns);
    return text + section("Parameters", diff.parameters);
}

Json to_json(const DesignDiff& diff) {
    const Json counts{{"tree", diff.tree.blocks.size()},
                      {"picks", diff.picks.size()},
                      {"ends", diff.ends.size()},
                      {"yarns", diff.yarns.size()},
                      {"parameters", diff.parameters.size()}};
    return {
        {"equal", diff.is_same()},
        {"tree", tree_json(diff.tree)},
        {"root",
         {{"before", diff.tree.root_before}, {"after", diff.tree.root_after}, {"same", diff.tree.same_root}}},
        {"pixels", card_json(diff)},
        {"picks", to_json(diff.picks)},
        {"ends", to_json(diff.ends)},
        {"yarns", to_json(diff.yarns)},
        {"parameters", to_json(diff.parameters)},
        {"view_differs", diff.view_differs},
        {"counts", counts}};
}

}  // namespace weave
