// Loom profiles: the shipped ones load and say what was observed; every member is refused when it is wrong.

#include "../support/random.hpp"

#include <weave/core/file.hpp>
#include <weave/core/json.hpp>
#include <weave/loom/profile.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::string shipped(const std::string& name) {
    return std::string(WEAVE_SOURCE_DIR) + "/db/looms/" + name + ".json";
}

/// A profile that has every member.
Json full() {
    return Json::parse(
        R"({"format":"weave-loom","version":1,"name":"n","maker":"m","revision":"3","notes":"x",
        "insertion":"rapier","density_ends_per_cm":20,
        "hooks":{"areas":[{"name":"a","hooks":20}],"rule":"repeats","repeats":2,"body":[[0,9]],"cast_out":[[10,10]],
            "constant_on":[[11,11]],"selvedge":[[12,13]],"selvedge_weave":["01","10"],"regulator":[14]},
        "feeders":{"count":2,"encoding":"hooks","places":[15,16],"per_pick":2},
        "file":{"output":"raw","lifted_is_one":false,"least_bit_first":false,"pick_1_at_bottom":false,"end_1_at_left":false,
            "name_limit":5,"lead_in_picks":4,"function_bytes":2,"areas_on_bytes":false,"converts_to":"","hook_permutation":[19,18,17,16,15,14,13,12,11,10,9,8,7,6,5,4,3,2,1,0]},
        "limits":{"float_face":1,"float_back":2,"lift_difference":0.5,"lift_share":0.6,"picks":7,"take_up_difference":0.1,
            "reed_width_mm":900},
        "severities":{"float.face":"error"}})");
}

}  // namespace

TEST_CASE("the shipped profiles load and carry the ends that were observed") {
    const auto tc2 = load_profile(shipped("tc2")), small = load_profile(shipped("ep-2688"));
    const auto large = load_profile(shipped("ep-5376")), jc5 = load_profile(shipped("jc5-5120"));
    REQUIRE(tc2);
    REQUIRE(small);
    REQUIRE(large);
    REQUIRE(jc5);
    const auto raw = load_profile(shipped("raw-14x192"));
    REQUIRE(raw);
    CHECK(most_ends(*raw) == 2400);
    CHECK_FALSE(raw->lifted_is_one);
    CHECK(most_ends(*tc2) == 1320);
    CHECK(most_ends(*small) == 2400);
    CHECK(most_ends(*large) == 4800);
    CHECK(most_ends(*jc5) == 4800);
    CHECK(jc5->total_hooks == 5120);
    CHECK(hooks_of_end(*small, 0, 2400) == std::vector<std::size_t>{144});
    CHECK(hooks_of_end(*small, 2399, 2400) == std::vector<std::size_t>{2543});
    const auto uses = hook_uses(*small);
    CHECK(uses[53] == HookUse::cast_out);
    CHECK(uses[54] == HookUse::constant_on);
    CHECK(uses[56] == HookUse::selvedge);
    CHECK(uses[143] == HookUse::cast_out);
    CHECK(uses[2631] == HookUse::selvedge);
    CHECK(uses[2632] == HookUse::cast_out);
    CHECK(small->sha256.size() == 64);
}

TEST_CASE("hooks of an end by rule") {
    LoomProfile profile;
    profile.total_hooks = 12;
    profile.body = {{1, 3}, {6, 8}};
    CHECK(hooks_of_end(profile, 3, 6) == std::vector<std::size_t>{6});
    CHECK(hooks_of_end(profile, 0, 7).empty());
    profile.hook_rule = HookRule::point;
    CHECK(most_ends(profile) == 3);
    CHECK(hooks_of_end(profile, 0, 3) == std::vector<std::size_t>{1, 7});
    CHECK(hooks_of_end(profile, 2, 3) == std::vector<std::size_t>{3});
    profile.hook_rule = HookRule::repeats;
    profile.repeats = 2;
    CHECK(hooks_of_end(profile, 1, 3) == std::vector<std::size_t>{2, 7});
    profile.hook_rule = HookRule::list;
    profile.hook_of_end = {9, 4};
    CHECK(hooks_of_end(profile, 1, 2) == std::vector<std::size_t>{4});
}

TEST_CASE("a full profile is read to the last member") {
    const auto profile = read_profile(full().dump());
    REQUIRE(profile);
    CHECK(profile->version == "3");
    CHECK(profile->repeats == 2);
    CHECK(profile->feeder_hooks == std::vector<std::size_t>{15, 16});
    CHECK_FALSE(profile->lifted_is_one);
    CHECK(profile->hook_permutation.size() == 20);
    CHECK(profile->function_bytes == 2);
    CHECK_FALSE(profile->areas_on_bytes);
    CHECK(profile->limits.picks == 7);
    CHECK(profile->severities.at("float.face") == Severity::error);
}

TEST_CASE("every member is refused when it has the wrong kind, and what is unknown is refused by name") {
    const Json flat = full().flatten();
    for (auto it = flat.begin(); it != flat.end(); ++it) {
        Json broken = full();
        const Json::json_pointer place(it.key());
        broken[place] = Json::object();
        INFO(it.key());
        const auto read = read_profile(broken.dump());
        REQUIRE_FALSE(read);
        CHECK_FALSE(read.error().where.empty());
    }
    for (const char* object :
         {"", "/hooks", "/hooks/areas/0", "/feeders", "/file", "/limits", "/severities"}) {
        Json broken = full();
        broken[Json::json_pointer(object)]["surprise"] = 1;
        INFO(object);
        const auto read = read_profile(broken.dump());
        REQUIRE_FALSE(read);
        CHECK(read.error().where.find("surprise") != std::string::npos);
    }
}

TEST_CASE("a file of another kind is told for what it is") {
    const auto told = [](std::string_view text) { return read_profile(text).error().text(); };
    CHECK(told("\x89PNG\r\n") == "is no profile of a loom, which would begin with {");
    CHECK(told(R"({"format": "weave", "version": 1})") == "is a design, no profile of a loom");
    CHECK(told(R"({"format": "trust"})") == "format: must be weave-loom, as a profile of a loom has it");
    CHECK_THAT(told("{\"format\": "), Catch::Contains("is not JSON: line 1"));
}

TEST_CASE("values out of range or at odds with each other are refused") {
    const std::vector<std::pair<std::string, std::string>> wrong{{"/version", "2"},
                                                                 {"/format", "\"weave\""},
                                                                 {"/name", "\"\""},
                                                                 {"/insertion", "\"needle\""},
                                                                 {"/hooks/areas", "[]"},
                                                                 {"/hooks/areas/0/hooks", "65537"},
                                                                 {"/hooks/body", "[[5,4]]"},
                                                                 {"/hooks/body", "[[0,20]]"},
                                                                 {"/hooks/body", "[[0,10]]"},
                                                                 {"/hooks/body", "[[0,5],[5,9]]"},
                                                                 {"/hooks/body", "[]"},
                                                                 {"/hooks/body", "[[0]]"},
                                                                 {"/hooks/body", "[[-1,3]]"},
                                                                 {"/hooks/repeats", "11"},
                                                                 {"/hooks/selvedge_weave", "[\"01\",\"1\"]"},
                                                                 {"/hooks/selvedge_weave", "[\"02\"]"},
                                                                 {"/hooks/regulator", "[20]"},
                                                                 {"/hooks/regulator", "[13]"},
                                                                 {"/feeders/count", "65"},
                                                                 {"/feeders/places", "[15]"},
                                                                 {"/feeders/places", "[15,15]"},
                                                                 {"/feeders/per_pick", "3"},
                                                                 {"/file/output", "\"jc6\""},
                                                                 {"/file/hook_permutation", "[0,1]"},
                                                                 {"/file/name_limit", "-1"},
                                                                 {"/file/function_bytes", "9"},
                                                                 {"/file/converts_to", "\"JC6\""},
                                                                 {"/file/output", "\"jc5\""},
                                                                 {"/file/output", "\"png\""},
                                                                 {"/limits/lift_share", "1.5"},
                                                                 {"/limits/reed_width_mm", "0"},
                                                                 {"/severities/float.face", "\"fatal\""}};
    for (const auto& [place, value] : wrong) {
        Json broken = full();
        broken[Json::json_pointer(place)] = Json::parse(value);
        INFO(place << " = " << value);
        CHECK_FALSE(read_profile(broken.dump()));
    }
}

TEST_CASE("function bits must be in the file; pictures have none, but may be for a mill's CAD") {
    Json profile = full();
    profile["feeders"] = {{"count", 17}, {"encoding", "one-hot"}};
    const auto refused = read_profile(profile.dump());
    REQUIRE_FALSE(refused);
    CHECK(refused.error().text().find("function bit 16, but the file has 2 function bytes") !=
          std::string::npos);
    profile["file"]["function_bytes"] = 3;
    CHECK(read_profile(profile.dump()));
    profile["file"]["output"] = "ep";
    profile["file"].erase("function_bytes");
    CHECK(read_profile(profile.dump())->function_bytes == 4);
    profile["file"]["output"] = "tiff";
    CHECK_FALSE(read_profile(profile.dump()));  // lead-in picks
    profile["file"]["lead_in_picks"] = 0;
    profile["file"]["converts_to"] = "JC6";
    const auto read = read_profile(profile.dump());
    REQUIRE(read);
    CHECK(read->converts_to == "JC6");
    CHECK(read->function_bytes == 0);
    CHECK(takes_picture(read->output));
}

TEST_CASE("feeders as a number among the hooks take as many hooks as the number has digits") {
    Json profile = full();
    profile["feeders"] = {{"count", 3}, {"encoding", "binary-hooks"}, {"places", {15, 16}}};
    const auto read = read_profile(profile.dump());
    REQUIRE(read);
    CHECK(feeders_in_hooks(*read));
    CHECK(hook_uses(*read)[16] == HookUse::feeder);
    profile["feeders"]["places"] = {14, 16};
    CHECK_FALSE(read_profile(profile.dump()));  // 14 stops the take-up
    profile["feeders"]["count"] = 4;
    profile["feeders"]["places"] = {15, 16};
    CHECK_FALSE(read_profile(profile.dump()));
}

TEST_CASE("where end 1 is not at the left the ends count down through the body") {
    LoomProfile profile;
    profile.total_hooks = 12;
    profile.body = {{1, 3}, {6, 8}};
    profile.end_1_at_left = false;
    CHECK(hooks_of_end(profile, 0, 4) == std::vector<std::size_t>{8});
    CHECK(hooks_of_end(profile, 3, 4) == std::vector<std::size_t>{3});
    CHECK(hooks_of_end(profile, 0, 7).empty());
    profile.hook_rule = HookRule::list;
    profile.hook_of_end = {9, 4};
    CHECK(hooks_of_end(profile, 0, 2) == std::vector<std::size_t>{9});
}

TEST_CASE("garbage is refused, never more") {
    const std::string sound = full().dump();
    for_all(
        [&](Random& random) {
            std::string text = sound;
            for (std::size_t k = random.between(1, 4); k > 0; --k) {
                const std::size_t at = random.between(0, text.size() - 1);
                if (random.coin())
                    text[at] = static_cast<char>(random.between(0, 255));
                else
                    text.erase(at, random.between(1, 20));
                if (text.empty()) return;
            }
            const auto read = read_profile(text);
            if (!read) CHECK_FALSE(read.error().message.empty());
        },
        property_cases());
    CHECK_FALSE(read_profile(""));
    CHECK_FALSE(load_profile("no/such/file.json"));
}
