#include <weave/core/json_reader.hpp>

#include <catch2/catch.hpp>

using namespace weave;

namespace {

/// The error after `read` has read the members of an object.
template <class Read>
std::string error_of(const std::string& text, Read read) {
    const Json json = parse_json(text).value();
    JsonReader reader(json, "shoe.weave");
    read(reader);
    return reader.status() ? "" : reader.status().error().text();
}

}  // namespace

TEST_CASE("a reader hands out members of every kind") {
    const Json json =
        parse_json(R"({"n": 1.5, "i": -3, "b": true, "t": "plain", "c": "#A0b1c2", "way": "right",
        "list": [1, 2], "o": {"x": 1}, "os": [{"x": 1}, {"x": 2}], "named": {"toe": {"x": 4}, "heel": {"x": 5}}, "raw": [null],
        "names": ["loom", ""]})")
            .value();
    JsonReader reader(json, "here");
    REQUIRE(reader.number("n", {0, 2}) == 1.5);
    REQUIRE(reader.integer("i", -3, 3) == -3);
    REQUIRE(reader.boolean("b"));
    REQUIRE(reader.text("t") == "plain");
    REQUIRE(reader.colour("c") == Colour{0xa0, 0xb1, 0xc2});
    REQUIRE(reader.choice("way", {"left", "right"}) == 1);
    REQUIRE(reader.integers("list", 1, 2) == std::vector<std::int64_t>{1, 2});
    REQUIRE(reader.texts("names", 2) == std::vector<std::string>{"loom", ""});
    REQUIRE(reader.object("o").integer("x", 0, 9) == 1);
    REQUIRE(reader.objects("os")[1].integer("x", 0, 9) == 2);
    auto named = reader.object("named").named_objects();
    REQUIRE(named[1].first == "heel");
    REQUIRE(named[1].second.integer("x", 0, 9) == 5);
    REQUIRE(reader.raw("raw").size() == 1);
    REQUIRE(reader.raw("none").is_null());
    reader.no_others();
    REQUIRE(reader.status());
    REQUIRE(reader.integer("gone", 0, 9, 7) == 7);
    REQUIRE(reader.colour("gone", Colour{1, 2, 3}) == Colour{1, 2, 3});
    REQUIRE(reader.text("gone", "spare") == "spare");
    REQUIRE(reader.object("gone", true).integer("x", 0, 9, 3) == 3);
    REQUIRE(reader.objects("gone", true).empty());
    REQUIRE(reader.texts("gone", 1).empty());
    REQUIRE(reader.status());
}

TEST_CASE("the first error is kept, with the path to its member") {
    REQUIRE(error_of("{}", [](auto& r) { r.number("dx", {}); }) == "shoe.weave.dx: is missing");
    REQUIRE(error_of(R"({"a": {"b": [{}, {"c": 11}]}})", [](auto& r) {
                for (auto& item : r.object("a").objects("b")) item.integer("c", 0, 10, 1), item.no_others();
                r.text("later");
            }) == "shoe.weave.a.b[1].c: must be a whole number from 0 to 10");
    REQUIRE(error_of(R"({"x": 1, "typo": 2})", [](auto& r) { r.integer("x", 0, 9), r.no_others(); }) ==
            "shoe.weave.typo: is not known here");
    REQUIRE(error_of(R"({"x": "a"})", [](auto& r) { r.texts("x", 2); }) ==
            "shoe.weave.x: must be a list of at most 2 texts");
    REQUIRE(error_of(R"({"x": ["a", "b", "c"]})", [](auto& r) { r.texts("x", 2); }) ==
            "shoe.weave.x: must be a list of at most 2 texts");
    REQUIRE(error_of(R"({"x": ["a", 1]})", [](auto& r) { r.texts("x", 2); }) ==
            "shoe.weave.x[1]: must be a text");
    REQUIRE(error_of("[1]", [](auto& r) { r.no_others(); }) == "shoe.weave: must be an object");
}

TEST_CASE("values of a wrong kind or out of range are refused") {
    const auto whole = [](const std::string& value) {
        return error_of("{\"x\": " + value + "}", [](auto& r) { r.integer("x", INT64_MIN, INT64_MAX); });
    };
    REQUIRE(whole("9223372036854775807").empty());
    REQUIRE(whole("-9223372036854775808").empty());
    for (const char* value : {"9223372036854775808", "18446744073709551615", "1.0", "\"1\"", "null", "[1]"}) {
        INFO(value);
        REQUIRE_FALSE(whole(value).empty());
    }
    const auto refused = [](const std::string& value, auto read) {
        return !error_of("{\"x\": " + value + "}", read).empty();
    };
    REQUIRE(refused("1", [](auto& r) { r.text("x"); }));
    REQUIRE(refused("\"abcd\"", [](auto& r) { r.text("x", {}, 3); }));
    REQUIRE(refused("1", [](auto& r) { r.boolean("x"); }));
    REQUIRE(refused("true", [](auto& r) { r.number("x", {}); }));
    REQUIRE(refused("3", [](auto& r) { r.number("x", {0, 2}); }));
    REQUIRE(refused("\"#12345\"", [](auto& r) { r.colour("x"); }));
    REQUIRE(refused("\"up\"", [](auto& r) { r.choice("x", {"left", "right"}); }));
    REQUIRE(refused("[1, 99]", [](auto& r) { r.integers("x", 0, 9); }));
    REQUIRE(refused("[18446744073709551615]", [](auto& r) { r.integers("x", -5, 9); }));
    REQUIRE(refused("[1.5]", [](auto& r) { r.integers("x", 0, 9); }));
    REQUIRE(refused("{}", [](auto& r) { r.objects("x"); }));
    REQUIRE(refused("[1]", [](auto& r) { r.objects("x"); }));
    REQUIRE(refused("[]", [](auto& r) { r.object("x"); }));
}
