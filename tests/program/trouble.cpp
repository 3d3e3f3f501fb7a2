// Broken inputs and outputs that cannot be written: one clear line, the documented exit status, nothing
// half-written.

#include "run.hpp"

#include <weave/io/bitmap.hpp>

#include <csignal>
#include <sys/stat.h>

using program_tests::loom;
using program_tests::Workshop;
using weave::Json;

namespace {

using Words = std::vector<std::string>;

/// A workshop with a good design, its card, and one of each broken input.
void furnish(const Workshop& shop) {
    shop.must({"preset", "twill", "-o", "t.weave"});
    shop.must({"card", "t.weave", "-o", "t.png"});
    shop.must({"card", "t.weave", "-o", "t.tif"});
    const std::string whole = shop.get("t.weave"), picture = shop.get("t.png");
    shop.put("cut.weave", whole.substr(0, whole.size() / 2));
    Json newer = *weave::parse_json(whole);
    newer["version"] = 99;
    shop.put("newer.weave", newer.dump());
    shop.put("empty.weave", "");
    shop.put("cut.png", picture.substr(0, picture.size() / 2));
    shop.put("cut.tif", shop.get("t.tif").substr(0, 40));
    weave::ColourImage image{2, 3, std::vector<weave::Colour>(6, weave::Colour{255, 255, 255})};
    image.pixels[1] = weave::Colour{0, 0, 0};
    image.pixels[5] = weave::Colour{128, 128, 128};
    shop.put("grey.png", *weave::write_png(image));
    shop.put("garbage.wif", "[WIF]\nVersion=1.1\n[CONTENTS]\nthis is no weaving\n");
    Json profile = *weave::parse_json(*weave::read_file(loom("tc2")));
    profile["colour"] = "blue";
    shop.put("odd.json", profile.dump());
    shop.put("cut.json", "{\"format\": \"weave-loom\", \"version\": 1,\n \"name\": ");
}

/// Every command that writes, writing to `out`; `folder` where export is to go.
std::vector<Words> writers(const std::string& out) {
    return {
        {"samples", "plain", "-o", out + ".weave"},
        {"preset", "plain", "-o", out + ".weave"},
        {"tile", "t.weave", "--x", "2", "-o", out + ".weave"},
        {"attach", "t.weave", "t.weave", "--face", "+x", "-o", out + ".weave"},
        {"stencil", "t.png", "--map", "#000000=t.weave", "--map", "#ffffff=t.weave", "-o", out + ".weave"},
        {"renumber", "t.weave", "--row", "0", "--order", "0", "-o", out + ".weave"},
        {"flip", "t.weave", "--pick", "1", "--end", "1", "-o", out + ".weave"},
        {"import", "t.png", "-o", out + ".weave"},
        {"card", "t.weave", "-o", out + ".png"},
        {"card", "t.weave", "-o", out + ".tif"},
        {"card", "t.weave", "-o", out + ".bmp"},
        {"render", "t.weave", "--view", "face", "-o", out + ".png"},
        {"render", "t.weave", "--view", "block", "-o", out + ".svg"},
        {"export", "t.weave", "--loom", loom("tc2"), "-o", out},
    };
}

}  // namespace

TEST_CASE("bad input ends with 3 and one line that names the file and the place in it") {
    const Workshop shop;
    furnish(shop);
    const std::vector<std::pair<Words, Words>> calls{
        {{"info", "none.weave"}, {"none.weave"}},
        {{"info", "."}, {".", "regular file"}},
        {{"info", "cut.weave"}, {"cut.weave", "line"}},
        {{"info", "newer.weave"}, {"newer.weave", "version", "99"}},
        {{"info", "empty.weave"}, {"empty.weave"}},
        {{"info", "t.png"}, {"t.png"}},
        {{"card", "cut.weave", "-o", "new.png"}, {"cut.weave", "line"}},
        {{"render", "newer.weave", "--view", "face", "-o", "new.png"}, {"newer.weave", "version"}},
        {{"tile", "cut.weave", "--x", "2", "-o", "new.weave"}, {"cut.weave", "line"}},
        {{"attach", "t.weave", "cut.weave", "--face", "+x", "-o", "new.weave"}, {"cut.weave", "line"}},
        {{"renumber", "cut.weave", "--row", "0", "--order", "0", "-o", "new.weave"}, {"cut.weave", "line"}},
        {{"flip", "newer.weave", "--pick", "1", "--end", "1", "-o", "new.weave"}, {"newer.weave", "version"}},
        {{"stencil", "none.png", "--map", "#000000=t.weave", "-o", "new.weave"}, {"none.png"}},
        {{"stencil", "cut.png", "--map", "#000000=t.weave", "-o", "new.weave"}, {"cut.png"}},
        {{"stencil", "t.png", "--map", "#000000=cut.weave", "-o", "new.weave"}, {"cut.weave", "line"}},
        {{"stencil", "grey.png", "--map", "#000000=t.weave", "--map", "#ffffff=t.weave", "-o", "new.weave"},
         {"grey.png", "row 2", "column 3", "#808080"}},
        {{"import", "none.png", "-o", "new.weave"}, {"none.png"}},
        {{"import", "grey.png", "-o", "new.weave"}, {"grey.png"}},
        {{"import", "cut.png", "-o", "new.weave"}, {"cut.png"}},
        {{"import", "cut.tif", "-o", "new.weave"}, {"cut.tif"}},
        {{"import", "t.weave", "-o", "new.weave"}, {"t.weave", "PNG"}},
        {{"import", "garbage.wif", "-o", "new.weave"}, {"garbage.wif", "line 4"}},
        {{"import", "t.png", "--t", "3", "-o", "new.weave"}, {"t.png", "3", "4"}},
        {{"check", "cut.weave", "--loom", loom("tc2")}, {"cut.weave", "line"}},
        {{"check", "t.weave", "--loom", "none.json"}, {"none.json"}},
        {{"check", "t.weave", "--loom", "odd.json"}, {"odd.json", "colour"}},
        {{"check", "t.weave", "--loom", "cut.json"}, {"cut.json", "line 2"}},
        {{"check", "t.weave", "--loom", "t.weave"}, {"t.weave", "is a design, no profile of a loom"}},
        {{"export", "cut.weave", "--loom", loom("tc2"), "-o", "new"}, {"cut.weave", "line"}},
        {{"export", "t.weave", "--loom", "odd.json", "-o", "new"}, {"odd.json", "colour"}},
    };
    for (const auto& [words, pieces] : calls) shop.refused(words, 3, pieces);
}

TEST_CASE("a stencil that would be too large is refused before its picture is read") {
    const Workshop shop;
    shop.must({"preset", "multi-layer", "layers=64", "-o", "m.weave"});
    const weave::ColourImage image{600, 700, std::vector<weave::Colour>(std::size_t{600} * 700)};
    const std::string whole = *weave::write_png(image);
    shop.put("cut.png", whole.substr(0, 100));  // its size is there, its pixels are not
    shop.refused({"stencil", "cut.png", "--map", "#000000=m.weave", "-o", "new.weave"}, 3,
                 {"cut.png with block 0 = m.weave", "38400 picks and 44800 ends is larger than the limit"});
}

TEST_CASE("what does not fit a cloth of 500 million crossings is refused by its counts, the limit of crossings first") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "plain.weave"});
    shop.must({"tile", "plain.weave", "--x", "16384", "--y", "8192", "-o", "big.weave"});
    using Words = std::vector<std::string>;
    const std::vector<std::pair<Words, Words>> calls{
        {{"tile", "big.weave", "--x", "2"}, {"65536 picks and 16384 ends", "crossings"}},
        {{"attach", "big.weave", "big.weave", "--face", "+x"}, {"65536 picks and 16384 ends", "crossings"}},
        {{"attach", "big.weave", "big.weave", "--face", "-z"}, {"65536 picks and 32768 ends", "crossings"}},
        {{"attach", "big.weave", "plain.weave", "--face", "+y"}, {"32768 rows", "on the faces that meet"}},
        {{"attach", "big.weave", "plain.weave", "--face", "+z"}, {"32768 rows", "on top of each other"}},
        {{"renumber", "big.weave", "--row", "0", "--order", "1"}, {"row 0", "1 picks once"}},
        {{"renumber", "big.weave", "--row", "99999", "--order", "0"}, {"no row 99999", "32767"}},
    };
    for (auto [words, pieces] : calls) {
        words.insert(words.end(), {"-o", "new.weave"});
        pieces.push_back("big.weave");
        shop.refused(words, 3, pieces);
    }
}

TEST_CASE("a program that reads along is told of a failure in JSON, and nothing else") {
    const Workshop shop;
    furnish(shop);
    shop.refused({"info", "cut.weave", "--json"}, 3, {"cut.weave"});
    const Json error = shop.json({"info", "newer.weave"}, 3).at("error");
    CHECK(error.at("kind") == "bad input");
    CHECK(error.at("where").get<std::string>() == "newer.weave: version");
    shop.refused({"check", "t.weave", "--loom", "odd.json", "--json"}, 3, {"odd.json"});
}

TEST_CASE("a place where nothing can be written ends with 5, and nothing is left behind") {
    const Workshop shop;
    furnish(shop);
    for (const Words& call : writers("none/there/new")) {
        if (call[0] == "export") continue;  // makes the folders that lead to its own
        shop.refused(call, 5, {"none/there/new"});
    }
    for (const Words& call : writers("t.weave/new")) shop.refused(call, 5, {"t.weave/new"});  // below a file
}

TEST_CASE("a full disk ends with 5: no new file, and an old one stays as it was") {
    const Workshop shop;
    furnish(shop);
    for (const Words& call : writers("new")) shop.refused(call, 5, {"new"}, 20);
    for (const char* extension : {".weave", ".png", ".tif", ".bmp", ".svg"})
        shop.put(std::string("old") + extension, "of old");
    for (const Words& call : writers("old")) {
        if (call[0] == "export") continue;
        shop.refused(call, 5, {"old"}, 20);
        CHECK(shop.get(call.back()) == "of old");
    }
}

TEST_CASE("bad input leaves an old output as it was") {
    const Workshop shop;
    furnish(shop);
    shop.put("old.weave", "of old");
    shop.put("old.png", "of old");
    shop.refused({"tile", "cut.weave", "--x", "2", "-o", "old.weave"}, 3, {"cut.weave"});
    shop.refused({"import", "grey.png", "-o", "old.weave"}, 3, {"grey.png"});
    shop.refused({"card", "cut.weave", "-o", "old.png"}, 3, {"cut.weave"});
    shop.refused({"flip", "t.weave", "--pick", "99", "--end", "1", "-o", "old.weave"}, 3, {"99"});
    CHECK(shop.get("old.weave") == "of old");
    CHECK(shop.get("old.png") == "of old");
}

TEST_CASE("an output replaces the old file as a whole, even the very file that it is made from") {
    const Workshop shop;
    furnish(shop);
    std::filesystem::create_hard_link(shop.path("t.weave"), shop.path("held.weave"));
    const std::string before = shop.get("t.weave");
    const std::set<std::string> names = shop.names();
    const program_tests::Ended tiled = shop.run({"tile", "t.weave", "--x", "2", "-o", "t.weave"});
    CHECK(tiled.exit == 0);
    CHECK(tiled.complaints() ==
          Words{"weave: t.weave: another name of this file (hard link) keeps the old content"});
    CHECK(shop.get("held.weave") == before);  // a new file took the name; the old one was never written into
    CHECK(shop.json({"info", "t.weave"}).at("picks") == 8);
    CHECK(shop.names() == names);
}

TEST_CASE("a symbolic link stays a link, to the new content") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "real.weave"});
    std::filesystem::create_symlink("real.weave", shop.path("link.weave"));
    shop.must({"preset", "satin", "-o", "link.weave"});
    CHECK(std::filesystem::is_symlink(shop.path("link.weave")));
    CHECK(shop.json({"info", "real.weave"}).at("picks") == 5);
}

TEST_CASE("a token that others may read is warned of, one line before what came of it") {
    const Workshop shop;
    shop.put("token", "a-very-secret-token\n");
    const Words words{"jobs", "--on", "unix:none.sock", "--token-file", "token"};
    const std::string quiet = shop.run(words).err;
    CHECK(quiet.find("chmod") == std::string::npos);
    REQUIRE(::chmod(shop.path("token").c_str(), 0644) == 0);
    const auto warned = shop.run(words);
    CHECK(warned.err == "weave: token: others may read or write it; what it holds is yours alone (chmod 600)\n" + quiet);
    CHECK(warned.err.find("secret") == std::string::npos);
}

TEST_CASE("control characters from a file's name do not reach the terminal") {
    const Workshop shop;
    const std::string line = shop.refused({"info", "a\x1b[2Jb.weave"}, 3, {"a\\x1b[2Jb.weave"});
    CHECK(line.find('\x1b') == std::string::npos);
}

TEST_CASE("no title, loom or file name forges a line or reaches the terminal's controls") {
    const Workshop shop;
    const std::string evil = "\x1b[31mEVIL\nOn TC2: 0 errors\xc2\x9b\xe2\x80\xae",
                      shown = "\\x1b[31mEVIL\\x0aOn TC2";
    shop.must({"preset", "twill", "-o", "t.weave"});
    Json document = *weave::parse_json(shop.get("t.weave"));
    document["title"] = evil;
    shop.put("evil.weave", document.dump());
    Json profile = *weave::parse_json(*weave::read_file(loom("tc2")));
    profile["name"] = evil;
    shop.put("evil.json", profile.dump());
    const std::vector<Words> calls{
        {"info", "evil.weave"},
        {"check", "t.weave", "--loom", "evil.json"},
        {"preset", "plain", "-o", evil + ".weave"},
        {"card", "t.weave", "-o", evil + ".png"},
        {"card", "t.weave", "-o", evil + ".wif"},
        {"render", "t.weave", "--view", "face", "-o", evil + ".png"},
        {"export", "t.weave", "--loom", loom("tc2"), "-o", evil},
    };
    for (Words call : calls) {
        const program_tests::Ended ended = shop.must(call);
        INFO(ended.out);
        CHECK(ended.out.find(shown) != std::string::npos);
        CHECK(ended.out.find("\nOn TC2: 0 errors") == std::string::npos);
        call.emplace_back("--json");
        std::filesystem::remove_all(shop.path(evil));
        const std::string json = shop.run(call).out;
        for (const char* mark : {"\x1b", "\xc2\x9b", "\xe2\x80\xae"}) {
            CHECK(ended.out.find(mark) == std::string::npos);
            CHECK(json.find(mark) == std::string::npos);
        }
    }
}

TEST_CASE("what takes long is told, on one line, until it is done") {
    const Workshop shop;
    shop.must({"preset", "twill", "-o", "t.weave"});
    const std::string slow = "slow\x1b[2J.png";  // a pipe: written to only once somebody reads
    REQUIRE(::mkfifo(shop.path(slow).c_str(), 0600) == 0);
    Workshop::Running running = shop.start({"card", "t.weave", "-o", slow});
    CHECK(running.says("writing slow\\x1b[2J.png ... 1 s\n"));
    const int reader = ::open(shop.path(slow).c_str(), O_RDONLY | O_CLOEXEC);
    char buffer[4096];
    while (::read(reader, buffer, sizeof buffer) > 0) {
    }
    ::close(reader);
    CHECK(running.finish().exit == 0);
}

TEST_CASE("a signal in the middle of a write ends the program by that signal, with nothing left behind") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "1500", "--y", "1500", "-o", "large.weave"});
    const std::set<std::string> before = shop.names();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        bool caught = false;
        for (int attempt = 0; attempt < 50 && !caught; ++attempt) {  // it may be done before we look
            Workshop::Running running = shop.start({"card", "large.weave", "-o", "out.bmp"});
            while (!running.is_over() && shop.names() == before) {
            }
            ::kill(running.child, SIGSTOP);
            ::kill(running.child, signal);
            ::kill(running.child, SIGCONT);
            caught = running.finish().exit == 1000 + signal;
            std::filesystem::remove(shop.path("out.bmp"));  // whole, or not there
            CHECK(shop.names() == before);
        }
        CHECK(caught);
    }
}
