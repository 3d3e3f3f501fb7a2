// A client in Python, written from PROTOCOL.md alone, on a daemon as it runs: it sees what C++ sees of the same design.
// Hidden, because it needs python3: tests/simd/follow, which CTest runs, looks for that first.

#include "box.hpp"

#include <weave/sim/yarns_file.hpp>

#include <array>
#include <cmath>
#include <cstdio>

using namespace weave;
using namespace weave::simd::testing;

namespace {

const char* const cloth = "layer-to-layer";

/// What a command prints, and its exit status.
std::pair<std::string, int> run(const std::string& command) {
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), size);
    const int status = ::pclose(pipe);
    return {text, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

std::string in_quotes(const std::filesystem::path& path) {
    return "'" + path.string() + "'";
}

/// The script on this place, with these further words; errors come with what it prints.
std::pair<std::string, int> follow(const Box& box, const std::string& place, const std::string& words = "") {
    const auto design = box.config_file().parent_path() / "design.weave";
    std::ofstream(design) << document_of(cloth);
    return run("PYTHONDONTWRITEBYTECODE=1 python3 " + in_quotes(std::filesystem::path(WEAVE_SOURCE_DIR) / "tests/simd/follow_live.py") + " " + in_quotes(place) +
               " " + in_quotes(design) + " " + words + " 2>&1");
}

Json seen_at(const Box& box, const std::string& place, const std::string& words = "") {
    const auto [text, status] = follow(box, place, words);
    INFO(text << "; told: " << box.told());
    REQUIRE(status == 0);
    return parse_json(text).value();
}

/// A shown state as the script tells it.
Json shown(const wire::Frame& frame) {
    Json points = Json::array();
    std::size_t first = 0;
    for (const std::uint32_t count : frame.counts) {
        Json point = Json::array();
        for (const double place_mm : frame.points.at(first)) point.push_back(place_mm);
        points.push_back(std::move(point));
        first += count;
    }
    return {{"step", frame.head.step}, {"residual", frame.head.residual}, {"size_mm", frame.head.size_mm}, {"layout", frame.head.layout},
            {"first_points_mm", std::move(points)}};
}

/// The same session in C++: to its rest, with the same change to its rest again, closed.
Json seen_here(const Box& box) {
    Followed session(box, document_of(cloth), at(sim::Fidelity::standard));
    session.run();
    REQUIRE(session.until_rest());
    const Json rested = shown(*session.newest);
    session.change(wire::Parameters{{.strain = 1.02, .stiffness_scale = {}, .radius_scale = 1.1}, {}});
    REQUIRE(session.next<wire::Applied>());
    REQUIRE(session.until_rest());
    const Json changed = shown(*session.newest);
    const Yarns yarns = read_yarns(session.yarns()).value();
    CHECK(yarns.report.at("converged") == true);
    for (std::size_t y = 0; y < yarns.yarns.size(); ++y) {  // a frame is off by less than a fiftieth of a radius
        for (std::size_t axis = 0; axis < 3; ++axis)
            CHECK(std::abs(changed.at("first_points_mm")[y][axis].get<double>() - yarns.yarns[y].spline.control.front()[axis]) < 0.02 * yarns.yarns[y].radius_mm);
    }
    session.ask(wire::Close{wire::new_request_id(), session.number});
    REQUIRE(session.next<wire::Ended>());
    REQUIRE(session.follower().acknowledge());
    return {{"rested", rested}, {"changed", changed}, {"residual", yarns.report.at("residual")}};
}

void check_same(const Json& python, const Json& here) {
    INFO(python.dump(1) << here.dump(1));
    const Json& session = python.at("session");
    CHECK(session.at("rested") == here.at("rested"));
    CHECK(session.at("changed") == here.at("changed"));
    CHECK(session.at("applied_at") == here.at("rested").at("step"));
    CHECK(session.at("state").at("residual") == here.at("residual"));
    CHECK(session.at("state").at("step") == here.at("changed").at("step"));
    CHECK(session.at("ended").at("why") == "closed");
    CHECK(session.at("ended").at("residual") == here.at("residual"));
    CHECK(python.at("job").at("residual") == here.at("rested").at("residual"));
    CHECK(python.at("job").at("steps") == here.at("rested").at("step"));
    CHECK(python.at("events").at("applied") == 1);
    CHECK(python.at("events").at("ended") == 1);
    CHECK(python.at("connections") == 3);  // one that was cut, one to the session's end, one for the job
    CHECK(python.at("closed") == Json::array({1000, 1000}));
}

}  // namespace

TEST_CASE("Python, written from the document, sees what C++ sees, on the Unix socket and over TLS", "[.][python]") {
    const Box box(Json{{"address", "127.0.0.1"}, {"port", 0}, {"hosts", {"127.0.0.1"}}});
    const Json here = seen_here(box);
    const Json local = seen_at(box, "unix:" + (box.folder() / "simd.sock").string());
    check_same(local, here);
    CHECK(local.at("person").is_null());

    const std::string url = box.introduction.at("url"), pinned = " --fingerprint " + box.introduction.at("certificate_sha256").get<std::string>();
    const auto token = box.config_file().parent_path() / "token";
    const auto program = std::filesystem::path(WEAVE_PROGRAM).parent_path() / "simd";
    REQUIRE(run(in_quotes(program) + " token add " + in_quotes(box.folder()) + " dora > " + in_quotes(token)).second == 0);
    const Json remote = seen_at(box, url, "--token-file " + in_quotes(token) + pinned);
    check_same(remote, here);
    CHECK(remote.at("person") == "dora");
    CHECK(box.status().at("sessions").empty());

    const auto [refused, status] = follow(box, url, pinned);
    CHECK(status == 1);
    CHECK_THAT(refused, Catch::Contains("401"));
    const auto [stranger, stopped] = follow(box, url, "--token-file " + in_quotes(token) + " --fingerprint " + std::string(64, '0'));
    CHECK(stopped == 1);
    CHECK_THAT(stranger, Catch::Contains("another certificate"));
}
