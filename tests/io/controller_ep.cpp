// EP files byte by byte, their sizes, and everything that can be wrong with one.

#include "controller_case.hpp"

#include <support/controller_bytes.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// 16 hooks: two selvedge, one always on, one cast out, twelve ends; three feeders, one function bit each.
LoomProfile small_loom() {
    LoomProfile profile = bare_loom(OutputFormat::ep, 16);
    profile.body = {{4, 15}};
    profile.constant_on = {{1, 1}};
    profile.selvedge = {{2, 3}};
    profile.selvedge_weave = {"01", "10"};
    profile.feeders = 3;
    profile.feeder_encoding = FeederEncoding::one_hot;
    profile.feeder_hooks = {0, 1, 2};
    return profile;
}

/// Three picks by hand.
std::string by_hand() {
    std::string bytes = bytes_of(
        "01 00"                                         // 0: one block of 4096 holds 32 + 3 · 6 bytes
        "00"                                            // 2
        "03 00"                                         // 3: picks
        "00"                                            // 5
        "53 41 54 49 4E 20 38 41"                       // 6: "SATIN 8A", all eight characters and no NUL
        "00"                                            // 14
        "04"                                            // 15: function bytes
        "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"  // 16 to 30
        "12"                                            // 31
        "10 00"                                         // 32: hooks
        "01 00 00 00 1A 80"                             // 34: feeder 1; hooks 1, 3, 4 and 15
        "02 00 00 00 26 00"                             // 40: feeder 2; hooks 1, 2 and 5
        "04 00 00 00 FA FF");                           // 46: feeder 3; hooks 1, 3 and all ends
    bytes.resize(2 + 4096, '\xff');
    bytes.resize(2 + 4096 + 1022, '\0');
    return bytes;
}

std::string with(std::size_t offset, const std::string& digits) {
    const std::string part = bytes_of(digits);
    return by_hand().replace(offset, part.size(), part);
}

}  // namespace

TEST_CASE("an EP file by hand says what its bytes say") {
    REQUIRE(by_hand().size() == 5120);
    const Result<ControllerFile> file = read_controller_file(by_hand(), small_loom());
    REQUIRE(file);
    CHECK(file->format == OutputFormat::ep);
    CHECK(file->name == "SATIN 8A");
    CHECK(file->comment.empty());
    CHECK(file->warnings.empty());
    REQUIRE(file->picks() == 3);
    CHECK(shed_of(*file, 0) == ".X.XX..........X");
    CHECK(shed_of(*file, 1) == ".XX..X..........");
    CHECK(shed_of(*file, 2) == ".X.XXXXXXXXXXXXX");
    CHECK(file->function_words == std::vector<std::uint64_t>{1, 2, 4});
    CHECK(file->offset_of(2) == 46);
    const Result<ControllerCard> card = card_of(*file, small_loom());
    REQUIRE(card);
    CHECK(card->difference_count == 0);
    CHECK(card->warnings.empty());
    CHECK(card->feeders == std::vector<FeederSet>{{0}, {1}, {2}});
    CHECK(card->card.ends() == 12);
    for (std::size_t end = 0; end < 12; ++end) {
        CHECK(card->card.weft_over(0, end) == (end != 0 && end != 11));
        CHECK(card->card.weft_over(1, end) == (end != 1));
        CHECK_FALSE(card->card.weft_over(2, end));
    }
}

TEST_CASE("a name shorter than its field ends at NUL or blanks") {
    CHECK(read_controller_file(with(6, "41 42 00 00 00 00 00 00"), small_loom())->name == "AB");
    const std::string filled = with(6, "41 20 42 20 20 20 20 20");
    CHECK(read_controller_file(filled, small_loom())->name == "A B     ");
    CHECK(design_from_controller_file(filled, small_loom())->design.title == "A B");
    CHECK(read_controller_file(with(6, "00 00 00 00 00 00 00 00"), small_loom())->name.empty());
    check_warned(with(6, "41 42 00 43 00 00 00 00"), small_loom(), "byte 9", "goes on with 43");
    check_warned(with(6, "41 07 42 00 00 00 00 00"), small_loom(), "byte 6", "'A\\x07B'");
}

TEST_CASE("every byte of the EP header counts") {
    const LoomProfile profile = small_loom();
    for (const std::size_t at :
         std::vector<std::size_t>{2, 5, 14, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30})
        check_warned(with(at, "07"), profile, "byte " + std::to_string(at), "is 07, where 00 was observed");
    check_warned(with(31, "13"), profile, "byte 31", "is 13, where 12 was observed");
    check_refused(with(0, "02 00"), profile, "byte 0", "says 2 blocks, but 3 picks of 6 bytes need 1");
    check_refused(with(0, "00 00"), profile, "byte 0", "says 0 blocks");
    check_refused(with(0, "01 FF"), profile, "byte 0", "says 65281 blocks");
    check_refused(with(3, "00 00"), profile, "byte 3", "no picks");
    check_refused(with(3, "FF FF"), profile, "byte 0", "65535 picks of 6 bytes need 97");
    check_refused(with(15, "02"), profile, "byte 15", "2 function bytes");
    check_refused(with(32, "00 00"), profile, "byte 32", "0 hooks");
    check_refused(with(32, "11 00"), profile, "byte 32", "17 hooks, but the loom of the profile has 16");
    check_refused(with(32, "18 00"), profile, "byte 32", "24 hooks, but the loom of the profile has 16");
    for (std::size_t offset = 0; offset < 34; ++offset) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string damaged = by_hand();
            damaged[offset] = static_cast<char>(damaged[offset] ^ flip);
            INFO(offset << " ^ " << flip);
            const Result<ControllerFile> read = read_controller_file(damaged, profile);
            if (!read || !read->warnings.empty() || read->name != "SATIN 8A") continue;
            // More picks than there are in as many blocks: padding is read as picks, whose function bits are
            // all set.
            CHECK((offset == 3 || offset == 4));
            const Result<ControllerCard> card = card_of(*read, profile);
            CHECK((!card || !card->warnings.empty()));
        }
    }
}

TEST_CASE("padding that is not FF, and a tail that is not 00, are told at their first byte") {
    const LoomProfile profile = small_loom();
    check_warned(with(52, "00"), profile, "byte 52", "is 00 in a padding of ff; 1 byte of it is");
    check_warned(with(4097, "7F"), profile, "byte 4097", "is 7f in a padding of ff");
    check_warned(with(4098, "FF 01"), profile, "byte 4098", "is ff in a padding of 00; 2 bytes of it are");
    check_warned(with(5119, "01"), profile, "byte 5119", "is 01 in a padding of 00");
}

TEST_CASE("an EP file that is cut anywhere, or goes on, is refused") {
    const std::string bytes = by_hand();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const Result<ControllerFile> read = read_controller_file(bytes.substr(0, length), small_loom());
        INFO(length);
        REQUIRE_FALSE(read);
        REQUIRE(read.error().where == "byte " + std::to_string(length));
    }
    check_refused(bytes + '\0', small_loom(), "byte 5120",
                  "1 block make a file of 5120 bytes, but it has 5121");
}

TEST_CASE("blocks and sizes of EP files follow from picks and hooks, and nothing else is taken") {
    const LoomProfile profile = shipped("ep-2688");
    const Shed pick{std::string(2688, '.')};
    // 340 bytes a pick: 12 picks fill 4112 of the 4096 bytes of a block less its header, 11 are the last that
    // fit.
    for (const auto& [picks, blocks] : std::vector<std::pair<std::size_t, std::size_t>>{{1, 1},
                                                                                        {11, 1},
                                                                                        {12, 2},
                                                                                        {24, 2},
                                                                                        {25, 3},
                                                                                        {36, 3},
                                                                                        {37, 4},
                                                                                        {48, 4},
                                                                                        {60, 5},
                                                                                        {602, 50},
                                                                                        {603, 51}}) {
        INFO(picks);
        const Shed shed(picks, pick[0]);
        std::string bytes = ep_bytes("SIZE", shed, Words(picks, 1), profile);
        REQUIRE(bytes.size() == 1024 + 4096 * blocks);
        const Result<ControllerFile> file = read_controller_file(bytes, profile);
        REQUIRE(file);
        CHECK(file->picks() == picks);
        CHECK(file->warnings.empty());
        CHECK(recognise_controller_file(bytes, "") == OutputFormat::ep);
        // A block more or less, in the header or in the file, contradicts the picks.
        CHECK_FALSE(read_controller_file(bytes + std::string(4096, '\0'), profile));
        CHECK_FALSE(read_controller_file(bytes.substr(0, bytes.size() - 4096), profile));
        for (const int step : {-1, 1}) {
            std::string other = bytes;
            other.replace(0, 2, little_bytes(blocks + static_cast<std::size_t>(step), 2));
            other.resize(bytes.size() + static_cast<std::size_t>(4096 * step));
            const Result<ControllerFile> read = read_controller_file(other, profile);
            REQUIRE_FALSE(read);
            CHECK(read.error().where == "byte 0");
        }
    }
}

TEST_CASE("32 header bytes and records that fill a block exactly leave no padding") {
    const LoomProfile profile =
        bare_loom(OutputFormat::ep, 32);  // 8 bytes a pick: 508 picks and 32 make 4096
    for (const auto& [picks, blocks] :
         std::vector<std::pair<std::size_t, std::size_t>>{{507, 1}, {508, 1}, {509, 2}}) {
        const Shed shed(picks, std::string(32, 'X'));
        const std::string bytes = ep_bytes("", shed, Words(picks, 0), profile);
        CHECK(bytes.size() == 1024 + 4096 * blocks);
        REQUIRE(read_controller_file(bytes, profile));
        CHECK(read_controller_file(bytes, profile)->warnings.empty());
    }
}

TEST_CASE("EP 2688: six feeders one-hot, the first twice in seven picks, on the hooks that real files use") {
    const LoomProfile profile = shipped("ep-2688");
    const Words cycle{1, 2, 1, 4, 8, 16, 32};
    Shed shed(14, std::string(2688, '.'));
    Words words;
    for (std::size_t pick = 0; pick < 14; ++pick) {
        words.push_back(cycle[pick % 7]);
        shed[pick][54] = shed[pick][55] = 'X';               // constant on
        for (std::size_t place = 0; place < 168; ++place) {  // 84 hooks a side
            const std::size_t hook = place < 84 ? 56 + place : 2548 + place - 84;
            if ((place + pick) % 2 == 1) shed[pick][hook] = 'X';
        }
        shed[pick][144 + pick] = shed[pick][2543 - pick] = 'X';  // ends 1, 2, … and the last, last but one, …
    }
    const std::string bytes = ep_bytes("SIXFEEDERS", shed, words, profile);
    CHECK(bytes.substr(34 + 340, 4) == bytes_of("02 00 00 00"));
    const Result<DesignFromController> read = design_from_controller_file(bytes, profile);
    REQUIRE(read);
    CHECK(read->warnings.empty());
    CHECK(read->design.title == "SIXFEEDE");  // cut at 8
    CHECK(read->design.weft.feeders.size() == 6);
    CHECK(read->design.weft.feeder_order == std::vector<FeederSet>{{0}, {1}, {0}, {2}, {3}, {4}, {5}});
    const CardImage& card = *std::get<CardLeaf>(read->design.blocks.at(read->design.root)->source).card;
    CHECK(card.picks() == 14);
    REQUIRE(card.ends() == 2400);
    for (std::size_t pick = 0; pick < 14; ++pick)
        for (std::size_t end = 0; end < 2400; ++end)
            REQUIRE(card.weft_over(pick, end) == (end != pick && end != 2399 - pick));
}

TEST_CASE("polarity and bit order are of the hooks: function bits stay as they are") {
    LoomProfile profile = small_loom();
    profile.lifted_is_one = false;
    profile.least_bit_first = false;
    profile.pick_1_at_bottom = false;
    const ControllerFile file = *read_controller_file(by_hand(), profile);
    CHECK(shed_of(file, 2) == "XXX..X.X.XXXXXXX");
    CHECK(file.function_words == std::vector<std::uint64_t>{4, 2, 1});
    CHECK(file.offset_of(0) == 46);
}
