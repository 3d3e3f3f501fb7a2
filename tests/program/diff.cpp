// Two designs compared: what is said, drawn and answered.

#include "run.hpp"

using program_tests::Ended;
using program_tests::Workshop;
using weave::Json;

TEST_CASE("weave diff tells the same design from one that differs, by its exit status too") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "a.weave"});
    shop.must({"samples", "layer-to-layer", "-o", "same.weave"});
    CHECK(shop.must({"diff", "a.weave", "same.weave"}).out == "a.weave and same.weave are the same design\n");
    CHECK(shop.json({"diff", "a.weave", "same.weave"}).at("equal") == true);

    shop.must({"preset", "twill", "up=2", "down=2", "-o", "t.weave"});
    shop.must({"tile", "t.weave", "--x", "3", "--y", "4", "-o", "b.weave"});
    shop.must({"flip", "b.weave", "--pick", "5", "--end", "7", "-o", "c.weave"});
    const Ended told = shop.run({"diff", "b.weave", "c.weave"});
    CHECK(told.exit == 1);
    CHECK(told.complaints().empty());
    CHECK(told.out.find("b.weave and c.weave differ: blocks (1)\n1 of 192 crossings differ (0.52 %): ") == 0);
    CHECK(told.out.find("\nBlocks\n") != std::string::npos);
    CHECK(told.out.find("pick 5, end 7: ") != std::string::npos);
    const Json answer = shop.json({"diff", "b.weave", "c.weave"}, 1);
    CHECK(answer.at("equal") == false);
    CHECK(answer.at("tree").size() == 1);
    CHECK(answer.at("pixels").at("changed") == 1);
    CHECK(answer.at("pixels").at("runs").at(0).at("pick") == 5);
    CHECK(answer.at("pixels").at("runs").at(0).at("first_end") == 7);
    for (const char* key : {"picks", "ends", "yarns", "parameters"}) CHECK(answer.at(key).empty());
}

TEST_CASE("weave diff draws the cards laid on each other, and overwrites no design") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "a.weave"});
    shop.must({"preset", "twill", "-o", "b.weave"});
    for (const std::string out : {"p.png", "p.svg"}) {
        CHECK(shop.json({"diff", "a.weave", "b.weave", "-o", out}, 1).at("file") == out);
        CHECK(shop.get(out).find(out == "p.png" ? "PNG" : "<svg") != std::string::npos);
    }
    shop.refused({"diff", "a.weave", "b.weave", "-o", "p.gif"}, 2, {".png or .svg"});
    shop.refused({"diff", "a.weave", "missing.weave"}, 3, {"missing.weave"});
}
