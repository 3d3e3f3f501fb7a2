#include <weave/sim/measured.hpp>

#include <catch2/catch.hpp>

using namespace weave;

namespace {

Error refusal(std::string_view text) {
    auto read = read_measured(text);
    REQUIRE_FALSE(read);
    CHECK(read.error().code == ErrorCode::bad_input);
    return read.error();
}

}  // namespace

TEST_CASE("measured centrelines are read with comments, blank lines and any line ends") {
    const auto yarns = read_measured(
        "\xef\xbb\xbf# a scan, mm\r\n\r\n2 # the first\r\n0 0\t0.5\r\n1.5e1 -2 .25 # its end\r\n\n3\n1 2 "
        "3\n\n4 5 6\n7 8 9");
    REQUIRE(yarns);
    REQUIRE(yarns->size() == 2);
    REQUIRE((*yarns)[0].places.size() == 2);
    CHECK((*yarns)[0].places[1] == Vec3(15, -2, 0.25));
    CHECK((*yarns)[0].line == 3);
    REQUIRE((*yarns)[1].places.size() == 3);
    CHECK((*yarns)[1].places[2] == Vec3(7, 8, 9));
    CHECK((*yarns)[1].line == 7);
}

TEST_CASE("what is wrong with measured centrelines is said with its line") {
    CHECK(refusal("2\n0 0 0\n0 0 x\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0 0 0\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0 nan\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0 inf\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0 1e10\n").where == "line 3");
    CHECK(refusal("2\n0 0 0\n0 0 1e999\n").where == "line 3");
    CHECK(refusal("\n# only\n1\n0 0 0\n").where == "line 3");
    CHECK(refusal("2 3\n").where == "line 1");
    CHECK(refusal("two\n").where == "line 1");
    CHECK(refusal("-2\n").where == "line 1");
    CHECK(refusal("99999999\n0 0 0\n").where == "line 1");
    CHECK(refusal("16777216\n0 0 0\n").message.find("ends after 1 point of the 16777216") !=
          std::string::npos);
    CHECK(refusal("2\n0 0 0\n1 1 1\n3\n0 0 0\n1 1 1\n").where == "line 4");
    CHECK(refusal("2\n0 0 \xff\n").message.find("UTF-8") != std::string::npos);
    CHECK(refusal("").message == "there is no yarn in this file");
    CHECK(refusal("# nothing\n").message == "there is no yarn in this file");
}
