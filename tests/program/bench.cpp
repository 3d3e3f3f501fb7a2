// Benchmarks of the simulator through the program, made short.

#include "run.hpp"

#include <cmath>
#include <csignal>

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
    CHECK(one.at("runs").size() == 12);
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
    CHECK(shop.get("kept/tradeoff-thickness.svg").find("<svg") != std::string::npos);

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

TEST_CASE("bench tradeoff measures any sample, and tells the errors of a fidelity apart") {
    const Workshop shop;
    const Json said = shop.json({"bench", "tradeoff", "--only", "rib", "--only", "basket", "--seconds", "5", "--threads", "1", "-o", "kept"});
    REQUIRE(said.at("structures").size() == 2);
    CHECK(said.at("structures").at(0).at("name") == "rib");
    for (const Json& one : said.at("structures")) {
        INFO(one.at("name"));
        CHECK(one.at("reference").at("residual").get<double>() <= 1e-8);
        for (const Json& run : one.at("runs")) {
            if (run.at("solver") != "relax") continue;
            INFO(run.at("fidelity") << " from " << run.at("start"));
            REQUIRE(run.at("ending") == "converged");
            // A few times what is measured: in so few points a draft errs by hundredths of a point, the others by thousandths.
            CHECK(std::abs(run.at("end").at("crimp_warp_pp").get<double>()) < (run.at("fidelity") == "draft" ? 0.2 : 0.05));
            // To 1e-8 it ends where it ends; its goal is not far from there.
            const double left = std::abs(run.at("end").at("to_its_end").at("crimp_warp_pp").get<double>());
            CHECK(left < (run.at("start") == "raw" ? 1e-9 : 0.05));
        }
    }
    const std::string table = shop.get("kept/tradeoff.md");
    for (const char* row : {"| reference | points alone | 2 |", "| reference | as one gets it | 2 |", "| reference | from the plan | 2 |", "| draft | stopped at its goal | 2 |", "| rib | 64 |", "In the median over these cloths `standard` takes "})
        CHECK(table.find(row) != std::string::npos);
}

TEST_CASE("a structure that comes to no rest is measured as far as it comes, and said to be none to measure against") {
    const Workshop shop;
    const Json said = shop.json({"bench", "tradeoff", "--only", "satin-e", "--seconds", "1e-3", "--threads", "1", "-o", "kept"});
    const Json& one = said.at("structures").at(0);
    CHECK(one.at("runs").size() == 6);
    CHECK(one.at("basins").at("comparable") == false);
    CHECK(one.at("ratios").at("1e-03").at("ratio").is_null());
    CHECK(shop.get("kept/tradeoff.md").find(": not at rest |") != std::string::npos);
}

TEST_CASE("bench savings: what is left out of a scene changes no result, and the table says what it saves") {
    // How far apart the results may lie, in radii: some times as far as they do, and nothing where nothing is computed otherwise.
    const std::vector<std::pair<std::string, double>> apart{{"repeat", 1e-6}, {"repeat-satin", 0.05}, {"yarns", 1e-6}, {"radii", 1e-7}, {"pins", 0}, {"fields", 0},
                                                            {"gravity", 0}, {"friction", 1e-6}, {"transition", 0.1}, {"periods", 0.01}, {"balance", 1e-4}};
    std::vector<std::string> words{"bench", "savings", "--threads", "1", "-o", "kept"};
    for (const auto& [name, most] : apart) words.insert(words.end(), {"--only", name});
    const Workshop shop;
    const Json said = shop.json(words);
    CHECK(said.at("bad") == 0);
    REQUIRE(said.at("savings").size() == apart.size());
    for (std::size_t k = 0; k < apart.size(); ++k) {
        const Json &saving = said.at("savings").at(k), &left_out = saving.at("left_out"), &with_it = saving.at("with_it");
        INFO(saving.dump());
        CHECK(saving.at("fault") == "");
        CHECK(left_out.at("at_rest") == true);
        CHECK(with_it.at("at_rest") == true);
        CHECK(saving.at("apart_radii").get<double>() <= apart[k].second);
        CHECK(with_it.at("points").get<int>() >= left_out.at("points").get<int>());
        CHECK(saving.at("ratio").get<double>() == Approx(with_it.at("seconds").get<double>() / left_out.at("seconds").get<double>()));
    }
    CHECK(said.at("savings").at(0).at("with_it").at("points") == 16 * said.at("savings").at(0).at("left_out").at("points").get<int>());
    CHECK(Json::parse(shop.get("kept/savings.json")) == said);
    CHECK(shop.get("kept/savings.md").find("| friction | herringbone |") != std::string::npos);
}

TEST_CASE("bench savings: a part of a cloth has nearly its crimp, and loose ends cost their points", "[.][long]") {
    const Workshop shop;
    const Json said = shop.json({"bench", "savings", "--threads", "1", "--seconds", "600", "--only", "region", "--only", "yarns-i-beam"});
    CHECK(said.at("bad") == 0);
    const Json &beam = said.at("savings").at(1), &part = said.at("savings").at(0);
    CHECK(part.at("term") == "region");
    CHECK(part.at("crimp_apart_pp").get<double>() < 0.5);
    CHECK(part.at("with_it").at("points").get<int>() > 3 * part.at("left_out").at("points").get<int>());
    CHECK(beam.at("apart_radii").is_null());  // neither is at rest
    CHECK(beam.at("with_it").at("steps") == 100);
    CHECK(beam.at("with_it").at("points").get<int>() - beam.at("left_out").at("points").get<int>() == 80 * 16);
}

TEST_CASE("bench savings says where both runs cannot be compared") {
    const Workshop shop;
    const Json said = shop.json({"bench", "savings", "--threads", "1", "--seconds", "1e-3", "--only", "friction"}, 1);
    CHECK(said.at("bad") == 1);
    CHECK(said.at("savings").at(0).at("fault") == "not both at rest");
}

TEST_CASE("bench stability keeps what became of each extreme, and what each was") {
    const Workshop shop;
    const Json said = shop.json({"bench", "stability", "--threads", "1", "--seconds", "600", "-o", "kept"});
    CHECK(said.at("bad") == 0);
    const std::string table = shop.get("kept/stability.md");
    for (const Json& one : said.at("cases")) {
        INFO(one.at("name"));
        CHECK(one.at("good") == true);
        CHECK_FALSE(one.at("about").get<std::string>().empty());
        CHECK(table.find("| " + one.at("name").get<std::string>() + " | ") != std::string::npos);
    }
    CHECK(Json::parse(shop.get("kept/stability.json")) == said);
}

TEST_CASE("bench scale measures sizes from the least to the most and fits exponents") {
    const Workshop shop;
    const Json said = shop.json({"bench", "scale", "--most", "6000", "--residual", "1e-2", "--threads", "1", "-o", "kept"});
    REQUIRE(said.at("sizes").size() == 3);
    CHECK(said.at("asked_points") == Json({500, 1581, 5000}));
    CHECK_FALSE(said.contains("interrupted"));
    double points = 0;
    for (const Json& size : said.at("sizes")) {
        CHECK(size.at("points").get<double>() > points);
        points = size.at("points");
        CHECK(size.at("converged") == true);
        CHECK(size.at("residual").get<double>() <= 1e-2);
        CHECK(size.at("lost_crossings") == 0);
        CHECK(size.at("steps").get<int>() > 0);
        CHECK(size.at("seconds").get<double>() > 0);
        CHECK(size.at("us_a_point").get<double>() == Approx(1e6 * size.at("seconds").get<double>() / points));
        CHECK(size.at("peak_bytes").get<double>() > 0);
    }
    CHECK(std::abs(said.at("sizes").back().at("points").get<double>() - 5000) <= 0.5 * said.at("cell_points").get<double>());
    for (const char* exponent : {"exponent_time", "exponent_memory", "exponent_steps"}) {
        INFO(exponent);
        CHECK(std::isfinite(said.at(exponent).get<double>()));
    }
    CHECK(said.at("exponent_time").get<double>() > 0);
    const std::string table = shop.get("kept/scale.md");
    CHECK(table.find("Bytes a point") != std::string::npos);
    CHECK(table.find("one repeat, has 800 points: it stands for the 500 asked for") != std::string::npos);
    CHECK(Json::parse(shop.get("kept/scale.json")) == said);
}

TEST_CASE("bench scale says that its last size did not come to rest, and fits nothing to it") {
    const Workshop shop;
    const Json said = shop.json({"bench", "scale", "--most", "6000", "--residual", "1e-12", "--seconds", "1e-3", "-o", "kept"});
    REQUIRE(said.at("sizes").size() == 1);
    CHECK(said.at("sizes").at(0).at("converged") == false);
    CHECK(said.at("exponent_time").is_null());
    CHECK(shop.get("kept/scale.md").find("The last did not come to rest in its time") != std::string::npos);
}

TEST_CASE("an interrupted benchmark says how much of what was asked for is done, and spoils no whole table") {
    const Workshop shop;
    const auto interrupted = [&](std::vector<std::string> words, const std::string& when) {
        words.insert(words.end(), {"--threads", "1", "--json"});
        Workshop::Running running = shop.start(words);
        REQUIRE(running.says(when));
        ::kill(running.child, SIGINT);
        const Ended ended = running.finish();
        INFO(ended.err);
        CHECK(ended.exit == 1);
        CHECK(ended.err.find("weave: interrupted: ") != std::string::npos);
        Json said = Json::parse(ended.out);
        CHECK(said.at("interrupted") == true);
        CHECK(said.at("done").get<int>() < said.at("asked").get<int>());
        return said;
    };
    std::filesystem::create_directory(shop.path("kept"));  // with tables of whole runs
    shop.put("kept/stability.md", "whole");
    const Json cases = interrupted({"bench", "stability", "-o", "kept"}, "stability: ");
    CHECK(cases.at("done") == cases.at("cases").size());
    CHECK(cases.at("asked").get<int>() >= 30);
    CHECK(shop.get("kept/stability.md") == "whole");
    CHECK_FALSE(shop.has("kept/stability.json"));
    shop.put("kept/savings.md", "whole");
    const Json savings = interrupted({"bench", "savings", "-o", "kept"}, "savings: ");
    CHECK(savings.at("done") == savings.at("savings").size());
    CHECK(shop.get("kept/savings.md") == "whole");

    shop.put("kept/scale.json", "whole");
    shop.put("kept/scale.md", "whole");
    const Json sizes = interrupted({"bench", "scale", "-o", "kept"}, "some 1581 points");
    CHECK(sizes.at("asked") == 7);
    CHECK(sizes.at("done") == sizes.at("sizes").size());
    CHECK(sizes.at("done").get<int>() >= 1);
    CHECK(shop.get("kept/scale.json") == "whole");
    CHECK(shop.get("kept/scale.md") == "whole");

    REQUIRE(shop.run({"bench", "tradeoff", "--only", "plain-pinned", "--seconds", "0.2", "--threads", "1", "-o", "kept"}).exit == 0);
    Json other = Json::parse(shop.get("kept/tradeoff-plain-pinned.json"));
    other["name"] = "satin-e";
    shop.put("kept/tradeoff-satin-e.json", other.dump());
    REQUIRE(shop.run({"bench", "tradeoff", "--only", "plain-pinned", "--missing", "-o", "kept"}).exit == 0);
    const std::string table = shop.get("kept/tradeoff.md");
    REQUIRE(table.find("satin-e") != std::string::npos);
    REQUIRE(table.find("plain-pinned") != std::string::npos);
    const Json structures = interrupted({"bench", "tradeoff", "--only", "satin-e", "-o", "kept"}, "draft, relax");
    CHECK(structures.at("done") == 0);
    CHECK(structures.at("asked") == 1);
    CHECK(shop.get("kept/tradeoff.md") == table);
    CHECK(Json::parse(shop.get("kept/tradeoff-satin-e.json")) == other);
}

TEST_CASE("a second signal ends a benchmark at once, unless it comes right after the first") {
    const Workshop shop;
    // Planning a million points goes on for seconds without looking whether it is to stop.
    Workshop::Running running = shop.start({"bench", "scale", "--least", "1000000", "--threads", "1", "-o", "kept"});
    REQUIRE(running.says("some 1000000 points"));
    ::kill(running.child, SIGINT);
    REQUIRE(running.says("weave: interrupted: "));
    ::usleep(20'000);
    ::kill(running.child, SIGINT);
    ::usleep(200'000);
    CHECK_FALSE(running.is_over());
    ::usleep(400'000);
    ::kill(running.child, SIGINT);
    CHECK(running.finish().exit == 1000 + SIGINT);
    CHECK(shop.names().empty());
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
    refused({"bench", "scale", "--least", "5", "--most", "1"}, "--most 1: is less than --least 5");
    refused({"bench", "scale", "--most", "0"}, "--most 0");
    refused({"bench", "scale", "--least", "0"}, "--least 0");
    refused({"bench", "scale", "--most", "600"}, "--most 600: the smallest cloth, one repeat, has 800 points");
    refused({"bench", "tradeoff", "--missing"}, "--missing");
    refused({"bench", "savings", "--only", "twist"}, "there is no term 'twist'; there are repeat, ");
    for (const char* part : {"tradeoff", "scale", "stability", "savings"}) refused({"bench", part, "--threads", "1025"}, "--threads");
    CHECK(shop.must({"bench", "tradeoff", "--help"}).out.find("plain-pinned") != std::string::npos);
    CHECK(shop.must({"bench", "scale", "--help"}).out.find("Ctrl-C") != std::string::npos);
}

TEST_CASE("a place that no benchmark can write to is told before anything is measured") {
    const Workshop shop;
    shop.put("taken", "a file");
    for (const char* part : {"tradeoff", "scale", "stability", "savings"}) {
        const Ended ended = shop.run({"bench", part, "-o", "taken/inside"});
        INFO(part << ": " << ended.err);
        CHECK(ended.exit == 5);
        CHECK(ended.out.empty());
        CHECK(ended.err.find("taken/inside: ") != std::string::npos);
        CHECK(ended.err.find(part + std::string(": ")) == std::string::npos);  // as what is being measured is told
    }
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
