// Turns at the repeat, and turns that only a loose end holds.

#include "check_case.hpp"

using namespace weave;
using namespace weave::testing;

namespace {

Case turning(const std::vector<std::string>& rows) {
    Case c;
    c.design.scene.weft_mode = WeftMode::wraparound;
    c.cloth.block = block_of(rows);
    return c;
}

/// The same cloth with the end of one column loose.
BlockPtr with_loose_end(const Block& block, std::size_t loose_column) {
    return std::make_shared<const Block>(
        make_block(block.t(), block.p(), [&](std::size_t row, std::size_t column) {
            std::vector<Slot> slots;
            for (const Slot slot : block.stack(row, column).slots()) {
                slots.push_back(slot.is_warp() && column == loose_column ? Slot::warp(slot.index(), true)
                                                                         : slot);
            }
            return Stack(std::move(slots));
        }).value());
}

}  // namespace

TEST_CASE("a turn that only a loose end catches pulls through once it is trimmed") {
    Case c = turning({"0110", "0111"});
    c.design.scene.boundary_x = Boundary::frozen;
    CHECK(c.passes("turn.caught"));
    c.cloth.block = with_loose_end(*c.cloth.block, 3);
    c.expect_at("turn.caught", 1, {});
    CHECK(c.of("turn.caught")[0].message.find("held only at end 4, which is loose") != std::string::npos);
    // A firm end farther in catches it after trimming.
    c.cloth.block = with_loose_end(*block_of({"0010", "0111"}), 3);
    CHECK(c.passes("turn.caught"));
    // The end that no pick differs at holds nothing anyway.
    c.cloth.block = with_loose_end(*block_of({"0110", "0111"}), 0);
    CHECK(c.passes("turn.caught"));
}

TEST_CASE("where the warp repeats the turn from the last pick to the first is judged as well") {
    Case c = turning({"0101", "0011", "1010", "0101"});
    c.expect_at("turn.caught", 0, {});
    CHECK(c.of("turn.caught").size() == 1);
    CHECK(c.of("turn.caught")[0].message.find("from pick 4 to pick 1 of the next repeat") !=
          std::string::npos);
    c.design.scene.boundary_x = Boundary::frozen;
    CHECK(c.passes("turn.caught"));
    c = turning({"0101", "1010", "0101"});  // odd: the next repeat goes the other way
    c.expect_at("turn.caught", 0, {});
    CHECK(c.of("turn.caught").size() == 1);
    c = turning({"0101", "1010", "0011"});
    CHECK(c.passes("turn.caught"));
    CHECK(c.passes("turn.crossed"));
}

TEST_CASE("at the repeat two turns of a pick may pull past each other") {
    // Pick 1 keeps its turn to pick 2 at end 1 alone, and that from pick 4 at end 4 alone.
    Case c = turning({"1001", "0001", "1110", "1000"});
    c.design.scene.boundary_x = Boundary::frozen;
    CHECK(c.passes("turn.crossed"));
    c.design.scene.boundary_x = Boundary::periodic;
    c.expect_at("turn.crossed", 0, {});
}

TEST_CASE("the shuttle's box is judged at the repeat, too") {
    for (const WeftMode mode : {WeftMode::periodic, WeftMode::wraparound}) {
        Case c = turning({"0101", "1010", "0011"});
        c.design.scene.weft_mode = mode;
        CHECK(c.passes("turn.box"));
        using enum Direction;
        c.design.weft.directions = {left_to_right, right_to_left, left_to_right};
        c.expect_at("turn.box", 0, {});
        CHECK(c.of("turn.box").size() == 1);
        c.design.scene.boundary_x = Boundary::free;
        CHECK(c.passes("turn.box"));
    }
}
