// JC5 files byte by byte, and everything that can be wrong with one.

#include "controller_case.hpp"

#include <support/controller_bytes.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// Three areas of 8, 8 and 16 hooks; the feeders stand in the first.
LoomProfile small_loom() {
    LoomProfile profile = bare_loom(OutputFormat::jc5, 32);
    profile.areas = {{"fn", 8}, {"sel", 8}, {"body", 16}};
    profile.body = {{16, 31}};
    profile.selvedge = {{8, 15}};
    profile.selvedge_weave = {"01", "10"};
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {0};
    return profile;
}

/// A file by hand in pieces, so that a test can spoil one.
struct Pieces {
    std::string magic = bytes_of("81 FE 01 01");
    std::string attributes = bytes_of("00 00 00 04");                                     // their count
    std::string name = bytes_of("00 00 00 01  00 00 00 09  54 57 49 4C 4C 20 31 00 00");  // "TWILL 1", NULs
    std::string picks = bytes_of("00 00 00 02  00 00 00 04  00 00 00 02");                // two picks
    std::string zero = bytes_of("00 00 00 06  00 00 00 04  00 00 00 00");
    std::string comment = bytes_of("00 00 00 08  00 00 00 03  68 69 00");  // "hi"
    std::string areas = bytes_of("00 00 00 03");                           // their count
    std::string area_1 = bytes_of("00 00 00 64  00 00 00 0B  00 00 00 01  00 00 00 08  66 6E 00");  // "fn"
    std::string area_2 =
        bytes_of("00 00 00 64  00 00 00 0C  00 00 00 01  00 00 00 08  73 65 6C 00");  // "sel"
    std::string area_3 =
        bytes_of("00 00 00 64  00 00 00 0D  00 00 00 01  00 00 00 10  62 6F 64 79 00");  // "body"
    std::string data = bytes_of(
        "01 AA 01 80"    // pick 1: feeder 1; selvedge every other; ends 1 and 16 lifted
        "01 55 FE 7F");  // pick 2: the other way round

    [[nodiscard]] std::string all() const {
        return magic + attributes + name + picks + zero + comment + areas + area_1 + area_2 + area_3 + data;
    }
};
constexpr std::size_t attributes_at = 4, name_at = 8, picks_at = 25, zero_at = 37, comment_at = 49,
                      areas_at = 60, area_1_at = 64, area_2_at = 83, area_3_at = 103, data_at = 124;

std::string at(std::size_t offset) {
    return "byte " + std::to_string(offset);
}

}  // namespace

TEST_CASE("a JC5 file by hand says what its bytes say") {
    const Result<ControllerFile> file = read_controller_file(Pieces{}.all(), small_loom());
    REQUIRE(file);
    CHECK(file->format == OutputFormat::jc5);
    CHECK(file->name == "TWILL 1");
    CHECK(file->comment == "hi");
    CHECK(file->warnings.empty());
    CHECK(file->function_words.empty());
    REQUIRE(file->areas.size() == 3);
    CHECK(file->areas[2].name == "body");
    CHECK(file->areas[2].hooks == 16);
    REQUIRE(file->picks() == 2);
    CHECK(shed_of(*file, 0) ==
          "X......."
          ".X.X.X.X"
          "X..............X");
    CHECK(shed_of(*file, 1) ==
          "X......."
          "X.X.X.X."
          ".XXXXXXXXXXXXXX.");
    CHECK(file->records_at == data_at);
    CHECK(file->record_bytes == 4);
    CHECK(file->offset_of(1) == data_at + 4);

    const Result<ControllerCard> card = card_of(*file, small_loom());
    REQUIRE(card);
    CHECK(card->difference_count == 0);
    CHECK(card->warnings.empty());
    CHECK(card->take_up.empty());
    CHECK(card->feeders == std::vector<FeederSet>{{0}, {0}});
    CHECK(card->card.picks() == 2);
    CHECK(card->card.ends() == 16);
    for (std::size_t end = 0; end < 16; ++end) {
        const bool outer = end == 0 || end == 15;
        CHECK(card->card.weft_over(0, end) == !outer);
        CHECK(card->card.weft_over(1, end) == outer);
    }
}

TEST_CASE("polarity, bit order, pick 1 and permutation of a JC5 file are the profile's") {
    LoomProfile profile = small_loom();
    profile.lifted_is_one = false;
    CHECK(shed_of(*read_controller_file(Pieces{}.all(), profile), 0) ==
          ".XXXXXXX"
          "X.X.X.X."
          ".XXXXXXXXXXXXXX.");
    profile = small_loom();
    profile.least_bit_first = false;
    CHECK(shed_of(*read_controller_file(Pieces{}.all(), profile), 0) ==
          ".......X"
          "X.X.X.X."
          ".......XX.......");
    profile = small_loom();
    profile.pick_1_at_bottom = false;
    const ControllerFile turned = *read_controller_file(Pieces{}.all(), profile);
    CHECK(shed_of(turned, 1) ==
          "X......."
          ".X.X.X.X"
          "X..............X");
    CHECK(turned.offset_of(0) == data_at + 4);
    profile = small_loom();
    for (std::size_t hook = 0; hook < 32; ++hook) profile.hook_permutation.push_back(31 - hook);
    CHECK(shed_of(*read_controller_file(Pieces{}.all(), profile), 0) ==
          "X..............X"
          "X.X.X.X."
          ".......X");
}

TEST_CASE("the areas of a real JC5 loom make 640 bytes a pick") {
    const LoomProfile profile = shipped("jc5-5120");
    Shed shed(3, std::string(5120, '.'));
    for (std::size_t pick = 0; pick < 3; ++pick) {
        shed[pick][0] = 'X';  // 01 00 00 00 as observed
        for (std::size_t place = 0; place < 288; ++place)
            shed[pick][32 + place] = (place + pick) % 2 == 1 ? 'X' : '.';
        shed[pick][320 + 100 * pick] = 'X';
    }
    const std::string bytes = jc5_bytes("SATIN", "", shed, profile);
    const std::size_t header = 4 + 4 + 17 + 12 + 12 + 9 + 4 + (16 + 9) + (16 + 16) + (16 + 5);
    REQUIRE(bytes.size() == header + 3 * 640);
    CHECK(bytes.substr(header, 4) == bytes_of("01 00 00 00"));
    const ControllerFile file = *read_controller_file(bytes, profile);
    CHECK(file.record_bytes == 640);
    CHECK(file.warnings.empty());
    const ControllerCard card = *card_of(file, profile, 4800);
    CHECK(card.difference_count == 0);
    CHECK(card.card.ends() == 4800);
    for (std::size_t pick = 0; pick < 3; ++pick)
        for (std::size_t end = 0; end < 4800; ++end)
            REQUIRE(card.card.weft_over(pick, end) == (end != 100 * pick));
}

TEST_CASE("areas of hooks that fill no whole bytes are laid out as the profile says") {
    LoomProfile profile = small_loom();
    profile.areas = {{"fn", 3}, {"sel", 9}, {"body", 20}};
    for (const bool on_bytes : {true, false}) {
        profile.areas_on_bytes = on_bytes;
        const Shed shed{"X.XX.......XXXXXXXXXXXX........X", ".X.X.......X...................X"};
        const std::string bytes = jc5_bytes("N", "", shed, profile);
        const Result<ControllerFile> file = read_controller_file(bytes, profile);
        REQUIRE(file);
        CHECK(file->warnings.empty());
        CHECK(file->record_bytes == (on_bytes ? 6 : 4));
        for (std::size_t pick = 0; pick < 2; ++pick) CHECK(shed_of(*file, pick) == shed[pick]);
    }
    profile.function_bytes = 1;
    check_refused(Pieces{}.all(), profile, "", "1 function byte a pick, but such a file at most 0");
}

TEST_CASE("a JC5 file that is cut anywhere, or goes on, is refused") {
    const std::string bytes = Pieces{}.all();
    const LoomProfile profile = small_loom();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        INFO(length);
        const Result<ControllerFile> read = read_controller_file(bytes.substr(0, length), profile);
        REQUIRE_FALSE(read);
        CHECK(read.error().where.rfind("byte ", 0) == 0);
        CHECK_FALSE(read.error().message.empty());
    }
    check_refused(bytes.substr(0, data_at + 5), profile, at(data_at + 5), "ends within pick record 2");
    check_refused(bytes + "x", profile, at(data_at + 8),
                  "2 picks of 4 bytes need 8 bytes, but the file has 9");
}

TEST_CASE("each part of a JC5 file that cannot be understood is refused at its byte") {
    const LoomProfile profile = small_loom();
    Pieces p;
    p.magic = bytes_of("81 FE 01 02");
    check_refused(p.all(), profile, at(0), "81 fe 01 02 instead of 81 fe 01 01");
    p = {};
    p.attributes = bytes_of("FF FF FF FF");
    check_refused(p.all(), profile, at(attributes_at), "4294967295 attributes");
    p = {};
    p.name = bytes_of("00 00 00 01  FF FF FF FF  54");
    check_refused(p.all(), profile, at(name_at + 8), "should have 4294967295 bytes");
    p = {};
    p.picks = bytes_of("00 00 00 02  00 00 00 02  00 02");
    check_refused(p.all(), profile, at(picks_at + 8), "2 bytes instead of 4");
    p.picks = bytes_of("00 00 00 02  00 00 00 04  00 00 00 00");
    check_refused(p.all(), profile, at(picks_at + 8), "no picks");
    p.picks = bytes_of("00 00 00 02  00 00 00 04  FF FF FF FF");
    check_refused(p.all(), profile, at(data_at + 8), "need 17179869180 bytes");
    p.picks = p.zero;
    check_refused(p.all(), profile, at(zero_at), "attribute 6 comes twice");
    p.picks = bytes_of("00 00 00 07  00 00 00 04  00 00 00 02");
    check_refused(p.all(), profile, at(areas_at), "number of picks, is missing");
    p = {};
    p.areas = bytes_of("FF FF FF FF");
    check_refused(p.all(), profile, at(areas_at), "4294967295 areas of hooks, but the profile of the loom 3");
    p = {};
    p.area_1 = bytes_of("00 00 00 65  00 00 00 0B  00 00 00 01  00 00 00 08  66 6E 00");
    check_refused(p.all(), profile, at(area_1_at), "tag 101 instead of 100");
    p.area_1 = bytes_of("00 00 00 64  00 00 00 07  00 00 00 01  00 00 00");
    check_refused(p.all(), profile, at(area_1_at + 8), "too few");
    p.area_1 = bytes_of("00 00 00 64  00 00 00 0B  00 00 00 01  00 00 00 0C  66 6E 00");
    check_refused(p.all(), profile, at(area_1_at + 12), "12 hooks, but in the profile of the loom 8");
    p.area_1 = bytes_of("00 00 00 64  00 00 00 0B  00 00 00 01  00 00 00 00  66 6E 00");
    check_refused(p.all(), profile, at(area_1_at + 12), "0 hooks");
    p.area_1 = bytes_of("00 00 00 64  00 00 00 0B  00 00 00 01  FF FF FF F8  66 6E 00");
    check_refused(p.all(), profile, at(area_1_at + 12), "4294967288 hooks");
    p.area_1 = bytes_of("00 00 00 64  00 00 00 0B  00 00 00 01  00 00 00 10  66 6E 00");
    check_refused(p.all(), profile, at(area_1_at + 12), "16 hooks, but in the profile of the loom 8");
}

TEST_CASE("what is not as observed in a JC5 file is told with its byte, and read") {
    const LoomProfile profile = small_loom();
    Pieces p;
    p.zero = bytes_of("00 00 00 06  00 00 00 04  00 00 07 00");
    check_warned(p.all(), profile, at(zero_at + 8), "00 00 07 00, where 00 00 00 00");
    p.zero = bytes_of("00 00 00 07  00 00 00 04  00 00 00 00");
    REQUIRE(read_controller_file(p.all(), profile));
    CHECK(read_controller_file(p.all(), profile)->warnings ==
          std::vector<std::string>{"byte 37: attribute 7 is not known: 4 bytes, 00 00 00 00",
                                   "byte 60: attribute 6 is missing, which was observed in all files"});
    p = {};
    p.attributes = bytes_of("00 00 00 05");
    p.zero += bytes_of("00 00 00 07  00 00 00 00");
    REQUIRE(read_controller_file(p.all(), profile));
    CHECK(read_controller_file(p.all(), profile)->warnings.size() == 2);
    p = {};
    std::swap(p.name, p.picks);
    check_warned(p.all(), profile, at(20), "attribute 1 comes after attribute 2");
    p = {};
    p.name = bytes_of("00 00 00 01  00 00 00 09  41 42 43 44 45 46 47 48 49");  // nine letters, no NUL
    check_warned(p.all(), profile, at(name_at + 8), "does not end with NUL");
    p.name = bytes_of("00 00 00 01  00 00 00 03  41 42 00");
    check_warned(p.all(), profile, at(name_at + 8), "3 bytes, where 9");
    p.name = bytes_of("00 00 00 01  00 00 00 09  41 42 00 43 00 00 00 00 00");
    check_warned(p.all(), profile, at(name_at + 11), "goes on with 43 00");
    p.name = bytes_of("00 00 00 01  00 00 00 09  1B 5B 32 4A 00 00 00 00 00");  // clears a terminal
    check_warned(p.all(), profile, at(name_at + 8), "'\\x1b[2J'");
    CHECK(read_controller_file(p.all(), profile)->name == "\\x1b[2J");
    p = {};
    p.comment = bytes_of("00 00 00 08  00 00 00 02  68 69");
    check_warned(p.all(), profile, at(comment_at + 8), "comment does not end with NUL");
    p.comment = bytes_of("00 00 00 08  00 00 00 04  68 69 00 00");
    check_warned(p.all(), profile, at(comment_at + 8), "more than one NUL");
    p.comment = bytes_of("00 00 00 08  00 00 00 02  E4 00");
    check_warned(p.all(), profile, at(comment_at + 8), "'\\xe4'");
    p = {};
    p.area_2 = bytes_of("00 00 00 64  00 00 00 0C  00 00 00 02  00 00 00 08  73 65 6C 00");
    check_warned(p.all(), profile, at(area_2_at + 8), "00 00 00 02, where 00 00 00 01");
    p.area_2 = bytes_of("00 00 00 64  00 00 00 0C  00 00 00 01  00 00 00 08  53 65 6C 00");
    check_warned(p.all(), profile, at(area_2_at + 16), "'Sel', in the profile of the loom 'sel'");
    p = {};
    p.area_3 = bytes_of("00 00 00 64  00 00 00 0C  00 00 00 01  00 00 00 10  62 6F 64 79");
    check_warned(p.all(), profile, at(area_3_at + 16), "does not end with NUL");
}

TEST_CASE(
    "every byte of the head of a JC5 file counts: another one is refused, told, or changes name or comment") {
    const std::string bytes = Pieces{}.all();
    const LoomProfile profile = small_loom();
    for (std::size_t offset = 0; offset < data_at; ++offset) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string damaged = bytes;
            damaged[offset] = static_cast<char>(damaged[offset] ^ flip);
            const Result<ControllerFile> read = read_controller_file(damaged, profile);
            INFO(offset << " ^ " << flip);
            CHECK((!read || !read->warnings.empty() || read->name != "TWILL 1" || read->comment != "hi"));
        }
    }
}
