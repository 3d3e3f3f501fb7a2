#include <weave/core/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <limits>
#include <support/random.hpp>

using namespace weave;

namespace {

std::string number(std::uint64_t bits) {
    return ecmascript_number(std::bit_cast<double>(bits));
}
std::string refusal(const std::string& text) {
    const auto parsed = parse_json(text);
    REQUIRE_FALSE(parsed);
    return parsed.error().text();
}

std::string list_of(std::size_t count, const std::string& item) {
    std::string text = "[";
    for (std::size_t k = 0; k < count; ++k) text += (k > 0 ? "," : "") + item;
    return text + "]";
}

/// Processor time to parse, the least of three tries.
double parsing_ticks(const std::string& text) {
    double least = std::numeric_limits<double>::max();
    for (int k = 0; k < 3; ++k) {
        const std::clock_t start = std::clock();
        REQUIRE(parse_json(text));
        least = std::min(least, static_cast<double>(std::clock() - start));
    }
    return least;
}

}  // namespace

TEST_CASE("numbers are printed as the table of RFC 8785, appendix B, demands") {
    REQUIRE(number(0x0000000000000000) == "0");
    REQUIRE(number(0x8000000000000000) == "0");
    REQUIRE(number(0x0000000000000001) == "5e-324");
    REQUIRE(number(0x8000000000000001) == "-5e-324");
    REQUIRE(number(0x7fefffffffffffff) == "1.7976931348623157e+308");
    REQUIRE(number(0xffefffffffffffff) == "-1.7976931348623157e+308");
    REQUIRE(number(0x4340000000000000) == "9007199254740992");
    REQUIRE(number(0xc340000000000000) == "-9007199254740992");
    REQUIRE(number(0x4430000000000000) == "295147905179352830000");
    REQUIRE(number(0x44b52d02c7e14af5) == "9.999999999999997e+22");
    REQUIRE(number(0x44b52d02c7e14af6) == "1e+23");
    REQUIRE(number(0x44b52d02c7e14af7) == "1.0000000000000001e+23");
    REQUIRE(number(0x444b1ae4d6e2ef4e) == "999999999999999700000");
    REQUIRE(number(0x444b1ae4d6e2ef4f) == "999999999999999900000");
    REQUIRE(number(0x444b1ae4d6e2ef50) == "1e+21");
    REQUIRE(number(0x3eb0c6f7a0b5ed8c) == "9.999999999999997e-7");
    REQUIRE(number(0x3eb0c6f7a0b5ed8d) == "0.000001");
    REQUIRE(number(0x41b3de4355555553) == "333333333.3333332");
    REQUIRE(number(0x41b3de4355555554) == "333333333.33333325");
    REQUIRE(number(0x41b3de4355555555) == "333333333.3333333");
    REQUIRE(number(0x41b3de4355555556) == "333333333.3333334");
    REQUIRE(number(0x41b3de4355555557) == "333333333.33333343");
    REQUIRE(number(0xbecbf647612f3696) == "-0.0000033333333333333333");
    REQUIRE(number(0x43143ff3c1cb0959) == "1424953923781206.2");
}

TEST_CASE("any number printed reads back as the same number") {
    weave::testing::for_all([](weave::testing::Random& random) {
        const double value = std::bit_cast<double>(static_cast<std::uint64_t>(random.between(0, SIZE_MAX)));
        if (!std::isfinite(value)) return;
        REQUIRE(std::strtod(ecmascript_number(value).c_str(), nullptr) == value);
    });
}

TEST_CASE("canonical bytes are those of the examples of RFC 8785") {
    const auto canonical = [](const std::string& text) { return canonical_json(parse_json(text).value()); };
    REQUIRE(canonical(R"({
        "numbers": [333333333.33333329, 1E30, 4.50, 2e-3, 0.000000000000000000000000001],
        "string": "\u20ac$\u000F\u000aA'\u0042\u0022\u005c\\\"\/",
        "literals": [null, true, false]
    })") == "{\"literals\":[null,true,false],\"numbers\":[333333333.3333333,1e+30,4.5,0.002,1e-27],"
            "\"string\":\"\xe2\x82\xac$\\u000f\\nA'B\\\"\\\\\\\\\\\"/\"}");
    // members go by UTF-16 code units: an emoji (surrogates from d800) stands before the ligature at fb33
    REQUIRE(
        canonical("{\"\\u20ac\": \"Euro Sign\", \"\\r\": \"Carriage Return\", \"\\ufb33\": \"Hebrew Letter "
                  "Dalet With Dagesh\","
                  "\"1\": \"One\", \"\\ud83d\\ude00\": \"Emoji: Grinning Face\", \"\\u0080\": \"Control\","
                  "\"\\u00f6\": \"Latin Small Letter O With Diaeresis\"}") ==
        "{\"\\r\":\"Carriage Return\",\"1\":\"One\",\"\xc2\x80\":\"Control\","
        "\"\xc3\xb6\":\"Latin Small Letter O With Diaeresis\",\"\xe2\x82\xac\":\"Euro Sign\","
        "\"\xf0\x9f\x98\x80\":\"Emoji: Grinning Face\",\"\xef\xac\xb3\":\"Hebrew Letter Dalet With "
        "Dagesh\"}");
    REQUIRE(canonical("\"\\b\\t\\n\\f\\r\\u0000\\u001f\\u007f\"") == "\"\\b\\t\\n\\f\\r\\u0000\\u001f\x7f\"");
    REQUIRE(canonical(R"([{}, [], "", -0.0, 18446744073709551615, -1])") ==
            R"([{},[],"",0,18446744073709552000,-1])");
}

TEST_CASE("the order of members and the spacing do not change the canonical bytes") {
    const auto one = parse_json(R"({"b": [1, 2.0], "a": {"y": 1e2, "x": "é"}})").value();
    const auto other = parse_json("{\"a\":{\"x\":\"\\u00e9\",\"y\":100},\"b\":[1.0,2]}").value();
    REQUIRE(canonical_json(one) == canonical_json(other));
    REQUIRE(canonical_json(parse_json(canonical_json(one)).value()) == canonical_json(one));
}

TEST_CASE("what is not strict JSON is refused, with its place") {
    REQUIRE_THAT(refusal(R"({"a": 1, "b": 2, "a": 3})"), Catch::Contains("repeats the member 'a'"));
    REQUIRE_THAT(refusal(R"({"x": {"a": 1, "\u0061": 3}})"), Catch::Contains("repeats the member 'a'"));
    REQUIRE(parse_json(R"({"x": {"a": 1}, "y": {"a": 2}, "a": [{"a": 1}]})"));
    REQUIRE_THAT(refusal("{\n  \"a\": tru }"), Catch::Contains("line 2"));
    for (const std::string text :
         {"",       " ",         "{",           "[1,]",     "{\"a\":1,}", "01",    "+1",
          "1.",     ".5",        "NaN",         "Infinity", "'a'",        "[1] 2", "// no\n1",
          "\"\t\"", "\"\\x41\"", "\"\\ud800\"", "nul",      "1e999",      "{a:1}", "[1 2]"}) {
        INFO(text);
        REQUIRE_FALSE(parse_json(text));
    }
    for (const std::string text :
         {"\"\xff\"", "\"\xc0\xaf\"", "\"\xed\xa0\x80\"", "\"\xe2\x82\"", "\"\xf4\x90\x80\x80\""}) {
        REQUIRE_FALSE(parse_json(text));
    }
}

TEST_CASE("what breaks off or has a wrong word is told by place and reason, without the parser's grammar") {
    CHECK(refusal("{\"a\": [1,\n2") == "is not JSON: line 2, column 2: it ends too early");
    CHECK(refusal("") == "is not JSON: line 1, column 1: it ends too early");
    CHECK(refusal("{\"a\": yes}") == "is not JSON: line 1, column 7: invalid literal");
    CHECK(refusal("[1, }") == "is not JSON: line 1, column 5: unexpected '}'");
}

TEST_CASE("depth and members are bounded, whatever a file holds") {
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    REQUIRE(parse_json(nested(64)));
    REQUIRE_THAT(refusal(nested(65)), Catch::Contains("deeper than 64"));
    REQUIRE_FALSE(parse_json(std::string(10000000, '[')));
    REQUIRE_THAT(refusal("yarns" + std::string(100, '[')), Catch::Contains("is not JSON: line 1, column 1"));  // what is no JSON nests nowhere
    REQUIRE(parse_json("\"" + std::string(100, '[') + "\\\"[\""));  // brackets in a text are no depth
    const auto members = [](std::size_t count) {
        std::string text = "{";
        for (std::size_t k = 0; k < count; ++k) text += (k > 0 ? ",\"" : "\"") + std::to_string(k) + "\":0";
        return text + "}";
    };
    REQUIRE(parse_json(members(4096)));
    REQUIRE_THAT(refusal(members(4097)), Catch::Contains("more than 4096 members"));
}

TEST_CASE("a long list of objects takes no other work than a long list of lists") {
    // Lists and objects of one number cost much the same. A parser that looks through the parent's items at
    // the end of each object takes thousands of times longer for these: the bound is far from both.
    constexpr std::size_t count = 100000;
    const double lists = parsing_ticks(list_of(count, "[0]"));
    CHECK(parsing_ticks(list_of(count, R"({"a":0})")) < 40 * lists);
    CHECK(parsing_ticks(R"({"a":)" + list_of(count, "{}") + "}") < 40 * lists);
}

TEST_CASE("a value is built as it is written, whatever is nested in what") {
    const Json value =
        parse_json(
            R"({"b": [1, [], {}, {"x": [[2], null]}, "t"], "a": {"y": {"z": true}, "w": -3}, "c": 1.5})")
            .value();
    REQUIRE(value.dump() == R"({"b":[1,[],{},{"x":[[2],null]},"t"],"a":{"y":{"z":true},"w":-3},"c":1.5})");
    REQUIRE(value["b"][0].is_number_unsigned());
    REQUIRE(value["a"]["w"].is_number_integer());
    REQUIRE(parse_json("7").value() == 7);
    REQUIRE(parse_json(R"({"": {"": []}})").value()[""][""].is_array());
}
