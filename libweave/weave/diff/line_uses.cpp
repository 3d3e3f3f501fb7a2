#include <weave/design/picks.hpp>
#include <weave/design/plan_json.hpp>
#include <weave/diff/plan_diff.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace weave {

namespace {

using Ids = std::vector<std::size_t>;

/// Gives what lines use small numbers that are equal exactly for the same use, and remembers its words.
class Uses {
  public:
    std::uint32_t number_of(const Ids& use, const std::string& words) {
        const auto [found, is_new] = m_numbers.try_emplace(use, static_cast<std::uint32_t>(m_words.size()));
        if (is_new) m_words.push_back(words);
        return found->second;
    }
    [[nodiscard]] const std::string& words(std::uint32_t number) const { return m_words[number]; }

  private:
    std::map<Ids, std::uint32_t> m_numbers;
    std::vector<std::string> m_words;
};

/// What each pick or end of one cloth uses, as numbers of Uses.
using UseOfLines = std::vector<std::uint32_t>;

/// One thing that lines use, such as feeders.
struct UseKind {
    System system;
    std::string where;    ///< place of the order in the document
    std::string subject;  ///< in front of what is used: `feeder`
};

/// Tells which lines use something else than the line that they were, those with the same change together.
void tell_uses(const UseKind& kind, const LineAlignment& lines, const UseOfLines& before,
               const UseOfLines& after, const Uses& uses, Changes& changes) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> groups;
    for (const LineMatch& match : lines.matches) {
        for (std::size_t k = 0; k < match.count; ++k) {
            const std::uint32_t old = before[match.before + k], now = after[match.after + k];
            if (old != now) groups[{old, now}].push_back(match.after + k);
        }
    }
    Changes found;
    for (const auto& [use, numbers] : groups) {
        const std::string &old = uses.words(use.first), &now = uses.words(use.second);
        std::vector<LineRange> ranges = ranges_of(numbers);
        const std::string text = lines_in_words(kind.system == System::weft ? "pick" : "end", ranges) + ": " +
                                 kind.subject + " " + now + ", was " + old;
        found.push_back({ChangeKind::changed, kind.where, text, old, now, numbers.size(), std::move(ranges)});
    }
    std::ranges::stable_sort(found, {}, [](const Change& change) { return change.lines[0].first; });
    changes.insert(changes.end(), std::make_move_iterator(found.begin()),
                   std::make_move_iterator(found.end()));
}

/// Tells an order that is written otherwise, where no line has told so.
void tell_as_written(const UseKind& kind, const Json& before, const Json& after, bool has_cloth,
                     Changes& changes) {
    const std::string key = kind.where.substr(kind.where.find('.') + 1);
    const Json old = before.contains(key) ? before.at(key) : Json(),
               now = after.contains(key) ? after.at(key) : Json();
    if (old == now || std::ranges::find(changes, kind.where, &Change::where) != changes.end()) return;
    changes.push_back({ChangeKind::changed, kind.where,
                       "the order of " + kind.subject + "s is written otherwise" +
                           (has_cloth ? " and comes to the same where both cloths have it" : "") + ": " +
                           was_and_is(old, now),
                       old, now});
}

std::string numbered(std::size_t k, const std::string& name) {
    return std::to_string(k + 1) + " " + in_quotes(name);
}

/// For each end the number of what an order gives it. `id` says what an entry is on both sides, `words` how
/// it is called.
template <class Id, class Words>
UseOfLines uses_of_ends(const Sequence& order, std::size_t ends, Uses& uses, Id id, Words words) {
    std::map<std::uint32_t, std::uint32_t> known;
    UseOfLines result(ends);
    for (std::size_t end = 0; end < ends; ++end) {
        const std::uint32_t entry = order.at(end);
        const auto [found, is_new] = known.try_emplace(entry, 0);
        if (is_new) found->second = uses.number_of({id(entry)}, words(entry));
        result[end] = found->second;
    }
    return result;
}

/// Tells what an order of the warp changes. `words(design, entry)` calls an entry.
template <class Words>
void tell_end_order(const UseKind& kind, const Design& before, const Design& after, Sequence WarpPlan::*order,
                    const ListPartners& partners, std::size_t own, const LineAlignment& ends, Words words,
                    Changes& changes) {
    // Entries below `own` stand for nothing in the list: 0 of the colours is the yarn's own.
    const auto id_before = [&](std::uint32_t entry) {
        return entry < own ? entry : own + partners.id_before(entry - own);
    };
    Uses uses;
    const UseOfLines now = uses_of_ends(
        after.warp.*order, ends.after, uses, [](std::uint32_t entry) { return std::size_t{entry}; },
        [&](std::uint32_t entry) { return words(after, entry); });
    const UseOfLines old = uses_of_ends(before.warp.*order, ends.before, uses, id_before,
                                        [&](std::uint32_t entry) { return words(before, entry); });
    tell_uses(kind, ends, old, now, uses, changes);
}

const UseKind end_yarns{System::warp, "warp.order", "yarn"},
    end_beams{System::warp, "warp.beam_order", "beam"},
    end_colours{System::warp, "warp.colour_order", "colour"};
const UseKind pick_feeders{System::weft, "weft.feeder_order", "feeder"},
    pick_directions{System::weft, "weft.directions", "direction"},
    pick_take_ups{System::weft, "weft.take_up", "take-up"}, pick_yarns{System::weft, "weft.feeders", "yarn"};

/// What the picks of one cloth use, and what they share with those of the other.
struct PickUses {
    UseOfLines feeders, yarns, directions, take_ups;
};
struct SharedUses {
    Uses feeders, yarns, directions, take_ups;
};

template <class Words>
std::string all_in_words(const FeederSet& feeders, Words words) {
    if (feeders.empty()) return "none";
    std::string text;
    for (const std::uint32_t feeder : feeders) text += (text.empty() ? "" : " + ") + words(feeder);
    return text;
}

/// `feeder_id` and `yarn_id` say what these are on both sides.
template <class FeederId, class YarnId>
PickUses uses_of_picks(const Design& design, const BlockGrid& grid, SharedUses& uses, FeederId feeder_id,
                       YarnId yarn_id) {
    PickUses result;
    std::map<FeederSet, std::pair<std::uint32_t, std::uint32_t>> known;
    const WeftPlan& weft = design.weft;
    for (const Pick& pick : pick_table(design, grid)) {
        const auto [found, is_new] = known.try_emplace(pick.feeders);
        if (is_new) {
            Ids feeders, yarns;
            for (const std::uint32_t feeder : pick.feeders)
                feeders.push_back(feeder_id(feeder)), yarns.push_back(yarn_id(weft.feeders[feeder].yarn));
            found->second.first = uses.feeders.number_of(
                feeders, all_in_words(pick.feeders,
                                      [&](std::uint32_t f) { return numbered(f, weft.feeders[f].name); }));
            found->second.second =
                uses.yarns.number_of(yarns, all_in_words(pick.feeders, [&](std::uint32_t f) {
                                         const std::uint32_t yarn = weft.feeders[f].yarn;
                                         return numbered(yarn, weft.yarns[yarn].name);
                                     }));
        }
        result.feeders.push_back(found->second.first);
        result.yarns.push_back(found->second.second);
        const bool leftwards = pick.direction == Direction::right_to_left;
        result.directions.push_back(
            uses.directions.number_of({leftwards ? 1U : 0U}, leftwards ? "right to left" : "left to right"));
        result.take_ups.push_back(
            uses.take_ups.number_of({pick.take_up ? 1U : 0U}, pick.take_up ? "on" : "stopped"));
    }
    return result;
}

void tell_pick_uses(const Design& before, const Design& after, const PlanPartners& partners,
                    const PickLines& lines, Changes& changes) {
    const auto same = [](std::uint32_t entry) { return std::size_t{entry}; };
    SharedUses uses;
    const PickUses now = uses_of_picks(after, lines.after, uses, same, same);
    const PickUses old = uses_of_picks(
        before, lines.before, uses, [&](std::uint32_t feeder) { return partners.feeders.id_before(feeder); },
        [&](std::uint32_t yarn) { return partners.weft_yarns.id_before(yarn); });
    tell_uses(pick_feeders, lines.picks, old.feeders, now.feeders, uses.feeders, changes);
    tell_uses(pick_yarns, lines.picks, old.yarns, now.yarns, uses.yarns, changes);
    tell_uses(pick_directions, lines.picks, old.directions, now.directions, uses.directions, changes);
    tell_uses(pick_take_ups, lines.picks, old.take_ups, now.take_ups, uses.take_ups, changes);
}

std::string colour_in_words(const Design& design, std::uint32_t entry) {
    return entry == 0 ? "of the yarn" : std::to_string(entry) + " " + to_text(design.warp.colours[entry - 1]);
}

}  // namespace

Changes diff_end_uses(const Design& before, const Design& after, const PlanPartners& partners,
                      const LineAlignment* ends) {
    Changes changes;
    if (ends != nullptr) {
        const auto yarn = [](const Design& design, std::uint32_t k) {
            return numbered(k, design.warp.yarns[k].name);
        };
        const auto beam = [](const Design& design, std::uint32_t k) {
            return numbered(k, design.warp.beams[k].name);
        };
        tell_end_order(end_yarns, before, after, &WarpPlan::order, partners.warp_yarns, 0, *ends, yarn,
                       changes);
        tell_end_order(end_beams, before, after, &WarpPlan::beam_order, partners.beams, 0, *ends, beam,
                       changes);
        tell_end_order(end_colours, before, after, &WarpPlan::colour_order, partners.colours, 1, *ends,
                       colour_in_words, changes);
    }
    const Json old = to_json(before.warp), now = to_json(after.warp);
    for (const UseKind* kind : {&end_yarns, &end_beams, &end_colours})
        tell_as_written(*kind, old, now, ends != nullptr, changes);
    return changes;
}

Changes diff_pick_uses(const Design& before, const Design& after, const PlanPartners& partners,
                       const PickLines* lines) {
    Changes changes;
    if (lines != nullptr) tell_pick_uses(before, after, partners, *lines, changes);
    const Json old = to_json(before.weft), now = to_json(after.weft);
    for (const UseKind* kind : {&pick_feeders, &pick_directions, &pick_take_ups})
        tell_as_written(*kind, old, now, lines != nullptr, changes);
    return changes;
}

}  // namespace weave
