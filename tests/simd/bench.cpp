// The benchmarks of simd, made short: they measure what they say, and tell what they do not know.

#include <weave/core/instrumented.hpp>
#include <weave/core/json.hpp>

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <support/program.hpp>
#include <support/temporary_folder.hpp>

using namespace weave;

namespace {

struct Said {
    int exit = 0;
    std::string out, err;
};

Said bench(std::vector<std::string> words) {
    const weave::testing::TemporaryFolder folder;
    const std::string told = (folder.path / "told").string();
    Said said;
    weave::testing::Program program("weave_bench", std::move(words), told);
    for (std::string line = program.line(); !line.empty(); line = program.line()) said.out += line + "\n";
    said.exit = program.exit_code();
    std::ifstream file(told);
    said.err.assign(std::istreambuf_iterator<char>(file), {});
    return said;
}

Json measured(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Said said = bench(std::move(words));
    INFO(said.err);
    REQUIRE(said.exit == 0);
    return parse_json(said.out).value();
}

void check_spread(const Json& spread, std::size_t count) {
    CHECK(spread.at("count") == count);
    CHECK(spread.at("p50_ms").get<double>() > 0);
    CHECK(spread.at("p50_ms") <= spread.at("p99_ms"));
    CHECK(spread.at("p99_ms") <= spread.at("max_ms"));
}

}  // namespace

TEST_CASE("bench simd-latency times every change, flip and cancelled job that it was asked for") {
    const Json said = measured({"simd-latency", "--points", "100", "--changes", "4", "--flips", "2", "--cancels", "2", "--threads", "1"});
    REQUIRE(said.at("sizes").size() == 1);
    const Json& size = said.at("sizes").at(0);
    CHECK(size.at("points").get<int>() >= 100);
    for (const char* way : {"tcp", "unix"}) {
        for (const char* what : {"accepted", "applied", "shown"}) check_spread(size.at(way).at(what), 4);
        CHECK(size.at(way).at("applied").at("max_ms") <= size.at(way).at("shown").at("max_ms"));
    }
    check_spread(size.at("flip").at("accepted"), 2);
    check_spread(size.at("cancel").at("ended"), 2);
    CHECK(said.at("before").at("cores").get<int>() >= 1);
    CHECK(said.at("after").at("load").get<double>() >= 0);
}

TEST_CASE("bench simd-sessions measures a crowd with and without trouble") {
    const Json said = measured({"simd-sessions", "--sessions", "3", "--points", "100", "--seconds", is_instrumented ? "20" : "2", "--rounds", "1", "--threads", "1"});
    REQUIRE(said.at("side_by_side").size() == 2);
    CHECK(said.at("side_by_side").at(0).at("sessions") == 1);
    CHECK(said.at("side_by_side").at(1).at("sessions") == 3);
    const Json& trouble = said.at("trouble");
    CHECK(trouble.at("others") == 1);
    CHECK(trouble.at("stretches").size() == 2);
    CHECK(trouble.at("hostile_messages").get<int>() > 0);
    CHECK(trouble.at("kills").get<int>() > 0);
}

TEST_CASE("bench simd-frames compares frames with the yarns themselves") {
    const Json said = measured({"simd-frames", "--sample", "layer-to-layer"});
    REQUIRE(said.at("samples").size() == 1);
    for (const char* kind : {"moving", "resting"}) {
        const Json& frames = said.at("samples").at(0).at(kind);
        CHECK(frames.at("frames").get<int>() >= 1);
        CHECK(frames.at("bytes_a_point").get<double>() > 0);
        CHECK(frames.at("greatest_error_radii").get<double>() > 0);
        CHECK(frames.at("greatest_error_radii").get<double>() <= 1.0 / 50);
    }
}

TEST_CASE("bench simd-recovery kills workers and the daemon, and sees sessions go on") {
    const Json said = measured({"simd-recovery", "--sessions", "2", "--points", "100", "--kills", "2", "--restarts", "1", "--seconds", "0", "--threads", "1"});
    const Json& faults = said.at("workers").at("faults");
    REQUIRE(faults.size() == 2);
    for (const Json& fault : faults) {
        CHECK(fault.at("recovered_s").get<double>() > 0);
        CHECK(fault.at("recovered_s") <= fault.at("moved_s"));
        CHECK(fault.at("checkpoint_age_s").get<double>() >= 0);
    }
    REQUIRE(said.at("daemon").at("restarts").size() == 1);
    CHECK(said.at("daemon").at("restarts").at(0).at("serves_s") <= said.at("daemon").at("restarts").at(0).at("all_go_on_s"));
}

TEST_CASE("benchmarks of simd refuse what they do not know, and explain themselves") {
    for (const auto& words : std::vector<std::vector<std::string>>{{"simd-weaving"},
                                                                   {"simd-latency", "--changes", "0"},
                                                                   {"simd-latency", "--points", "none"},
                                                                   {"simd-sessions", "--sessions", "201"},
                                                                   {"simd-sessions", "--seconds", "-1"},
                                                                   {"simd-frames", "--sample", "jersey"},
                                                                   {"simd-recovery", "--kills", "0"},
                                                                   {"shoe", "--points", "5"}}) {
        INFO(words.front() << " " << words.back());
        const Said said = bench(words);
        CHECK(said.exit == 2);
        CHECK_FALSE(said.err.empty());
    }
    for (const char* name : {"simd-latency", "simd-sessions", "simd-frames", "simd-recovery"}) {
        INFO(name);
        const Said said = bench({name, "--help"});
        CHECK(said.exit == 0);
    }
    CHECK(bench({}).out.find("simd-recovery") != std::string::npos);
}
