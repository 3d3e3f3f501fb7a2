#include <weave/block/slice_moves.hpp>

#include <support/random.hpp>

#include <set>

using namespace weave;
using namespace weave::testing;

namespace {

/// A slice of a random block in either direction, with some wefts disabled, that is still a cloth.
Slice random_slice(Random& random) {
    const Block block = random_block(random);
    Slice slice = random.coin() ? warp_slice(block, random.between(0, block.columns() - 1)).value()
                                : weft_slice(block, random.between(0, block.rows() - 1)).value();
    Slice with_disabled = slice;
    for (auto& places : with_disabled.positions) {
        for (SliceYarn& place : places) place.disabled = place.yarn.is_weft() && random.between(0, 5) == 0;
    }
    return to_block(with_disabled) ? with_disabled : slice;
}

std::vector<SliceYarnId> yarns_of(const Slice& slice) {
    std::vector<SliceYarnId> yarns;
    for (std::size_t path = 0; path < paths_of(slice); ++path) yarns.push_back(SliceYarnId::run(path));
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        for (std::size_t k = 0; k < dots_at(slice, position); ++k)
            yarns.push_back(SliceYarnId::dot(position, k));
    }
    return yarns;
}

SliceYarnId some_yarn(Random& random, const Slice& slice) {
    const auto yarns = yarns_of(slice);
    return yarns[random.between(0, yarns.size() - 1)];
}
std::size_t some_position(Random& random, const Slice& slice) {
    return random.between(0, slice.positions.size() - 1);
}

/// The yarns of a position from the bottom up, one left out; empty places as well.
std::vector<SliceYarn> order_without(const Slice& slice, std::size_t position, const SliceYarnId& yarn) {
    std::vector<SliceYarn> order;
    const auto level = level_of(slice, yarn, position);
    for (std::size_t k = 0; k < slice.positions[position].size(); ++k) {
        const SliceYarn& place = slice.positions[position][k];
        if (!place.yarn.is_empty() && (k != level || (!yarn.path && yarn.position != position)))
            order.push_back(place);
    }
    return order;
}
const SliceYarnId no_yarn = SliceYarnId::run(1000);

void require_same_order(const Slice& a, const Slice& b, const SliceYarnId& but = no_yarn) {
    REQUIRE(a.positions.size() == b.positions.size());
    for (std::size_t position = 0; position < a.positions.size(); ++position)
        REQUIRE(order_without(a, position, but) == order_without(b, position, but));
}

std::vector<PathStep> random_steps(Random& random, const Slice& slice) {
    std::vector<PathStep> steps;
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        if (random.coin()) continue;
        steps.push_back({position, random.between(0, dots_at(slice, position)), {}});
        if (random.coin()) steps.back().level = random.between(0, levels_of(slice) + 1);
    }
    return steps;
}

Slice slice_of(System dots, const std::vector<std::string>& positions) {
    Slice slice{dots, {}};
    for (const auto& text : positions) slice.positions.push_back(parse_slice_position(text).value());
    return slice;
}
std::vector<std::string> texts(const Slice& slice) {
    std::vector<std::string> list;
    for (const auto& places : slice.positions) list.push_back(to_text(places));
    return list;
}
using Texts = std::vector<std::string>;

/// Any edit at all, sensible or not.
Result<Slice> random_move(Random& random, const Slice& slice) {
    const SliceYarnId yarn = some_yarn(random, slice);
    const std::size_t position = random.between(0, slice.positions.size());
    const std::size_t level = random.between(0, levels_of(slice) + 1);
    switch (random.between(0, 15)) {
        case 0:
            return route_path(slice, random.between(0, paths_of(slice)), random_steps(random, slice));
        case 1:
            return add_path(slice, random_steps(random, slice));
        case 2:
            return add_dot(slice, position, level);
        case 3:
            return duplicate_yarn(slice, yarn);
        case 4:
            return remove_yarns(slice, std::vector{yarn, some_yarn(random, slice)});
        case 5:
            return move_dot(slice, yarn, level);
        case 6:
            return move_dot_to_position(slice, yarn, position, level);
        case 7:
            return renumber_yarn(slice, yarn, random.between(0, 3));
        case 8:
            return set_enabled(slice, yarn, random.coin());
        case 9:
            return insert_position(slice, position);
        case 10:
            return duplicate_position(slice, position);
        case 11:
            return remove_position(slice, position);
        case 12:
            return move_position(slice, position, some_position(random, slice));
        case 13:
            return raise(slice, position, level);
        case 14:
            return lower(slice, position, level);
        default:
            return without_empty_levels(slice);
    }
}

}  // namespace

TEST_CASE("whatever is done to a slice, what comes of it is a cloth, or an error in words") {
    for_all([](Random& random) {
        Slice slice = random_slice(random);
        for (int step = 0; step < 8 && slice.positions.size() < 30; ++step) {
            Result<Slice> next = random_move(random, slice);
            if (!next) {
                REQUIRE(next.error().message.size() > 10);
                continue;
            }
            const auto made = to_block(*next);
            INFO((made ? "" : made.error().text()));
            REQUIRE(made);
            slice = std::move(next).value();
        }
    });
}

TEST_CASE("a routed path runs above as many dots as asked, and nothing else changes its order") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const std::size_t path = random.between(0, paths_of(slice) - 1);
        const auto steps = random_steps(random, slice);
        const Slice routed = route_path(slice, path, steps).value();
        std::vector<std::size_t> expected;
        for (std::size_t k = 0; k < slice.positions.size(); ++k) expected.push_back(gap_of(slice, path, k));
        for (const PathStep& step : steps) expected[step.position] = step.gap;
        for (std::size_t k = 0; k < slice.positions.size(); ++k)
            REQUIRE(gap_of(routed, path, k) == expected[k]);
        require_same_order(slice, routed, SliceYarnId::run(path));
    });
}

TEST_CASE("what is added and removed again leaves the slice as it was, but for empty levels") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const Slice with_path = add_path(slice, random_steps(random, slice)).value();
        const SliceYarnId path = SliceYarnId::run(paths_of(slice));
        REQUIRE(without_empty_levels(remove_yarns(with_path, std::vector{path}).value()) ==
                without_empty_levels(slice));
        const std::size_t position = some_position(random, slice);
        const SliceYarnId dot = SliceYarnId::dot(position, dots_at(slice, position));
        const Slice with_dot = add_dot(slice, position, random.between(0, levels_of(slice) + 1)).value();
        REQUIRE(without_empty_levels(remove_yarns(with_dot, std::vector{dot}).value()) ==
                without_empty_levels(slice));
        const SliceYarnId yarn = some_yarn(random, slice);
        SliceYarnId copy = yarn;
        ++copy.number;
        const Slice twice = duplicate_yarn(slice, yarn).value();
        REQUIRE(without_empty_levels(remove_yarns(twice, std::vector{copy}).value()) ==
                without_empty_levels(slice));
        const Slice longer = duplicate_position(slice, position).value();
        REQUIRE(without_empty_levels(remove_position(longer, position + 1).value()) ==
                without_empty_levels(slice));
        const std::size_t gap = random.between(0, slice.positions.size());
        REQUIRE(without_empty_levels(remove_position(insert_position(slice, gap).value(), gap).value()) ==
                without_empty_levels(slice));
    });
}

TEST_CASE("a new dot lies where it was put: above all that lay below that level, below the rest") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const std::size_t position = some_position(random, slice),
                          level = random.between(0, levels_of(slice) + 1);
        const SliceYarnId dot = SliceYarnId::dot(position, dots_at(slice, position));
        const Slice added = add_dot(slice, position, level).value();
        REQUIRE(level_of(added, dot, position) == level);
        require_same_order(slice, added, dot);
        for (std::size_t k = 0; k < std::min(level, slice.positions[position].size()); ++k)
            REQUIRE(added.positions[position][k] == slice.positions[position][k]);
    });
}

TEST_CASE("a moved dot passes what lies between and leaves all else in order; moving it back undoes it") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const std::size_t position = some_position(random, slice);
        if (dots_at(slice, position) == 0) return;
        const SliceYarnId dot = SliceYarnId::dot(position, random.between(0, dots_at(slice, position) - 1));
        const std::size_t from = level_of(slice, dot, 0).value(),
                          to = random.between(0, levels_of(slice) - 1);
        const Slice moved = move_dot(slice, dot, to).value();
        require_same_order(slice, moved, dot);
        if (levels_of(moved) != levels_of(slice)) return;  // it left its level empty, which is gone
        REQUIRE(level_of(moved, dot, 0) == to);
        const Slice back = move_dot(moved, dot, from).value();
        require_same_order(slice, back);
        if (levels_of(back) == levels_of(slice)) REQUIRE(level_of(back, dot, 0) == from);
    });
}

TEST_CASE("renumbering changes the order on loom and card and nothing that is drawn") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const SliceYarnId yarn = some_yarn(random, slice);
        const std::size_t yarns = yarn.path ? paths_of(slice) : dots_at(slice, yarn.position);
        SliceYarnId to = yarn;
        to.number = random.between(0, yarns - 1);
        const Slice moved = renumber_yarn(slice, yarn, to.number).value();
        for (std::size_t k = 0; k < slice.positions.size(); ++k)
            REQUIRE(level_of(moved, to, k) == level_of(slice, yarn, k));
        REQUIRE(texts(renumber_yarn(moved, to, yarn.number).value()) == texts(slice));
        // The others keep their order: the numbers of two of them are never exchanged.
        for (const SliceYarnId& other : yarns_of(slice)) {
            if (other == yarn || other.path != yarn.path || other.position != yarn.position) continue;
            SliceYarnId now = other;
            if (other.number > yarn.number) --now.number;
            if (now.number >= to.number) ++now.number;
            REQUIRE(level_of(moved, now, 0) == level_of(slice, other, 0));
        }
        REQUIRE_FALSE(renumber_yarn(slice, yarn, yarns));
    });
}

TEST_CASE("the numbers told of a slice are those of its block's picks and ends") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const Block block = to_block(slice).value();
        const SliceNumbers numbers = card_numbers(slice);
        std::size_t picks = 0, ends = 0;
        for (const SliceYarnId& yarn : yarns_of(slice)) {
            const auto number = numbers.of(yarn);
            REQUIRE(number.has_value() != is_disabled(slice, yarn));
            if (!number) continue;
            const bool weft = (slice.dots == System::weft) != yarn.path;
            ++(weft ? picks : ends);
            for (std::size_t k = 0; k < slice.positions.size(); ++k) {
                const auto level = level_of(slice, yarn, k);
                if (!level || (!yarn.path && k != yarn.position)) continue;
                const bool rows = slice.dots == System::weft;
                const Stack& stack = rows ? block.stack(k, 0) : block.stack(0, k);
                const std::size_t first =
                    weft ? block.first_pick(rows ? k : 0) : block.first_end(rows ? 0 : k);
                const auto places = stack.positions(weft ? System::weft : System::warp);
                REQUIRE(*number >= first);
                REQUIRE(places.at(*number - first) == *level);
            }
        }
        REQUIRE(picks == block.picks());
        REQUIRE(ends == block.ends());
    });
}

TEST_CASE("raised and lowered again, a position is as it was") {
    for_all([](Random& random) {
        const Slice slice = random_slice(random);
        const std::size_t position = some_position(random, slice),
                          level = random.between(0, levels_of(slice));
        const Result<Slice> raised = raise(slice, position, level);
        if (!raised) return;
        REQUIRE(raised->positions[position][level].yarn.is_empty());
        require_same_order(slice, *raised);
        REQUIRE(without_empty_levels(lower(*raised, position, level + 1).value()) ==
                without_empty_levels(slice));
    });
}

TEST_CASE("the picture stays calm: a path takes an empty place, else one level is put in all along") {
    const Slice plain = new_slice(System::weft, 3).value();
    REQUIRE(texts(plain) == Texts{"P0 T0", "P0 T0", "P0 T0"});
    const std::vector<PathStep> over{{1, 1, {}}};
    const Slice woven = route_path(plain, 0, over).value();
    REQUIRE(texts(woven) == Texts{"P0 T0 -", "- T0 P0", "P0 T0 -"});
    const std::vector<PathStep> under{{1, 0, {}}};
    REQUIRE(route_path(woven, 0, under).value() == plain);  // the level that it left goes
    const Slice two = add_path(woven, std::vector<PathStep>{{0, 1, {}}, {1, 0, {}}, {2, 1, {}}}).value();
    REQUIRE(texts(two) == Texts{"P0 T0 P1", "P1 T0 P0", "P0 T0 P1"});
    REQUIRE(texts(route_path(two, 1, std::vector<PathStep>{{0, 0, 0}}).value()) ==
            Texts{"P1 P0 T0 -", "- P1 T0 P0", "- P0 T0 P1"});
}

TEST_CASE("a slice move that cannot be made says which yarn and why") {
    const Slice slice = slice_of(System::weft, {"P0 T0", "T0 P0 (T1)"});
    const auto error = [](const Result<Slice>& result) { return result.error().text(); };
    REQUIRE(error(remove_yarns(slice, std::vector{SliceYarnId::run(0)})) ==
            "Warp 1 cannot be removed: no warp would be left; a slice needs at least one end");
    REQUIRE(error(remove_yarns(slice, std::vector{SliceYarnId::dot(0, 0), SliceYarnId::dot(1, 0)})) ==
            "The yarns chosen cannot be removed: no weft would be woven any more; a slice needs at least one "
            "pick");
    const Slice one = set_enabled(slice, SliceYarnId::dot(1, 0), false).value();
    REQUIRE(error(set_enabled(one, SliceYarnId::dot(0, 0), false)) ==
            "Weft 1 of position 1 cannot be disabled: no weft would be woven any more; a slice needs at "
            "least one "
            "pick");
    REQUIRE(error(set_enabled(slice, SliceYarnId::run(0), false)) ==
            "Warp 1 is an end, which runs through the whole cloth; only wefts can be disabled");
    REQUIRE(error(renumber_yarn(slice, SliceYarnId::dot(1, 0), 2)) ==
            "Weft 1 of position 2 cannot become number 3: its position has only 2");
    REQUIRE(error(route_path(slice, 0, std::vector<PathStep>{{0, 2, {}}})) ==
            "Warp 1 cannot run above 2 dots of position 1, which has 1");
    REQUIRE(error(route_path(slice, 1, {})) == "the slice has no warp 2");
    REQUIRE(error(move_dot(slice, SliceYarnId::run(0), 0)) ==
            "Warp 1 runs along the slice; draw its way instead");
    REQUIRE(error(remove_position(remove_position(slice, 0).value(), 0)) ==
            "the only position cannot be removed; a slice needs at least one");
    REQUIRE(error(lower(slice, 0, 1)) == "there is no empty place below level 2 of position 1");
    REQUIRE(error(add_dot(slice, 0, most_height)).find("higher than the 1048576 levels") !=
            std::string::npos);
    REQUIRE(error(add_dot(slice, 5, 0)) == "there is no position 6; the last one is 2");
    REQUIRE_FALSE(new_slice(System::weft, 0));
    REQUIRE_FALSE(add_dot(Slice{}, 0, 0));
}
