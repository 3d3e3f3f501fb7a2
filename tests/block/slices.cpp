#include <weave/block/slice.hpp>

#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// One column (or row) of a block by itself.
Block column_of(const Block& block, std::size_t column) {
    return make_block(
               block.t(), {block.p()[column]}, [&](auto row, auto) { return block.stack(row, column); },
               block.height())
        .value();
}
Block row_of(const Block& block, std::size_t row) {
    return make_block(
               {block.t()[row]}, block.p(), [&](auto, auto column) { return block.stack(row, column); },
               block.height())
        .value();
}

Slice slice_of(System dots, const std::vector<std::string>& positions) {
    Slice slice{dots, {}};
    for (const auto& text : positions) slice.positions.push_back(parse_slice_position(text).value());
    return slice;
}

}  // namespace

TEST_CASE("a column of a block as a slice and back is that column, empty slots included") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const std::size_t column = random.between(0, block.columns() - 1),
                          row = random.between(0, block.rows() - 1);
        const Slice warps = warp_slice(block, column).value(), wefts = weft_slice(block, row).value();
        REQUIRE(to_block(warps).value() == column_of(block, column));
        REQUIRE(to_block(wefts).value() == row_of(block, row));
        for (const auto& position : warps.positions) {
            REQUIRE(parse_slice_position(to_text(position)).value() == position);
        }
    });
}

namespace {

/// One position after these wefts are taken out, made slot by slot: each other weft is numbered by how many
/// with a lower number are left.
Stack left_over(const std::vector<SliceYarn>& position, const std::set<std::size_t>& gone) {
    std::vector<Slot> slots;
    for (const SliceYarn& place : position) {
        const Slot yarn = place.yarn;
        if (!yarn.is_weft()) {
            slots.push_back(yarn);
        } else if (gone.contains(yarn.index())) {
            slots.emplace_back();
        } else {
            const auto lower = std::distance(gone.begin(), gone.lower_bound(yarn.index()));
            slots.push_back(yarn.renumbered(yarn.index() - static_cast<std::size_t>(lower)));
        }
    }
    return Stack(std::move(slots));
}

/// Switches some wefts of one position off.
std::set<std::size_t> disable_some(Random& random, std::vector<SliceYarn>& position) {
    std::set<std::size_t> gone;
    for (SliceYarn& place : position) {
        place.disabled = place.yarn.is_weft() && random.between(0, 2) == 0;
        if (place.disabled) gone.insert(place.yarn.index());
    }
    return gone;
}

}  // namespace

TEST_CASE(
    "a weft switched off in a warp slice leaves its slot empty there, the others close up, spacing stays") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        Slice slice = warp_slice(block, 0).value();
        std::vector<Stack> expected;
        std::size_t left = 0;
        for (auto& position : slice.positions) {
            expected.push_back(left_over(position, disable_some(random, position)));
            left += expected.back().wefts();
        }
        const auto made = to_block(slice);
        REQUIRE(static_cast<bool>(made) == (left > 0));
        if (!made) return;
        for (std::size_t k = 0; k < expected.size(); ++k) REQUIRE(made->stack(k, 0) == expected[k]);
        REQUIRE(made->height() == block.height());
        REQUIRE(made->picks() == left);
    });
}

TEST_CASE("a weft switched off anywhere in a weft slice is gone from every stack of its row") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        Slice slice = weft_slice(block, 0).value();
        std::set<std::size_t> gone;
        for (auto& position : slice.positions) gone.merge(disable_some(random, position));
        const auto made = to_block(slice);
        REQUIRE(static_cast<bool>(made) == (gone.size() < block.t()[0]));
        if (!made) return;
        for (std::size_t k = 0; k < block.columns(); ++k)
            REQUIRE(made->stack(0, k) == left_over(slice.positions[k], gone));
        REQUIRE(made->height() == block.height());
        REQUIRE(made->picks() == block.t()[0] - gone.size());
        REQUIRE(made->ends() == block.ends());
    });
}

TEST_CASE("a slice's text reads as it is drawn") {
    const auto position = parse_slice_position("T0 - (T1~) P0").value();
    REQUIRE(position.size() == 4);
    REQUIRE(position[2].disabled);
    REQUIRE(position[2].yarn == Slot::weft(1, true));
    REQUIRE(to_text(position) == "T0 - (T1~) P0");
    REQUIRE(to_block(slice_of(System::weft, {"(T0) P0 T1 -", "T0 P0"}))->stack(0, 0) ==
            parse_stack("- P0 T0").value());
    REQUIRE(to_block(slice_of(System::warp, {"(T0) P0 T1", "T0 - T1 P0"})).value() ==
            make_block(
                {1}, {1, 1},
                [](auto, auto column) { return parse_stack(column == 0 ? "- P0 T0" : "- - T0 P0").value(); },
                4)
                .value());
    REQUIRE(parse_slice_position("T0 (P0)").error().message ==
            "'(P0)' is no weft; only wefts can be disabled");
    for (const char* text : {"()", "(T0", "T0)", "((T0))", "(-)", "X"})
        REQUIRE_FALSE(parse_slice_position(text));
}

TEST_CASE("a slice that is no cloth is refused at its position") {
    const auto error = [](std::vector<std::string> positions) {
        return to_block(slice_of(System::weft, positions)).error();
    };
    REQUIRE_THAT(error({}).message, Catch::Contains("at least one position"));
    REQUIRE(error({"T0 P0", "T0 P0 P1"}).text() ==
            "positions[1]: has 2 ends running along the slice, but positions[0] has 1");
    REQUIRE(error({"T0 P0", "T0 T0 P0"}).where == "positions[1]");
    REQUIRE(error({"T0 P0", "T1 P0"}).where == "positions[1]");
    REQUIRE(error({"(T1) T1 P0"}).where == "positions[0]");
    REQUIRE_THAT(error({"(T0) P0"}).message, Catch::Contains("at least one pick"));
    Slice slice = slice_of(System::weft, {"T0 P0"});
    slice.positions[0][1].disabled = true;
    REQUIRE_THAT(to_block(slice).error().message, Catch::Contains("only wefts can be disabled"));
    slice.dots = System::warp;
    REQUIRE(to_block(slice).error().where == "positions[0]");
    Random random(4);
    const Block block = random_block(random, {1, 1}, {1});
    REQUIRE_THAT(warp_slice(block, 1).error().message, Catch::Contains("no column 1"));
    REQUIRE_THAT(weft_slice(block, 2).error().message, Catch::Contains("no row 2"));
}
