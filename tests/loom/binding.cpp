// What binds, held against an oracle that looks at every crossing by itself.

#include "../support/random.hpp"
#include "check_case.hpp"

#include <weave/loom/pick_table.hpp>
#include <weave/loom/weft_way.hpp>

#include <map>
#include <set>

using namespace weave;
using namespace weave::testing;

namespace {

/// For each yarn whether it is firm anywhere, and passes over and under a firm yarn that is there.
struct Crossed {
    bool firm = false, over = false, under = false;
    [[nodiscard]] bool binds() const { return !firm || (over && under); }
};

/// First and last end of each pick that carries a weft; of two feeders the outermost.
using Ways = std::map<std::size_t, std::pair<std::size_t, std::size_t>>;

Ways ways_of(const Block& block, const std::vector<Pick>& picks, WeftMode mode) {
    Ways ways;
    if (mode == WeftMode::periodic) {
        for (std::size_t k = 0; k < picks.size(); ++k) {
            if (!picks[k].feeders.empty()) ways[k] = {0, block.ends() - 1};
        }
        return ways;
    }
    const CardImage loose = loose_ends(block);
    for (const PickSpan& span : weft_way(block.card_image(), picks, &loose).spans) {
        const auto [at, fresh] = ways.try_emplace(span.pick, span.first, span.last);
        at->second.first = std::min(at->second.first, span.first);
        at->second.second = std::max(at->second.second, span.last);
    }
    return ways;
}

/// Crossing by crossing from the stacks and the way of the weft.
void cross_all(const Block& block, const Ways& spans, std::vector<Crossed>& picks,
               std::vector<Crossed>& ends) {
    const auto loose = [&](std::size_t row, std::size_t column, bool weft, std::size_t index) {
        const auto slots = block.stack(row, column).slots();
        return std::any_of(slots.begin(), slots.end(),
                           [&](Slot s) { return s.is_weft() == weft && s.index() == index && s.is_loose(); });
    };
    for (std::size_t end = 0; end < block.ends(); ++end) {
        const std::size_t column = block.column_of_end(end);
        for (std::size_t row = 0; row < block.rows(); ++row) {
            if (!loose(row, column, false, end - block.first_end(column))) ends[end].firm = true;
        }
        for (const auto& [pick, span] : spans) {
            if (end < span.first || end > span.second) continue;
            const std::size_t row = block.row_of_pick(pick);
            if (loose(row, column, true, pick - block.first_pick(row))) continue;
            picks[pick].firm = true;
            if (loose(row, column, false, end - block.first_end(column))) continue;
            const bool weft_over = block.weft_over(pick, end);
            (weft_over ? picks[pick].over : picks[pick].under) = true;
            (weft_over ? ends[end].under : ends[end].over) = true;
        }
    }
}

}  // namespace

TEST_CASE("what binds and what does not is what the crossings say, one by one") {
    std::size_t narrow = 0, unbound = 0;
    for_all([&](Random& random) {
        Case c;
        c.cloth.block = std::make_shared<const Block>(random_block(random));
        const Block& block = *c.cloth.block;
        c.design.scene.weft_mode = random.coin() ? WeftMode::wraparound : WeftMode::periodic;
        c.design.weft.feeders = {{"a", 0}, {"b", 0}};
        c.design.weft.feeder_order = {{0}, {1}, {}, {0, 1}, {0}};
        const auto picks = pick_table(c.design, block);
        const auto spans = ways_of(block, picks, c.design.scene.weft_mode);
        std::vector<Crossed> of_pick(block.picks()), of_end(block.ends());
        for (const auto& [pick, span] : spans) narrow += span.second - span.first + 1 < block.ends();
        cross_all(block, spans, of_pick, of_end);
        std::set<std::size_t> expected_picks, expected_ends, found_picks, found_ends;
        for (std::size_t k = 0; k < of_pick.size(); ++k) {
            if (!of_pick[k].binds()) expected_picks.insert(k);
        }
        for (std::size_t k = 0; k < of_end.size(); ++k) {
            if (!of_end[k].binds()) expected_ends.insert(k);
        }
        for (const Finding& finding : c.of("bind.pick")) found_picks.insert(*finding.pick);
        for (const Finding& finding : c.of("bind.end")) found_ends.insert(*finding.end);
        CHECK(found_picks == expected_picks);
        CHECK(found_ends == expected_ends);
        unbound += expected_picks.size() + expected_ends.size();
    });
    CHECK(narrow > 0);
    CHECK(unbound > 0);
}
