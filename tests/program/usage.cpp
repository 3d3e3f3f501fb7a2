// What a person meets first: help, version, and calls that make no sense.

#include "run.hpp"

#include <map>

using program_tests::Ended;
using program_tests::Workshop;

namespace {

/// Every command, and what its help must mention.
const std::map<std::string, std::vector<std::string>> commands{
    {"samples", {"NAME", "--out"}},
    {"preset", {"FAMILY", "--out", "twill", "up=2", "satin", "move=0", "angle-interlock", "stuffers=0"}},
    {"tile", {"FILE", "--x", "--y", "--z", "--out"}},
    {"attach", {"A", "B", "--face", "+x, -x, +y, -y, +z or -z", "--out"}},
    {"stencil", {"IMAGE", "--map", "--out"}},
    {"renumber", {"FILE", "--row", "--column", "--order", "--out"}},
    {"import", {"IN", "--out", "--t", "--p", "--infer", "--grouping", "--pick-1", "--end-1", "--lifted", "--loom", "--ends", "JC5"}},
    {"info", {"FILE"}},
    {"card", {"FILE", "--out", ".png", ".tif", ".bmp", "--pick-1", "--end-1", "--lifted"}},
    {"check", {"FILE", "--loom"}},
    {"render", {"FILE", "--out", "--view", "--trim", "--from-pick", "--to-pick", "--from-end", "--to-end", "floats", "weft:N", "warp:N", "block"}},
    {"diff", {"BEFORE", "AFTER", "--out"}},
    {"flip", {"FILE", "--pick", "--end", "--out"}},
    {"export", {"FILE", "--loom", "--out"}},
    {"jobs", {"--on", "fetch", "cancel"}},
    {"sessions", {"--on", "close"}},
    {"devices", {"CUDA", "why"}},
};

}  // namespace

TEST_CASE("weave --help names every command, and every command's help its options") {
    const Workshop shop;
    const Ended all = shop.must({"--help"});
    CHECK(all.out.find("Exit status") != std::string::npos);
    CHECK(all.err.empty());
    for (const auto& [command, mentions] : commands) {
        INFO(command);
        CHECK(all.out.find("\n  " + command + " ") != std::string::npos);
        const Ended help = shop.must({command, "--help"});
        CHECK(help.err.empty());
        CHECK(help.out.find("--json") != std::string::npos);
        for (const std::string& mention : mentions) {
            INFO("must mention " << mention);
            CHECK(help.out.find(mention) != std::string::npos);
        }
        CHECK(help.out.find("16777216") == std::string::npos);
        CHECK(help.out.find("268435456") == std::string::npos);  // limits of our own are no one's reading
        CHECK(help.out.find("1073741824") == std::string::npos);
    }
    CHECK(shop.names().empty());
}

TEST_CASE("help on presets lists each family with its options") {
    const Workshop shop;
    const std::string twill = shop.must({"preset", "twill", "--help"}).out;
    CHECK(twill.find("up=2") != std::string::npos);
    CHECK(twill.find("step=1") != std::string::npos);
}

TEST_CASE("weave --version tells name and version") {
    const Workshop shop;
    const Ended ended = shop.must({"--version"});
    CHECK(ended.out.rfind("weave ", 0) == 0);
    CHECK(ended.out.find('.') != std::string::npos);
}

TEST_CASE("what is told to a full device ends with 5, help and version too") {
    const Workshop shop;
    for (const char* words : {"--help", "--version", "tile --help", "samples"}) {
        INFO(words);
        const std::string call = std::string(WEAVE_PROGRAM) + " " + words + " > /dev/full 2> /dev/null";
        const int status = std::system(call.c_str());
        REQUIRE(WIFEXITED(status));
        CHECK(WEXITSTATUS(status) == 5);
    }
}

TEST_CASE("one pick is no picks: a cloth is told in words that fit its numbers") {
    const Workshop shop;
    shop.put("one.weave", R"({"format": "weave", "version": 1, "root": "a", "blocks": {"a": {"kind": "stacks",
        "stacks": [["T0 P0"]]}}})");
    CHECK(shop.must({"tile", "one.weave", "-o", "t.weave"}).out == "t.weave: 1 pick and 1 end in 1 row and 1 column, 2 high\n");
    CHECK(shop.must({"tile", "one.weave", "--x", "2", "-o", "t.weave"}).out ==
          "t.weave: 2 picks and 1 end in 2 rows and 1 column, 2 high\n");
}

TEST_CASE("a design is written to standard output where that is a pipe") {
    const Workshop shop;
    const Ended ended = shop.must({"preset", "plain", "-o", "/dev/stdout", "--json"});
    CHECK(ended.out.find("\"format\": \"weave\"") != std::string::npos);
}

TEST_CASE("a number is decimal, with zeros in front as well") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "p.weave"});
    CHECK(shop.json({"tile", "p.weave", "--x", "010", "--y", "08", "-o", "t.weave"}).at("picks") == 20);
    CHECK(shop.json({"info", "t.weave"}).at("ends") == 16);
    shop.must({"flip", "t.weave", "--pick", "010", "--end", "1", "-o", "f.weave"});
    const weave::Json flips = weave::parse_json(shop.get("f.weave"))->at("blocks").at("plain-tiled").at("flips");
    CHECK(flips.at(0).at("pick") == 9);
    shop.must({"card", "t.weave", "-o", "t.png"});
    shop.must({"import", "t.png", "--t", "02,2", "--p", "001", "-o", "i.weave"});
    CHECK(shop.json({"renumber", "i.weave", "--row", "09", "--order", "01,00", "-o", "r.weave"}).at("rows") == 10);
}

TEST_CASE("a call that makes no sense ends with 2 and says what is wrong with it") {
    const Workshop shop;
    shop.must({"preset", "twill", "-o", "t.weave"});
    shop.must({"card", "t.weave", "-o", "t.png"});
    using Words = std::vector<std::string>;
    const std::vector<std::pair<Words, Words>> calls{
        {{}, {"command"}},
        {{"wave"}, {"wave"}},
        {{"--wave"}, {"--wave"}},
        {{"info"}, {"FILE"}},
        {{"info", "t.weave", "--wave"}, {"--wave"}},
        {{"info", "t.weave", "u.weave"}, {"u.weave"}},
        {{"preset", "twill", "-o", "new.weave", "--wave"}, {"--wave"}},
        {{"preset", "tweed", "-o", "new.weave"}, {"tweed", "plain", "twill", "satin"}},
        {{"preset", "twill", "sideways=1", "-o", "new.weave"}, {"sideways", "up", "down", "step"}},
        {{"preset", "twill", "up", "-o", "new.weave"}, {"up", "=3"}},
        {{"preset", "twill", "up=many", "-o", "new.weave"}, {"up=many"}},
        {{"preset", "twill", "up=201", "-o", "new.weave"}, {"up", "200"}},
        {{"preset", "twill", "up=1", "up=2", "-o", "new.weave"}, {"up", "twice"}},
        {{"preset", "satin", "size=6", "move=2", "-o", "new.weave"}, {"6", "2"}},
        {{"preset", "twill"}, {"--out"}},
        {{"samples", "trousers", "-o", "new.weave"}, {"trousers", "weave samples"}},
        {{"samples", "plain"}, {"-o"}},
        {{"samples", "-o", "new.weave"}, {"NAME"}},
        {{"tile", "t.weave", "--x", "0", "-o", "new.weave"}, {"--x"}},
        {{"tile", "t.weave", "--x", "16777217", "-o", "new.weave"}, {"--x", "16777216"}},
        {{"tile", "t.weave", "--z", "16777217", "-o", "new.weave"}, {"--z", "16777216"}},
        {{"tile", "t.weave", "--x", "two", "-o", "new.weave"}, {"--x", "two"}},
        {{"attach", "t.weave", "t.weave", "--face", "up", "-o", "new.weave"}, {"--face", "up", "+z"}},
        {{"attach", "t.weave", "t.weave", "-o", "new.weave"}, {"--face"}},
        {{"renumber", "t.weave", "--order", "0", "-o", "new.weave"}, {"--row", "--column"}},
        {{"renumber", "t.weave", "--row", "0", "--column", "0", "--order", "0", "-o", "new.weave"},
         {"--row", "--column"}},
        {{"stencil", "t.png", "--map", "red", "-o", "new.weave"}, {"red", "#ff0000="}},
        {{"stencil", "t.png", "--map", "red=t.weave", "-o", "new.weave"}, {"red", "#"}},
        {{"stencil", "t.png", "--map", "#000000=t.weave", "--map", "#000000=t.weave", "-o", "new.weave"},
         {"#000000", "twice"}},
        {{"import", "t.png", "--infer", "--t", "2", "-o", "new.weave"}, {"--t", "--infer"}},
        {{"import", "t.png", "--grouping", "2", "-o", "new.weave"}, {"--grouping", "--infer"}},
        {{"import", "t.png", "--infer", "--grouping", "999", "-o", "new.weave"}, {"grouping"}},
        {{"import", "t.png", "--lifted", "grey", "-o", "new.weave"}, {"--lifted", "grey", "black"}},
        {{"card", "t.weave", "-o", "card.gif"}, {"card.gif", ".png", ".tif", ".bmp", ".wif"}},
        {{"render", "t.weave", "--view", "card", "-o", "card.bmp"}, {"card.bmp", ".png", ".svg"}},
        {{"render", "t.weave", "--view", "inside", "-o", "new.png"}, {"inside", "face", "weft:N"}},
        {{"render", "t.weave", "--view", "weft:5", "-o", "new.png"}, {"5", "1 to 4"}},
        {{"render", "t.weave", "--view", "warp:0", "-o", "new.png"}, {"0", "1 to 4"}},
        {{"flip", "t.weave", "--pick", "0", "--end", "1", "-o", "new.weave"}, {"--pick"}},
        {{"flip", "t.weave", "--pick", "-1", "--end", "1", "-o", "new.weave"}, {"--pick", "-1"}},
        {{"flip", "t.weave", "--pick", "99999999999999999999", "--end", "1", "-o", "new.weave"},
         {"--pick", "'99999999999999999999' is not from 1 to "}},
        {{"simulate", "t.weave", "--steps", "-1", "-o", "new.yarns"}, {"--steps: '-1' is not from 0 on"}},
        {{"flip", "t.weave", "--pick", "0x2", "--end", "1", "-o", "new.weave"}, {"--pick", "0x2"}},
        {{"flip", "t.weave", "--pick", "+2", "--end", "1", "-o", "new.weave"}, {"--pick", "+2"}},
        {{"flip", "t.weave", "--pick", "", "--end", "1", "-o", "new.weave"}, {"--pick"}},
        {{"render", "t.weave", "--view", "weft:1", "--from-end", "0x1", "-o", "new.png"}, {"--from-end", "0x1"}},
        {{"simulate", "t.weave", "--steps", "0x10", "-o", "new.yarns"}, {"--steps", "0x10"}},
        {{"simulate", "t.weave", "--residual", "1e-300", "-o", "new.yarns"}, {"--residual", "1e-300", "1e-15 to 1"}},
        {{"simulate", "t.weave", "--residual", "0", "-o", "new.yarns"}, {"--residual", "above 0"}},
        {{"simulate", "t.weave", "--points", "0x4", "-o", "new.yarns"}, {"--points", "0x4"}},
        {{"renumber", "t.weave", "--row", "0", "--order", "1,,0", "-o", "new.weave"}, {"--order"}},
        {{"renumber", "t.weave", "--row", "0", "--order", "0,", "-o", "new.weave"}, {"--order"}},
        {{"renumber", "t.weave", "--row", "0", "--order", ",0", "-o", "new.weave"}, {"--order"}},
        {{"renumber", "t.weave", "--row", "0", "--order", "", "-o", "new.weave"}, {"--order"}},
        {{"renumber", "t.weave", "--row", "0", "--order", "0x0", "-o", "new.weave"}, {"--order", "0x0"}},
        {{"import", "t.png", "--t", "2,,2", "-o", "new.weave"}, {"--t"}},
        {{"import", "t.png", "--p", "2,", "-o", "new.weave"}, {"--p"}},
        {{"flip", "t.weave", "--pick", "1.5", "--end", "1", "-o", "new.weave"}, {"--pick", "1.5"}},
        {{"flip", "t.weave", "--pick", "1", "--end", "16777217", "-o", "new.weave"}, {"--end", "16777217"}},
        {{"flip", "t.weave", "--pick", "1", "--end", "18446744073709551617", "-o", "new.weave"}, {"--end"}},
        {{"check", "t.weave"}, {"--loom"}},
        {{"export", "t.weave", "-o", "new"}, {"--loom"}},
        {{"export", "t.weave", "--loom", program_tests::loom("tc2"), "-o", ""}, {"--out"}},
        {{"tile", "t.weave", "-o", ""}, {"--out"}},
        {{"import", "t.png", "-o", ""}, {"--out"}},
    };
    shop.must({"card", "t.weave", "-o", "t.wif"});
    for (const std::string option : {"--pick-1", "--end-1", "--lifted"}) {  // which WIF knows nothing of
        const std::string value = option == "--pick-1" ? "top" : option == "--end-1" ? "right" : "white";
        shop.refused({"card", "t.weave", "-o", "new.wif", option, value}, 2, {option, "WIF"});
        shop.refused({"import", "t.wif", "-o", "new.weave", option, value}, 2, {option, "WIF"});
    }
    for (const auto& [words, pieces] : calls) {
        shop.refused(words, 2, pieces);
        Words with_json = words;
        with_json.emplace_back("--json");
        if (!words.empty() && words[0].size() > 4 && words[0][0] != '-') shop.refused(with_json, 2, {});
    }
}
