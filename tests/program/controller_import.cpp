// `weave import` of controller files: JC5, EP and raw become designs, or are refused with file and byte.

#include "run.hpp"

#include <weave/block/card_image.hpp>
#include <weave/io/bitmap.hpp>

#include <support/controller_bytes.hpp>

using program_tests::loom;
using program_tests::Workshop;
using weave::CardImage;
using weave::Json;
using weave::LoomProfile;
using weave::testing::Shed;

namespace {

/// The shipped EP loom with a 14-pick twill over all 2,400 ends, six feeders, the first twice in seven picks.
std::string ep_twill(const LoomProfile& profile) {
    Shed shed(14, std::string(2688, '.'));
    const std::vector<std::uint64_t> cycle{1, 2, 1, 4, 8, 16, 32};
    std::vector<std::uint64_t> words;
    for (std::size_t pick = 0; pick < 14; ++pick) {
        words.push_back(cycle[pick % 7]);
        shed[pick][54] = shed[pick][55] = 'X';
        for (std::size_t k = 0; k < 84; ++k) {
            if ((k + pick) % 2 == 1) shed[pick][56 + k] = shed[pick][2548 + k] = 'X';
        }
        for (std::size_t end = 0; end < 2400; ++end) {
            if ((end + pick) % 4 < 2) shed[pick][144 + end] = 'X';
        }
    }
    return weave::testing::ep_bytes("TWILL22", shed, words, profile);
}

/// A raw loom of 16 hooks, three of them feeders.
void put_raw_loom(const Workshop& shop) {
    shop.put("raw.json", R"({"format": "weave-loom", "version": 1, "name": "raw", "insertion": "rapier",
        "hooks": {"areas": [{"name": "all", "hooks": 16}], "rule": "straight", "body": [[8, 15]]},
        "feeders": {"count": 3, "encoding": "hooks", "places": [0, 1, 2]}, "file": {"output": "raw"}})");
}

}  // namespace

TEST_CASE("an EP file becomes a design with its card and its feeder order") {
    const Workshop shop;
    const LoomProfile profile = *weave::load_profile(loom("ep-2688"));
    shop.put("old.ep", ep_twill(profile));
    const Json answer = shop.json({"import", "old.ep", "--loom", loom("ep-2688"), "-o", "old.weave"});
    CHECK(answer.at("picks") == 14);
    CHECK(answer.at("ends") == 2400);
    CHECK(answer.at("warnings").empty());
    const Json document = *weave::parse_json(shop.get("old.weave"));
    CHECK(document.at("title") == "TWILL22");
    CHECK(document.at("weft").at("feeders").size() == 6);
    shop.must({"card", "old.weave", "-o", "old.png"});
    const CardImage card = weave::read_bitmap(shop.get("old.png"))->card;
    for (std::size_t pick = 0; pick < 14; ++pick)
        for (std::size_t end = 0; end < 2400; ++end)
            REQUIRE(card.weft_over(pick, end) == ((end + pick) % 4 >= 2));
    // It is known by what is in it, and groups as a bitmap does.
    shop.put("old.bin", shop.get("old.ep"));
    shop.must({"import", "old.bin", "--loom", loom("ep-2688"), "-o", "bin.weave", "--t", "2", "--p", "2"});
    CHECK_FALSE(shop.json({"import", "old.ep", "--loom", loom("ep-2688"), "--infer", "-o", "i.weave"})
                    .at("groupings")
                    .empty());
}

TEST_CASE("what is odd about a controller file is told, on standard error and in the answer") {
    const Workshop shop;
    std::string bytes = ep_twill(*weave::load_profile(loom("ep-2688")));
    bytes[20] = 7;
    bytes[34 + 340 + 4] = 1;  // pick 2: hook 1, which is cast out
    shop.put("odd.ep", bytes);
    const std::vector<std::string> words{"import", "odd.ep", "--loom", loom("ep-2688"), "-o", "odd.weave"};
    const auto lines = shop.run(words).complaints();
    REQUIRE(lines.size() == 2);
    CHECK_THAT(lines[0], Catch::Contains("odd.ep: byte 20: is 07, where 00 was observed"));
    CHECK_THAT(lines[1], Catch::Contains("odd.ep: pick 2: hook 1 is lifted, but is cast out"));
    const Json answer = shop.json(words);
    REQUIRE(answer.at("warnings").size() == 2);
    CHECK(answer.at("warnings")[0] == "byte 20: is 07, where 00 was observed; its meaning is not known");
}

TEST_CASE("a raw file is read where the loom's profile says raw, as wide as is said") {
    const Workshop shop;
    put_raw_loom(shop);
    shop.put("a.dat", std::string("\x01\x05\x04\x0a", 4));
    const Json answer = shop.json({"import", "a.dat", "--loom", "raw.json", "--ends", "4", "-o", "a.weave"});
    CHECK(answer.at("picks") == 2);
    CHECK(answer.at("ends") == 4);
    CHECK(answer.at("warnings").empty());
    CHECK(shop.json({"import", "a.dat", "--loom", "raw.json", "-o", "b.weave"}).at("warnings").size() == 1);
    CHECK(weave::parse_json(shop.get("a.weave"))->at("title") == "a");
    shop.refused({"import", "a.dat", "--loom", loom("ep-2688"), "-o", "new.weave"}, 3,
                 {"a.dat", "neither", "raw"});
    shop.refused({"import", "a.dat", "-o", "new.weave"}, 3, {"a.dat", "--loom"});
    shop.refused({"import", "a.dat", "--loom", "raw.json", "--ends", "9", "-o", "new.weave"}, 3,
                 {"a.dat", "8 ends"});
    shop.put("a.ep", shop.get("a.dat"));
    shop.refused({"import", "a.ep", "--loom", "raw.json", "-o", "new.weave"}, 3, {"a.ep", "EP", "raw"});
}

TEST_CASE("controller files that cannot be read are refused with file and byte") {
    const Workshop shop;
    const std::string bytes = ep_twill(*weave::load_profile(loom("ep-2688")));
    shop.put("old.ep", bytes);
    shop.put("cut.ep", bytes.substr(0, 5000));
    shop.put("cut.jc5", std::string("\x81\xfe\x01\x01\0\0", 6));
    shop.refused({"import", "cut.ep", "--loom", loom("ep-2688"), "-o", "new.weave"}, 3,
                 {"cut.ep", "byte 5000"});
    shop.refused({"import", "cut.jc5", "--loom", loom("jc5-5120"), "-o", "new.weave"}, 3,
                 {"cut.jc5", "byte 4"});
    shop.refused({"import", "old.ep", "--loom", loom("ep-5376"), "-o", "new.weave"}, 3,
                 {"old.ep", "byte 32", "5376"});
    shop.refused({"import", "old.ep", "--loom", loom("jc5-5120"), "-o", "new.weave"}, 3,
                 {"old.ep", "EP", "JC5"});
    shop.refused({"import", "old.ep", "--loom", loom("tc2"), "-o", "new.weave"}, 3, {"old.ep", "picture"});
    shop.refused({"import", "old.ep", "--loom", "none.json", "-o", "new.weave"}, 3, {"none.json"});
    shop.refused({"import", "old.ep", "-o", "new.weave"}, 2, {"old.ep", "EP", "--loom"});
    shop.refused({"import", "cut.jc5", "-o", "new.weave"}, 2, {"cut.jc5", "JC5", "--loom"});
    shop.refused({"import", "old.ep", "--loom", loom("ep-2688"), "--lifted", "white", "-o", "new.weave"}, 2,
                 {"--lifted", "pictures"});
    shop.refused({"import", "old.ep", "--ends", "4", "-o", "new.weave"}, 2, {"--ends", "--loom"});
    put_raw_loom(shop);
    shop.refused({"import", "old.ep", "--loom", "raw.json", "-o", "raw.json"}, 2, {"raw.json", "profile"});
}
