// Benchmarks of the simulator through the program, made short.

#include "run.hpp"

using program_tests::Ended;
using program_tests::Workshop;
using weave::Json;

TEST_CASE("bench tradeoff measures a structure, keeps it, and goes on from what it has") {
    const Workshop shop;
    const Json said =
        shop.json({"bench", "tradeoff", "--only", "plain-pinned", "--seconds", "0.5", "-o", "kept"});
    REQUIRE(said.at("structures").size() == 1);
    const Json& one = said.at("structures").at(0);
    CHECK(one.at("name") == "plain-pinned");
    CHECK(one.at("runs").size() == 9);
    CHECK(one.at("sweep").size() == 9);
    CHECK(one.at("machine").at("cores").get<int>() >= 1);
    for (const Json& run : one.at("runs")) {
        for (const char* key : {"fidelity", "solver", "start", "points", "steps", "seconds_to", "peak_bytes",
                                "errors", "lost_crossings"}) {
            INFO(key);
            CHECK(run.contains(key));
        }
    }
    CHECK(one.at("reference").at("points").get<double>() > 3.5 * one.at("standard_points").get<double>());
    CHECK(one.at("ratios").contains("1e-03"));
    CHECK(shop.get("kept/tradeoff.md").find("plain-pinned") != std::string::npos);
    CHECK(shop.get("kept/tradeoff.svg").find("<svg") != std::string::npos);

    // What is kept is told again without being measured.
    const std::string before = shop.get("kept/tradeoff-plain-pinned.json");
    const Json again = shop.json({"bench", "tradeoff", "--only", "plain-pinned", "--missing", "-o", "kept"});
    CHECK(again.at("structures").at(0) == one);
    CHECK(shop.get("kept/tradeoff-plain-pinned.json") == before);
    shop.put("kept/tradeoff-pocket.json", "{}");
    const Ended spoilt = shop.run({"bench", "tradeoff", "--only", "plain-pinned", "--missing", "-o", "kept"});
    CHECK(spoilt.exit == 3);
    CHECK(spoilt.err.find("tradeoff-pocket.json") != std::string::npos);
}

TEST_CASE("bench scale measures sizes from the least to the most and fits exponents") {
    const Workshop shop;
    const Json said = shop.json({"bench", "scale", "--most", "6000", "--residual", "10", "-o", "kept"});
    REQUIRE(said.at("sizes").size() == 3);
    double points = 0;
    for (const Json& size : said.at("sizes")) {
        CHECK(size.at("points").get<double>() > points);
        points = size.at("points");
        CHECK(size.at("peak_bytes").get<double>() > 0);
    }
    CHECK(said.contains("exponent_time"));
    CHECK(shop.get("kept/scale.md").find("Bytes a point") != std::string::npos);
    CHECK(Json::parse(shop.get("kept/scale.json")) == said);
}

TEST_CASE("bench tells what it does not know") {
    const Workshop shop;
    const auto refused = [&](const std::vector<std::string>& words, const std::string& reason) {
        const Ended ended = shop.run(words);
        INFO(ended.err);
        CHECK(ended.exit == 2);
        CHECK(ended.err.find(reason) != std::string::npos);
    };
    refused({"bench"}, "--help");
    refused({"bench", "tradeoff", "--only", "jersey"}, "there is no structure 'jersey'");
    refused({"bench", "scale", "--seconds", "-1"}, "--seconds");
}

TEST_CASE("simulate takes the paper's solver, and knows no other") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const Json said =
        shop.json({"simulate", "d.weave", "-o", "d.yarns", "--solver", "paper", "--threads", "1"});
    CHECK(said.at("solver") == "paper");
    CHECK(said.at("converged") == true);
    CHECK(said.at("order_kept") == true);
    CHECK(said.at("iterations").get<std::size_t>() > 50);
    const Ended ended = shop.run({"simulate", "d.weave", "-o", "d.yarns", "--solver", "magic"});
    CHECK(ended.exit == 2);
    CHECK(ended.err.find("relax or paper") != std::string::npos);
}
