#include <weave/core/file.hpp>
#include <weave/io/wif.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>

using namespace weave;

namespace {

const std::string head =
    "[WIF]\nVersion=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\nSource Program=Hand\n";

/// Line 1 to 5 the head, 6 to 11 [CONTENTS], 12 to 15 [WEAVING], 16 [WARP], 18 [WEFT], 20 [THREADING], 24
/// [LIFTPLAN].
const std::string plain_cloth =
    head +
    "[CONTENTS]\nWEAVING=true\nWARP=true\nWEFT=true\nTHREADING=true\nLIFTPLAN=true\n"
    "[WEAVING]\nShafts=3\nTreadles=3\nRising Shed=true\n[WARP]\nThreads=3\n[WEFT]\nThreads=2\n"
    "[THREADING]\n1=1\n2=2\n3=3\n[LIFTPLAN]\n1=1\n2=2,3\n";

std::string with(const std::string& from, const std::string& to, std::string text = plain_cloth) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// The cloth with further sections, which [CONTENTS] lists.
std::string and_also(const std::string& sections, std::string text = plain_cloth) {
    for (std::size_t at = 0; (at = sections.find('[', at)) != std::string::npos; ++at) {
        const std::string name = sections.substr(at + 1, sections.find(']', at) - at - 1);
        text = with("[CONTENTS]\n", "[CONTENTS]\n" + name + "=true\n", text);
    }
    return text + sections;
}

DesignFromWif read(const std::string& text) {
    Result<DesignFromWif> result = read_wif(text);
    if (!result) FAIL(result.error().text());
    REQUIRE(check(result->design));
    return std::move(*result);
}

std::string rows(const DesignFromWif& result) {
    const CardImage& card = *std::get<CardLeaf>(result.design.blocks.at(result.design.root)->source).card;
    std::string text;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        if (pick > 0) text += '/';
        for (std::size_t end = 0; end < card.ends(); ++end) text += card.weft_over(pick, end) ? '-' : '#';
    }
    return text;
}

/// One warning, at this line (0: none), that holds these words.
void check_warning(const DesignFromWif& result, std::size_t line, const std::string& words) {
    INFO((result.warnings.empty() ? std::string("no warning") : result.warnings[0]));
    REQUIRE(result.warnings.size() == 1);
    if (line > 0) CHECK(result.warnings[0].find("line " + std::to_string(line) + ": ") == 0);
    CHECK(result.warnings[0].find(words) != std::string::npos);
}

void check_refused(const std::string& text, std::size_t line, const std::string& words) {
    const Result<DesignFromWif> result = read_wif(text);
    INFO(words);
    REQUIRE_FALSE(result);
    INFO(result.error().text());
    CHECK(result.error().code == ErrorCode::bad_input);
    CHECK(result.error().where == "line " + std::to_string(line));
    CHECK(result.error().message.find(words) != std::string::npos);
}

DesignFromWif fixture(const std::string& name) {
    const Result<std::string> text = read_file(WEAVE_SOURCE_DIR "/tests/fixtures/wif/" + name);
    REQUIRE(text);
    return read(*text);
}

}  // namespace

TEST_CASE("WIF: a lift plan lifts the ends on its shafts, pick 1 first") {
    const DesignFromWif result = read(plain_cloth);
    CHECK(result.warnings.empty());
    CHECK(rows(result) == "#--/-##");
}

TEST_CASE("WIF: a treadle program's file") {
    const DesignFromWif result = fixture("treadled_twill.wif");
    CHECK(result.warnings.empty());
    CHECK(rows(result) == "##--##--/-##--##-/--##--##/#--##--#");
    const Design& design = result.design;
    CHECK(design.title == "Caf\xc3\xa9 twill; sample no. 3");
    CHECK(design.notes == "Author: A. Weaver");
    CHECK(design.warp.yarns.at(0).colour == Colour{255, 0, 0});
    CHECK(design.warp.yarns[0].radius_mm == Approx(0.5));
    CHECK(design.warp.density_ends_per_cm == Approx(8));
    REQUIRE(design.weft.feeders.size() == 2);
    CHECK(design.weft.feeder_order == std::vector<FeederSet>{{0}, {0}, {1}, {0}});
    CHECK(design.weft.yarns[0].colour == Colour{0, 0, 255});
    CHECK(design.weft.yarns[1].colour == Colour{0, 255, 0});
    CHECK(design.weft.yarns[1].radius_mm == Approx(0.635));
    CHECK(design.weft.density_picks_per_cm == Approx(10 / 1.27));
}

TEST_CASE("WIF: a dobby program's file with a falling shed and the old kind of colour") {
    const DesignFromWif result = fixture("dobby_falling.wif");
    CHECK(rows(result) == "-#-/#-#");
    CHECK(result.design.warp.yarns[0].colour == Colour{255, 128, 0});
    CHECK(result.warnings.size() == 3);  // version, date, colour
}

TEST_CASE("WIF: a file that counts from zero and says more than it holds") {
    const DesignFromWif result = fixture("from_zero.wif");
    CHECK(rows(result) == "#-#-/-##-");
    CHECK(result.design.weft.yarns[0].colour == Colour{10, 20, 30});
    CHECK(result.design.warp.yarns[0].colour == Colour{10, 20, 30});
    CHECK(result.design.warp.colours == std::vector<Colour>{{40, 50, 60}});
    CHECK(result.design.warp.colour_order == Sequence{{0, 1, 0, 1}});
    const auto warned = [&](const std::string& words) {
        return std::any_of(result.warnings.begin(), result.warnings.end(),
                           [&](const std::string& text) { return text.find(words) != std::string::npos; });
    };
    CHECK(warned("[THREADING] counts from 0"));
    CHECK(warned("[LIFTPLAN] counts from 0"));
    CHECK(warned("[COLOR TABLE] counts from 0"));
    CHECK(warned("says 6 picks, but only 2"));
    CHECK(warned("says 9 colours, but [COLOR TABLE] lists 2"));
    CHECK(warned("lists [WARP] again"));
}

TEST_CASE("WIF: a file is known by its [WIF] section, not by its name") {
    CHECK(is_wif(plain_cloth));
    CHECK(is_wif("\xef\xbb\xbf[wif]\r\n"));
    CHECK(is_wif("; by hand\n\n[CONTENTS]\nWIF=true\n  [ WIF ]  \n") == false);
    CHECK(is_wif("; by hand\n\n[CONTENTS]\r  [Wif]  \r"));
    CHECK_FALSE(is_wif(""));
    CHECK_FALSE(is_wif("WIF"));
    CHECK_FALSE(is_wif("\x89PNG\r\n\x1a\n[wif] in it"));
    CHECK_FALSE(is_wif(std::string(1 << 16, '\n') + "[WIF]"));
}

TEST_CASE("WIF: forms that the standard allows bring no warning") {
    std::string crlf;
    for (const char c : plain_cloth) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    CHECK(read("\xef\xbb\xbf; a comment\r\n\r\n" + crlf).warnings.empty());
    std::string cr = plain_cloth;
    std::replace(cr.begin(), cr.end(), '\n', '\r');
    CHECK(rows(read(cr)) == "#--/-##");
    const DesignFromWif loose =
        read(with("Rising Shed=true", "  rising SHED = ON ; up", with("[THREADING]", "[Threading]")));
    CHECK(loose.warnings.empty());
    CHECK(rows(loose) == "#--/-##");
    CHECK(rows(read(with("2=2,3", "2= 2 , 3 ; two"))) == "#--/-##");
    CHECK(rows(read(with("1=1\n2=2\n3=3", "3=3\n1=1\n2=2"))) == "#--/-##");
}

TEST_CASE("WIF: shaft 0, several shafts and unlisted threads") {
    CHECK(rows(read(with("2=2\n3=3", "2=0\n3=1,2"))) == "#-#/--#");
    CHECK(rows(read(with("2=2\n3=3", "3=3"))) == "#--/--#");
    CHECK(rows(read(with("1=1\n2=2,3", "2=2,3"))) == "---/-##");
    CHECK(rows(read(with("1=1\n2=2,3", "1=\n2=0"))) == "---/---");
}

TEST_CASE("WIF: a warning names the ends that the threading leaves out, and those that it puts on shaft 0") {
    check_warning(read(with("2=2\n3=3", "3=3")), 20, "[THREADING] leaves out end 2, read as on no shaft");
    check_warning(read(with("2=2\n3=3", "2=0\n3=3")), 20, "[THREADING] puts end 2 on no shaft (0)");
    check_warning(read(with("2=2\n3=3", "2=\n3=0")), 20, "[THREADING] puts ends 2 to 3 on no shaft (0)");
    const std::string wide = with("Threads=3", "Threads=30", with("3=3\n", "3=3\n5=1\n8=1\n30=2\n"));
    check_warning(read(wide), 20, "leaves out ends 4, 6 to 7, 9 to 29, read as");
    std::string odd = "1=1\n";
    for (int end = 3; end < 30; end += 2) odd += std::to_string(end) + "=1\n";
    check_warning(read(with("1=1\n2=2\n3=3\n", odd, with("Threads=3", "Threads=29"))), 20,
                  "leaves out ends 2, 4, 6, 8, 10, 12 and 8 more, read as");
    // listed among the colours alone
    const std::string coloured = and_also("[WARP COLORS]\n4=1\n", with("Threads=3", "Threads=4"));
    const DesignFromWif last = read(coloured);
    CHECK(std::ranges::any_of(last.warnings, [](const std::string& text) {
        return text.find("[THREADING] leaves out end 4") != std::string::npos;
    }));
}

TEST_CASE("WIF: a warning names picks and treadles without a line, not those that are said to lift nothing") {
    check_warning(read(with("1=1\n2=2,3", "2=2,3")), 24, "[LIFTPLAN] leaves out pick 1, read as lifting nothing");
    for (const char* nothing : {"1=0\n2=2,3", "1=\n2=2,3"}) CHECK(read(with("1=1\n2=2,3", nothing)).warnings.empty());
    const std::string treadled = with("[LIFTPLAN]\n1=1\n2=2,3\n", "[TIEUP]\n1=1\n2=2\n[TREADLING]\n1=1\n2=2\n",
                                      with("LIFTPLAN=true", "TIEUP=true\nTREADLING=true"));
    CHECK(read(treadled).warnings.empty());  // no pick presses treadle 3
    const DesignFromWif untied = read(with("2=2\n[TREADLING]", "[TREADLING]", treadled));
    check_warning(untied, 25, "[TIEUP] leaves out treadle 2, read as lifting nothing");
    CHECK(rows(untied) == "#--/---");
    CHECK(read(with("2=2\n[TREADLING]", "2=0\n[TREADLING]", treadled)).warnings.empty());
    CHECK(read(with("[TREADLING]\n1=1", "[TREADLING]\n1=0", treadled)).warnings.empty());
    const DesignFromWif unpressed = read(with("[TREADLING]\n1=1\n", "[TREADLING]\n", treadled));
    check_warning(unpressed, 28, "[TREADLING] leaves out pick 1, read as lifting nothing");
    CHECK(rows(unpressed) == "---/-#-");
}

TEST_CASE("WIF: a last pick without a line lifts nothing; a declaration that is far too high is overstated") {
    const std::string four = with("2=2,3\n", "2=2,3\n3=1\n", with("Threads=2", "Threads=4"));
    const DesignFromWif kept = read(four);
    check_warning(kept, 19, "says 4 picks, but only 3 are listed; pick 4 is read as lifting nothing");
    CHECK(rows(kept) == "#--/-##/#--/---");
    const DesignFromWif dropped = read(with("Threads=4", "Threads=5", four));
    check_warning(dropped, 19, "picks 4 to 5 are dropped, as more than a quarter is missing");
    CHECK(rows(dropped) == "#--/-##/#--");
    const DesignFromWif ends = read(with("3=3\n", "3=3\n4=1\n5=2\n6=3\n", with("Threads=3", "Threads=8")));
    check_warning(ends, 17, "says 8 ends, but only 6 are listed; ends 7 to 8 are read as lifting nothing");
    CHECK(rows(ends) == "#--#----/-##-##--");
}

TEST_CASE("WIF: a falling shed turns the cloth over, ends on no shaft stay up") {
    const std::string falling = with("Rising Shed=true", "Rising Shed=no");
    CHECK(rows(read(falling)) == "-##/#--");
    CHECK(rows(read(with("3=3", "3=0", falling))) == "-##/#-#");
}

TEST_CASE("WIF: tie-up and treadling win over a lift plan") {
    const DesignFromWif result = read(and_also("[TIEUP]\n1=2\n2=1,3\n[TREADLING]\n1=1\n2=2\n"));
    check_warning(result, 26, "[LIFTPLAN] stands beside");
    CHECK(rows(result) == "-#-/#-#");
    const DesignFromWif two =
        read(with("[LIFTPLAN]\n1=1\n2=2,3\n", "[TIEUP]\n1=1\n3=2,3\n[TREADLING]\n1=1,3\n2=2\n",
                  with("LIFTPLAN=true", "TIEUP=true\nTREADLING=true")));
    check_warning(two, 25, "[TIEUP] leaves out treadle 2");
    CHECK(rows(two) == "###/---");
}

TEST_CASE("WIF: oddities are read with one warning each") {
    check_warning(read(with("April 20, 1997", "2011-05-01")), 3, "Date");
    check_warning(read(with("Date=April 20, 1997\n", "")), 1, "lacks the Date");
    check_warning(read(with("Version=1.1", "Version=1.0")), 2, "read as 1.1");
    check_warning(read(with("Version=1.1\n", "")), 1, "Version");
    check_warning(read(with("Developers=wif@mhsoft.com\n", "")), 1, "developers");
    check_warning(read(with("Source Program=Hand\n", "")), 1, "source program");
    check_warning(read(with("THREADING=true\n", "")), 19, "[THREADING] is not listed");
    check_warning(read(with("THREADING=true", "THREADING=false")), 20, "[THREADING] is not listed");
    check_warning(read(with("WARP=true", "WARP=true\nWARP=true")), 9, "lists [WARP] again");
    check_warning(read(with("WARP=true", "WARP=true\nTIEUP=true")), 9, "[TIEUP], which is not in the file");
    check_warning(read(with("[WEAVING]", "[CONTENTS]\n[WEAVING]")), 12, "comes again");
    check_warning(
        read(with("[CONTENTS]\nWEAVING=true\nWARP=true\nWEFT=true\nTHREADING=true\nLIFTPLAN=true\n", "")), 0,
        "no [CONTENTS]");
    check_warning(read(with("Rising Shed=true\n", "")), 12, "rising shed");
    check_warning(read(with("Threads=3", "Threads=30")), 17, "says 30 ends, but only 3");
    check_warning(read(with("Threads=2", "Threads=5")), 19, "says 5 picks, but only 2");
    check_warning(read(with("Threads=2\n", "")), 0, "[WEFT] does not say Threads");
    check_warning(read(with("Shafts=3", "Shafts=3\nshafts=3")), 14, "comes again");
    check_warning(read(with("3=3", "3=3\n3=3")), 24, "again");
    check_warning(read(with("1=1\n2=2\n3=3", "0=1\n1=2\n2=3")), 20, "counts from 0");
    CHECK(rows(read(with("1=1\n2=2\n3=3", "0=1\n1=2\n2=3"))) == "#--/-##");
    check_warning(read(with("Threads=3", "Threads=3\nThickness=2")), 18, "without Units");
    check_warning(read(with("Threads=3", "Threads=3\nUnits=cm\nThickness=0")), 19, "no size");
}

TEST_CASE("WIF: oddities of colours") {
    const std::string table = "[COLOR PALETTE]\nEntries=2\nRange=0,255\n[COLOR TABLE]\n1=1,2,3\n2=4,5,6\n";
    const std::string two = and_also(table, with("Threads=3", "Threads=3\nColor=2"));
    CHECK(read(two).warnings.empty());
    CHECK(read(two).design.warp.yarns[0].colour == Colour{4, 5, 6});
    check_warning(read(with("Entries=2", "Entries=20", two)), 31, "says 20 colours");
    check_warning(read(with("Color=2", "Color=7", two)), 20, "colour 7 is not in [COLOR TABLE]");
    check_warning(read(with("Color=2", "Color=2,7,8,9", two)), 20, "older files");
    CHECK(read(with("Color=2", "Color=2,7,8,9", two)).design.warp.yarns[0].colour == Colour{7, 8, 9});
    check_warning(read(with("Range=0,255\n", "", two)), 30, "does not say Range");
    const std::string no_colour = with("Threads=3\nColor=2", "Threads=3", two);
    check_warning(read(with("Range=0,255", "Range=0,255\nForm=CMYK", no_colour)), 32, "not RGB");
    check_warning(read(with("2=4,5,6", "2=4,5,600", two)), 35, "beyond the range");
    check_warning(read(with("Color=2", "Color=0", two)), 20, "count their colours from 0");
    CHECK(read(with("Color=2", "Color=0", two)).design.warp.yarns[0].colour == Colour{1, 2, 3});
    const std::string missing = and_also("[WARP COLORS]\n1=1\n3=2\n", with("Color=2\n", "", two));
    check_warning(read(missing), 37, "have no colour");
}

TEST_CASE("WIF: uneven thickness makes yarns, spacing makes density") {
    const DesignFromWif result =
        read(and_also("[WARP THICKNESS]\n2=36\n[WARP SPACING]\n1=72\n2=36\n3=36\n",
                      with("Threads=3", "Threads=3\nUnits=decipoints\nThickness=18\nSpacing=1")));
    CHECK(result.warnings.empty());
    REQUIRE(result.design.warp.yarns.size() == 2);
    CHECK(result.design.warp.yarns[0].radius_mm == Approx(25.4 / 80));
    CHECK(result.design.warp.yarns[1].radius_mm == Approx(25.4 / 40));
    CHECK(result.design.warp.order == Sequence{{0, 1, 0}});
    CHECK(result.design.warp.density_ends_per_cm == Approx(10 / (25.4 / 15)));
}

TEST_CASE("WIF: more than 64 weft yarns are merged with a warning") {
    std::string plan = "[LIFTPLAN]\n", table = "[COLOR TABLE]\n", colours = "[WEFT COLORS]\n";
    for (int k = 1; k <= 70; ++k) {
        const std::string number = std::to_string(k);
        plan += number + "=1\n";
        table += number + "=" + number + ",0,0\n";
        colours += number + "=" + number + "\n";
    }
    const std::string text = with("[LIFTPLAN]\n1=1\n2=2,3\n", plan, with("Threads=2", "Threads=70"));
    const DesignFromWif result =
        read(and_also("[COLOR PALETTE]\nRange=0,255\nEntries=70\n" + table + colours, text));
    check_warning(result, 0, "at most 64 feeders");
    REQUIRE(result.design.weft.feeders.size() == 64);
    CHECK(result.design.weft.feeder_order[63] == FeederSet{63});
    CHECK(result.design.weft.feeder_order[69] == FeederSet{63});  // the nearest red
}

TEST_CASE("WIF: a long title is cut between characters") {
    std::string title(999, 'x');
    const DesignFromWif result =
        read(and_also("[TEXT]\nTitle=" + title + "\xc3\xa9\n[NOTES]\n1=one = two\nthree\n"));
    check_warning(result, 0, "the title is longer");
    CHECK(result.design.title == title);
    CHECK(result.design.notes == "one = two\nthree");
}

TEST_CASE("WIF: what cannot be understood is refused with its line") {
    check_refused("", 1, "no section [WIF]");
    check_refused("hello\n", 1, "before the first section");
    check_refused("[WEAVING]\nShafts=3\n", 1, "no section [WIF]");
    check_refused(std::string("\xff\xfe[\0W\0", 6), 1, "UTF-16");
    check_refused(with("Version=1.1", "Version=2.0"), 2, "only 1.1");
    check_refused(with("[WEFT]", "[WEFT"), 18, "no ']'");
    check_refused(with("[WEFT]", "[ ]"), 18, "no name");
    check_refused(with("WARP=true", "WARP=perhaps"), 8, "neither true nor false");
    check_refused(with("Rising Shed=true", "Rising Shed=maybe"), 15, "neither true nor false");
    check_refused(with("Shafts=3", "Shafts"), 13, "not a name and its value");
    check_refused(with("Shafts=3", "Shafts=three"), 13, "not a whole number");
    check_refused(with("Shafts=3", "Shafts=0"), 13, "must be from 1");
    check_refused(with("Shafts=3", "Shafts=99999999999"), 13, "must be from 1");
    check_refused(with("Shafts=3\n", ""), 12, "how many shafts");
    check_refused(with("Shafts=3", "Shafts=3\nShafts=4"), 14, "with another value");
    check_refused(with("3=3", "3=4"), 23, "the highest is 3");
    check_refused(with("3=3", "3=-1"), 23, "not a number");
    check_refused(with("3=3", "3=x"), 23, "not a number");
    check_refused(with("3=3", "x=3"), 23, "not a number and its value");
    check_refused(with("3=3", "3=3\n2=1"), 24, "another value");
    check_refused(with("3=3", "4=3"), 23, "there are only 3");
    check_refused(with("1=1\n2=2\n3=3", "0=1\n1=1\n2=2\n3=3"), 24, "there are only 3");
    check_refused(with("Threads=3", "Threads=-3"), 17, "must be from 1");
    check_refused(with("Threads=3", "Threads=3\nUnits=cubits"), 18, "no unit");
    check_refused(with("Threads=3", "Threads=3\nUnits=cm\nSpacing=wide"), 19, "not a number");
    check_refused(with("Threads=3", "Threads=3\nColor=1,2"), 18, "neither the number of a colour");
    check_refused(with("[LIFTPLAN]\n1=1\n2=2,3\n", ""), 1, "nothing says how it is woven");
    check_refused(with("[LIFTPLAN]\n1=1\n2=2,3\n", "[LIFTPLAN]\n"), 24, "[LIFTPLAN] is empty");
    check_refused(with("[LIFTPLAN]\n1=1\n2=2,3\n", "[TIEUP]\n1=1\n[TREADLING]\n"), 26, "[TREADLING] is empty");
    check_refused(with("[LIFTPLAN]\n1=1\n2=2,3\n", "[TREADLING]\n1=1\n2=1\n[TIEUP]\n"), 27, "[TIEUP] is empty");
    check_refused(with("[LIFTPLAN]", "[TREADLING]"), 24, "no [TIEUP]");
    check_refused(with("[THREADING]\n1=1\n2=2\n3=3\n", ""), 1, "no [THREADING]");
    check_refused(plain_cloth + "[COLOR TABLE]\n1=1,2\n", 28, "not 3 numbers");
    check_refused(plain_cloth + "[COLOR PALETTE]\nRange=9,9\n", 28, "does not rise");
    check_refused(plain_cloth + "[WARP COLORS]\n1=0\n2=2\n[COLOR TABLE]\n1=1,2,3\n2=1,2,3\n", 28, "colour 0");
}

TEST_CASE("WIF: sizes are bounded before anything is allocated") {
    check_refused(with("3=3\n", "3=3\n99999999999=1\n"), 24, "there are only 3");
    check_refused(with("Threads=3", "Threads=4194305"), 17, "must be from 1");
    const Result<DesignFromWif> huge = read_wif(
        with("Threads=3", "Threads=4194304",
             with("3=3", "4194304=3", with("Threads=2", "Threads=4194304", with("2=2,3", "4194304=2")))));
    REQUIRE_FALSE(huge);
    CHECK(huge.error().message.find("larger than the limit") != std::string::npos);
    std::string sections = head;
    for (int k = 0; k < 5000; ++k) sections += "[S" + std::to_string(k) + "]\n";
    CHECK_FALSE(read_wif(sections));
}

TEST_CASE("WIF: a Jacquard file of full size is read as it was written") {
    CardImage card(600, 2400);
    std::uint32_t state = 1;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) {
            state = state * 1664525 + 1013904223;
            card.set(pick, end, (state >> 31) != 0);
        }
    }
    Design design;
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(card);
    design.blocks["cloth"] = std::make_shared<const Node>(Node{leaf, {}});
    const Stack over({Slot::warp(0), Slot::weft(0)}), under({Slot::weft(0), Slot::warp(0)});
    const std::vector<std::uint32_t> t(600, 1), p(2400, 1);
    const Result<Block> block = make_block(
        t, p, [&](std::size_t pick, std::size_t end) { return card.weft_over(pick, end) ? over : under; });
    REQUIRE(block);
    const Result<std::string> text = write_wif(design, *block, card);
    REQUIRE(text);
    const DesignFromWif result = read(*text);
    CHECK(result.warnings.empty());
    CHECK(*std::get<CardLeaf>(result.design.blocks.at("cloth")->source).card == card);
}
