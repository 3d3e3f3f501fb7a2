#include <weave/core/colour.hpp>
#include <weave/core/log.hpp>
#include <weave/core/result.hpp>
#include <weave/core/units.hpp>

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

TEST_CASE("a number of cases that is none does not pass for one") {
    using weave::testing::case_count;
    CHECK(case_count("250") == 250);
    for (const char* text : {"", "abc", "0", "-5", "10k", " 7", "99999999999999999999"}) {
        INFO(text);
        CHECK(case_count(text) == 0);
    }
}
