// Raw files, and what a card is made of: hooks against the profile, feeders, repeats, the lead-in.

#include "controller_case.hpp"

#include <support/controller_bytes.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

ControllerCard card(const Shed& shed, const LoomProfile& profile, std::optional<std::size_t> ends = {}) {
    const Result<ControllerFile> file = read_controller_file(raw_bytes(shed, profile), profile);
    REQUIRE(file);
    const Result<ControllerCard> read = card_of(*file, profile, ends);
    if (!read) FAIL(read.error().text());
    return *read;
}

/// Lifted ends of a pick as text.
std::string ends_of(const CardImage& card, std::size_t pick) {
    std::string text;
    for (std::size_t end = 0; end < card.ends(); ++end) text += card.weft_over(pick, end) ? '.' : 'X';
    return text;
}

std::vector<std::string> told(const ControllerCard& card) {
    std::vector<std::string> lines;
    for (const HookDifference& difference : card.differences) lines.push_back(in_words(difference));
    return lines;
}

std::string refusal(const Shed& shed, const LoomProfile& profile, std::optional<std::size_t> ends = {}) {
    const Result<ControllerFile> file = read_controller_file(raw_bytes(shed, profile), profile);
    REQUIRE(file);
    const Result<ControllerCard> read = card_of(*file, profile, ends);
    REQUIRE_FALSE(read);
    CHECK(read.error().code == ErrorCode::bad_input);
    return read.error().text();
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("a raw file is picks of hook bytes, and nothing else") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 16);
    const ControllerFile file = *read_controller_file(bytes_of("01 80  FF 00"), profile);
    CHECK(file.format == OutputFormat::raw);
    CHECK(file.picks() == 2);
    CHECK(file.name.empty());
    CHECK(shed_of(file, 0) == "X..............X");
    CHECK(shed_of(file, 1) == "XXXXXXXX........");
    CHECK(file.offset_of(1) == 2);
    check_refused("", profile, "byte 0", "empty");
    check_refused("abc", profile, "byte 3", "1 byte into a pick of 2 bytes");
    profile.total_hooks = 12;
    check_refused("ab", profile, "", "do not add up");
    profile.function_bytes = 9;
    profile.total_hooks = 16;
    check_refused("abcdefghijk", profile, "", "9 function bytes a pick, but such a file at most 8");
}

TEST_CASE("areas on bytes of their own or run together, function bytes in front, bits of no hook") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 13);
    profile.areas = {{"a", 3}, {"b", 10}};
    profile.function_bytes = 1;
    const ControllerFile apart = *read_controller_file(bytes_of("05 06 01 02"), profile);
    CHECK(apart.function_words == std::vector<std::uint64_t>{5});
    CHECK(shed_of(apart, 0) == ".XXX........X");
    CHECK(apart.warnings.empty());
    check_warned(bytes_of("05 06 01 02 05 0E 01 02"), profile, "byte 5",
                 "bits of pick 2 that belong to no hook");
    profile.lifted_is_one = false;
    CHECK(shed_of(*read_controller_file(bytes_of("05 F9 FE FD"), profile), 0) == ".XXX........X");
    CHECK(read_controller_file(bytes_of("05 F9 FE FD"), profile)->warnings.empty());
    check_warned(bytes_of("05 F9 FE 7D"), profile, "byte 1", "f9 fe 7d");
    profile.lifted_is_one = true;
    profile.areas_on_bytes = false;
    const ControllerFile together = *read_controller_file(bytes_of("80 0E 10"), profile);
    CHECK(together.function_words == std::vector<std::uint64_t>{0x80});
    CHECK(shed_of(together, 0) == ".XXX........X");
    check_warned(bytes_of("80 0E 30"), profile, "byte 1", "0e 30");
    profile.least_bit_first = false;  // the function byte stays as it is
    const ControllerFile turned = *read_controller_file(bytes_of("80 70 08"), profile);
    CHECK(turned.function_words == std::vector<std::uint64_t>{0x80});
    CHECK(shed_of(turned, 0) == ".XXX........X");
}

TEST_CASE("end 1 at the right takes the last body hook, and ends count down") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.body = {{0, 2}, {5, 7}};
    profile.end_1_at_left = false;
    CHECK(ends_of(card({"X....XX."}, profile).card, 0) == ".XX..X");
    CHECK(ends_of(card({".....XX."}, profile, 3).card, 0) == ".XX");
    profile.hook_rule = HookRule::repeats;
    profile.repeats = 2;
    CHECK(ends_of(card({".XX..XX."}, profile).card, 0) == ".XX");
    CHECK(told(card({"XX...XX."}, profile)).empty());
    CHECK(told(card({".XX..XX."}, profile)).size() == 2);
}

TEST_CASE("hooks in 14 planes of 192, 0 lifted, feeders in-band at the first hook of six planes") {
    // The one matched pair that was seen: hook h stands in plane h mod 14, at place h / 14 of it.
    LoomProfile profile = bare_loom(OutputFormat::raw, 14 * 192);
    profile.lifted_is_one = false;
    for (std::size_t hook = 0; hook < profile.total_hooks; ++hook)
        profile.hook_permutation.push_back(hook % 14 * 192 + hook / 14);
    profile.feeders = 6;
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {0, 1, 2, 3, 4, 5};  // places 0, 192, 384, 576, 768, 960 of the file
    profile.body = {{14, 2687}};
    std::string bytes(2 * 336, '\xff');
    bytes[192 / 8] = '\xfe';                     // pick 1: place 192, feeder 2
    bytes[1] = static_cast<char>(0xff & ~0x02);  // pick 1: place 9 of plane 0, hook 9 · 14 = 126
    bytes[336 + 960 / 8] = '\xfe';               // pick 2: place 960, feeder 6
    bytes[336 + (13 * 192 + 191) / 8] = '\x7f';  // pick 2: the last place, hook 2687
    const ControllerFile file = *read_controller_file(bytes, profile);
    const ControllerCard read = *card_of(file, profile);
    CHECK(read.difference_count == 0);
    CHECK(read.feeders == std::vector<FeederSet>{{1}, {5}});
    std::vector<std::pair<std::size_t, std::size_t>> lifted;
    for (std::size_t pick = 0; pick < 2; ++pick)
        for (std::size_t end = 0; end < read.card.ends(); ++end)
            if (!read.card.weft_over(pick, end)) lifted.emplace_back(pick, end);
    CHECK(lifted == std::vector<std::pair<std::size_t, std::size_t>>{{0, 112}, {1, 2673}});
}

TEST_CASE("hooks that do otherwise than the profile says are told with pick and hook") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 16);
    profile.body = {{4, 11}};
    profile.selvedge = {{14, 15}, {0, 1}};  // counted through the ranges as they are listed
    profile.selvedge_weave = {"0110", "1001"};
    profile.constant_on = {{2, 2}};
    profile.cast_out = {{13, 13}};  // 3 and 12 are named nowhere
    CHECK(told(card({"X.X.XXXXXXXX...X", ".XX.........  X."}, profile)).empty());
    CHECK(told(card({"X.X.XXXXXXXX...X", ".XXX.........XX."}, profile)) ==
          Lines{"pick 2: hook 4 is lifted, but is cast out", "pick 2: hook 14 is lifted, but is cast out"});
    CHECK(told(card({"X...XXXXXXXX...X"}, profile)) ==
          Lines{"pick 1: hook 3 is down, but is to be lifted on every pick"});
    CHECK(told(card({".XX.XXXXXXXX...X"}, profile)) ==
          Lines{"pick 1: hook 1 is down, against the selvedge weave of the profile",
                "pick 1: hook 2 is lifted, against the selvedge weave of the profile"});
    CHECK(told(card({"X.X.XXXX.XX....X"}, profile, 4)) ==
          Lines{"pick 1: hook 10 is lifted, but carries no end",
                "pick 1: hook 11 is lifted, but carries no end"});
    const ControllerCard many = card(Shed(100, "X.X.XXXXXXXX...X"), profile);  // the selvedge never changes
    CHECK(many.difference_count == 200);
    CHECK(many.differences.size() == most_listed_differences);
    CHECK(many.differences[0].pick == 1);
    CHECK(many.differences[0].hook == 14);
    CHECK(many.differences[0].lifted == false);
    CHECK(many.differences[0].use == HookUse::selvedge);
}

TEST_CASE("an end takes its first hook's word, and its other hooks must agree") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.hook_rule = HookRule::repeats;
    profile.repeats = 2;
    const ControllerCard twice = card({"X.XXX.XX", "..X.X.X."}, profile);
    CHECK(ends_of(twice.card, 0) == "X.XX");
    CHECK(ends_of(twice.card, 1) == "..X.");
    CHECK(told(twice) == Lines{"pick 2: hook 5 is lifted, but end 1 does otherwise on its first hook"});
    CHECK(told(card({"X.XX.X.."}, profile, 3)).size() == 0);
    CHECK(ends_of(card({"X.XX.X.."}, profile, 3).card, 0) == "X.X");
    profile.hook_rule = HookRule::point;
    const ControllerCard mirrored = card({"XX.X.XX.", "XX.X.X.."}, profile, 4);
    CHECK(ends_of(mirrored.card, 0) == "XX.X");
    CHECK(told(mirrored) == Lines{"pick 2: hook 7 is down, but end 1 does otherwise on its first hook"});
    profile.hook_rule = HookRule::list;
    profile.body.clear();
    profile.hook_of_end = {7, 6, 0, 0};
    CHECK(ends_of(card({"X......."}, profile).card, 0) == "..XX");
    CHECK(told(card({".X......"}, profile)) == Lines{"pick 1: hook 2 is lifted, but is cast out"});
}

TEST_CASE("the lead-in is no part of the card, and nothing but what always lifts lifts there") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.body = {{3, 7}};
    profile.selvedge = {{0, 0}};
    profile.selvedge_weave = {"1", "0"};
    profile.constant_on = {{1, 1}};
    profile.lead_in_picks = 2;
    const ControllerCard read = card({"..X....X", ".X......", "XXX....X", ".X.XXXXX"}, profile);
    CHECK(read.card.picks() == 2);
    CHECK(ends_of(read.card, 0) == "....X");
    CHECK(ends_of(read.card, 1) == "XXXXX");
    CHECK(told(read) ==
          Lines{"pick 1: hook 8 is lifted, but in the lead-in nothing lifts that is not always lifted",
                "pick 1: hook 3 is lifted, but is cast out", "pick 3: hook 3 is lifted, but is cast out",
                "pick 1: hook 2 is down, but is to be lifted on every pick"});
    CHECK_THAT(refusal({"........", "........"}, profile),
               Catch::Contains("lead-in of the loom alone has 2"));
    const auto design = design_from_controller_file(raw_bytes(Shed(3, "XX.....X"), profile), profile);
    REQUIRE(design);
    CHECK_THAT(design->warnings.back(), Catch::Contains("the first 2 picks of the file"));
}

TEST_CASE("regulator hooks say which picks take up") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.body = {{0, 5}};
    profile.regulator_hooks = {7, 6};
    const ControllerCard read = card({"......XX", "X.......", "X......X"}, profile);
    CHECK(read.take_up == std::vector<bool>{false, true, false});
    CHECK(told(read) == Lines{"pick 3: hook 7 is down, but the first hook of the take-up does otherwise"});
    const Shed shed{"X.....XX", "X.......", "X.....XX", "X......."};
    const auto design = design_from_controller_file(raw_bytes(shed, profile), profile, 6);
    REQUIRE(design);
    CHECK(design->warnings.empty());
    CHECK(design->design.weft.take_up == std::vector<bool>{false, true});
}

TEST_CASE("feeders in hooks: none, one, two, and more than the loom inserts") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.body = {{0, 3}};
    profile.feeders = 3;
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {6, 5, 4};
    profile.feeders_per_pick = 2;
    const ControllerCard two = card({"XXXX..X.", "XXXX....", "XXXXX.X."}, profile);
    CHECK(two.feeders == std::vector<FeederSet>{{0}, {}, {0, 2}});
    CHECK(two.warnings.empty());
    profile.feeders_per_pick = 1;
    const ControllerCard crowded = card({"XXXX..X.", "XXXX....", "XXXXX.X."}, profile);
    CHECK(crowded.feeders == two.feeders);
    CHECK(crowded.warnings ==
          Lines{"byte 2: two feeders are taken on 1 pick, pick 3, but this loom inserts 1"});
    CHECK_THAT(refusal({"XXXX..X.", "XXXXXXX."}, profile),
               Catch::Contains("byte 1: pick 2 takes 3 feeders at once"));
    profile.feeder_encoding = FeederEncoding::binary_hooks;
    profile.feeder_hooks = {7, 4};  // digits, the lowest first
    CHECK(card({"XXXX....", "XXXX...X", "XXXXX...", "XXXXX..X"}, profile).feeders ==
          std::vector<FeederSet>{{}, {0}, {1}, {2}});
    profile.feeders = 2;
    CHECK_THAT(refusal({"XXXX....", "XXXXX..X"}, profile), Catch::Contains("byte 1: pick 2 takes feeder 3"));
    profile.feeder_encoding = FeederEncoding::one_hot;
    CHECK_THAT(refusal({"XXXX..X."}, profile), Catch::Contains("but no function bytes"));
}

TEST_CASE("feeders in function bits: one-hot, binary, bits that mean nothing to the profile") {
    LoomProfile profile = bare_loom(OutputFormat::ep, 8);
    const Shed shed(4, "XXXXXXXX");
    const auto read = [&](const Words& words) {
        return card_of(*read_controller_file(ep_bytes("", shed, words, profile), profile), profile);
    };
    profile.feeders = 5;
    profile.feeder_encoding = FeederEncoding::binary;
    profile.feeder_hooks = {31, 8, 9};
    CHECK(read({0, 0x80000000, 0x100, 0x80000200})->feeders == std::vector<FeederSet>{{}, {0}, {1}, {4}});
    CHECK(read({0, 0x80000000, 0x100, 0x80000200})->warnings.empty());
    const auto beyond = read({0, 0x300, 0, 0});
    REQUIRE_FALSE(beyond);
    CHECK(beyond.error().text() == "byte 39: pick 2 takes feeder 6, but the loom has 5 feeders");
    profile.feeder_encoding = FeederEncoding::one_hot;
    profile.feeder_hooks = {0, 1, 2, 3, 4};
    CHECK(read({1, 2, 1, 16})->feeders == std::vector<FeederSet>{{0}, {1}, {0}, {4}});
    CHECK(read({1, 0x80000042, 1, 32})->warnings == Lines{"byte 39: function bits that the profile does not "
                                                          "name are set on 2 picks, the first pick 2, there "
                                                          "bits 6, 31 counted from 0"});
    profile.lead_in_picks = 1;
    CHECK(read({0, 2, 1, 16})->warnings.empty());
    CHECK(read({1, 2, 1, 16})->warnings.size() == 1);
    profile.lead_in_picks = 0;
    profile.feeder_encoding = FeederEncoding::none;
    CHECK(read({0, 0, 0, 0})->warnings.empty());
    CHECK(read({0, 0, 0, 0})->feeders.empty());
    CHECK(read({0, 0, 1, 0})->warnings == Lines{"byte 44: function bits that the profile does not name are "
                                                "set on 1 pick, pick 3, there bits 0 counted "
                                                "from 0"});
}

TEST_CASE("ends: as many as the loom carries or as are said, and a hint where the last never lift") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    CHECK(card({"X.X....."}, profile).card.ends() == 8);
    CHECK(card({"X.X....."}, profile).warnings ==
          Lines{"ends 4 to 8 never lift; a design with fewer ends than the loom carries is read with their "
                "number given (weave import --ends N)"});
    CHECK(card({"XXXXXXX."}, profile).warnings[0].rfind("end 8 never", 0) == 0);
    CHECK(card({"X.X....."}, profile, 3).warnings.empty());
    CHECK_THAT(refusal({"X......."}, profile, 9), Catch::Contains("1 to 8 ends, not 9"));
    CHECK_THAT(refusal({"X......."}, profile, 0), Catch::Contains("not 0"));
}

TEST_CASE("a controller file becomes a design: title, notes, card, and the loom's feeders") {
    LoomProfile profile = bare_loom(OutputFormat::jc5, 16);
    profile.body = {{8, 15}};
    profile.feeders = 2;
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {0, 1};
    const Shed shed{"X.......X.X.X.X.", "X........X.X.X.X", ".X......X.X.X.X.", "X.......XXXXXXXX"};
    const auto read = design_from_controller_file(jc5_bytes("A NAME", "a comment", shed, profile), profile);
    REQUIRE(read);
    CHECK(read->warnings.empty());
    CHECK(read->design.title == "A NAME");
    CHECK(read->design.notes == "a comment");
    CHECK(read->design.weft.feeder_order == std::vector<FeederSet>{{0}, {0}, {1}, {0}});
    REQUIRE(read->design.weft.feeders.size() == 2);
    CHECK(read->design.weft.feeders[1].name == "shuttle 2");
    CHECK(read->design.weft.take_up.empty());
    const CardLeaf& leaf = std::get<CardLeaf>(read->design.blocks.at("card")->source);
    CHECK(ends_of(*leaf.card, 1) == ".X.X.X.X");
    profile.output = OutputFormat::tiff;
    CHECK_FALSE(design_from_controller_file("II*", profile));
}

TEST_CASE("a name or comment that is too long for a design is cut, and that is told") {
    const LoomProfile profile = bare_loom(OutputFormat::jc5, 8);
    const std::string comment = std::string(longest_notes - 1, 'c') + "äö";
    const auto read = design_from_controller_file(jc5_bytes("", comment, {"XXXXXXXX"}, profile), profile);
    REQUIRE(read);
    CHECK(read->design.notes == std::string(longest_notes - 1, 'c'));
    REQUIRE(read->warnings.size() == 1);
    CHECK_THAT(read->warnings[0], Catch::Contains("the comment is longer"));
}

TEST_CASE("controller files are known by content, else by extension; raw ones never") {
    const LoomProfile jc5 = bare_loom(OutputFormat::jc5, 8), ep = bare_loom(OutputFormat::ep, 8);
    const Shed shed{"X......."};
    CHECK(recognise_controller_file(jc5_bytes("", "", shed, jc5), ".dat") == OutputFormat::jc5);
    CHECK(recognise_controller_file(ep_bytes("", shed, {0}, ep), ".jc5") == OutputFormat::ep);
    CHECK(recognise_controller_file("nonsense", ".jc5") == OutputFormat::jc5);
    CHECK(recognise_controller_file("nonsense", ".ep") == OutputFormat::ep);
    CHECK_FALSE(recognise_controller_file("nonsense", ".raw"));
    CHECK_FALSE(recognise_controller_file("", ""));
}

TEST_CASE("a permutation that does not fit the hooks is refused, not followed") {
    LoomProfile profile = bare_loom(OutputFormat::raw, 8);
    profile.hook_permutation = {0, 1, 2, 3, 4, 5, 6, 8};
    check_refused("a", profile, "", "permutation");
    profile.hook_permutation = {0, 1, 2};
    check_refused("a", profile, "", "permutation");
}
