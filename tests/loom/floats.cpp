// Floats: what counts as passed, and what loose yarns and absent picks do.

#include "check_case.hpp"

using namespace weave;
using namespace weave::testing;

namespace {

/// A row of columns, each with the stack of that text, numbers counted within the cell.
BlockPtr block_of_stacks(const std::vector<std::vector<std::string>>& rows, std::uint32_t t,
                         std::uint32_t p) {
    const std::vector<std::uint32_t> picks(rows.size(), t), ends(rows.front().size(), p);
    return std::make_shared<const Block>(make_block(picks, ends, [&](std::size_t row, std::size_t column) {
                                             return parse_stack(rows[row][column]).value();
                                         }).value());
}

std::string only_message(const std::vector<Finding>& found) {
    REQUIRE(found.size() == 1);
    return found[0].message;
}

}  // namespace

TEST_CASE("a float counts stacks: yarns that lie on each other are passed as one") {
    Case c;
    // The end lies over four rows and under the fifth, with one pick a row and with four.
    const std::vector<std::string> one{"0", "0", "0", "0", "1"};
    std::vector<std::string> four;
    for (const std::string& row : one) four.insert(four.end(), 4, row);
    c.cloth.block = block_of(one);
    CHECK(only_message(c.of("float.face")).find("over 4 picks, from pick 1 to 4;") != std::string::npos);
    c.cloth.block = block_of(four, 4);
    CHECK(only_message(c.of("float.face")).find("over 4 rows of picks, from pick 1 to 16;") !=
          std::string::npos);
    c.profile.limits.float_face = 4;
    CHECK(c.passes("float.face"));
    c.profile.limits.float_face = 3;
    const std::string up = "P0 P1 T0", down = "T0 P0 P1";
    c.cloth.block = block_of_stacks({{up, up, up, up, down}}, 1, 2);
    CHECK(only_message(c.of("float.face")).find("over 4 columns of ends, from end 1 to 8;") !=
          std::string::npos);
}

TEST_CASE("a loose yarn on a face hides no float there") {
    Case c;
    const std::string up = "P0 T0", down = "T0 P0";
    c.cloth.block = block_of_stacks({{up, up, up, up, down}}, 1, 1);
    c.expect_at("float.face", 0, 0);
    const std::string hidden_up = "P2~ P0 T0 P1~", hidden_down = "P2~ T0 P0 P1~";
    c.cloth.block = block_of_stacks({{hidden_up, hidden_up, hidden_up, hidden_up, hidden_down}}, 1, 3);
    c.expect_at("float.face", 0, 0);
    c.cloth.block = block_of_stacks({{hidden_down, hidden_down, hidden_down, hidden_down, hidden_up}}, 1, 3);
    c.expect_at("float.back", 0, 0);
}

TEST_CASE("a pick without weft neither lengthens a float nor breaks it") {
    Case c;
    c.design.weft.feeder_order = {{0}, {0}, {0}, {}, {0}};
    c.cloth.block = block_of({"01", "01", "01", "01", "10"});
    CHECK(c.passes("float.face"));
    c.design.weft.feeder_order = {{0}, {0}, {}, {0}, {0}, {0}};
    c.cloth.block = block_of({"01", "01", "10", "01", "01", "10"});
    CHECK(only_message(c.of("float.face")).find("end 1 floats on the face over 4 picks, from pick 1 to 5;") !=
          std::string::npos);
    // Where the cloth begins and ends with such a pick the float goes on through the repeat.
    c.design.weft.feeder_order = {{}, {0}, {0}, {0}, {0}, {0}, {}};
    c.cloth.block = block_of({"10", "01", "01", "10", "01", "01", "10"});
    CHECK(only_message(c.of("float.face")).find("from pick 5 through the repeat to 3;") != std::string::npos);
}
