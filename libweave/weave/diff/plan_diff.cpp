#include <weave/diff/plan_diff.hpp>

#include <weave/core/text.hpp>
#include <weave/design/plan_json.hpp>

#include <algorithm>

namespace weave {

namespace {

const ListWords warp_yarn_words{"warp yarn"}, weft_yarn_words{"weft yarn"}, beam_words{"beam"},
    feeder_words{"feeder"}, colour_words{"warp colour", false}, pin_words{"pin", false, false},
    field_words{"force field", false};

void tell_list(const Json& before, const Json& after, const ListPartners& partners, const char* section,
               const char* member, const ListWords& words, Changes& changes) {
    diff_list(before.at(member), after.at(member), partners, std::string(section) + "." + member, words,
              changes);
}

/// The carrier of each feeder's yarn tells more than its number in a list.
void tell_feeder_yarns(const Design& before, const Design& after, const PlanPartners& partners,
                       Changes& changes) {
    for (std::size_t k = 0; k < partners.feeders.after(); ++k) {
        const std::size_t from = partners.feeders.of_after(k);
        if (from == ListPartners::none) continue;
        const std::uint32_t old = before.weft.feeders[from].yarn, now = after.weft.feeders[k].yarn;
        if (old == now || partners.weft_yarns.of_before(old) == now) continue;
        changes.push_back({ChangeKind::changed, indexed("weft.feeders", k) + ".yarn",
                           "feeder " + std::to_string(k + 1) + " " + in_quotes(after.weft.feeders[k].name) +
                               " carries " + in_quotes(after.weft.yarns[now].name) + ", carried " +
                               in_quotes(before.weft.yarns[old].name),
                           before.weft.yarns[old].name, after.weft.yarns[now].name});
    }
}

std::string number_of(const char* noun, std::size_t number) {
    return std::string(noun) + " " + std::to_string(number);
}

/// Where inserted (or removed) lines stand in the other list.
std::string place_of(std::size_t next, std::size_t count, const char* noun) {
    if (next == 0) return "before the first";
    return next == count ? "after the last"
                         : "between " + number_of(noun, next) + " and " + std::to_string(next + 1);
}

}  // namespace

PlanPartners::PlanPartners(const Design& before, const Design& after)
    : warp_yarns(to_json(before.warp).at("yarns"), to_json(after.warp).at("yarns"), warp_yarn_words),
      beams(to_json(before.warp).at("beams"), to_json(after.warp).at("beams"), beam_words),
      colours(to_json(before.warp).at("colours"), to_json(after.warp).at("colours"), colour_words),
      weft_yarns(to_json(before.weft).at("yarns"), to_json(after.weft).at("yarns"), weft_yarn_words),
      feeders(to_json(before.weft).at("feeders"), to_json(after.weft).at("feeders"), feeder_words) {}

Changes diff_yarn_lists(const Design& before, const Design& after, const PlanPartners& partners) {
    Changes changes;
    const Json old_warp = to_json(before.warp), now_warp = to_json(after.warp);
    const Json old_weft = to_json(before.weft), now_weft = to_json(after.weft);
    tell_list(old_warp, now_warp, partners.warp_yarns, "warp", "yarns", warp_yarn_words, changes);
    tell_list(old_weft, now_weft, partners.weft_yarns, "weft", "yarns", weft_yarn_words, changes);
    tell_list(old_weft, now_weft, partners.feeders, "weft", "feeders", feeder_words, changes);
    tell_feeder_yarns(before, after, partners, changes);
    tell_list(old_warp, now_warp, partners.beams, "warp", "beams", beam_words, changes);
    tell_list(old_warp, now_warp, partners.colours, "warp", "colours", colour_words, changes);
    return changes;
}

Changes diff_lines(const LineAlignment& lines, const std::vector<MovedLine>& moved, System system) {
    const char* const noun = system == System::weft ? "pick" : "end";
    const std::string where = system == System::weft ? "cloth.picks" : "cloth.ends";
    Changes changes;
    for (const MergedSpan& span : merged(lines)) {
        if (span.kind == MergedSpan::Kind::matched) continue;
        const bool is_new = span.kind == MergedSpan::Kind::inserted;
        const std::size_t first = is_new ? span.after : span.before, last = first + span.count - 1;
        const std::string text =
            lines_in_words(noun, {{first, last, 1}}) +
            (is_new ? " inserted, " + place_of(span.before, lines.before, noun) + " of the design before"
                    : " of the design before removed, " + place_of(span.after, lines.after, noun) +
                          " of the design after");
        changes.push_back({is_new ? ChangeKind::added : ChangeKind::removed,
                           where,
                           text,
                           nullptr,
                           nullptr,
                           span.count,
                           {{first, last, 1}}});
    }
    for (const MovedLine& line : moved) {
        changes.push_back(
            {ChangeKind::moved,
             where,
             number_of(noun, line.after + 1) + " weaves what " + number_of(noun, line.before + 1) + " wove",
             line.before + 1,
             line.after + 1,
             1,
             {{line.after, line.after, 1}}});
    }
    return changes;
}

Changes diff_parameters(const Design& before, const Design& after) {
    Changes changes;
    diff_members({{"title", before.title}, {"notes", before.notes}},
                 {{"title", after.title}, {"notes", after.notes}}, "", "", changes);
    diff_members({{"density_ends_per_cm", before.warp.density_ends_per_cm},
                  {"ends_per_dent", before.warp.ends_per_dent}},
                 {{"density_ends_per_cm", after.warp.density_ends_per_cm},
                  {"ends_per_dent", after.warp.ends_per_dent}},
                 "warp", "warp", changes);
    diff_members({{"density_picks_per_cm", before.weft.density_picks_per_cm}},
                 {{"density_picks_per_cm", after.weft.density_picks_per_cm}}, "weft", "weft", changes);
    Json old = to_json(before.scene), now = to_json(after.scene);
    Json old_lists = Json::object(), now_lists = Json::object();
    for (const char* list : {"pins", "fields"}) {
        old_lists[list] = std::move(old[list]), old.erase(list);
        now_lists[list] = std::move(now[list]), now.erase(list);
    }
    diff_members(old, now, "scene", "scene", changes);
    for (const auto& [list, words] : {std::pair("pins", pin_words), std::pair("fields", field_words)}) {
        const ListPartners partners(old_lists[list], now_lists[list], words);
        tell_list(old_lists, now_lists, partners, "scene", list, words, changes);
    }
    return changes;
}

}  // namespace weave
