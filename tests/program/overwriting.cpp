// No command writes over what it reads or over its own other output, by whatever name; what is sensible to change in place
// is.

#include "run.hpp"

#include <weave/sim/yarns_file.hpp>

#include <map>

using program_tests::Workshop;
using weave::Json;

namespace {

using Words = std::vector<std::string>;

/// Refused as usage, with every file left as it is.
void spares(const Workshop& shop, const Words& words, const std::string& lost) {
    std::map<std::string, std::string> before;
    for (const std::string& name : shop.names()) {
        if (std::filesystem::is_regular_file(shop.path(name))) before[name] = shop.get(name);
    }
    shop.refused(words, 2, {lost, "would be lost"});
    for (const auto& [name, bytes] : before) CHECK(shop.get(name) == bytes);
}

}  // namespace

TEST_CASE("simulate spares the design that it reads, and keeps its two outputs apart") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "2", "--y", "2", "-o", "d.weave"});
    shop.must({"simulate", "d.weave", "--threads", "1", "-o", "a.yarns"});
    std::filesystem::create_directory(shop.path("sub"));
    std::filesystem::create_symlink("d.weave", shop.path("link.weave"));
    std::filesystem::create_symlink("new.weave", shop.path("empty-link"));
    for (const char* name : {"d.weave", "./d.weave", "sub/../d.weave", "link.weave"})
        spares(shop, {"simulate", "d.weave", "-o", name}, "the design that is read");
    spares(shop, {"simulate", "link.weave", "-o", "d.weave"}, "the design that is read");
    spares(shop, {"simulate", "d.weave", "--flip", "2,3", "--save-design", "x", "-o", "x"}, "the file for the yarns");
    spares(shop, {"simulate", "d.weave", "--flip", "2,3", "--save-design", "empty-link", "-o", "new.weave"}, "the file for the yarns");
    spares(shop, {"simulate", "d.weave", "--resume", "a.yarns", "--flip", "2,3", "--save-design", "a.yarns", "-o", "b.yarns"},
           "the file of yarns that are gone on from");
}

TEST_CASE("yarns that are gone on from, and the design that gets its flips, may change in place") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "2", "--y", "2", "-o", "d.weave"});
    shop.must({"simulate", "d.weave", "--threads", "1", "-o", "a.yarns"});
    const Json again = shop.json({"simulate", "d.weave", "--threads", "1", "--residual", "1e-7", "--resume", "a.yarns", "-o", "a.yarns"});
    CHECK(again.at("residual").get<double>() <= 1e-7);
    const weave::Result<weave::Yarns> yarns = weave::read_yarns(shop.get("a.yarns"));
    REQUIRE(yarns);
    CHECK(yarns->report.at("residual") == again.at("residual"));
    const Json flipped = shop.json({"simulate", "d.weave", "--threads", "1", "--flip", "2,3", "--save-design", "d.weave", "-o", "f.yarns"});
    CHECK(flipped.at("design_sha256") == shop.json({"info", "d.weave"}).at("design_sha256"));
    shop.must({"flip", "d.weave", "--pick", "2", "--end", "3", "-o", "d.weave"});
    CHECK(shop.json({"info", "d.weave"}).at("design_sha256") != flipped.at("design_sha256"));
}

TEST_CASE("pictures, exports and imports spare what they are made from") {
    const Workshop shop;
    shop.must({"preset", "twill", "-o", "t.weave"});
    shop.must({"card", "t.weave", "-o", "t.png"});
    shop.must({"simulate", "t.weave", "--threads", "1", "-o", "y.yarns"});
    for (const char* name : {"d.png", "d.svg"}) shop.put(name, shop.get("t.weave"));
    for (const char* name : {"y.png", "y.obj"}) shop.put(name, shop.get("y.yarns"));
    spares(shop, {"card", "d.png", "-o", "d.png"}, "the design that is read");
    spares(shop, {"render", "d.svg", "--view", "block", "-o", "./d.svg"}, "the file that is read");
    spares(shop, {"render", "y.png", "--view", "3d", "-o", "y.png"}, "the file that is read");
    spares(shop, {"export-yarns", "y.obj", "-o", "y.obj"}, "the file of yarns that is read");
    spares(shop, {"import", "t.png", "-o", "t.png"}, "the file that is read");
    spares(shop, {"stencil", "t.png", "--map", "#000000=t.weave", "--map", "#ffffff=t.weave", "-o", "t.png"}, "the picture that is read");
    shop.must({"stencil", "t.png", "--map", "#000000=t.weave", "--map", "#ffffff=t.weave", "-o", "t.weave"});
}

TEST_CASE("a picture of relaxed cloth takes no option for pictures of designs") {
    const Workshop shop;
    for (const Words& words : {Words{"--trim"}, {"--from-pick", "1"}, {"--to-pick", "1"}, {"--from-end", "1"}, {"--to-end", "1"}}) {
        Words all{"render", "y.yarns", "--view", "3d", "-o", "y.png"};
        all.insert(all.end(), words.begin(), words.end());
        shop.refused(all, 2, {words[0], "--view 3d"});
    }
}

TEST_CASE("designs that are joined or merged, and slices, are spared; the one that grows may change in place") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "a.weave"});
    shop.must({"samples", "plain", "-o", "b.weave"});
    spares(shop, {"attach", "a.weave", "b.weave", "--face", "+x", "-o", "b.weave"}, "the design that is joined to it");
    shop.must({"attach", "a.weave", "b.weave", "--face", "+x", "-o", "a.weave"});
    CHECK(shop.json({"info", "a.weave"}).at("picks") == 4);
    shop.must({"card", "b.weave", "-o", "two.png"});  // black and white
    spares(shop, {"stencil", "two.png", "--map", "#000000=a.weave", "--map", "#ffffff=b.weave", "-o", "b.weave"}, "a design that is merged");
    shop.put("s.txt", "P0 T0\nT0 P0\n");
    spares(shop, {"slices", "s.txt", "-o", "./s.txt"}, "the text that is read");
}

TEST_CASE("what is written does not take the name of another kind of file") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.put("face.png", "a picture");
    shop.refused({"samples", "plain", "-o", "face.png"}, 2, {"face.png: ", "NAME.weave"});
    CHECK(shop.get("face.png") == "a picture");
    shop.refused({"simulate", "p.weave", "-o", "v.obj"}, 2, {"v.obj: ", "NAME.yarns"});
    shop.refused({"simulate", "p.weave", "--flip", "1,1", "--save-design", "f.yarns", "-o", "v.yarns"}, 2, {"f.yarns: ", "NAME.weave"});
    shop.must({"samples", "plain", "-o", "plain.of-mine"});
    shop.must({"simulate", "p.weave", "-o", "yarns"});
}
