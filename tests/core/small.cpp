#include <weave/core/colour.hpp>
#include <weave/core/log.hpp>
#include <weave/core/result.hpp>
#include <weave/core/text.hpp>
#include <weave/core/units.hpp>

#include <cstdlib>
#include <support/random.hpp>

using namespace weave;

TEST_CASE("a colour survives its text") {
    weave::testing::for_all(
        [](weave::testing::Random& random) {
            const auto part = [&] { return static_cast<std::uint8_t>(random.between(0, 255)); };
            const Colour colour{part(), part(), part()};
            REQUIRE(parse_colour(to_text(colour)).value() == colour);
        },
        weave::testing::property_cases());
    REQUIRE(to_text(Colour{0, 10, 255}) == "#000aff");
    REQUIRE(parse_colour("#D08030").value() == Colour{0xd0, 0x80, 0x30});
    for (const char* text : {"", "#", "d08030", "#d0803", "#d080300", "#d0803g", "#-08030", "#+08030",
                             "# 08030", "#0x0803", "red"}) {
        INFO(text);
        REQUIRE_FALSE(parse_colour(text));
    }
}

TEST_CASE("an error gathers its place from the inside out") {
    REQUIRE(bad_input("is missing").text() == "is missing");
    REQUIRE(bad_input("is missing", "t").under("blocks.toe").in("shoe.weave").text() ==
            "shoe.weave: blocks.toe.t: is missing");
    REQUIRE(bad_input("holds T5", "[3]").under("stacks").text() == "stacks[3]: holds T5");
    REQUIRE(bad_input("holds T5").under("stacks").in("a.weave").text() == "a.weave: stacks: holds T5");
    const auto tries = [](bool fails) -> Result<int> {
        WEAVE_TRY(const int value, fails ? Result<int>(invalid("no")) : Result<int>(4));
        WEAVE_CHECK_OK(value == 4 ? Status() : Status(invalid("never")));
        return value + 1;
    };
    REQUIRE(tries(false).value() == 5);
    REQUIRE(tries(true).error().code == ErrorCode::invalid);
}

TEST_CASE("a foreign name cannot move the cursor, forge a line or turn the writing") {
    CHECK(on_one_line("caf\xc3\xa9 \xe2\x80\x94 no. 3 \xf0\x9f\xa7\xb5") ==
          "caf\xc3\xa9 \xe2\x80\x94 no. 3 \xf0\x9f\xa7\xb5");
    CHECK(on_one_line("a\x1b[31mb") == "a\\x1b[31mb");
    CHECK(on_one_line("shoe\npicks 9999\r\t") == "shoe\\x0apicks 9999\\x0d\\x09");
    CHECK(on_one_line(std::string("\0\x7f", 2)) == "\\x00\\x7f");
    CHECK(on_one_line("\xc2\x9b 31m") == "\\u009b 31m");            // the C1 control that ESC [ stands for
    CHECK(on_one_line("\x9b 31m\xff") == "\\x9b 31m\\xff");         // no UTF-8
    CHECK(on_one_line("\xe2\x80\xaegnp.exe") == "\\u202egnp.exe");  // writes on from right to left
    CHECK(on_one_line("\xe2\x81\xa6\xe2\x80\xa8\xd8\x9c") == "\\u2066\\u2028\\u061c");
    CHECK(on_one_line("\xc3") == "\\xc3");
}

TEST_CASE("one judgement of UTF-8: length of the first character, and whole texts") {
    CHECK(utf8_length("") == 0);
    CHECK(utf8_length("ab") == 1);
    CHECK(utf8_length("\xc3\xa9z") == 2);
    CHECK(utf8_length("\xe2\x82\xac") == 3);
    CHECK(utf8_length("\xf0\x9f\xa7\xb5") == 4);
    for (const char* wrong : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                              "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xc3z"}) {
        CHECK(utf8_length(wrong) == 0);
        CHECK_FALSE(is_utf8(std::string("ab") + wrong));
    }
    CHECK(is_utf8("\xed\x9f\xbf\xf4\x8f\xbf\xbf"));
}

TEST_CASE("the shortest list that repeats to the whole") {
    using Counts = std::vector<std::uint32_t>;
    CHECK(shortest_repeat(Counts{2, 2, 2, 2}) == Counts{2});
    CHECK(shortest_repeat(Counts{1, 2, 1, 2}) == Counts{1, 2});
    CHECK(shortest_repeat(Counts{1, 2, 1}) == Counts{1, 2, 1});
    CHECK(shortest_repeat(Counts{}).empty());
}

TEST_CASE("how many cases a property test runs is read strictly") {
    const char* const before = std::getenv("WEAVE_PROPERTY_CASES");
    const std::string kept = before == nullptr ? "" : before;
    for (const char* wrong : {"abc", "", "0", "-3", "12x", "1e4"}) {
        INFO(wrong);
        ::setenv("WEAVE_PROPERTY_CASES", wrong, 1);
        CHECK_THROWS(weave::testing::property_cases());
    }
    ::setenv("WEAVE_PROPERTY_CASES", "3", 1);
    CHECK(weave::testing::property_cases() == 3);
    std::size_t runs = 0;
    weave::testing::for_all([&](weave::testing::Random&) { ++runs; }, weave::testing::property_cases() / 10);
    CHECK(runs == 1);  // a share of a few is one, never none
    before == nullptr ? ::unsetenv("WEAVE_PROPERTY_CASES")
                      : ::setenv("WEAVE_PROPERTY_CASES", kept.c_str(), 1);
}

TEST_CASE("messages go to the sink, or nowhere") {
    std::vector<std::string> heard;
    set_log_sink([&](LogLevel level, std::string_view message) {
        if (level == LogLevel::warning) heard.emplace_back(message);
    });
    log(LogLevel::warning, "a pick is uncaught");
    log(LogLevel::debug, "detail");
    set_log_sink({});
    log(LogLevel::warning, "unheard");
    REQUIRE(heard == std::vector<std::string>{"a pick is uncaught"});
}

TEST_CASE("units convert to millimetre, gram and millisecond") {
    REQUIRE(units::gram_per_mm(1000) == Approx(1e-3));  // 1000 tex: a gram a metre
    REQUIRE(units::spacing_mm(20) == Approx(0.5));
    REQUIRE(units::standard_gravity == Approx(9.80665 * 1000 / (1000.0 * 1000.0)));  // m/s² in mm/ms²
}
