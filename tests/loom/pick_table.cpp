#include <weave/loom/pick_table.hpp>

#include <catch2/catch.hpp>

using namespace weave;

namespace {

Block block_of(std::vector<std::uint32_t> t) {
    return make_block(std::move(t), {1},
                      [&](std::size_t row, std::size_t) {
                          std::vector<Slot> slots{Slot::warp(0)};
                          for (std::size_t k = 0; k < (row == 0 ? 2U : 1U); ++k)
                              slots.push_back(Slot::weft(k));
                          return Stack(std::move(slots));
                      })
        .value();
}

}  // namespace

TEST_CASE("each feeder goes back and forth, the cloth advances after each row") {
    Design design;
    design.weft.feeders = {{"one", 0}, {"two, red", 0}};
    design.weft.feeder_order = {{0}, {1}, {0}};
    const auto picks = pick_table(design, block_of({2, 1, 1}));
    REQUIRE(picks.size() == 4);
    CHECK(picks[0].direction == Direction::left_to_right);
    CHECK(picks[1].direction == Direction::left_to_right);
    CHECK(picks[2].direction == Direction::right_to_left);
    CHECK(picks[3].direction == Direction::left_to_right);
    CHECK_FALSE(picks[0].take_up);
    CHECK(picks[1].take_up);
    CHECK(picks[1].row == 0);
    CHECK(picks[3].row == 2);
    const std::string csv = pick_table_csv(design, picks);
    CHECK(csv.find("2,1,2,\"two, red\",left to right,yes,") != std::string::npos);
}

TEST_CASE("given directions and take-up repeat; a pick without feeder says nothing") {
    Design design;
    design.weft.directions = {Direction::right_to_left};
    design.weft.take_up = {true, false};
    design.weft.feeder_order = {{0}, {}};
    const auto picks = pick_table(design, block_of({2, 1}));
    CHECK(picks[2].direction == Direction::right_to_left);
    CHECK_FALSE(picks[1].take_up);
    CHECK(yarn_of_pick(design, picks[1]) == nullptr);
    CHECK(yarn_of_pick(design, picks[0]) == &design.weft.yarns[0]);
    CHECK(pick_table_csv(design, picks).find("2,1,,,,no,,\r\n") != std::string::npos);
    design.warp.colours = {{1, 2, 3}};
    design.warp.colour_order.once = {0, 1};
    CHECK(colour_of_end(design, 3) == Colour{1, 2, 3});
    CHECK(colour_of_end(design, 2) == yarn_of_end(design, 2).colour);
}

TEST_CASE("further repeats start the plans anew, but the shuttles go on from where they stand") {
    Design design;
    const Block block = make_block({1, 1, 1}, {1}, [](auto, auto) {
                            return Stack({Slot::warp(0), Slot::weft(0)});
                        }).value();
    const auto picks = pick_table(design, block, 2);
    REQUIRE(picks.size() == 6);
    CHECK(picks[2].direction == Direction::left_to_right);
    CHECK(picks[3].direction == Direction::right_to_left);
    CHECK(picks[5].row == 5);
    design.weft.directions = {Direction::left_to_right, Direction::right_to_left};
    CHECK(pick_table(design, block, 2)[3].direction == Direction::left_to_right);
}

TEST_CASE("no name in the pick table is a formula to a spreadsheet") {
    for (const std::string name :
         {"=cmd|' /C calc'!A0", "@SUM(1+1)", "+1", "-1", "=HYPERLINK(\"x\",\"y\")", "\t=1", "\r=1"}) {
        INFO(name);
        Design design;
        design.weft.yarns[0].name = name;
        design.weft.feeders = {{name, 0}, {"plain", 0}};
        design.weft.feeder_order = {{0, 1}, {1, 0}};
        const std::string csv = pick_table_csv(design, pick_table(design, block_of({2})));
        for (const char* before : {",", "\""}) {
            CHECK(csv.find(before + name.substr(0, 2)) == std::string::npos);
        }
        CHECK(csv.find("'" + name.substr(0, 1)) != std::string::npos);
        CHECK(csv.find("plain + ") != std::string::npos);  // only the start of a cell matters
    }
    Design design;
    design.weft.feeders = {{"a-b", 0}};
    CHECK(pick_table_csv(design, pick_table(design, block_of({2}))).find(",a-b,") != std::string::npos);
}
