#include <weave/diff/design_diff.hpp>

#include <weave/core/text.hpp>
#include <weave/diff/plan_diff.hpp>

#include <utility>

namespace weave {

namespace {

/// `2`, or `1 2`, of counts that repeat so.
std::string repeat_in_words(const std::vector<std::uint32_t>& counts) {
    return to_text(Sequence{shortest_repeat(counts)});
}

void tell_cloth(const char* member, const std::string& name, const Json& before, const Json& after,
                Changes& changes) {
    if (before == after) return;
    changes.push_back({ChangeKind::changed, std::string("cloth.") + member,
                       name + " " + was_and_is(before, after), before, after});
}

/// Size, counts and whether there is a cloth at all: what follows from the blocks, told for those who weave
/// it.
Changes diff_cloths(const WovenDesign& before, const WovenDesign& after) {
    Changes changes;
    if (!before.cloth || !after.cloth) {
        const auto says = [](const WovenDesign& design) {
            return design.cloth ? Json() : Json(design.no_cloth);
        };
        if (before.cloth || after.cloth)
            tell_cloth("error", "what keeps the cloth from being made", says(before), says(after), changes);
        return changes;
    }
    const WovenCloth &old = *before.cloth, &now = *after.cloth;
    tell_cloth("picks", "number of picks", old.grid.picks(), now.grid.picks(), changes);
    tell_cloth("ends", "number of ends", old.grid.ends(), now.grid.ends(), changes);
    tell_cloth("rows", "number of rows", old.grid.rows(), now.grid.rows(), changes);
    tell_cloth("columns", "number of columns", old.grid.columns(), now.grid.columns(), changes);
    tell_cloth("height", "height in levels", old.height, now.height, changes);
    tell_cloth("t", "picks in each row", repeat_in_words(old.grid.t()), repeat_in_words(now.grid.t()),
               changes);
    tell_cloth("p", "ends in each column", repeat_in_words(old.grid.p()), repeat_in_words(now.grid.p()),
               changes);
    return changes;
}

void append(Changes& changes, Changes more) {
    changes.insert(changes.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::string why_no_card(const WovenDesign& before, const WovenDesign& after) {
    if (!before.cloth && !after.cloth)
        return "neither design has a cloth: " + before.no_cloth +
               (before.no_cloth == after.no_cloth ? "" : "; " + after.no_cloth);
    return before.cloth ? "the design after has no cloth: " + after.no_cloth
                        : "the design before has no cloth: " + before.no_cloth;
}

void compare_cloths(const WovenDesign& before, const WovenDesign& after, const PlanPartners& partners,
                    DesignDiff& diff) {
    diff.card = diff_cards(before.cloth->card, after.cloth->card);
    const auto& [picks, ends] = diff.card->alignment;
    diff.picks = diff_lines(picks, diff.card->moved_picks, System::weft);
    diff.ends = diff_lines(ends, diff.card->moved_ends, System::warp);
    const PickLines lines{before.cloth->grid, after.cloth->grid, picks};
    append(diff.picks, diff_pick_uses(before.design, after.design, partners, &lines));
    append(diff.yarns, diff_end_uses(before.design, after.design, partners, &ends));
}

}  // namespace

Result<WovenDesign> weave_design(Design design) {
    WovenDesign woven{std::move(design), std::nullopt, {}, {}};
    Result<Evaluation> cloth = evaluate(woven.design);
    if (cloth) {
        woven.cloth = WovenCloth{cloth->block->card_image(), cloth->block->grid(), cloth->block->height()};
        woven.lost_flips = std::move(cloth->lost_flips);
    } else if (cloth.error().code == ErrorCode::system) {
        return std::move(cloth).error();
    } else {
        woven.no_cloth = on_one_line(cloth.error().text());
    }
    return woven;
}

DesignDiff diff_designs(const WovenDesign& before, const WovenDesign& after) {
    DesignDiff diff;
    const PlanPartners partners(before.design, after.design);
    diff.tree = diff_trees(before.design, after.design);
    diff.yarns = diff_yarn_lists(before.design, after.design, partners);
    if (before.cloth && after.cloth) {
        compare_cloths(before, after, partners, diff);
    } else {
        diff.no_card = why_no_card(before, after);
        append(diff.picks, diff_pick_uses(before.design, after.design, partners, nullptr));
        append(diff.yarns, diff_end_uses(before.design, after.design, partners, nullptr));
    }
    diff.parameters = diff_cloths(before, after);
    append(diff.parameters, diff_parameters(before.design, after.design));
    diff.view_differs = before.design.view != after.design.view;
    return diff;
}

}  // namespace weave
