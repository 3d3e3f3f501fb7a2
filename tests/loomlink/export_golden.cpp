// Bytes of controller files, typed by hand from what was observed.

#include "export_case.hpp"

#include <weave/loom/profile.hpp>

#include <loomlink/export/controller_files.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::testing;

namespace {

std::string shipped(const std::string& name) {
    return std::string(WEAVE_SOURCE_DIR) + "/db/looms/" + name + ".json";
}

LoomProfile small_ep() {
    LoomProfile profile = plain_loom(OutputFormat::ep, 16);
    profile.body = {{4, 11}};
    profile.constant_on = {{2, 3}};
    profile.selvedge = {{0, 1}, {12, 13}};
    profile.selvedge_weave = {"01", "10"};
    profile.feeders = 6;
    profile.feeder_encoding = FeederEncoding::one_hot;
    profile.feeder_hooks = {0, 1, 2, 3, 4, 5};
    return profile;
}

LoomProfile small_jc5() {
    LoomProfile profile = plain_loom(OutputFormat::jc5, 56);
    profile.areas = {{"fn", 32}, {"ground", 8}, {"body", 16}};
    profile.body = {{40, 55}};
    profile.selvedge = {{32, 35}};
    profile.selvedge_weave = {"0011", "1100"};
    profile.feeders = 2;
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {0, 1};
    return profile;
}

/// A pick of a raw file on which these of twelve ends are lifted.
std::string raw_pick(const LoomProfile& profile, const std::string& pick) {
    const Design design = design_of(card_of({pick}), {0});
    const auto plan = plan_of(design, profile, {});
    REQUIRE(plan);
    const auto file = write_raw(*plan, profile);
    REQUIRE(file);
    return file->bytes;
}

}  // namespace

TEST_CASE("EP: a small design, byte by byte") {
    const LoomProfile profile = small_ep();
    const Design design = design_of(card_of({"X.X.X.X.", ".X.X.X.X", "XX..XX.."}), {1, 6, 1});
    const auto plan = plan_of(design, profile, straight_map(6));
    REQUIRE(plan);
    const auto file = write_ep(*plan, profile, {"TOWEL", ""});
    REQUIRE(file);
    CHECK(file->bytes == bytes_of("01 00 00 03 00 00 'TOWEL' 00*3 00 04 00*15 12 10 00 "
                                  "01 00 00 00 5E 25 "
                                  "20 00 00 00 AD 1A "
                                  "01 00 00 00 3E 23 "
                                  "FF*4046 00*1022"));
    CHECK(file->names.name == "TOWEL");
    CHECK_FALSE(file->name_cut);
    CHECK(file->unknown_fields.size() == 3);
}

TEST_CASE("JC5: a small design of three areas, byte by byte, its name cut at eight") {
    const LoomProfile profile = small_jc5();
    const Design design = design_of(card_of({"XXXXXXXX........", ".X.X.X.X.X.X.X.X"}), {1, 2});
    const auto plan = plan_of(design, profile, straight_map(2));
    REQUIRE(plan);
    const auto file = write_jc5(*plan, profile, {"LINENSHOE", "hi"});
    REQUIRE(file);
    CHECK(file->bytes == bytes_of("81 FE 01 01 00 00 00 04 "
                                  "00 00 00 01 00 00 00 09 'LINENSHO' 00 "
                                  "00 00 00 02 00 00 00 04 00 00 00 02 "
                                  "00 00 00 06 00 00 00 04 00 00 00 00 "
                                  "00 00 00 08 00 00 00 03 'hi' 00 "
                                  "00 00 00 03 "
                                  "00 00 00 64 00 00 00 0B 00 00 00 01 00 00 00 20 'fn' 00 "
                                  "00 00 00 64 00 00 00 0F 00 00 00 01 00 00 00 08 'ground' 00 "
                                  "00 00 00 64 00 00 00 0D 00 00 00 01 00 00 00 10 'body' 00 "
                                  "01 00 00 00 0C FF 00 "
                                  "02 00 00 00 03 AA AA"));
    CHECK(file->names.name == "LINENSHO");
    CHECK(file->name_cut);
    CHECK(file->unknown_fields.size() == 2);
}

TEST_CASE("raw: areas that are no multiple of eight, bit order, polarity and permutation") {
    LoomProfile profile = plain_loom(OutputFormat::raw, 12);
    profile.areas = {{"a", 3}, {"b", 9}};
    const std::string pick = "X.XX.......X";
    CHECK(raw_pick(profile, pick) == bytes_of("05 01 01"));
    profile.areas_on_bytes = false;
    CHECK(raw_pick(profile, pick) == bytes_of("0D 08"));
    profile.areas_on_bytes = true;
    profile.lifted_is_one = false;
    CHECK(raw_pick(profile, pick) == bytes_of("FA FE FE"));
    profile.lifted_is_one = true;
    profile.least_bit_first = false;
    CHECK(raw_pick(profile, pick) == bytes_of("A0 80 80"));
    profile.least_bit_first = true;
    profile.hook_permutation = {11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
    CHECK(raw_pick(profile, pick) == bytes_of("01 60 01"));
    profile.hook_permutation.clear();
    profile.end_1_at_left = false;
    CHECK(raw_pick(profile, "XX..........") == bytes_of("00 80 01"));
}

TEST_CASE("raw: function bytes, lead-in picks, and records from the last pick on") {
    LoomProfile profile = plain_loom(OutputFormat::raw, 8);
    profile.body = {{0, 5}};
    profile.constant_on = {{7, 7}};
    profile.feeders = 3;
    profile.feeder_encoding = FeederEncoding::binary;
    profile.feeder_hooks = {4, 9};
    profile.function_bytes = 2;
    profile.lead_in_picks = 1;
    const Design design = design_of(card_of({"X.....", ".X....", "..X..."}), {1, 2, 3});
    const auto plan = plan_of(design, profile, straight_map(3));
    REQUIRE(plan);
    CHECK(write_raw(*plan, profile)->bytes == bytes_of("00 00 80  10 00 81  00 02 82  10 02 84"));
    profile.pick_1_at_bottom = false;
    profile.lifted_is_one = false;  // of hooks; function bits stay
    CHECK(write_raw(*plan, profile)->bytes == bytes_of("10 02 7B  00 02 7D  10 00 7E  00 00 7F"));
}

TEST_CASE("EP: castouts of 2688 and 5376 hooks as observed, counted from 0") {
    struct Loom {
        std::string name;
        std::vector<HookRange> lifted, never;
    };
    const std::vector<Loom> looms{
        {"ep-2688", {{54, 55}, {144, 2543}}, {{0, 53}, {140, 143}, {2544, 2547}, {2632, 2687}}},
        {"ep-5376", {{222, 223}, {316, 5115}}, {{0, 221}, {308, 315}, {5116, 5123}, {5208, 5375}}}};
    for (const Loom& loom : looms) {
        INFO(loom.name);
        const LoomProfile profile = load_profile(shipped(loom.name)).value();
        const Design design = design_of(card_of({std::string(most_ends(profile), 'X')}));
        const auto plan = plan_of(design, profile, straight_map(6));
        REQUIRE(plan);
        const std::string bytes = write_ep(*plan, profile, {"X", ""})->bytes;
        const auto bit = [&](std::size_t hook) {
            return static_cast<unsigned char>(bytes[38 + hook / 8]) / (1 << hook % 8) % 2;
        };
        std::size_t counted = 0;
        for (const HookRange& range : loom.lifted)
            for (std::size_t hook = range.first; hook <= range.last; ++hook, ++counted)
                REQUIRE(bit(hook) == 1);
        for (const HookRange& range : loom.never)
            for (std::size_t hook = range.first; hook <= range.last; ++hook, ++counted)
                REQUIRE(bit(hook) == 0);
        CHECK(counted + 168 == profile.total_hooks);  // the rest is selvedge, 84 on each side
    }
}

TEST_CASE("EP: six feeders one-hot, the first twice in every seven picks") {
    const LoomProfile profile = load_profile(shipped("ep-2688")).value();
    const std::vector<std::string> picks(14, "X.");
    const Design design = design_of(card_of(picks), {1, 2, 3, 4, 5, 6, 1});
    const auto plan = plan_of(design, profile, straight_map(6));
    REQUIRE(plan);
    const std::string bytes = write_ep(*plan, profile, {"six", ""})->bytes;
    std::string words;
    for (std::size_t k = 0; k < 14; ++k) words += bytes.substr(34 + 340 * k, 4);
    const std::string seven = bytes_of("01 00*3 02 00*3 04 00*3 08 00*3 10 00*3 20 00*3 01 00*3");
    CHECK(words == seven + seven);
}

TEST_CASE("raw: the example of 14 planes of 192 selects feeders at the start of the first six planes") {
    const LoomProfile profile = load_profile(shipped("raw-14x192")).value();
    REQUIRE(profile.hook_permutation.size() == 2688);
    for (std::size_t plane = 0; plane < 14; ++plane)
        for (std::size_t k = 0; k < 192; ++k)
            REQUIRE(profile.hook_permutation[14 * k + plane] == 192 * plane + k);
    const Design design = design_of(card_of(std::vector<std::string>(6, "X")), {1, 2, 3, 4, 5, 6});
    const auto plan = plan_of(design, profile, straight_map(6));
    REQUIRE(plan);
    const std::string bytes = write_raw(*plan, profile)->bytes;
    REQUIRE(bytes.size() == 6 * 336);
    for (std::size_t pick = 0; pick < 6; ++pick)
        for (std::size_t feeder = 0; feeder < 6; ++feeder)  // 0 selects
            CHECK(static_cast<unsigned char>(bytes[336 * pick + 24 * feeder]) % 2 ==
                  (pick == feeder ? 0 : 1));
}

TEST_CASE("EP: sizes over many counts of picks, and the most it can count") {
    const LoomProfile profile = small_ep();
    const auto file_of = [&](std::size_t picks) {
        const Design design = design_of(CardImage(picks, 1));
        return write_ep(plan_of(design, profile, straight_map(6)).value(), profile, {"n", ""});
    };
    // Records of 6 bytes: 677 of them and the header are 4094, within the first block; 678 need a second.
    for (const auto& [picks, size] : std::vector<std::pair<std::size_t, std::size_t>>{
             {1, 5120}, {677, 5120}, {678, 9216}, {1360, 9216}, {1361, 13312}, {65535, 1024 + 4096 * 97}}) {
        INFO(picks);
        const auto file = file_of(picks);
        REQUIRE(file);
        CHECK(file->bytes.size() == size);
        CHECK(static_cast<unsigned char>(file->bytes[3]) + 256 * static_cast<unsigned char>(file->bytes[4]) ==
              static_cast<int>(picks));
    }
    for (std::size_t picks = 1; picks < 1500; ++picks) {
        std::size_t size = 1024, data = 32 + 6 * picks;
        for (; data > 4096; data -= 4096) size += 4096;
        REQUIRE(file_of(picks)->bytes.size() == size + 4096);
    }
    expect_refusal(file_of(65536), "at most 65535 picks");
}

TEST_CASE("names: what a file cannot hold is refused, what is too long is cut, what is short is filled") {
    const LoomProfile ep = small_ep();
    const Design design = design_of(card_of({"X.X.X.X."}));
    const HookPlan plan = plan_of(design, ep, straight_map(6)).value();
    CHECK(write_ep(plan, ep, {"abcdefghij", ""})->bytes.substr(6, 10) == bytes_of("'abcdefgh' 00 04"));
    CHECK(write_ep(plan, ep, {"abcdefghij", ""})->name_cut);
    CHECK_FALSE(write_ep(plan, ep, {"abcdefgh", ""})->name_cut);
    CHECK(write_ep(plan, ep, {"a", ""})->bytes.substr(6, 9) == bytes_of("'a' 00*8"));
    expect_refusal(write_ep(plan, ep, {"", ""}), "needs a name");
    expect_refusal(write_ep(plan, ep, {"K\xC3\xA4se", ""}), "ASCII");
    expect_refusal(write_ep(plan, ep, {"a\nb", ""}), "ASCII");
    LoomProfile shorter = ep;
    shorter.name_limit = 3;
    CHECK(write_ep(plan, shorter, {"abcdef", ""})->names.name == "abc");
    shorter.name_limit = 0;
    CHECK(write_ep(plan, shorter, {"abcdefghij", ""})->names.name == "abcdefgh");
}

TEST_CASE("JC5: what its layout cannot hold is refused") {
    LoomProfile profile = small_jc5();
    const Design design = design_of(card_of({"XXXXXXXX........"}));
    const HookPlan plan = plan_of(design, profile, straight_map(2)).value();
    expect_refusal(write_jc5(plan, profile, {"n", std::string(256, 'c')}), "at most 255");
    REQUIRE(write_jc5(plan, profile, {"n", std::string(255, 'c')}));
    expect_refusal(write_jc5(plan, profile, {"n", "caf\xC3\xA9"}), "ASCII");
    profile.areas[1].name = "gr\xC3\xBCn";
    expect_refusal(write_jc5(plan, profile, {"n", ""}), "area");
    profile = small_jc5();
    profile.function_bytes = 4;
    expect_refusal(write_jc5(plan, profile, {"n", ""}), "function bytes");
    profile = small_jc5();
    profile.feeder_encoding = FeederEncoding::one_hot;
    expect_refusal(write_jc5(plan, profile, {"n", ""}), "function bits");
    expect_refusal(write_controller_file(plan, plain_loom(OutputFormat::tiff, 56), {"n", ""}), "picture");
}
