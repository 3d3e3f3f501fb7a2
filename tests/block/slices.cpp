#include <weave/block/slice.hpp>

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
    for (const auto& text : positions) slice.positions.push_back(parse_slice_position(text, dots).value());
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
            REQUIRE(parse_slice_position(to_text(position), System::weft).value() == position);
        }
    });
}

TEST_CASE("a disabled dot becomes an empty slot, the others close up and the spacing stays") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const bool wefts_run = random.coin();
        Slice slice = wefts_run ? weft_slice(block, 0).value() : warp_slice(block, 0).value();
        std::vector<Stack> expected;
        std::size_t left = 0;
        for (auto& position : slice.positions) {
            std::vector<Slot> slots;
            for (SliceYarn& place : position) {
                const bool dot = wefts_run ? place.yarn.is_warp() : place.yarn.is_weft();
                place.disabled = dot && random.coin();
                left += dot && !place.disabled ? 1 : 0;
                slots.push_back(place.disabled ? Slot() : place.yarn);
            }
            for (Slot& slot : slots) {  // its new number: enabled dots that had a lower one
                std::size_t lower = 0;
                for (const Slot other : slots) {
                    if (!other.is_empty() && other.same_system(slot) && other.index() < slot.index()) ++lower;
                }
                if (!slot.is_empty()) slot = slot.renumbered(lower);
            }
            expected.emplace_back(std::move(slots));
        }
        const auto made = to_block(slice);
        REQUIRE(static_cast<bool>(made) == (left > 0));
        if (!made) return;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            REQUIRE(made->stack(wefts_run ? 0 : k, wefts_run ? k : 0) == expected[k]);
        }
        REQUIRE(made->height() == block.height());
        REQUIRE((wefts_run ? made->ends() : made->picks()) == left);
    });
}

TEST_CASE("a slice's text reads as it is drawn") {
    const auto position = parse_slice_position("T0 - (T1~) P0", System::weft).value();
    REQUIRE(position.size() == 4);
    REQUIRE(position[2].disabled);
    REQUIRE(position[2].yarn == Slot::weft(1, true));
    REQUIRE(to_text(position) == "T0 - (T1~) P0");
    REQUIRE(to_block(slice_of(System::weft, {"(T0) P0 T1 -", "T0 P0"}))->stack(0, 0) ==
            parse_stack("- P0 T0").value());
    REQUIRE_THAT(parse_slice_position("(P0)", System::weft).error().message, Catch::Contains("only wefts"));
    REQUIRE_THAT(parse_slice_position("T0 (T1)", System::warp).error().message,
                 Catch::Contains("only warps"));
    for (const char* text : {"()", "(T0", "T0)", "((T0))", "(-)", "X"})
        REQUIRE_FALSE(parse_slice_position(text, System::weft));
}

TEST_CASE("a slice that is no cloth is refused at its position") {
    const auto error = [](std::vector<std::string> positions) {
        return to_block(slice_of(System::weft, positions)).error();
    };
    REQUIRE_THAT(error({}).message, Catch::Contains("at least one position"));
    REQUIRE(error({"T0 P0", "T0 P0 P1"}).text() ==
            "positions[1]: has 2 warps running along the slice, but positions[0] has 1");
    REQUIRE(error({"T0 P0", "T0 T0 P0"}).where == "positions[1]");
    REQUIRE(error({"T0 P0", "T1 P0"}).where == "positions[1]");
    REQUIRE(error({"(T1) T1 P0"}).where == "positions[0]");
    REQUIRE_THAT(error({"(T0) P0"}).message, Catch::Contains("at least one pick"));
    Slice slice = slice_of(System::weft, {"T0 P0"});
    slice.positions[0][1].disabled = true;
    REQUIRE_THAT(to_block(slice).error().message, Catch::Contains("seen end-on"));
    Random random(4);
    const Block block = random_block(random, {1, 1}, {1});
    REQUIRE_THAT(warp_slice(block, 1).error().message, Catch::Contains("no column 1"));
    REQUIRE_THAT(weft_slice(block, 2).error().message, Catch::Contains("no row 2"));
}
